# SPDX-License-Identifier: GPL-2.0-or-later
"""Sedimentation of the paper (section 5.2) at any number of grains: what its charts share."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nscd_lmp.charts.beds import (
    Scene,
    Timed,
    Watch,
    box_walls,
    box_width,
    fastest,
    follow,
    loose_cloud,
    steps_between_looks,
)
from nscd_lmp.charts.grains import per_grain
from nscd_lmp.charts.methods import METHODS, RIGID, Contacts
from nscd_lmp.charts.references import Arrays, kept

Array = NDArray[np.float64]

SMALLEST, LARGEST = 0.25e-3, 0.5e-3  # m
FEW = 1000  # grains; up to here runs are so short that looking would count: they are timed apart
ERRORS = {
    "overlap_max": "largest overlap / radius",
    "overlap_mean": "sum of overlaps / radius, a grain",
    "distance": "distance to the converged places / radius",
    "height": "height of the centre of mass, relative error",
}
LIGHTEST = 2500 * 4 / 3 * np.pi * SMALLEST**3  # kg


@dataclass(frozen=True)
class Sedimentation:
    """How a sedimentation is run: grains, seconds simulated, and what it is compared with.

    `window` is the time (s) up to which places can be compared; `fine` the dt (s) and tol (m/s) of the reference, None:
    overlaps alone are looked at.
    """

    grains: int
    simulated: float
    window: float
    fine: tuple[float, float] | None
    repeats: int = 2

    @property
    def scene(self) -> Scene:
        """Grains and walls."""
        width = box_width(self.grains)
        cloud = loose_cloud(self.grains, width, SMALLEST, LARGEST)
        return Scene(cloud, box_walls(width), [(0, width), (0, width), (0, cloud.height)])


def converged(run: Sedimentation, folder: Path, fine: tuple[float, float]) -> Arrays:
    """Return heights of the centre of mass over time, and places and velocities at the end of the window."""
    case = {"method": "gap/apgs", "dt": fine[0], "tol": fine[1]}
    contacts = run.scene.begin(folder, case)
    watch = Watch(contacts, [], fine[0])
    at: Arrays = {}

    def look(taken: int) -> None:
        x = watch.look(taken)
        if taken == round(run.window / fine[0]):
            at.update(window_x=x)

    follow(contacts, round(run.simulated / fine[0]), 5, look)
    contacts.lmp.close()
    return {"times": np.array(watch.times), "heights": np.array(watch.heights), **at}


class Compared(Watch):
    """A watch that also compares with the reference."""

    def __init__(self, contacts: Contacts, scene: Scene, dt: float, window: float, reference: Arrays | None) -> None:
        super().__init__(contacts, scene.walls, dt)
        self.window, self.reference = window, reference
        self.distance = np.nan

    def look(self, taken: int) -> Array:
        """Look; at the look nearest the end of the window compare places, moved to its very end."""
        x = super().look(taken)
        late = taken * self.dt - self.window
        if self.reference and late >= -0.5 * self.dt and np.isnan(self.distance):
            x_then = x - late * per_grain(self.lmp, "v")
            apart = np.linalg.norm(x_then - self.reference["window_x"], axis=1)
            self.distance = float(np.sqrt((apart**2).mean()) / self.probe.radius.mean())
        return x

    def errors(self) -> dict[str, float]:
        """Return the columns of ERRORS."""
        if not self.reference:
            return self.overlaps()
        right = np.interp(self.times, self.reference["times"], self.reference["heights"])
        off = float(np.sqrt(np.mean((np.array(self.heights) / right - 1) ** 2)))
        return {**self.overlaps(), "distance": self.distance, "height": off}


def run_case(run: Sedimentation, folder: Path, case: dict[str, Any]) -> dict[str, Any]:
    """Run a case, timed, then watched (above FEW grains at once), and compare it with the converged answer."""
    fine, reference = run.fine, None
    if fine is not None:
        reference = kept(folder, f"reference_{run.grains}", lambda: converged(run, folder, fine))
    scene, steps = run.scene, round(run.simulated / case["dt"])
    contacts = scene.begin(folder, case)
    watch = Compared(contacts, scene, case["dt"], run.window, reference)
    every = steps_between_looks(case, LIGHTEST, steps, 2000 if run.grains <= FEW else 500)
    if METHODS[case["method"]].family != RIGID:  # so that one look is at the end of the window
        window = round(run.window / case["dt"])
        every = max(1, window // max(1, round(window / every)))
    watched = seconds = follow(contacts, steps, every, watch.look)
    totals = contacts.totals()
    contacts.lmp.close()
    if run.grains <= FEW:
        seconds = fastest(lambda: scene.begin(folder, case), steps, run.repeats)
    found = watch.errors()
    if totals["worst_overlap_ratio"] is not None:
        found["overlap_max"] = totals["worst_overlap_ratio"]
    return {**found, **costs(seconds, watched, totals, run.simulated, steps)}


def costs(
    seconds: Timed, watched: Timed, totals: dict[str, float | None], simulated: float, steps: int
) -> dict[str, Any]:
    """Return the columns that say what a run took; solve_seconds are processor seconds of its one thread.

    Shares of the solver and of everything else of the fix are those of the run that was `watched`.
    """
    shares = {
        f"share_{part}": None if (spent := totals[f"seconds_{part}"]) is None else spent / watched.wall
        for part in ("solver", "contacts")
    }
    return {
        "solve_seconds": seconds.processor,
        "wall_seconds": seconds.wall,
        "simulated": simulated,
        "steps": steps,
        "iterations": totals["iterations"],
        "unconverged_steps": totals["unconverged_steps"],
        **shares,
    }
