# SPDX-License-Identifier: GPL-2.0-or-later
"""Beds of grains whose sizes differ by up to 1:20."""

from functools import cache
from typing import Any

import numpy as np

from nscd_lmp.atlas.grid import Axis, Cell
from nscd_lmp.atlas.outcomes import BUDGET
from nscd_lmp.atlas.scenes import Grains, grains, sides, start, state
from nscd_lmp.atlas.trial import AT_REST, Look, count, hard, row
from nscd_lmp.door.attach import attach

ORDER = 100
TITLE = "Size ratio x solver: one step from no impulses"
PANELS = {
    "smooth": "120 grains settled, no friction",
    "rough": "120 grains settled, friction 0.3",
    "large": "a large ball on 400 small ones, no friction",
}
SOLVERS = ("auto", "interior_point", "active_set", "apgs", "pdas", "eal", "ebp", "sal", "sbp")
X = Axis("size_ratio", "largest radius over smallest", (1.0, 2.0, 3.0, 5.0, 10.0, 20.0), (1.0, 5.0))
Y = Axis("solver", "solver", SOLVERS, ("auto", "apgs", "pdas"))
SHOWN = "iterations (sweeps or factorisations) to a relative residual of 1e-6, where it was reached"
MECHANISM = (
    "Masses go with the cube of the size: 1:20 is 1:8000. One large ball on small ones stalls sweeps as heavy on "
    "light does, since a visit takes a small ball's share off the large one's weight. In settled beds of many "
    "sizes large grains rest on many, and the bed matters more than its sizes: long chains of forces, and with "
    "friction the kernel of W."
)
REMEDY = "without friction solver auto or active_set, which no ratio slows down; with friction warm start and apgs."
UNSEEN: dict[str, str] = {}
LARGEST, GRAINS, DT, SETTLING = 1e-3, 120, 2e-4, 1000  # m, -, s, steps
WIDTH = 6.5 * LARGEST
SMALL, ACROSS = 0.5e-3, 20  # m; grains along a side of the carpet


def run(panel: str, cell: Cell) -> dict[str, Any] | None:
    """Run one step of the settled bed."""
    friction = 0.3 if panel == "rough" else 0.0
    if friction and cell["solver"] == "active_set":
        return None
    ratio = cell["size_ratio"]
    large = panel == "large"
    balls = carpet(ratio) if large else settled(ratio, friction)
    width, look = (2 * ACROSS * SMALL, AT_REST) if large else (WIDTH, Look())
    options: dict[str, Any] = {"solver": cell["solver"], "criterion": "natural", "tol": 1e-6, "maxiter": BUDGET}
    seen = hard(balls, DT, 1, sides(width), look, friction=friction, reach=1e-3, **options)
    return row(seen, count(seen.iterations) if not seen.unconverged and not seen.error else "")


@cache
def settled(ratio: float, friction: float) -> Grains:
    """Return grains that fell into a box and lie still."""
    random = np.random.default_rng(5)
    radius = LARGEST * ratio ** -random.uniform(0, 1, GRAINS)
    number = np.arange(GRAINS)
    cell = np.stack([number % 3, number // 3 % 3, number // 9], axis=1)
    size = np.array([WIDTH / 3, WIDTH / 3, 2.04 * LARGEST])
    x = (cell + 0.5) * size + random.uniform(-1, 1, (GRAINS, 3)) * (size / 2 - radius[:, None])
    balls = grains(x, radius)
    lmp = start(balls, DT, reach=1e-3)
    haste: dict[str, Any] = {"solver": "apgs", "criterion": "natural", "tol": 1e-4, "maxiter": 300}
    attach(lmp, walls=sides(WIDTH), friction=friction, unconverged="ignore", **haste)
    lmp.command(f"run {SETTLING} post no")
    x, v, _ = state(lmp)
    lmp.close()
    return Grains(x, radius, balls.mass, v)


def carpet(ratio: float) -> Grains:
    """Return 20 x 20 small grains that fill the floor of a box and a ball in the hollow of the middle four: at rest."""
    place = SMALL * (2 * np.arange(ACROSS) + 1)
    x = [(a, b, SMALL) for a in place for b in place]
    middle, large = ACROSS * SMALL, ratio * SMALL
    height = SMALL + np.sqrt((large + SMALL) ** 2 - 2 * SMALL**2)
    return grains([*x, (middle, middle, height)], [*np.full(ACROSS**2, SMALL), large])
