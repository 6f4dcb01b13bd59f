# SPDX-License-Identifier: GPL-2.0-or-later
"""A wall of triangles, and those of its edges that a picture draws."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]
SHARP = 20.0  # degrees between neighbours, above which their common edge is drawn
_SAME = 1e-6  # share of the size within which corners are one


@dataclass(frozen=True)
class Mesh:
    """Triangles (n, 3, 3)."""

    triangles: Array

    def segments(self, cuts: Sequence[tuple[Array, float]], eye: Array) -> Array:
        """Segments (m, 2, 3): edges that are sharp, open or on the silhouette, and what lies in the cuts."""
        found = [self._edges(eye), *(self._section(normal, offset) for normal, offset in cuts)]
        return np.concatenate(found)

    def _edges(self, eye: Array) -> Array:
        corners = self.triangles.reshape(-1, 3)
        grid = np.rint((corners - corners.min(axis=0)) / (_SAME * np.max(np.ptp(corners, axis=0))))
        number = np.unique(grid, axis=0, return_inverse=True)[1].reshape(-1, 3)
        whole = (np.diff(np.sort(number, axis=1), axis=1) != 0).all(axis=1)  # without those that have no area
        triangles, number = self.triangles[whole], number[whole]
        normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), np.finfo(float).tiny)
        faces = np.sign(np.einsum("nc,nc->n", normal, eye - triangles[:, 0]))
        owner = np.repeat(np.arange(len(triangles)), 3)
        first, second = number.ravel(), np.roll(number, -1, axis=1).ravel()
        ends = np.stack([triangles.reshape(-1, 3), np.roll(triangles, -1, axis=1).reshape(-1, 3)], axis=1)
        key = np.column_stack([np.minimum(first, second), np.maximum(first, second)])
        order = np.lexsort(key.T)
        start = np.flatnonzero(np.append(True, np.any(np.diff(key[order], axis=0) != 0, axis=1)))
        count = np.diff(np.append(start, len(order)))
        pair = start[count == 2]
        one, other = order[pair], order[pair + 1]
        flip = np.where(first[one] == first[other], -1.0, 1.0)  # neighbours that are wound against each other
        cosine = flip * np.einsum("nc,nc->n", normal[owner[one]], normal[owner[other]])
        turns = faces[owner[one]] * faces[owner[other]] * flip < 0.0
        shown = one[turns | (cosine < np.cos(np.radians(SHARP)))]
        return np.concatenate([ends[order[start[count != 2]]], ends[shown]])

    def _section(self, normal: Array, offset: float) -> Array:
        """Segments in which the triangles cross a plane; what lies in the plane itself has its edges."""
        height = self.triangles @ normal - offset
        above = height > 0.0
        crossed = above.any(axis=1) & ~above.all(axis=1)
        triangles, height, above = self.triangles[crossed], height[crossed], above[crossed]
        alone = np.where(above.sum(axis=1) == 1, np.argmax(above, axis=1), np.argmin(above, axis=1))
        row = np.arange(len(alone))
        ends = []
        for step in (1, 2):
            other = (alone + step) % 3
            share = height[row, alone] / (height[row, alone] - height[row, other])
            ends.append(triangles[row, alone] + share[:, None] * (triangles[row, other] - triangles[row, alone]))
        return np.stack(ends, axis=1)
