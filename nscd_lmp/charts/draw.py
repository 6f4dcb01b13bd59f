# SPDX-License-Identifier: GPL-2.0-or-later
"""The picture of a chart: error against processor seconds per simulated second.

A row of panels an error, a column each for the contact laws and the penalty models. Points are all runs, the line of a
method goes through those that no other of its runs beats; the bold steps are the Pareto fronts of all rigid and all
penalty methods, the same in every column.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedFormatter, FixedLocator, LogLocator, NullLocator

from nscd_lmp._choices import LAWS, LOCAL_LAWS, SOLVERS
from nscd_lmp.charts.methods import METHODS, PENALTY, RIGID, Method
from nscd_lmp.charts.pareto import COST, Row, family, front, is_number, usable
from nscd_lmp.charts.series import Series, label, make_series

STYLE: Any = {
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 10,
    "legend.frameon": False,
    "legend.fontsize": 8,
    "svg.hashsalt": "nscd_lmp",
}
FLOOR = 1e-14  # of scenes without their own
FRONTS = {RIGID: ("#1f4e9c", "best of rigid"), PENALTY: ("#c0392b", "best of penalty")}
# Local laws are blues and greens from slow to fast, solvers of all contacts at once have colors of their own.
LOCAL_COLORS = ("#9ecae1", "#6baed6", "#74c476", "#31a354", "#08519c")
GLOBAL_COLORS = ("#7b3294", "#e08214", "#8c510a", "#111111", "#01665e")
PENALTY_COLORS = ("#e31a1c", "#fd8d3c", "#a50f5a")
MARKERS = "osD^v<>ph*"
DPI = 150
BAND = 0.12  # of the decades of errors, how far below them zero is drawn
LINE = 40  # characters of an axis' label


def color_and_marker(method: Method) -> tuple[str, str]:
    """Return what a method has in all charts."""
    if method.family == PENALTY:
        place = [name for name, other in METHODS.items() if other.family == PENALTY].index(method.name)
        return PENALTY_COLORS[place % len(PENALTY_COLORS)], MARKERS[place % len(MARKERS)]
    marker = MARKERS[list(SOLVERS).index(method.solver) % len(MARKERS)]
    if method.solver in LOCAL_LAWS:
        return LOCAL_COLORS[list(LOCAL_LAWS).index(method.solver) % len(LOCAL_COLORS)], marker
    others = [name for name in SOLVERS if name not in LOCAL_LAWS]
    return GLOBAL_COLORS[others.index(method.solver) % len(GLOBAL_COLORS)], marker


def draw(scene: Any, rows: Sequence[Row], path: Path) -> list[Path]:
    """Draw a scene's table.

    Parameters
    ----------
    scene : module
        See :mod:`nscd_lmp.charts.scenes`.
    rows : sequence of mappings
        Of its table, with the column ``seconds_per_second``.
    path : Path
        Of the pictures, without suffix.

    Returns
    -------
    list of Path
        PNG and SVG.
    """
    columns = _columns(rows)
    width, height = 3.5 * len(columns) + 0.9, 2.7 * len(scene.ERRORS) + 1.7
    pictures = [path.with_name(path.name + suffix) for suffix in (".png", ".svg")]
    path.parent.mkdir(parents=True, exist_ok=True)
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(width, height), layout="constrained")
        grid = figure.subplots(len(scene.ERRORS), len(columns), sharex=True, sharey="row", squeeze=False)
        figure.suptitle(scene.TITLE, fontsize=11)
        floor = getattr(scene, "FLOOR", FLOOR)
        for axes_row, error in zip(grid, scene.ERRORS, strict=True):
            ErrorRow(rows, error, list(scene.ERRORS), floor, getattr(scene, "REFERENCES", ())).draw(axes_row, columns)
            axes_row[0].set_ylabel(_wrapped(scene.ERRORS[error]))
        for axes, (title, own) in zip(grid[0], columns.items(), strict=True):
            failed = sum(row.get("status", "ok") != "ok" for row in own)
            axes.set_title(title + (f" ({failed} of {len(own)} runs failed)" if failed else ""))
        for axes, own in zip(grid[-1], columns.values(), strict=True):
            axes.set_xlabel("processor seconds per simulated second")
            _legend(axes, own, list(scene.ERRORS), floor, rows)
        for picture in pictures:
            metadata = {"Date": None} if picture.suffix == ".svg" else {}
            figure.savefig(picture, dpi=DPI, metadata=metadata)
    return pictures


def _columns(rows: Sequence[Row]) -> dict[str, list[Row]]:
    """Return the rows of each column of panels by its title."""
    columns = {
        f"rigid, law {law}": [row for row in rows if METHODS[row["method"]].law == law] for law in reversed(LAWS)
    }
    columns["penalty"] = [row for row in rows if family(row) == PENALTY]
    return {title: own for title, own in columns.items() if own}


class ErrorRow:
    """The panels of one error."""

    def __init__(
        self, rows: Sequence[Row], error: str, errors: list[str], floor: float, references: Sequence[Any]
    ) -> None:
        self.rows, self.error, self.errors, self.floor = rows, error, errors, floor
        # (label, seconds, {error: value}, source)
        self.stars = [(name, cost, values[error]) for name, cost, values, _ in references if error in values]
        values = [row[error] for row in rows if is_number(row.get(error))]
        above = [value for value in [*values, *(star[2] for star in self.stars)] if value > floor]
        self.lowest = min(above, default=1.0)
        self.highest = max(above, default=1.0)
        self.exact = any(value <= floor for value in values)
        below = max(1, round(BAND * math.log10(self.highest / self.lowest)))
        self.drawn_floor = 10.0 ** (math.floor(math.log10(self.lowest)) - below)

    def y(self, value: float) -> float:
        """Return where an error is drawn."""
        return value if value > self.floor else self.drawn_floor

    def draw(self, axes_row: Sequence[Any], columns: dict[str, list[Row]]) -> None:
        """Draw all panels."""
        axes_row[0].set_xscale("log")
        axes_row[0].set_yscale("log")
        self._scale(axes_row[0])
        for axes, own in zip(axes_row, columns.values(), strict=True):
            axes.grid(True, which="major", color="#e8e8e8", linewidth=0.6)
            axes.set_axisbelow(True)
            if self.exact:
                axes.axhspan(axes.get_ylim()[0], math.sqrt(self.drawn_floor * self.lowest), color="#f2f2f2", zorder=0)
            for name in FRONTS:
                self._front(axes, name)
            for series in make_series(own, self.errors, self.floor):
                self._series(axes, series)
            for name, cost, value in self.stars:
                axes.plot([cost], [value], "*", color="black", markersize=8, zorder=5)
                axes.annotate(name, (cost, value), (4, 4), textcoords="offset points", fontsize=7)

    def _scale(self, axes: Any) -> None:
        top = self.highest * 3
        axes.set_ylim(self.drawn_floor**1.5 / self.lowest**0.5 if self.exact else self.lowest / 3, top)
        places = [place for place in _ticks(self.lowest / 3, top) if not self.exact or place >= self.lowest / 3]
        names = [_power_of_ten(place) for place in places]
        if self.exact:
            places, names = [self.drawn_floor, *places], [_power_of_ten(self.floor, "\\leq "), *names]
        axes.yaxis.set_major_locator(FixedLocator(places))
        axes.yaxis.set_major_formatter(FixedFormatter(names))
        axes.yaxis.set_minor_locator(NullLocator())
        axes.xaxis.set_major_locator(LogLocator(numticks=7))
        axes.xaxis.set_minor_locator(NullLocator())

    def _front(self, axes: Any, name: str) -> None:
        found = [row for row in usable(self.rows, self.error) if family(row) == name]
        if not found:
            return
        cost = np.array([row[COST] for row in found])
        error = np.array([self.y(row[self.error]) for row in found])
        best = front(cost, error)
        x = [cost[best[0]], *cost[best], max(row[COST] for row in self.rows if is_number(row.get(COST))) * 1.5]
        y = [self.highest * 3, *error[best], error[best[-1]]]
        axes.step(x, y, where="post", color=FRONTS[name][0], linewidth=4, alpha=0.3, zorder=1, solid_joinstyle="miter")

    def _series(self, axes: Any, series: Series) -> None:
        color, marker = color_and_marker(series.methods[0])
        drawn = [row for row in series.rows if is_number(row.get(COST)) and is_number(row.get(self.error))]
        for solved in (True, False):
            some = [row for row in drawn if (not row.get("unconverged_steps")) == solved]
            points = [row[COST] for row in some], [self.y(row[self.error]) for row in some]
            face = color if solved else "none"
            axes.scatter(*points, s=11, marker=marker, facecolors=face, edgecolors=color, linewidths=0.7, zorder=3)
        solved_rows = usable(series.first, self.error)
        if not solved_rows:
            return
        cost = np.array([row[COST] for row in solved_rows])
        error = np.array([self.y(row[self.error]) for row in solved_rows])
        best = front(cost, error)
        axes.plot(cost[best], error[best], color=color, linewidth=1.2, zorder=2)


def _ticks(low: float, high: float) -> list[float]:
    """Return powers of ten, six or so at most; if there are but one or two, also what lies between them."""
    powers = range(math.ceil(math.log10(low)), math.floor(math.log10(high)) + 1)
    if len(powers) > 2:
        return [10.0**power for power in powers[:: math.ceil(len(powers) / 6)]]
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)))
    places = [lead * 10.0**power for power in decades for lead in (1, 2, 5)]
    return [place for place in places if low < place < high]


def _power_of_ten(value: float, before: str = "") -> str:
    power = math.floor(math.log10(value) + 1e-9)
    lead = round(value / 10.0**power)
    times = "" if lead == 1 else rf"{lead} \cdot "
    return f"${before}{times}10^{{{power}}}$"


def _wrapped(words: str) -> str:
    """Return a label in lines that fit beside a panel."""
    return "\n".join(line for part in words.split("\n") for line in textwrap.wrap(part, LINE))


def _legend(axes: Any, own: Sequence[Row], errors: list[str], floor: float, rows: Sequence[Row]) -> None:
    handles = []
    for series in make_series(own, errors, floor):
        color, marker = color_and_marker(series.methods[0])
        words = label(series, list(dict.fromkeys(row["method"] for row in own)))
        handles.append(Line2D([], [], color=color, marker=marker, markersize=4, linewidth=1.2, label=words))
    if any(row.get("unconverged_steps") for row in own):
        words = "hollow: steps left above tol"
        handles.append(Line2D([], [], color="none", marker="o", markersize=4, markeredgecolor="gray", label=words))
    if family(own[0]) == PENALTY or len({family(row) for row in rows}) == 1:
        for name in dict.fromkeys(family(row) for row in rows):
            color, words = FRONTS[name]
            handles.append(Line2D([], [], color=color, alpha=0.3, linewidth=4, label=words))
    axes.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.24), ncols=2 if len(handles) > 4 else 1)
