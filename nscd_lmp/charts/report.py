# SPDX-License-Identifier: GPL-2.0-or-later
"""The table of a chart for the terminal: who is cheapest at which error."""

from __future__ import annotations

import math
from collections.abc import Sequence
from types import ModuleType
from typing import Any

from rich.table import Table
from rich.text import Text

from nscd_lmp.charts.pareto import COST, Row, compare, usable

MOST_LEVELS = 6


def levels(rows: Sequence[Row], error: str, floor: float) -> list[float]:
    """Return the powers of ten above the errors of a table, largest first, and `floor` if some are below it."""
    values = [row[error] for row in usable(rows, error)]
    above = [value for value in values if value > floor]
    if not above:
        return [floor] if values else []
    high, low = (math.ceil(math.log10(value)) for value in (max(above), min(above)))
    step = max(1, math.ceil((high - low + 1) / MOST_LEVELS))
    powers = [10.0**power for power in range(high, low - 1, -step)]
    return powers + ([floor] if len(above) < len(values) else [])


def closing_table(scene: ModuleType, rows: Sequence[Row]) -> Table:
    """Return, for errors and levels, the cheapest rigid and penalty runs and how many times rigid is faster."""
    table = Table(title=Text(scene.TITLE), caption="s/s: processor seconds per simulated second")
    for name in ("error", "at most", "rigid", "s/s", "penalty", "s/s", "rigid is faster by"):
        table.add_column(name, justify="right" if name in ("at most", "s/s", "rigid is faster by") else "left")
    floor = getattr(scene, "FLOOR", 1e-14)
    for error in scene.ERRORS:
        for number, found in enumerate(_strictest(compare(rows, error, levels(rows, error, floor)))):
            cells = [_words(found["rigid"]), _cost(found["rigid"]), _words(found["penalty"]), _cost(found["penalty"])]
            faster = "" if math.isnan(found["faster"]) else f"{found['faster']:.3g}"
            table.add_row(error if number == 0 else "", f"{found['level']:g}", *map(Text, cells), faster)
        table.add_section()
    return table


def _strictest(found: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return of levels with the same runs the last one."""
    following = [*found[1:], {"rigid": None, "penalty": None}]
    return [
        one
        for one, after in zip(found, following, strict=True)
        if (one["rigid"], one["penalty"]) != (after["rigid"], after["penalty"])
    ]


def _words(row: Row | None) -> str:
    """Return a run in words."""
    if row is None:
        return "none"
    given = [f"{name} {row[name]:g}" for name in ("tol", "overlap", "stiffness", "dt") if row.get(name) is not None]
    return f"{row['method']}, {', '.join(given)}"


def _cost(row: Row | None) -> str:
    return "" if row is None else f"{row[COST]:.3g}"
