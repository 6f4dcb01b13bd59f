# SPDX-License-Identifier: GPL-2.0-or-later
"""The four laws that have a rho, on a heavy ball that three light ones carry by friction."""

from typing import Any

from nscd_lmp.atlas.grid import Axis, Cell
from nscd_lmp.atlas.maps._carried import carried, masses
from nscd_lmp.atlas.trial import count, row

ORDER = 10
TITLE = "rho x mass ratio: a heavy ball on three light ones, friction 0.5, one step from no impulses"
PANELS = {"sbp": "SBP", "sal": "SAL", "ebp": "EBP", "eal": "EAL"}
X = masses((1.0, 1e6), "mass of the upper ball over that of each lower one")
Y = Axis("rho", "rho (multiple of 1/W_nn)", (0.01, 0.03, 0.1, 0.3, 4 / 9, 1.0, 2.0, 3.0, 10.0, 100.0), (4 / 9, 100.0))
SHOWN = "sweeps to a relative residual of 1e-6, where it was reached"
MECHANISM = (
    "SBP and SAL take a fixed step along the velocity: a small rho crawls, and beyond rho W_tt = 2, or a few "
    "times that where contacts share their work, a visit throws a sticking contact further than it was, so "
    "sweeps circle or run away; impulses that ran away and were dropped leave their round-off in the "
    "velocities. EBP and EAL take Newton's step, in which rho only decides who is open. All of them crawl "
    "with the mass ratio: a visit takes a light ball's share off a heavy one's fall."
)
REMEDY = (
    "the default rho, 4/9 (SBP, SAL) or 1 (EBP, EAL); for mass ratios above 1000 solver auto (`rho or gamma closer to"
    " its default`, `another solver` in the error; `raise maxiter` in the warning)."
)
UNSEEN: dict[str, str] = {}


def run(panel: str, cell: Cell) -> dict[str, Any]:
    """Run one step with a law and its rho."""
    seen = carried(cell["mass_ratio"], solver=panel, rho=cell["rho"])
    return row(seen, count(seen.iterations) if not seen.unconverged and not seen.error else "")
