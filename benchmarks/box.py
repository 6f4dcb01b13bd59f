# SPDX-License-Identifier: GPL-2.0-or-later
"""The box of in.sedimentation."""

from __future__ import annotations

import nscd_lmp


def box_walls(width: float) -> list[nscd_lmp.Plane]:
    """Return the floor and the four sides of a box of `width` x `width` m above the corner 0 0 0."""
    faces = [
        ((0, 0, 0), (0, 0, 1)),
        ((0, 0, 0), (1, 0, 0)),
        ((width, 0, 0), (-1, 0, 0)),
        ((0, 0, 0), (0, 1, 0)),
        ((0, width, 0), (0, -1, 0)),
    ]
    return [nscd_lmp.Plane(point, normal) for point, normal in faces]
