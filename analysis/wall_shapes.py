# SPDX-License-Identifier: GPL-2.0-or-later
"""Shapes of walls, and the curves on them that a picture draws.

A curve is a function of t from 0 to 1 that returns points of the surface, (n,) to (n, 3). `wall_outlines` cuts curves
to the box. An eye is the place of the camera, a cut a plane (normal, offset): the points of normal . x = offset.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]
Curve = Callable[[Array], Array]
Cut = tuple[Array, float]
_PARALLEL = 1e-9  # sine of an angle below which directions are the same


def across(axis: Array) -> tuple[Array, Array]:
    """Two unit vectors that are perpendicular to a unit vector and to each other."""
    first = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    first = first / np.linalg.norm(first)
    return first, np.cross(axis, first)


def circle(centre: Array, normal: Array, radius: float) -> Curve:
    """Circle about a unit normal."""
    u, v = across(normal)

    def points(t: Array) -> Array:
        angle = 2.0 * np.pi * t[:, None]
        return centre + radius * (np.cos(angle) * u + np.sin(angle) * v)

    return points


def line(start: Array, end: Array) -> Curve:
    """Straight line between two points."""
    return lambda t: start + t[:, None] * (end - start)


def crossing(one: Cut, other: Cut, middle: Array, reach: float) -> list[Curve]:
    """Line in which two planes meet, `reach` to both sides of the place nearest to `middle`; none if parallel."""
    along: Array = np.cross(one[0], other[0])
    size = float(np.linalg.norm(along))
    if size < _PARALLEL:
        return []
    along = along / size
    system = np.array([one[0], other[0], along])
    place = np.linalg.solve(system, np.array([one[1], other[1], float(along @ middle)]))
    return [line(place - reach * along, place + reach * along)]


@dataclass(frozen=True)
class Plane:
    """Half-space on the side of the unit normal."""

    point: Array
    normal: Array

    @property
    def cuts(self) -> list[Cut]:
        """The plane itself."""
        return [(self.normal, float(self.normal @ self.point))]

    def distance(self, points: Array) -> Array:
        """Distance (n,) into the free side."""
        return (points - self.point) @ self.normal

    def curves(self, cuts: Sequence[Cut], eye: Array, middle: Array, reach: float) -> list[Curve]:
        """Lines in which the plane meets the cuts."""
        return [curve for cut in cuts for curve in crossing(self.cuts[0], cut, middle, reach)]


@dataclass(frozen=True)
class Block:
    """Box (3, 2), sides at infinity left out."""

    bounds: Array

    @property
    def cuts(self) -> list[Cut]:
        """Its faces."""
        return [(np.eye(3)[c], float(b)) for c, pair in enumerate(self.bounds) for b in pair if np.isfinite(b)]

    def distance(self, points: Array) -> Array:
        """Distance (n,) to the nearest face, negative outside."""
        inner = np.minimum(points - self.bounds[:, 0], self.bounds[:, 1] - points)
        return np.asarray(inner.min(axis=1))

    def extent(self, points: Array) -> Array:
        """The same: curves end at the edges."""
        return self.distance(points)

    def curves(self, cuts: Sequence[Cut], eye: Array, middle: Array, reach: float) -> list[Curve]:
        """Edges, and lines in which faces meet the cuts."""
        own = self.cuts
        pairs = [*combinations(own, 2), *((face, cut) for face in own for cut in cuts)]
        return [curve for face, cut in pairs for curve in crossing(face, cut, middle, reach)]


@dataclass(frozen=True)
class Sphere:
    """Sphere."""

    centre: Array
    radius: float

    def distance(self, points: Array) -> Array:
        """Distance (n,) to the surface, negative outside."""
        return self.radius - np.linalg.norm(points - self.centre, axis=1)

    def curves(self, cuts: Sequence[Cut], eye: Array, middle: Array, reach: float) -> list[Curve]:
        """Silhouette, equator, and circles in the cuts."""
        far = eye - self.centre
        share = self.radius / float(np.linalg.norm(far))
        found = []
        planes = [*cuts, (np.array([0.0, 0.0, 1.0]), float(self.centre[2]))]
        if share < 1.0:
            toward = far / np.linalg.norm(far)
            planes.append((toward, float(toward @ self.centre) + self.radius * share))
        for normal, offset in planes:
            height = offset - float(normal @ self.centre)
            if abs(height) < self.radius * (1.0 - _PARALLEL):
                width = float(np.sqrt(self.radius**2 - height**2))
                found.append(circle(self.centre + height * normal, normal, width))
        return found


@dataclass(frozen=True)
class Tube:
    """Cylinder or cone about an axis: at s along it the radius is `radius` + `slope` s, for s from `low` to `high`."""

    point: Array
    axis: Array
    radius: float
    slope: float = 0.0
    low: float = -np.inf
    high: float = np.inf
    frame: tuple[Array, Array] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "frame", across(self.axis))

    def distance(self, points: Array) -> Array:
        """Distance (n,) to the surface without ends, negative outside."""
        s = (points - self.point) @ self.axis
        out = np.linalg.norm(points - self.point - s[:, None] * self.axis, axis=1)
        return (self.radius + self.slope * s - out) / np.hypot(1.0, self.slope)

    def extent(self, points: Array) -> Array:
        """Distance (n,) to the nearer end, negative beyond it."""
        s = (points - self.point) @ self.axis
        return np.minimum(s - self.low, self.high - s)

    def curves(self, cuts: Sequence[Cut], eye: Array, middle: Array, reach: float) -> list[Curve]:
        """Rims at the ends, silhouette, and curves in the cuts."""
        ends = [s for s in (self.low, self.high) if np.isfinite(s) and self.radius + self.slope * s > 0.0]
        found = [circle(self.point + s * self.axis, self.axis, self.radius + self.slope * s) for s in ends]
        far = eye - self.point
        height = float(far @ self.axis)
        angles = self._angles_where(far, self.radius + self.slope * height)
        for cut in cuts:
            leaning = float(cut[0] @ self.axis)
            offset = cut[1] - float(cut[0] @ self.point)
            if abs(leaning) > _PARALLEL or (self.slope != 0.0 and abs(offset) > _PARALLEL * reach):
                found.append(self._section(cut))
            else:
                angles += self._angles_where(cut[0], 0.0 if self.slope != 0.0 else offset / self.radius)
        nearest = float((middle - self.point) @ self.axis)
        low, high = max(self.low, nearest - reach), min(self.high, nearest + reach)
        return [*found, *(line(self._at(angle, low), self._at(angle, high)) for angle in angles)]

    def _at(self, angle: float, s: float) -> Array:
        return np.asarray(self._points(np.array([angle]), np.array([s]))[0])

    def _points(self, angle: Array, s: Array) -> Array:
        u, v = self.frame
        out = np.cos(angle)[:, None] * u + np.sin(angle)[:, None] * v
        return self.point + s[:, None] * self.axis + (self.radius + self.slope * s)[:, None] * out

    def _angles_where(self, vector: Array, value: float) -> list[float]:
        """Angles of the directions from the axis whose product with the vector is the value."""
        parts = np.array([vector @ unit for unit in self.frame])
        size = float(np.linalg.norm(parts))
        if abs(value) >= size * (1.0 - _PARALLEL):
            return []
        half, middle = float(np.arccos(value / size)), float(np.arctan2(parts[1], parts[0]))
        return [middle - half, middle + half]

    def _section(self, cut: Cut) -> Curve:
        """Curve in a plane, by where each of the lines along the surface meets it."""
        u, v = self.frame
        normal, offset = cut[0], cut[1] - float(cut[0] @ self.point)

        def points(t: Array) -> Array:
            angle = 2.0 * np.pi * t
            lean = np.cos(angle) * float(normal @ u) + np.sin(angle) * float(normal @ v)
            with np.errstate(divide="ignore", invalid="ignore"):
                s = (offset - self.radius * lean) / (float(normal @ self.axis) + self.slope * lean)
                s[~(self.radius + self.slope * s >= 0.0)] = np.inf  # the other half of a double cone
                return self._points(angle, np.where(np.isfinite(s), s, 1e30))

        return points
