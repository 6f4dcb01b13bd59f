# SPDX-License-Identifier: GPL-2.0-or-later
"""A settled bed that should stay as it is."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from nscd_lmp.charts.beds import GRAVITY, Scene, Watch, fastest, follow, steps_between_looks
from nscd_lmp.charts.cases import penalty_cases, rigid_cases
from nscd_lmp.charts.grains import Array, per_grain
from nscd_lmp.charts.methods import METHODS, RIGID, rigid_methods
from nscd_lmp.charts.references import Arrays, kept
from nscd_lmp.charts.sedimentations import LIGHTEST, Sedimentation, costs
from nscd_lmp.charts.size import Size

ORDER = 55
TITLE = "A settled bed of 500 grains, without friction: does it stay at rest?"
ERRORS = {
    "overlap_max": "largest overlap / radius",
    "imbalance": "net force on a grain / weight,\nroot mean square",
    "kinetic": "kinetic energy a grain / (m g r)",
    "packing": "packing fraction,\nrelative error",
    "coordination": "contacts a grain,\nrelative error",
}
NOTES = """A bed settled by law gap (dt 5e-4 s, tol 1e-8, 1 s) runs on for 0.05 s. Net force: weight and contact
forces (of rigid contacts the mean of the step), over the weight; it and the kinetic energy are means over the last
0.02 s; the overlap is the largest of the whole run. Without friction a bed creeps on, and the finest rigid runs
show that creep. Penalty contacts start without overlap, and sink until their springs carry the weight. Packing
fraction: volume of the grains over that of the box up to twice the height of their centre of mass; contacts: pairs
nearer than 1e-4 of the radius; both at the end against the start. Seconds are processor seconds of the one thread,
best of 2."""

SIMULATED, WATCHED = 0.05, 0.02  # s
SETTLING: dict[str, Any] = {"method": "gap/apgs", "dt": 5e-4, "tol": 1e-8}
SETTLED = {500: 1.0, 60: 0.1}  # s
NEAR = 1e-4  # of the smaller radius: such pairs count as contacts
STIFFNESSES = (1e2, 1e3, 1e4, 1e5)  # N/m


def cases(size: Size) -> list[dict[str, Any]]:
    """Return the cases."""
    if size is Size.QUICK:
        return [
            *rigid_cases(["gap/apgs"], [5e-4], [1e-6], grains=60),
            *penalty_cases(["gran/hooke/history"], [1e3], LIGHTEST, [1 / 4], grains=60),
        ]
    fast = [f"gap/{solver}" for solver in ("pdas", "apgs", "auto", "active_set")]
    others = [name for name in rigid_methods(laws=["gap"]) if name not in fast]
    return [
        *rigid_cases(fast, [5e-4, 1e-3], [1e-5, 1e-6, 1e-7, 1e-8], grains=500),
        *rigid_cases(others, [1e-3], [1e-6], grains=500),
        *rigid_cases(["moreau/pdas", "moreau/apgs", "moreau/active_set"], [2e-4, 5e-4], [1e-6, 1e-8], grains=500),
        *penalty_cases(["gran/hooke/history"], STIFFNESSES, LIGHTEST, [1 / 4], grains=500),
        *penalty_cases(["gran/hooke/history"], STIFFNESSES[:3], LIGHTEST, [1 / 10], grains=500),
        *penalty_cases(["granular/hooke", "granular/hertz"], STIFFNESSES[:2], LIGHTEST, [1 / 4], grains=500),
    ]


def settle(folder: Path, scene: Scene, seconds: float) -> Arrays:
    """Return places and velocities of the settled bed."""
    contacts = scene.begin(folder, SETTLING)
    contacts.run(round(seconds / SETTLING["dt"]))
    found = {name: per_grain(contacts.lmp, name) for name in ("x", "v")}
    contacts.lmp.close()
    return found


class Rest(Watch):
    """A watch that notes net forces and kinetic energies over the last time."""

    def begin(self, weightless: bool, since: float) -> None:
        """`weightless`: the forces that LAMMPS has are those of the contacts alone."""
        self.weightless, self.since = weightless, since
        self.mass = per_grain(self.lmp, "rmass")
        self.imbalance: list[float] = []
        self.kinetic: list[float] = []

    def look(self, taken: int) -> Any:
        """Look."""
        x = super().look(taken)
        if self.times[-1] > self.since:
            weight = self.mass * GRAVITY
            force, v = per_grain(self.lmp, "f"), per_grain(self.lmp, "v")
            force[:, 2] -= weight if self.weightless else 0.0
            energy = 0.5 * self.mass * (v**2).sum(axis=1)
            self.imbalance.append(float(np.mean((force**2).sum(axis=1) / weight**2)))
            self.kinetic.append(float(energy.sum() / (weight * self.probe.radius).sum()))
        return x


def coordination(watch: Watch, x: Array) -> float:
    """Return the contacts a grain at the places x."""
    watch.probe.look(x)
    return watch.probe.coordination(x, NEAR)


def run(folder: Path, **case: Any) -> dict[str, Any]:
    """Run a case: watched, then timed."""
    grains = case["grains"]
    empty = Sedimentation(grains, SIMULATED, 0.0, None).scene
    state = kept(folder, f"settled_{grains}", lambda: settle(folder, empty, SETTLED[grains]))
    scene = replace(empty, start_x=state["x"], start_v=0 * state["v"], speed=0.1)
    steps = round(SIMULATED / case["dt"])
    contacts = scene.begin(folder, case)
    watch = Rest(contacts, scene.walls, case["dt"])
    watch.begin(METHODS[case["method"]].family == RIGID, SIMULATED - WATCHED)
    watched = follow(contacts, steps, steps_between_looks(case, LIGHTEST, steps), watch.look)
    totals, end = contacts.totals(), per_grain(contacts.lmp, "x")
    contacts.lmp.close()
    seconds = fastest(lambda: scene.begin(folder, case), steps, 2)
    found = watch.overlaps()
    if totals["worst_overlap_ratio"] is not None:
        found["overlap_max"] = totals["worst_overlap_ratio"]
    return {
        **found,
        "imbalance": float(np.sqrt(np.mean(watch.imbalance))),
        "kinetic": float(np.mean(watch.kinetic)),
        "packing": float(abs(state["x"][:, 2].mean() / watch.heights[-1] - 1)),
        "coordination": abs(coordination(watch, end) / coordination(watch, state["x"]) - 1),
        **costs(seconds, watched, totals, SIMULATED, steps),
    }
