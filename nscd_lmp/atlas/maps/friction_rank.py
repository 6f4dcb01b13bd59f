# SPDX-License-Identifier: GPL-2.0-or-later
"""Friction in piles whose impulses are less and less determined by the motion."""

from typing import Any

from nscd_lmp.atlas.grid import Axis, Cell
from nscd_lmp.atlas.maps._carried import DT
from nscd_lmp.atlas.outcomes import BUDGET
from nscd_lmp.atlas.scenes import FLOOR, pile
from nscd_lmp.atlas.trial import Look, count, hard, row

ORDER = 70
TITLE = "Friction x rank deficiency: tetrahedral piles, one step from no impulses"
PANELS = {"pdas": "PDAS", "apgs": "APGS", "interior_point": "interior point", "auto": "auto"}
PILES = {  # layers; share of the impulses that no motion determines
    "4 balls, 11 %": 2,
    "10 balls, 33 %": 3,
    "20 balls, 43 %": 4,
    "35 balls, 48 %": 5,
    "56 balls, 52 %": 6,
}
X = Axis("friction", "friction", (0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.6, 1.0, "stick"), (0.1, 0.6))
Y = Axis("pile", "pile, rank deficiency of W", tuple(PILES), ("4 balls, 11 %", "20 balls, 43 %"))
SHOWN = "iterations (sweeps or factorisations) to a relative residual of 1e-6, where it was reached"
MECHANISM = (
    "With friction a contact brings three unknowns and a ball six velocities, so W has a kernel: impulses that move"
    " nothing. Which of them is right decides what may slide, and sweeps wander in the kernel while contacts change"
    " between stick and slip, most where friction is just enough to hold the pile. The path of the interior point folds"
    " there."
)
REMEDY = (
    "warm start, which carries the kernel's part on; solver auto; a tol of 1e-4, enough for the velocities,"
    " which are unique where impulses are not."
)
UNSEEN: dict[str, str] = {}


def run(panel: str, cell: Cell) -> dict[str, Any]:
    """Run one step of a pile."""
    options: dict[str, Any] = {"solver": panel, "friction": cell["friction"], "criterion": "natural", "tol": 1e-6}
    seen = hard(pile(PILES[cell["pile"]]), DT, 1, [FLOOR], Look(), maxiter=BUDGET, **options)
    return row(seen, count(seen.iterations) if not seen.unconverged and not seen.error else "")
