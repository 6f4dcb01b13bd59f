# SPDX-License-Identifier: GPL-2.0-or-later
"""A ball that hits another one, by speed and time step."""

import math
from typing import Any

from nscd_lmp.atlas.grid import Axis, Cell
from nscd_lmp.atlas.scenes import grains
from nscd_lmp.atlas.trial import Look, hard, row, tiny

ORDER = 50
TITLE = "dt x impact speed: a ball of radius 5 mm hits one at rest head on, e = 0"
PANELS = {
    "gap": "law gap, (42) < 1e-7 m/s",
    "natural": "law gap, the default tolerance",
    "moreau": "law moreau, (42) < 1e-7 m/s",
    "short": "law gap, (42), cutoff 10 % above the diameter",
}
X = Axis("speed", "speed of the impact (m/s)", (0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0), (1.0, 100.0))
Y = Axis("dt", "time step (s)", (1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1), (1e-4, 1e-3))
SHOWN = "largest overlap over radius, where it is above 0.1 %"
MECHANISM = (
    "Law moreau sees a contact only where grains overlap half a step ahead, and nothing gives the overlap "
    "back: up to dt v stays, and a ball that moves by more than two diameters a step can pass unseen. Law gap "
    "looks ahead by dt v and leaves no overlap at any step, also where the neighbor list is too short for it."
)
REMEDY = (
    "law gap, or a step below r / (50 v) under law moreau. The end of a run tells of overlaps beyond 1 % of the radius "
    "and of grains that move by more than two of the smallest radii a step (`use law gap`)."
)
UNSEEN: dict[str, str] = {}
RADIUS, START, FURTHER = 5e-3, 0.0237, 0.05  # m; the start is no multiple of a step


def run(panel: str, cell: Cell) -> dict[str, Any]:
    """Let the ball fly, hit and go on for a while."""
    speed, dt = cell["speed"], cell["dt"]
    balls = grains([(0, 0, 0), (START, 0, 0)], RADIUS, v=[(speed, 0, 0), (0, 0, 0)])
    steps = math.ceil((START + FURTHER) / (speed * dt)) + 2
    look = Look(min(steps, 20), in_order=True)
    law = "moreau" if panel == "moreau" else "gap"
    options: dict[str, Any] = {} if panel == "natural" else {"criterion": "paper", "tol": 1e-7}
    reach = 0.2 * RADIUS if panel == "short" else 4 * speed * dt
    seen = hard(balls, dt, steps, [], look, gravity=0.0, reach=reach, room=steps * dt * speed, law=law, **options)
    shown = "passed" if seen.passed else tiny(seen.overlap) if seen.overlap > 1e-3 else ""
    return row(seen, shown, step_ratio=speed * dt / RADIUS)
