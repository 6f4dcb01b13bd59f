# SPDX-License-Identifier: GPL-2.0-or-later
"""A heavy grain above light ones, below them, and masses in turn."""

from typing import Any

from nscd_lmp.atlas.grid import Axis, Cell
from nscd_lmp.atlas.maps._carried import RATIOS, stacked
from nscd_lmp.atlas.trial import count, row

ORDER = 40
TITLE = "Mass ratio x order: columns of 10 grains without friction, one step from no impulses"
PANELS = {
    "heavy_on_light": "a heavy one on 9 light ones",
    "light_on_heavy": "9 light ones on a heavy one",
    "in_turn": "heavy and light in turn",
}
SOLVERS = ("auto", "interior_point", "active_set", "apgs", "pdas", "eal", "ebp", "sal", "sbp")
X = Axis("mass_ratio", "mass ratio", RATIOS, (1.0, 1e4))
Y = Axis("solver", "solver", SOLVERS, ("auto", "active_set", "apgs", "pdas"))
SHOWN = "iterations (sweeps or factorisations) to a relative residual of 1e-6, where it was reached"
MECHANISM = (
    "A visit of a light ball's contact takes its share, 1/R, off the fall of the heavy one above it: 2.3 R sweeps a"
    " digit, with momentum the square root of that. Light ones on a heavy one hand on only what they weigh, and take"
    " what a column of equal grains takes. Factorisations do not mind."
)
REMEDY = "solver auto, or active_set (without friction) and interior_point (with)."
UNSEEN: dict[str, str] = {}


def run(panel: str, cell: Cell) -> dict[str, Any]:
    """Run one step of a column."""
    ratio = cell["mass_ratio"]
    orders = {"heavy_on_light": [1] * 9 + [ratio], "light_on_heavy": [ratio] + [1] * 9, "in_turn": [1, ratio] * 5}
    seen = stacked(orders[panel], solver=cell["solver"])
    return row(seen, count(seen.iterations) if not seen.unconverged and not seen.error else "")
