# SPDX-License-Identifier: GPL-2.0-or-later
"""What the lines of a chart are: the runs of each method, methods that do the same in one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from nscd_lmp._choices import SOLVERS
from nscd_lmp.charts.methods import METHODS, RIGID, Method
from nscd_lmp.charts.pareto import COST, Row, is_number

SAME_ERROR = 1.05  # factors within which methods are drawn as one
SAME_COST = 2.0  # of one point; of the median point SAME_MEDIAN
SAME_MEDIAN = 1.25
NAMED = 3  # methods of a line that its label names one by one


@dataclass(frozen=True)
class Series:
    """The runs of one method or of several that cannot be told apart; the line is that of the first."""

    methods: tuple[Method, ...]
    rows: tuple[Row, ...]

    @property
    def first(self) -> list[Row]:
        """The rows of the first method."""
        return [row for row in self.rows if row["method"] == self.methods[0].name]


def make_series(rows: Sequence[Row], errors: Sequence[str], floor: float) -> list[Series]:
    """Return the series of rows, in the order of the methods.

    Methods are the same if all their runs have the same errors within SAME_ERROR (all below `floor` are the same) and
    costs that differ by less than SAME_COST, in the middle by less than SAME_MEDIAN.
    """
    groups: list[list[str]] = []
    tables = {name: _table(rows, name) for name in dict.fromkeys(row["method"] for row in rows)}
    for name, table in tables.items():
        for group in groups:
            if _same(tables[group[0]], table, errors, floor):
                group.append(name)
                break
        else:
            groups.append([name])
    return [
        Series(tuple(METHODS[name] for name in group), tuple(row for row in rows if row["method"] in group))
        for group in groups
    ]


def _table(rows: Sequence[Row], method: str) -> dict[Any, Row]:
    """Return the rows of a method by what was varied."""
    others = ("dt", "tol", "overlap", "stiffness", "grains")
    return {tuple(row.get(name) for name in others): row for row in rows if row["method"] == method}


def _same(one: dict[Any, Row], other: dict[Any, Row], errors: Sequence[str], floor: float) -> bool:
    if one.keys() != other.keys():
        return False
    ratios = []
    for key, row in one.items():
        twin = other[key]
        if row.get("status") != twin.get("status") or bool(row.get("unconverged_steps")) != bool(
            twin.get("unconverged_steps")
        ):
            return False
        for name in errors:
            if is_number(row.get(name)) != is_number(twin.get(name)):
                return False
            if is_number(row.get(name)) and not _near(row[name], twin[name], floor):
                return False
        if is_number(row.get(COST)) and is_number(twin.get(COST)):
            ratios.append(abs(np.log(row[COST] / twin[COST])))
    return not ratios or (max(ratios) < np.log(SAME_COST) and float(np.median(ratios)) < np.log(SAME_MEDIAN))


def _near(a: float, b: float, floor: float) -> bool:
    low, high = sorted((max(abs(a), floor), max(abs(b), floor)))
    return high <= SAME_ERROR * low


def label(series: Series, all_methods: Sequence[str]) -> str:
    """Return the words of the legend: the methods of a line, those of one law or family being `all_methods`."""
    if series.methods[0].family != RIGID:
        return ", ".join(method.title for method in series.methods)
    titles = [SOLVERS[method.solver].title for method in series.methods]
    if len(titles) > NAMED:
        missing = [name for name in all_methods if name not in {method.name for method in series.methods}]
        if not missing:
            return f"all {len(titles)} solvers"
        if len(missing) <= NAMED:
            return f"the {len(titles)} other solvers"
    return ", ".join(titles)
