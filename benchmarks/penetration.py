# SPDX-License-Identifier: GPL-2.0-or-later
"""Overlap of spheres from their positions alone, whatever code moved them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from analysis_scripts import find_grain_contacts
from numpy.typing import NDArray

from nscd_lmp import Plane

Array = NDArray[np.float64]

NO_BOX = np.tile([0.0, 1.0], (3, 1)), np.zeros(3, dtype=bool)  # bounds and periodic axes, for open boundaries


class Penetration:
    """Overlaps of spheres with each other and with planes, looked at again and again while the spheres move.

    The pairs that are near are listed anew only when a sphere has moved by a quarter of the margin, so that a
    look costs little.

    Parameters
    ----------
    radius : (n,) float, m
    walls : sequence of Plane
        Normals of length 1.
    """

    def __init__(self, radius: Array, walls: Sequence[Plane]) -> None:
        self.radius = radius
        self.normals = np.array([wall.normal for wall in walls], dtype=float)
        self.offsets = np.einsum("kd,kd->k", self.normals, np.array([wall.point for wall in walls], dtype=float))
        self.margin = float(radius.min())
        self.listed_x: Array | None = None
        self.i = self.j = np.zeros(0, dtype=np.intp)

    def overlaps(self, x: Array) -> tuple[Array, Array]:
        """Return all overlaps (m) and the smaller radius (m) of each contact; x is (n, 3) in m."""
        if self.listed_x is None or np.abs(x - self.listed_x).max() > self.margin / 4:
            near = find_grain_contacts(x, self.radius, *NO_BOX, reach=self.margin / self.radius.min())
            self.i, self.j, self.listed_x = near.i, near.j, x.copy()
        separation = x[self.i] - x[self.j]
        distance = np.sqrt(np.einsum("kd,kd->k", separation, separation))
        pairs = self.radius[self.i] + self.radius[self.j] - distance
        walls = self.radius[:, None] - (x @ self.normals.T - self.offsets)
        depth = np.concatenate([pairs, walls.ravel()])
        smaller = np.concatenate(
            [np.minimum(self.radius[self.i], self.radius[self.j]), np.repeat(self.radius, len(self.offsets))]
        )
        deep = depth > 0
        return depth[deep], smaller[deep]
