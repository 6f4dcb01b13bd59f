# SPDX-License-Identifier: GPL-2.0-or-later
"""Pareto fronts of cost and error, and what they say of one family of methods against another."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, TypeGuard

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nscd_lmp.charts.methods import METHODS, PENALTY, RIGID
from nscd_lmp.sweeps.record import OK

Row = Mapping[str, Any]

COST = "seconds_per_second"  # column: processor seconds per simulated second


def front(cost: ArrayLike, error: ArrayLike) -> NDArray[np.intp]:
    """Return the indices of the points that no other beats in both, cheapest first.

    Parameters
    ----------
    cost, error : array_like, shape (n,)
        Points with a NaN are left out.
    """
    costs, errors = np.asarray(cost, dtype=float), np.asarray(error, dtype=float)
    best, kept = np.inf, []
    for k in np.lexsort((errors, costs)):
        if errors[k] < best and np.isfinite(costs[k]):
            best = errors[k]
            kept.append(k)
    return np.array(kept, dtype=np.intp)


def usable(rows: Iterable[Row], error: str) -> list[Row]:
    """Return the rows that have a cost and this error, and whose run solved all of its steps."""
    return [
        row
        for row in rows
        if row.get("status", OK) == OK
        and all(is_number(row.get(name)) for name in (COST, error))
        and not row.get("unconverged_steps")
    ]


def is_number(value: Any) -> TypeGuard[float]:
    """Return whether a cell of a table is a finite number."""
    return isinstance(value, int | float) and bool(np.isfinite(value))


def family(row: Row) -> str:
    """Return rigid or penalty."""
    return METHODS[row["method"]].family


def cheapest(rows: Iterable[Row], error: str, level: float, family_: str | None = None) -> Row | None:
    """Return the row with the least cost whose error is at most `level`, of all methods or one family; None if none."""
    found = [row for row in usable(rows, error) if row[error] <= level and family_ in (None, family(row))]
    return min(found, key=lambda row: row[COST], default=None)


def compare(rows: Sequence[Row], error: str, levels: Iterable[float]) -> list[dict[str, Any]]:
    """Return, for each level of an error, the cheapest rigid and penalty rows and how many times rigid is faster.

    Returns
    -------
    list of dict
        ``level``, ``rigid`` and ``penalty`` (rows or None) and ``faster`` (NaN if one of them is None).
    """
    table = []
    for level in levels:
        rigid, penalty = (cheapest(rows, error, level, name) for name in (RIGID, PENALTY))
        faster = penalty[COST] / rigid[COST] if rigid and penalty else float("nan")
        table.append({"level": level, "rigid": rigid, "penalty": penalty, "faster": faster})
    return table
