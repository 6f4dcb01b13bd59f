# SPDX-License-Identifier: GPL-2.0-or-later
"""One look for all pictures: fonts, colours, length units, saving."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from cycler import cycler
from matplotlib.figure import Figure
from numpy.typing import NDArray

# The scripts run under matplotlib.rc_context(STYLE); the plot_* functions take what is in force.
STYLE: Any = {
    "axes.prop_cycle": cycler(color=["#21618c", "#d35400", "#7f8c8d", "#1e8449"]),
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.titlesize": 11,
    "axes.labelsize": 11,
    "grid.color": "#e3e6e8",
    "grid.linewidth": 0.8,
    "font.size": 10,
    "legend.frameon": False,
    "lines.linewidth": 1.8,
    "figure.dpi": 160,
}


class LengthUnit(NamedTuple):
    """A unit for axis labels; dump lengths are multiplied by `factor`."""

    name: str
    factor: float


LENGTH_UNITS = {
    "m": LengthUnit("m", 1.0),
    "mm": LengthUnit("mm", 1e3),
    "um": LengthUnit("µm", 1e6),
    "raw": LengthUnit("dump units", 1.0),
}


def choose_length_unit(name: str, radius: NDArray[np.float64]) -> LengthUnit:
    """Look a unit up; ``auto`` takes the one in which the mean radius (in m) is readable."""
    if name != "auto":
        return LENGTH_UNITS[name]
    mean = float(np.mean(radius))
    return LENGTH_UNITS["m" if mean >= 0.01 else "mm" if mean >= 2e-5 else "um"]


def new_figure(width: float = 6.0, height: float = 4.2, panels: int = 1) -> tuple[Figure, Any]:
    """Make a figure; returns it and its axes (an array for several panels).

    No pyplot, so no window and no backend: a cluster node has no screen.
    """
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, figure.subplots(1, panels)


def save_figure(figure: Figure, output: str | Path) -> None:
    """Write the picture, making its folder if needed."""
    Path(output).parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(output, facecolor="white")
