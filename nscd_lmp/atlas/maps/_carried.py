# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes of one step whose answer is known: balls carried by friction, columns, a shaken pile."""

from typing import Any

import numpy as np

from nscd_lmp.atlas.grid import Axis
from nscd_lmp.atlas.outcomes import BUDGET, Seen
from nscd_lmp.atlas.scenes import FLOOR, GRAVITY, column, pile
from nscd_lmp.atlas.trial import Look, hard, last_velocities

DT = 1e-4  # s
GRAIN = 1.3e-6  # kg, of 1 mm
RATIOS = (1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6)


def masses(quick: tuple[float, ...], label: str) -> Axis:
    """Return the axis of mass ratios."""
    return Axis("mass_ratio", label, RATIOS, quick)


def carried(ratio: float, **options: Any) -> Seen:
    """Run one step from no impulses.

    A lower ball of no weight is held by two contacts, 35.3 degrees apart, so each needs friction tan(17.6 degrees) =
    0.32; there is 0.5.
    """
    balls = pile(2)
    balls.mass[-1] *= ratio
    given: dict[str, Any] = {"friction": 0.5, "criterion": "natural", "tol": 1e-6, "maxiter": BUDGET}
    return hard(balls, DT, 1, [FLOOR], **given | options)


def stacked(masses: Any, **options: Any) -> Seen:
    """Run one step of a column of these masses (multiples of a grain's own), from no impulses; rest is the answer."""
    balls = column(GRAIN * np.array(masses))
    given: dict[str, Any] = {"criterion": "natural", "tol": 1e-6, "maxiter": BUDGET}
    return hard(balls, DT, 1, [FLOOR], **given | options)


def shaken(ratio: float, **options: Any) -> Seen:
    """Run one step of a pile of 20 balls that move at random, every other one heavy by the ratio.

    The answer, unique without friction, is that of the active set.
    """
    balls = pile(4)
    balls.mass[1::2] *= ratio
    balls.v[:] = np.random.default_rng(1).normal(size=(20, 3)) * GRAVITY * DT
    given: dict[str, Any] = {"criterion": "natural", "tol": 1e-6, "maxiter": BUDGET}
    answer = last_velocities(balls, DT, [FLOOR], solver="active_set", **given)
    return hard(balls, DT, 1, [FLOOR], Look(answer=answer), **given | options)
