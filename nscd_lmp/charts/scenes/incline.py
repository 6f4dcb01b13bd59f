# SPDX-License-Identifier: GPL-2.0-or-later
"""Balls that fall on an inclined plane, section 5.3 of the paper."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from nscd_lmp.charts.beds import DENSITY, Scene, Watch, fastest, follow, loose_cloud, steps_between_looks
from nscd_lmp.charts.cases import penalty_cases, rigid_cases
from nscd_lmp.charts.grains import per_grain
from nscd_lmp.charts.methods import rigid_methods
from nscd_lmp.charts.references import Arrays, kept
from nscd_lmp.charts.sedimentations import costs
from nscd_lmp.charts.size import Size
from nscd_lmp.door.walls import Plane

ORDER = 60
TITLE = "500 balls on a plane inclined by 10 degrees, friction on the plane alone"
ERRORS = {
    "overlap_max": "largest overlap / radius",
    "downhill": "mean velocity downhill,\nerror / its largest",
    "height": "height of the centre of mass,\nrelative error",
}
NOTES = """0.1 s from the loose cloud, all in section 5.3 of the paper except the plane: balls stick to it there,
here its friction is 2, since without slip a step need not have a solution (inputs/in.incline); the balls are as
fast. Balls have no friction among themselves. Velocity downhill and mean height are compared over the whole run,
root mean square, with law gap at dt 2e-5 s and tol 1e-8; single balls diverge, these means do not. Seconds are
processor seconds of the one thread, best of 2."""

SLOPE = math.radians(10)
SMALLEST, LARGEST, WIDTH = 0.6e-3, 1e-3, 20e-3  # m
GROUND = 2.0
SIMULATED = {500: 0.1, 60: 0.02}  # s, by grains
FINE = {500: (2e-5, 1e-8), 60: (2e-4, 1e-7)}  # dt in s, tol in m/s
LIGHTEST = DENSITY * 4 / 3 * math.pi * SMALLEST**3  # kg
STIFFNESSES = (1e3, 3e3, 1e4, 1e5)  # N/m


def cases(size: Size) -> list[dict[str, Any]]:
    """Return the cases."""
    if size is Size.QUICK:
        return [
            *rigid_cases(["gap/pdas"], [5e-4], [1e-6], grains=60),
            *penalty_cases(["gran/hooke/history"], [1e3], LIGHTEST, [1 / 5], grains=60),
        ]
    fast = [f"gap/{solver}" for solver in ("pdas", "apgs", "auto")]
    others = [name for name in rigid_methods(friction=True, laws=["gap"]) if name not in [*fast, "gap/interior_point"]]
    return [
        *rigid_cases(fast, [2e-4, 5e-4, 1e-3], [1e-5, 1e-6], grains=500),
        *rigid_cases(others, [5e-4], [1e-6], grains=500),
        *rigid_cases(["moreau/pdas", "moreau/apgs"], [5e-5, 2e-4], [1e-6], grains=500),
        *penalty_cases(["gran/hooke/history"], STIFFNESSES, LIGHTEST, [1 / 4], grains=500),
        *penalty_cases(["granular/hooke", "granular/hertz"], STIFFNESSES[:3], LIGHTEST, [1 / 4], grains=500),
    ]


def scene(grains: int) -> Scene:
    """Return grains and plane."""
    cloud = loose_cloud(grains, WIDTH if grains == 500 else 8e-3, SMALLEST, LARGEST)
    width = float(cloud.x.max() + LARGEST)
    ground = Plane((0, 0, 0), (0, 0, 1), friction=GROUND)
    return Scene(
        cloud,
        [ground],
        [(0, width), (0, width), (0, cloud.height)],
        boundary="m m fm",
        gravity=(math.sin(SLOPE), 0.0, -math.cos(SLOPE)),
    )


class Slope(Watch):
    """A watch that notes the velocity downhill too."""

    def look(self, taken: int) -> Any:
        """Look."""
        self.downhill = [*getattr(self, "downhill", []), float(per_grain(self.lmp, "v")[:, 0].mean())]
        return super().look(taken)


def converged(folder: Path, grains: int) -> Arrays:
    """Return mean velocities downhill and heights over time."""
    dt, tol = FINE[grains]
    contacts = scene(grains).begin(folder, {"method": "gap/apgs", "dt": dt, "tol": tol})
    watch = Slope(contacts, [], dt)
    follow(contacts, round(SIMULATED[grains] / dt), 10, watch.look)
    contacts.lmp.close()
    return {name: np.array(getattr(watch, name)) for name in ("times", "heights", "downhill")}


def run(folder: Path, **case: Any) -> dict[str, Any]:
    """Run a case: watched, then timed."""
    grains = case["grains"]
    right = kept(folder, f"incline_{grains}", lambda: converged(folder, grains))
    steps, here = round(SIMULATED[grains] / case["dt"]), scene(grains)
    contacts = here.begin(folder, case)
    watch = Slope(contacts, here.walls, case["dt"])
    watched = follow(contacts, steps, steps_between_looks(case, LIGHTEST, steps), watch.look)
    totals = contacts.totals()
    contacts.lmp.close()
    seconds = fastest(lambda: here.begin(folder, case), steps, 2)
    found = watch.overlaps()
    if totals["worst_overlap_ratio"] is not None:
        found["overlap_max"] = totals["worst_overlap_ratio"]
    velocity, height = (np.interp(watch.times, right["times"], right[name]) for name in ("downhill", "heights"))
    return {
        **found,
        "downhill": float(np.sqrt(np.mean((np.array(watch.downhill) - velocity) ** 2)) / right["downhill"].max()),
        "height": float(np.sqrt(np.mean((np.array(watch.heights) / height - 1) ** 2))),
        **costs(seconds, watched, totals, SIMULATED[grains], steps),
    }
