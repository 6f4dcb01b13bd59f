# SPDX-License-Identifier: GPL-2.0-or-later
"""Overlap of spheres from their positions alone, whatever method moved them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from nscd_lmp.charts.grains import per_grain
from nscd_lmp.charts.methods import Contacts
from nscd_lmp.door.walls import Plane

Array = NDArray[np.float64]

SHARE = 0.25  # of the margin that spheres may move before near pairs are listed anew


class Overlaps:
    """Overlaps of spheres with each other and with planes, looked at again and again while the spheres move.

    Pairs that are near are listed anew only when a sphere has moved by a quarter of the margin, so that a look costs
    little. Boundaries are open: periodic images are not looked at.

    Parameters
    ----------
    radius : ndarray, shape (n,)
        m.
    walls : sequence of Plane
    """

    def __init__(self, radius: Array, walls: Sequence[Plane] = ()) -> None:
        self.radius = np.array(radius, dtype=float)
        normals = np.array([wall.normal for wall in walls], dtype=float).reshape(-1, 3)
        self.normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
        points = np.array([wall.point for wall in walls], dtype=float).reshape(-1, 3)
        self.offsets = np.einsum("kd,kd->k", self.normals, points)
        self.margin = float(self.radius.min())
        self.listed_x: Array | None = None
        self.i = self.j = np.zeros(0, dtype=np.intp)

    def look(self, x: Array) -> tuple[Array, Array]:
        """Return the overlaps of all contacts.

        Parameters
        ----------
        x : ndarray, shape (n, 3)
            Centres, m, in the order of the radii.

        Returns
        -------
        depth : ndarray, shape (contacts,)
            m, above 0.
        smaller : ndarray, shape (contacts,)
            The smaller radius of each, m.
        """
        if self.listed_x is None or np.abs(x - self.listed_x).max() > SHARE * self.margin:
            self._list(x)
        distance = np.linalg.norm(x[self.i] - x[self.j], axis=1)
        pairs = self.radius[self.i] + self.radius[self.j] - distance
        walls = self.radius[:, None] - (x @ self.normals.T - self.offsets)
        depth = np.concatenate([pairs, walls.ravel()])
        at_walls = np.repeat(self.radius, len(self.offsets))
        smaller = np.concatenate([np.minimum(self.radius[self.i], self.radius[self.j]), at_walls])
        deep = depth > 0
        return depth[deep], smaller[deep]

    def largest_ratio(self, x: Array) -> float:
        """Return the largest overlap over the smaller radius, 0 if nothing overlaps."""
        depth, smaller = self.look(x)
        return float((depth / smaller).max(initial=0.0))

    def coordination(self, x: Array, near: float) -> float:
        """Return the contacts a grain, pairs nearer than `near` of the smaller radius, after :meth:`look` at x."""
        gap = np.linalg.norm(x[self.i] - x[self.j], axis=1) - self.radius[self.i] - self.radius[self.j]
        return 2 * int((gap < near * np.minimum(self.radius[self.i], self.radius[self.j])).sum()) / len(x)

    def _list(self, x: Array) -> None:
        from scipy.spatial import cKDTree  # here: SciPy takes long to import

        reach = 2 * float(self.radius.max()) + self.margin
        pairs = cKDTree(x).query_pairs(reach, output_type="ndarray").reshape(-1, 2)
        separation = np.linalg.norm(x[pairs[:, 0]] - x[pairs[:, 1]], axis=1)
        # two spheres may each move by a quarter of the margin along each axis: sqrt(3)/2 of it together
        near = separation <= self.radius[pairs].sum(axis=1) + self.margin
        self.i, self.j = pairs[near].T
        self.listed_x = x.copy()


def largest_overlap(contacts: Contacts, walls: Sequence[Plane], steps: int, first: int = 0) -> float:
    """Run a scene, and return the largest overlap over the smaller radius after any step from the `first` on."""
    lmp = contacts.lmp
    overlaps = Overlaps(per_grain(lmp, "radius"), walls)
    lmp.command(f"run {first} post no")
    worst = overlaps.largest_ratio(per_grain(lmp, "x"))
    for _ in range(first, steps):
        lmp.command("run 1 pre no post no")
        worst = max(worst, overlaps.largest_ratio(per_grain(lmp, "x")))
    return worst
