# SPDX-License-Identifier: GPL-2.0-or-later
"""What is known of a `fix wall/nscd` by its words: planes and cylinders, also those that move, but no regions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import all_pairs
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SHIFT, ANGLE = 7, 13  # of f_ID[...], counted from 0


@dataclass
class WallFix:
    """A wall in its own frame, None if it is not known, the group it touches, and the point and axis it turns about."""

    group: str
    distance: Callable[[Array], Array] | None
    point: Array
    axis: Array

    def surface_now(self, lmp: Any, fix: str) -> all_pairs.Surface | None:
        """Return the wall as it lies at the end of the step, by what the fix tells of its motion."""
        if self.distance is None:
            return None
        own = self.distance
        shift = np.array([lmp.extract_fix(fix, 0, 1, SHIFT + d) for d in range(3)])
        angle = lmp.extract_fix(fix, 0, 1, ANGLE)
        bit = 1 << lmp.available_ids("group").index(self.group)
        if not angle and not shift.any():
            return all_pairs.Surface(own, bit)
        return all_pairs.Surface(lambda x: own(self.point + turned(x - self.point - shift, self.axis, -angle)), bit)


def turned(x: Array, axis: Array, angle: float) -> Array:
    """Return vectors (n, 3) turned about a unit axis."""
    along = np.outer(x @ axis, axis)
    return along + (x - along) * np.cos(angle) + np.cross(axis, x) * np.sin(angle)


def read(words: list[str]) -> WallFix:
    """Return what the words of a `fix ID group wall/nscd ...` say; numbers in variables are not known."""
    point, axis = np.zeros(3), np.array([0.0, 0.0, 1.0])
    if any("$" in word for word in words):
        return WallFix(words[2], None, point, axis)
    if "rotate" in words:
        turns = words.index("rotate")
        numbers = np.array(words[turns + 2 : turns + 8], dtype=float)
        point, axis = numbers[:3], numbers[3:] / np.linalg.norm(numbers[3:])
    return WallFix(words[2], _distance(words[4], words[5:]), point, axis)


def _distance(kind: str, words: list[str]) -> Callable[[Array], Array] | None:
    """Return the distance from a wall of that kind, None for one that is not known."""
    if kind == "plane":
        numbers = np.array(words[:6], dtype=float)
        return all_pairs.plane(numbers[:3], numbers[3:]).distance
    if kind == "cylinder":
        numbers = np.array(words[:7], dtype=float)
        return all_pairs.cylinder(numbers[:3], numbers[3:6], numbers[6]).distance
    if kind[1:] == "cylinder":
        return all_pairs.cylinder(np.zeros(3), np.eye(3)["xyz".index(kind[0])], float(words[0])).distance
    if kind[1:] == "plane":
        across = "xyz".index(kind[0])
        low, high = (
            np.inf if word == "NULL" else sign * float(word) for word, sign in zip(words, (-1, 1), strict=False)
        )
        return lambda x: np.minimum(x[:, across] + low, high - x[:, across])
    return None
