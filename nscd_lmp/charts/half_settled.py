# SPDX-License-Identifier: GPL-2.0-or-later
"""Large sedimentations, looked at for a short time from a state that is half settled."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from nscd_lmp.charts.beds import Scene, Watch, follow
from nscd_lmp.charts.grains import per_grain
from nscd_lmp.charts.methods import METHODS, RIGID
from nscd_lmp.charts.references import Arrays, kept
from nscd_lmp.charts.sedimentations import Sedimentation, costs

MAKE: dict[str, Any] = {"method": "gap/apgs", "dt": 1e-3, "tol": 1e-6}
WARM = 3  # rigid steps that are not timed: the first starts from no impulses
LOOKS = 20  # at penalty contacts: a look at 100,000 grains takes as long as tens of their steps


@dataclass(frozen=True)
class HalfSettled:
    """A sedimentation that is timed over a window from `start` (s) on.

    Rigid contacts run over `window` (s), penalty contacts `penalty_steps` steps, after a tenth as many that are not
    timed; what they take is scaled to a simulated second.
    """

    grains: int
    start: float
    window: float
    penalty_steps: int

    @property
    def scene(self) -> Scene:
        """Grains and walls, from the start of the fall."""
        return Sedimentation(self.grains, self.start, 0.0, None).scene


def fall(run: HalfSettled, folder: Path) -> Arrays:
    """Return places and velocities at the start of the window."""
    contacts = run.scene.begin(folder, MAKE)
    contacts.run(round(run.start / MAKE["dt"]))
    found = {name: per_grain(contacts.lmp, name) for name in ("x", "v")}
    contacts.lmp.close()
    return found


def run_window(run: HalfSettled, folder: Path, case: dict[str, Any]) -> dict[str, Any]:
    """Run a case over the window."""
    state = kept(folder, f"state_{run.grains}", lambda: fall(run, folder))
    scene = replace(run.scene, start_x=state["x"], start_v=state["v"])
    rigid = METHODS[case["method"]].family == RIGID
    contacts = scene.begin(folder, case)
    steps = round(run.window / case["dt"]) if rigid else run.penalty_steps
    first = WARM if rigid else max(1, steps // 10)
    contacts.run(first)
    before = contacts.totals()
    watch = Watch(contacts, scene.walls, case["dt"])
    seconds = follow(contacts, steps, 1 if rigid else max(1, steps // LOOKS), watch.look)
    after = contacts.totals()
    contacts.lmp.close()
    spent = {name: None if now is None else now - (before[name] or 0.0) for name, now in after.items()}
    return {**watch.overlaps(), **costs(seconds, seconds, spent, steps * case["dt"], steps)}
