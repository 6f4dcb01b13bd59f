# SPDX-License-Identifier: GPL-2.0-or-later
"""Kinds of grains that friction turns, and in what frame: spheres, discs, and spheres in a planar scene.

kappa = 1 + k is the tangential share of a contact, W_tt / W_nn, with k = m r^2 / I: 7/2 for spheres, 3 for discs.
The grains of the tests with closed forms are boulders (r = 0.5 m), so that criterion (42) bounds velocities (see
test_one_contact.py).
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray

import nscd_lmp

RADIUS, DT = 0.5, 1e-3  # m, s
TOL = 1e-12  # m/s
# A converged contact has normal and slip velocities below tol; a step adds at most that, a few roundings besides.
STEP_ERROR = 4 * TOL
# m, overlap at the start, a few roundings: law moreau lets a grain fall for a step before it sees a contact whose gap
# is a rounding above 0. Law gap gives a fifth of it back, at 2e-13 m/s.
TOUCH = 1e-15
SOLVED = {"tol": TOL, "maxiter": 100000, "unconverged": "error"}


@dataclass(frozen=True)
class Kind:
    """A grain: dimension 2 or 3, the keyword for its inertia, and k = m r^2 / I."""

    name: str
    planar: bool
    inertia: str | None
    k: float

    @property
    def kappa(self) -> float:
        """Return W_tt / W_nn."""
        return 1 + self.k

    def frame(self, slope: float = 0.0) -> NDArray[np.float64]:
        """Return the rows downhill, normal and axis of forward rolling of a plane that falls by `slope` radians."""
        sine, cosine = math.sin(slope), math.cos(slope)
        if self.planar:
            downhill, normal = np.array([cosine, -sine, 0]), np.array([sine, cosine, 0])
        else:  # in no direction of the axes
            level, up = np.array([math.cos(0.7), math.sin(0.7), 0]), np.array([0, 0, 1.0])
            downhill, normal = cosine * level - sine * up, sine * level + cosine * up
        return np.array([downhill, normal, np.cross(normal, downhill)])


KINDS = [Kind("sphere", False, None, 2.5), Kind("disc", True, None, 2.0), Kind("flat sphere", True, "sphere", 2.5)]
EVERY_KIND = pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name.replace(" ", "-"))
BOTH_KINDS = pytest.mark.parametrize("kind", KINDS[:2], ids=lambda kind: kind.name)
LAWS, SOLVERS = list(nscd_lmp.LAWS), list(nscd_lmp.FRICTIONAL_SOLVERS)
EVERY_LAW = pytest.mark.parametrize("law", LAWS)
EVERY_SOLVER = pytest.mark.parametrize("solver", SOLVERS)
# For every_two_meet: a law and a kind, which is a dimension, are one axis, so solvers meet both together.
LAWS_AND_KINDS = list(itertools.product(LAWS, KINDS[:2]))
LAWS_AND_ALL_KINDS = list(itertools.product(LAWS, KINDS))
