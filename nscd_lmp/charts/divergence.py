# SPDX-License-Identifier: GPL-2.0-or-later
"""How long trajectories of the sedimentation can be compared: runs that are all fine, and what they differ by.

python -m nscd_lmp.charts.divergence FOLDER
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from nscd_lmp.charts.beds import follow
from nscd_lmp.charts.draw import DPI, STYLE
from nscd_lmp.charts.grains import per_grain
from nscd_lmp.charts.scenes import sedimentation
from nscd_lmp.charts.sedimentations import Sedimentation

Array = NDArray[np.float64]

FINEST, OTHERS = 1e-5, (2e-5, 5e-5, 2e-4)  # s
TOL = 1e-10  # m/s
EVERY = 1e-3  # s


def trajectory(run: Sedimentation, folder: Path, dt: float) -> Array:
    """Return the places after every EVERY seconds, (times, n, 3) in m."""
    contacts = run.scene.begin(folder, {"method": "gap/apgs", "dt": dt, "tol": TOL})
    places: list[Array] = []
    steps = round(run.simulated / dt)
    follow(contacts, steps, round(EVERY / dt), lambda _: places.append(per_grain(contacts.lmp, "x")))
    contacts.lmp.close()
    return np.array(places)


def distances(run: Sedimentation, folder: Path) -> dict[str, list[float]]:
    """Return the times (s), and of each dt the distance and the relative difference of heights from the finest run."""
    right = trajectory(run, folder, FINEST)
    radius = run.scene.cloud.radius.mean()
    table = {"time": [EVERY * (k + 1) for k in range(len(right))]}
    for dt in OTHERS:
        x = trajectory(run, folder, dt)
        apart = ((x - right) ** 2).sum(axis=2).mean(axis=1)
        table[f"distance, dt {dt:g} s"] = (np.sqrt(apart) / radius).tolist()
        table[f"height, dt {dt:g} s"] = np.abs(x[..., 2].mean(axis=1) / right[..., 2].mean(axis=1) - 1).tolist()
    return table


def draw(table: dict[str, list[float]], window: float, path: Path) -> None:
    """Draw both over time, with the end of the window."""
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(8.4, 3.4), layout="constrained")
        panels = {
            "distance": "distance to the finest run / radius",
            "height": "height of the centre of mass, difference",
        }
        for axes, (name, label) in zip(figure.subplots(1, 2), panels.items(), strict=True):
            for column, values in table.items():
                if column.startswith(name):
                    axes.semilogy(table["time"], np.maximum(values, 1e-16), label=column.partition(", ")[2])
            axes.axvline(window, color="gray", linestyle=":")
            axes.set_ylim(1e-6, 3)
            axes.set_xlabel("time, s")
            axes.set_ylabel(label)
        axes.legend(title="law gap against dt 1e-5 s")
        figure.savefig(path, dpi=DPI)


def main(folder: Path) -> None:
    """Run, write ``divergence.csv`` and draw ``divergence.png``."""
    folder.mkdir(parents=True, exist_ok=True)
    table = distances(sedimentation.RUN, folder)
    with open(folder / "divergence.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(table)
        writer.writerows(zip(*table.values(), strict=True))
    draw(table, sedimentation.RUN.window, folder / "divergence.png")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
