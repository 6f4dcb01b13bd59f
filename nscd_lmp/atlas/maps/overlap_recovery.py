# SPDX-License-Identifier: GPL-2.0-or-later
"""Grains that overlap at the start, by how much and by what law gap gives back."""

from typing import Any

import numpy as np

from nscd_lmp.atlas.grid import Axis, Cell
from nscd_lmp.atlas.maps._carried import GRAIN
from nscd_lmp.atlas.scenes import FLOOR, GRAVITY, column
from nscd_lmp.atlas.trial import Look, hard, row, tiny
from nscd_lmp.door.walls import Plane

ORDER = 80
TITLE = "Overlapping starts x recovery: law gap, 0.5 s, dt = 1 ms, criterion natural"
PANELS = {"column": "5 grains on a floor", "free": "2 grains, no gravity", "wedged": "5 grains between floor and lid"}
X = Axis("overlap", "overlap at the start (over the radius)", (1e-4, 1e-3, 0.02, 0.1, 0.3, 0.9, 1.1), (0.02, 1.1))
Y = Axis("recovery", "recovery", (0.0, 0.01, 0.05, 0.2, 0.5, 1.0), (0.0, 0.2))
SHOWN = "largest overlap at the end over the radius, where it is above 0.01 %"
MECHANISM = (
    "The recovery gives back its share of an overlap a step, but never faster than a tenth of what the smooth "
    "forces add to velocities in a step, so nothing is thrown apart: 0.1 g dt here, and nothing where there is no "
    "such force. Between walls that do not give way no velocity is admissible, and impulses grow until the solve "
    "is given up."
)
REMEDY = (
    "start without overlap; recovery 0.2, the default, and time; where no force acts, overlapping grains have to be"
    " moved by hand. Up to one radius an overlap is taken as the state that was asked for, and told at the end of the"
    " run (`start without overlap`); beyond: `remove one of them`."
)
UNSEEN: dict[str, str] = {}
STEPS, DT = 500, 1e-3  # -, s
RADIUS = 0.5e-3
OPTIONS: dict[str, Any] = {"solver": "pdas", "law": "gap", "criterion": "natural", "tol": 1e-6, "maxiter": 1000}


def run(panel: str, cell: Cell) -> dict[str, Any]:
    """Let the grains give way, or not."""
    share = cell["overlap"]
    n = 2 if panel == "free" else 5
    balls = column(np.full(n, GRAIN), RADIUS, gap=-share * RADIUS)
    walls = [] if panel == "free" else [FLOOR]
    if panel == "wedged":
        walls.append(Plane((0, 0, balls.x[-1, 2] + (1 - share) * RADIUS), (0, 0, -1)))
    look = Look(25, scale=GRAVITY * RADIUS * float(balls.mass.sum()), kinetic=True)
    gravity = 0.0 if panel == "free" else GRAVITY
    steps = STEPS if panel != "wedged" else 100
    seen = hard(balls, DT, steps, walls, look, gravity=gravity, recovery=cell["recovery"], **OPTIONS)
    seen.overlap = seen.overlap_left
    return row(seen, tiny(seen.overlap) if seen.overlap > 1e-4 else "")
