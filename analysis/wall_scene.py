# SPDX-License-Identifier: GPL-2.0-or-later
"""What a picture of a bed with walls shows: the part of the box that bed and walls take, lines, and floor."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from wall_mesh import Mesh
from wall_outlines import Wall, compute_bounds_with_walls, compute_wall_outlines, holds
from wall_shapes import Block, Plane

if TYPE_CHECKING:
    from packing import Frame

Array = NDArray[np.floating[Any]]
_LEVEL = 1.0 - 1e-9  # z of a normal that points straight up


class WallScene:
    """Walls around a frame, seen from far in a direction.

    Attributes
    ----------
    held : ndarray, (n, 3)
        Points of the lines.
    shown : ndarray, (3, 2)
        Box that holds the lines and the grains.

    Raises
    ------
    ValueError
        No line lies in the box.
    """

    def __init__(self, walls: Sequence[Wall], frame: Frame, whole: bool, camera: tuple[float, float]) -> None:
        self.walls, self.x = walls, frame.x
        self.bounds = compute_bounds_with_walls(walls, frame.x, frame.radius, frame.bounds, whole)
        az, el = np.radians(camera)
        toward = np.array([np.cos(el) * np.cos(az), np.cos(el) * np.sin(az), np.sin(el)])
        far = self.bounds.mean(axis=1) + 5.0 * float(np.max(np.ptp(self.bounds, axis=1))) * toward
        self.held = np.concatenate([np.zeros((0, 3)), *self.outlines(far)])
        if not len(self.held):
            low, high = (" ".join(f"{value:.4g}" for value in side) for side in self.bounds.T)
            raise ValueError(
                f"no line of the walls lies in the box from ({low}) to ({high}): give them in the units of the dump"
            )
        every = np.concatenate([self.held, frame.x - frame.radius[:, None], frame.x + frame.radius[:, None]])
        self.shown = np.column_stack([every.min(axis=0), every.max(axis=0)])

    def outlines(self, eye: Array) -> list[Array]:
        """Lines (n, 3) as seen from a place."""
        return compute_wall_outlines(self.walls, self.x, self.bounds, eye)

    def is_ground(self, points: Array) -> NDArray[np.bool_]:
        """Whether points of the bottom are on a level wall, and within the others."""
        near = 1e-6 * float(np.max(np.ptp(self.bounds, axis=1)))
        ground = np.zeros(len(points), dtype=bool)
        for wall in self.walls:
            if isinstance(wall, Plane) and wall.normal[2] > _LEVEL:
                ground |= np.abs(wall.distance(points)) < near
            if isinstance(wall, Block):
                ground |= np.abs(points[:, 2] - wall.bounds[2, 0]) < near
        for wall in self.walls:
            if holds(wall, self.x) and not isinstance(wall, Mesh):
                ground &= wall.distance(points) > -near
        return ground
