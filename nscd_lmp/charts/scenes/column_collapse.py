# SPDX-License-Identifier: GPL-2.0-or-later
"""A column of grains with friction, released at once."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from nscd_lmp.charts.beds import DENSITY, Scene, Watch, box_walls, follow, loose_cloud, steps_between_looks
from nscd_lmp.charts.cases import penalty_cases, rigid_cases
from nscd_lmp.charts.grains import per_grain
from nscd_lmp.charts.references import Arrays, kept
from nscd_lmp.charts.sedimentations import costs
from nscd_lmp.charts.size import Size

ORDER = 65
TITLE = "Collapse of a square column of 600 grains, friction 0.5"
ERRORS = {
    "overlap_max": "largest overlap / radius",
    "spread": "mean distance from the axis,\nrelative error",
    "height": "height of the centre of mass,\nrelative error",
    "coordination": "contacts a grain at the end,\nrelative error",
}
NOTES = """A column three times as high as half its width, settled between four walls without spin (law gap, dt 5e-4
s), is released at once on a plane; grains and plane have friction 0.5, e = 0. 0.1 s: later the grains roll apart
for ever, there is no rolling friction. Spread and height are compared over the whole run, root mean square, with
law gap at dt 1e-4 s and tol 1e-7; contacts are pairs nearer than 1 % of a radius, over the last fifth. Steps with
friction that end at maxiter 2000 above tol are hollow points. Seconds are processor seconds of the one thread, one
run."""

SMALLEST, LARGEST = 0.8e-3, 1.2e-3  # m
FRICTION = 0.5
LIGHTEST = DENSITY * 4 / 3 * np.pi * SMALLEST**3  # kg
WIDTH = {600: 14.5e-3, 60: 7e-3}  # m, by grains
FILLED, SIMULATED = {600: 0.2, 60: 0.05}, {600: 0.1, 60: 0.02}  # s
FINE = {600: (1e-4, 1e-7), 60: (2e-4, 1e-6)}  # dt in s, tol in m/s
FILLING: dict[str, Any] = {"method": "gap/apgs", "dt": 5e-4, "tol": 1e-6}
NEAR = 0.01  # of the smaller radius
OPTIONS = "maxiter 2000"
STIFFNESSES = (1e3, 3e3, 1e4, 1e5)  # N/m


def cases(size: Size) -> list[dict[str, Any]]:
    """Return the cases."""
    if size is Size.QUICK:
        return [
            *rigid_cases(["gap/pdas"], [5e-4], [1e-5], grains=60),
            *penalty_cases(["gran/hooke/history"], [1e3], LIGHTEST, [1 / 5], grains=60),
        ]
    return [
        *rigid_cases(["gap/pdas", "gap/apgs"], [5e-4, 1e-3], [1e-3, 1e-4, 1e-5], grains=600),
        *rigid_cases(["gap/pdas"], [2e-4], [1e-4], grains=600),
        *rigid_cases(["gap/sal", "gap/eal"], [5e-4], [1e-4], grains=600),
        *rigid_cases(["moreau/pdas"], [5e-5, 2e-4], [1e-5], grains=600),
        *penalty_cases(["gran/hooke/history"], STIFFNESSES, LIGHTEST, [1 / 10], grains=600),
        *penalty_cases(["gran/hooke/history"], STIFFNESSES[:1], LIGHTEST, [1 / 7, 1 / 5], grains=600),
        *penalty_cases(["granular/hooke", "granular/hertz"], STIFFNESSES[:2], LIGHTEST, [1 / 10], grains=600),
    ]


def column(grains: int) -> Scene:
    """Return the grains between their walls, loose."""
    width = WIDTH[grains]
    cloud = loose_cloud(grains, width, SMALLEST, LARGEST)
    return Scene(
        cloud, box_walls(width), [(0, width), (0, width), (0, cloud.height)], boundary="m m fm", options=OPTIONS
    )


def fill(folder: Path, grains: int) -> Arrays:
    """Return the places in the settled column."""
    contacts = column(grains).begin(folder, FILLING)
    contacts.run(round(FILLED[grains] / FILLING["dt"]))
    found = {"x": per_grain(contacts.lmp, "x")}
    contacts.lmp.close()
    return found


class Heap(Watch):
    """A watch that notes spread and contacts too."""

    def begin(self, axis: float, since: float) -> None:
        """`axis` (m) is where the column stands along x and y; contacts are counted `since` (s)."""
        self.axis, self.since = axis, since
        self.spreads: list[float] = []
        self.contacts: list[float] = []

    def look(self, taken: int) -> Any:
        """Look."""
        x = super().look(taken)
        self.spreads.append(float(np.linalg.norm(x[:, :2] - self.axis, axis=1).mean()))
        if self.times[-1] >= self.since:
            self.contacts.append(self.probe.coordination(x, NEAR))
        return x


def collapse(folder: Path, case: dict[str, Any]) -> tuple[Heap, dict[str, Any]]:
    """Release the column; return what was seen and what it cost."""
    grains = case["grains"]
    loose = column(grains)
    x = kept(folder, f"column_{grains}", lambda: fill(folder, grains))["x"]
    scene = replace(loose, walls=loose.walls[:1], friction=FRICTION, start_x=x, speed=0.8)
    steps = round(SIMULATED[grains] / case["dt"])
    contacts = scene.begin(folder, case)
    watch = Heap(contacts, scene.walls, case["dt"])
    watch.begin(WIDTH[grains] / 2, 0.8 * SIMULATED[grains])
    seconds = follow(contacts, steps, steps_between_looks(case, LIGHTEST, steps, 500), watch.look)
    totals = contacts.totals()
    contacts.lmp.close()
    found = {**watch.overlaps(), **costs(seconds, seconds, totals, SIMULATED[grains], steps)}
    if totals["worst_overlap_ratio"] is not None:
        found["overlap_max"] = totals["worst_overlap_ratio"]
    return watch, found


def converged(folder: Path, grains: int) -> Arrays:
    """Return spreads, heights and contacts of a fine run."""
    dt, tol = FINE[grains]
    watch, _ = collapse(folder, {"method": "gap/pdas", "dt": dt, "tol": tol, "grains": grains})
    return {
        "times": np.array(watch.times),
        "spreads": np.array(watch.spreads),
        "heights": np.array(watch.heights),
        "contacts": np.array([np.mean(watch.contacts)]),
    }


def run(folder: Path, **case: Any) -> dict[str, Any]:
    """Run a case."""
    grains = case["grains"]
    right = kept(folder, f"collapse_{grains}", lambda: converged(folder, grains))
    watch, found = collapse(folder, case)
    off = {
        name: np.array(getattr(watch, seen)) / np.interp(watch.times, right["times"], right[seen]) - 1
        for name, seen in (("spread", "spreads"), ("height", "heights"))
    }
    return {
        **found,
        **{name: float(np.sqrt(np.mean(values**2))) for name, values in off.items()},
        "coordination": float(abs(np.mean(watch.contacts) / right["contacts"][0] - 1)),
    }
