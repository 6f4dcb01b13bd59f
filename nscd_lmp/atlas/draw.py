# SPDX-License-Identifier: GPL-2.0-or-later
"""Pictures of a map: a cell for every pair of parameters, one colour an outcome."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from nscd_lmp.atlas.grid import Axis, Cell, Value
from nscd_lmp.atlas.map import Map
from nscd_lmp.atlas.outcomes import OUTCOMES, is_silent

CELL = (0.56, 0.36)  # inch
FONT = 8.0
DARK = ("converged", "diverged", "penetrated", "lost atoms")  # colours that take white figures
MOST_ACROSS = 4  # panels
CHARACTERS = 17.0  # of the text below the picture, an inch


def draw(made: Map, cells: Sequence[Cell], path: Path) -> list[Path]:
    """Draw the map with its explanation.

    Parameters
    ----------
    made : Map
    cells : sequence of dict
        With ``panel``, the names of both axes, ``outcome``, ``shown`` and ``told``.
    path : Path
        Of the pictures, without ending.

    Returns
    -------
    list of Path
        PNG and SVG.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    xs, ys = (_present(axis, cells) for axis in (made.X, made.Y))
    across, down = _arrangement(len(made.PANELS), len(xs))
    width, height = across * (CELL[0] * len(xs) + 0.5) + 1.3, down * (CELL[1] * len(ys) + 0.75) + 0.2
    text = _explanation(made, cells, max(width, 7.0))
    below = 0.15 * (text.count("\n") + 1) + 0.72
    figure = Figure(figsize=(max(width, 7.0), height + below + 0.35), layout="constrained")
    FigureCanvasAgg(figure)
    parts: Any = figure.subfigures(2, 1, height_ratios=[height + 0.35, below])
    top, bottom = parts
    axes = top.subplots(down, across, squeeze=False, sharex=True, sharey=True)
    for number, panel in enumerate(made.PANELS):
        _draw_panel(axes.flat[number], made, panel, cells, xs, ys)
    for empty in axes.flat[len(made.PANELS) :]:
        empty.set_axis_off()
    top.suptitle(made.TITLE, fontsize=FONT + 3)
    top.supxlabel(made.X.label, fontsize=FONT + 1)
    top.supylabel(made.Y.label, fontsize=FONT + 1)
    _draw_below(bottom, cells, text, made.SHOWN)
    paths = [path.with_suffix(ending) for ending in (".png", ".svg")]
    for one in paths:
        figure.savefig(one, dpi=110)
    return paths


def _present(axis: Axis, cells: Sequence[Cell]) -> list[Value]:
    """Return the values of an axis that cells have."""
    there = [cell[axis.name] for cell in cells]
    return [value for value in axis.values if value in there]


def _arrangement(panels: int, values: int) -> tuple[int, int]:
    """Return how many panels stand side by side, and in how many rows."""
    across = min(panels, MOST_ACROSS if values <= 7 else 3)
    if panels == 4 and values > 5:
        across = 2
    return across, math.ceil(panels / across)


def _draw_panel(axes: Any, made: Map, panel: str, cells: Sequence[Cell], xs: list[Value], ys: list[Value]) -> None:
    from matplotlib.patches import Rectangle

    for cell in cells:
        if cell["panel"] != panel:
            continue
        i, j = xs.index(cell[made.X.name]), ys.index(cell[made.Y.name])
        silent = is_silent(cell["outcome"], cell["told"])
        axes.add_patch(
            Rectangle(
                (i - 0.5, j - 0.5), 1, 1, facecolor=OUTCOMES[cell["outcome"]], edgecolor="white", linewidth=1.0,
                hatch="////" if silent else None,
            )
        )  # fmt: skip
        colour = "white" if cell["outcome"] in DARK else "black"
        box = {"facecolor": OUTCOMES[cell["outcome"]], "edgecolor": "none", "pad": 1.0} if silent else None
        axes.text(i, j, _text(cell["shown"]), ha="center", va="center", fontsize=FONT, color=colour, bbox=box)
    axes.set(xlim=(-0.5, len(xs) - 0.5), ylim=(-0.5, len(ys) - 0.5))
    axes.set_xticks(range(len(xs)), [label(x) for x in xs], fontsize=FONT)
    axes.set_yticks(range(len(ys)), [label(y) for y in ys], fontsize=FONT)
    axes.tick_params(length=0, labelbottom=True)
    axes.set_title(made.PANELS[panel], fontsize=FONT + 1)
    for side in axes.spines.values():
        side.set_visible(False)


def _text(shown: Any) -> str:
    return label(shown) if isinstance(shown, float) else str(shown)


def label(value: Value) -> str:
    """Return a value as a tick: 0.1, 20, 10^4, 3x10^-6, or the word it is."""
    if isinstance(value, str):
        return value
    if value == 0 or 0.009 < abs(value) < 1001:
        return f"{value:.3g}" if value < 1000 else "$10^3$"
    power = math.floor(math.log10(abs(value)) + 1e-9)
    factor = value / 10.0**power
    times = "" if math.isclose(factor, 1) else rf"{factor:.2g}\cdot"
    return rf"${times}10^{{{power}}}$"


def _explanation(made: Map, cells: Sequence[Cell], width: float) -> str:
    """Return mechanism and remedy, in lines that fit the width, inch."""
    silent = {cell["outcome"] for cell in cells if is_silent(cell["outcome"], cell["told"])}
    untold = [f"Not told ({outcome}): {why}" for outcome, why in made.UNSEEN.items() if outcome in silent]
    parts = [made.MECHANISM, f"Remedy: {made.REMEDY}", *untold]
    return "\n".join(textwrap.fill(part, round(width * CHARACTERS)) for part in parts)


def _draw_below(figure: Any, cells: Sequence[Cell], text: str, shown: str) -> None:
    """Draw the legend, what the numbers are, and the explanation."""
    from matplotlib.patches import Patch

    there = {cell["outcome"] for cell in cells}
    patches = [Patch(facecolor=colour, label=name) for name, colour in OUTCOMES.items() if name in there]
    if any(is_silent(cell["outcome"], cell["told"]) for cell in cells):
        patches.append(Patch(facecolor="white", edgecolor="black", hatch="////", label="nothing was told"))
    figure.legend(handles=patches, loc="upper center", ncols=len(patches), fontsize=FONT, frameon=False)
    figure.text(0.5, 1 - 0.42 / figure.bbox.height * figure.dpi, f"Numbers: {shown}.", ha="center", fontsize=FONT)
    figure.text(0.02, 1 - 0.62 / figure.bbox.height * figure.dpi, text, ha="left", va="top", fontsize=FONT)
