# SPDX-License-Identifier: GPL-2.0-or-later
"""Small scenes that go side by side into one box and never touch: what happens to one may not depend on the others."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scenes
from numpy.typing import NDArray
from scenes import FLOOR, GRAVITY

Array = NDArray[np.float64]
APART = 10.0  # m, from one island to the next
KINDS = ("column", "collision", "pressed", "spinning", "flying")


@dataclass(frozen=True)
class Island:
    """Some grains of one radius (m); `force` is what presses one on the floor, in units of its weight.

    column: n grains at rest on each other; collision: two that meet at 1 m/s, high up; pressed: one on the floor that a
    force presses; spinning: one on the floor that slides and turns; flying: one alone, at 50 m/s.
    """

    kind: str = "column"
    radius: float = 0.05
    n: int = 5
    force: float = 1.0

    def grains(self) -> scenes.Grains:
        """Return the grains around x = y = 0."""
        r = self.radius
        mass = 1000 * r**3 * 8
        if self.kind == "collision":
            return scenes.grains([(-1.01 * r, 0, 5), (1.01 * r, 0, 5)], r, mass, [(0.5, 0, 0), (-0.5, 0, 0)])
        if self.kind == "flying":
            return scenes.grains((0, 0, 5), r, mass, (0, 50.0, 0))
        if self.kind == "spinning":
            return scenes.grains((0, 0, r), r, mass, (0.3, 0, 0), omega=(0, -0.5 / r, 0.2 / r))
        return scenes.grains([(0, 0, (2 * k + 1) * r) for k in range(self.n if self.kind == "column" else 1)], r, mass)

    def worth(self, dt: float) -> float:
        """Return what velocities are worth here, m/s: what forces change in a step, or the speeds that there are."""
        speed = {"collision": 1.0, "flying": 50.0, "spinning": 0.8}.get(self.kind, 0.0)
        return max(speed, dt * GRAVITY * (1 + self.force * (self.kind == "pressed")))


def run(islands: list[Island], places: list[int], door: str, dt: float, steps: int, **options: Any) -> list[Array]:
    """Run the islands in one box; return position in units of the radius and velocity (frames, n, 6) of each.

    `places` are those in a row: an island alone lies where it lies among others, so that round-off is the same.
    """
    parts = [island.grains() for island in islands]
    for part, place in zip(parts, places, strict=True):
        part.x[:, 0] += place * APART
        if options.get("law") == "moreau":  # sees contacts that overlap, and round-off should not decide which do
            part.x[:, 2] *= 1 - 1e-4
    balls = scenes.grains(
        *(np.concatenate([getattr(part, name) for part in parts]) for name in ("x", "radius", "mass", "v")),
        omega=np.concatenate([part.omega for part in parts]),
    )
    width = 10 * APART
    fastest = max(island.worth(dt) for island in islands) + GRAVITY * dt * steps
    box = [(-width, width), (-width, width), (-1.0, 20.0)]
    lmp = scenes.start(balls, dt, gravity=GRAVITY, box=box, vmax=2 * fastest)
    ends = np.cumsum([0, *(len(part) for part in parts)])
    for k, island in enumerate(islands):
        if island.kind == "pressed":
            force = island.force * parts[k].mass[0] * GRAVITY
            lmp.commands_list([f"group g{k} id {ends[k] + 1}", f"fix push{k} g{k} addforce 0 0 {-float(force)!r}"])
    scenes.harden(lmp, door, walls=[FLOOR], **options)
    try:
        x, v = scenes.trajectory(lmp, steps)
    finally:
        lmp.close()
    return [
        np.concatenate([(x[:, a:b] - parts[k].x) / island.radius, v[:, a:b]], axis=2)
        for k, (island, a, b) in enumerate(zip(islands, ends[:-1], ends[1:], strict=True))
    ]
