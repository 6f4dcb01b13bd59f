# SPDX-License-Identifier: GPL-2.0-or-later
"""The active sets' gamma, on a heavy ball that three light ones carry by friction."""

from typing import Any

from nscd_lmp.atlas.grid import Axis, Cell
from nscd_lmp.atlas.maps._carried import carried, masses, shaken
from nscd_lmp.atlas.trial import count, row

ORDER = 20
TITLE = "gamma x mass ratio: PDAS, one step from no impulses"
PANELS = {
    "no": "a shaken pile of 20, every other one heavy, no friction",
    "yes": "heavy on three light ones, friction 0.5",
}
X = masses((1.0, 1e6), "mass ratio")
Y = Axis("gamma", "gamma (multiple of 1/W_nn)", (0.01, 0.1, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 100.0), (1.0, 10.0))
SHOWN = "sweeps to a relative residual of 1e-6, where it was reached"
MECHANISM = (
    "gamma decides which contacts count as open. Below 1 a contact that pulls stays shut for a sweep. Above 1 one that"
    " pushes is dropped for a velocity that its neighbours cause, comes back and is dropped again; with friction stick"
    " and slip flicker as well, from 5 on. Mass ratios stall it as they stall all sweeps."
)
REMEDY = (
    "gamma 1, the default, with which a visit is the exact solution of its contact; for mass ratios above 1000 solver"
    " auto."
)
UNSEEN: dict[str, str] = {}


def run(panel: str, cell: Cell) -> dict[str, Any]:
    """Run one step with this gamma."""
    options: dict[str, Any] = {"solver": "pdas", "gamma": cell["gamma"]}
    ratio = cell["mass_ratio"]
    seen = carried(ratio, **options) if panel == "yes" else shaken(ratio, **options)
    return row(seen, count(seen.iterations) if not seen.unconverged and not seen.error else "")
