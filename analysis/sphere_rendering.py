# SPDX-License-Identifier: GPL-2.0-or-later
"""Shaded spheres by ray casting, in numpy alone.

Each pixel casts a ray and keeps the nearest sphere (a z-buffer), so intersecting and crowded grains
are drawn right. Light is a sun and a dome of sky lamps, each with its own shadow map: the dome is
what darkens the pores. Some thousand grains take a few seconds.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]
UP = np.array([0.0, 0.0, 1.0])
FLOOR_COLOR = np.array([0.93, 0.93, 0.92])
AMBIENT, SKY, SUN, GLOSS = 0.15, 0.60, 0.52, 0.16  # light, as fractions of white
_NOTHING, _FLOOR = -1, -2  # what a ray meets, if no grain


@dataclass(frozen=True)
class View:
    """A perspective camera whose picture just holds the points it was fitted to.

    Attributes
    ----------
    eye : ndarray, (3,)
        Place of the camera.
    axes : ndarray, (3, 3)
        Rows: right, up and forward, unit vectors.
    corner : ndarray, (2,)
        Tangents (right, up) of the ray through the upper left corner of the picture.
    pixel : float
        Tangent covered by a pixel.
    shape : tuple of int
        Rows and columns, both even.
    """

    eye: Array
    axes: Array
    corner: Array
    pixel: float
    shape: tuple[int, int]

    @classmethod
    def fit(cls, points: Array, toward_eye: Array, distance: float, size: int) -> View:
        """Look at the middle of the points so that they fill a picture with `size` pixels along its
        longer side; `toward_eye` points from them to the camera.
        """
        forward = -toward_eye / np.linalg.norm(toward_eye)
        side = np.cross(forward, UP)
        right = side if np.linalg.norm(side) > 1e-6 else np.array([1.0, 0.0, 0.0])
        right = right / np.linalg.norm(right)
        axes = np.array([right, np.cross(right, forward), forward])
        eye = 0.5 * (points.min(axis=0) + points.max(axis=0)) - distance * forward
        seen = (points - eye) @ axes.T
        tangents = seen[:, :2] / seen[:, 2:]
        low, high = tangents.min(axis=0), tangents.max(axis=0)
        pixel = float(np.max(high - low) / size)
        columns, rows = (2 * max(1, round(0.5 * extent / pixel)) for extent in high - low)
        return cls(eye, axes, np.array([low[0], high[1]]), pixel, (rows, columns))

    def project(self, points: Array) -> tuple[Array, Array, Array]:
        """Column, row (0 at the centre of the first pixel) and depth of points (m, 3)."""
        seen = (points - self.eye.astype(points.dtype)) @ self.axes.T.astype(points.dtype)
        column = (seen[:, 0] / seen[:, 2] - self.corner[0]) / self.pixel - 0.5
        row = (self.corner[1] - seen[:, 1] / seen[:, 2]) / self.pixel - 0.5
        return column, row, seen[:, 2]

    def tangents(self) -> tuple[Array, Array]:
        """Tangents of the pixel columns and rows."""
        rows, columns = self.shape
        u = self.corner[0] + self.pixel * (np.arange(columns) + 0.5)
        return u, self.corner[1] - self.pixel * (np.arange(rows) + 0.5)


def rasterize(view: View, x: Array, radius: Array) -> tuple[Array, NDArray[np.intp]]:
    """Depth of the nearest sphere in each pixel (inf for none) and its index (-1 for none)."""
    u, v = view.tangents()
    depth = np.full(view.shape, np.inf)
    owner = np.full(view.shape, -1, dtype=np.intp)
    centres = (x - view.eye) @ view.axes.T
    # The silhouette of a sphere spans these tangents exactly.
    spans = []
    for c, start, sign in ((0, view.corner[0], 1.0), (1, view.corner[1], -1.0)):
        middle = np.arctan2(centres[:, c], centres[:, 2])
        half = np.arcsin(np.minimum(radius / np.hypot(centres[:, c], centres[:, 2]), 1.0))
        ends = np.tan(np.stack([middle - half, middle + half]))
        pixels = np.sort(sign * (ends - start) / view.pixel, axis=0)
        spans.append(np.clip(pixels + np.array([[0], [1]]), 0, view.shape[1 - c]).astype(int))
    for k, (c, r) in enumerate(zip(centres, radius, strict=True)):
        window = (slice(*spans[1][:, k]), slice(*spans[0][:, k]))
        uu, vv = u[window[1]], v[window[0], None]
        a = uu * uu + vv * vv + 1.0
        b = uu * c[0] + vv * c[1] + c[2]
        root = b * b - a * (c @ c - r * r)
        t = (b - np.sqrt(np.maximum(root, 0.0))) / a
        nearer = (root > 0.0) & (t < depth[window])
        depth[window][nearer] = t[nearer]
        owner[window][nearer] = k
    return depth, owner


def add_floor(
    view: View, depth: Array, bounds: Array, ground: Callable[[Array], NDArray[np.bool_]] | None = None
) -> NDArray[np.bool_]:
    """Put the bottom of the box, where `ground` of points (m, 3) says so, behind the spheres into `depth`; returns its
    pixels.
    """
    u, v = view.tangents()
    right, up, forward = view.axes  # right is level, so a row of pixels has one depth
    with np.errstate(divide="ignore", invalid="ignore"):
        t = ((bounds[2, 0] - view.eye[2]) / (v * up[2] + forward[2]))[:, None]
        inside = np.isfinite(t) & np.ones(view.shape, dtype=bool)
        for c in (0, 1):
            place = view.eye[c] + t * (u * right[c] + (v * up[c] + forward[c])[:, None])
            inside &= (place >= bounds[c, 0]) & (place <= bounds[c, 1])
    floor: NDArray[np.bool_] = inside & (t > 0.0) & (t < depth)
    if ground is not None:
        row, column = np.nonzero(floor)
        rays = np.column_stack([u[column], v[row], np.ones(len(row))]) @ view.axes
        floor[row, column] = ground(view.eye + t[row] * rays)
    depth[floor] = np.broadcast_to(t, view.shape)[floor]
    return floor


@dataclass(frozen=True)
class Scene:
    """Spheres, x (n, 3) and radius (n,), and points (k, 3) that shadow maps must hold."""

    x: Array
    radius: Array
    hull: Array


def shine(scene: Scene, points: Array, normals: Array, lamp: Array, size: int) -> Array:
    """Cosine between normals and a lamp (m,), 0 in its shadow.

    `lamp` points to the lamp, `size` is the resolution of the shadow map.
    """
    distance = 20.0 * float(np.max(np.ptp(scene.hull, axis=0)))
    view = View.fit(scene.hull, lamp, distance, size)
    depth, _ = rasterize(view, scene.x, scene.radius)
    cosine = np.maximum(normals @ lamp.astype(normals.dtype), 0.0)
    lit = np.flatnonzero(cosine > 0.0)
    # Lifted off the surface by a little more than a pixel of the map, lest it shadows itself.
    lift = 1.5 * view.pixel * distance
    column, row, far = view.project(points[lit] + lift * normals[lit])
    rows = np.clip(np.rint(row), 0, view.shape[0] - 1).astype(np.intp)
    columns = np.clip(np.rint(column), 0, view.shape[1] - 1).astype(np.intp)
    cosine[lit[far > depth[rows, columns] + 0.5 * lift]] = 0.0
    return cosine


def sky_lamps(number: int) -> Array:
    """Directions spread evenly over the upper half sphere, (number, 3)."""
    k = np.arange(number)
    z = (k + 0.5) / number
    angle = k * np.pi * (3.0 - np.sqrt(5.0))
    ring = np.sqrt(1.0 - z * z)
    return np.column_stack([ring * np.cos(angle), ring * np.sin(angle), z])


def render_bed(
    x: Array,
    radius: Array,
    rgb: Array,
    bounds: Array,
    azimuth: float = -62.0,
    elevation: float = 24.0,
    size: int = 1100,
    lamps: int = 32,
    ground: Callable[[Array], NDArray[np.bool_]] | None = None,
    held: Array | None = None,
) -> tuple[Array, View, Array]:
    """Draw the spheres and the floor of the box.

    Parameters
    ----------
    x : ndarray, (n, 3), float64
        Positions.
    radius : ndarray, (n,), float64
        Radii.
    rgb : ndarray, (n, 3)
        Colours from 0 to 1.
    bounds : ndarray, (3, 2), float64
        Lower and upper faces of the box to show.
    azimuth, elevation : float
        Direction of the camera in degrees: from x towards y, and above the floor.
    size : int
        Pixels along the longer side of the picture; each is an average of 2 x 2 rays.
    lamps : int
        Lamps of the sky dome; more give smoother shade and take longer.
    ground : callable, optional
        Which of some points (m, 3) of the bottom of the box are floor; all without it.
    held : ndarray, (m, 3), optional
        Points beside the spheres that the picture holds; without it the corners of the box.

    Returns
    -------
    pixels : ndarray, (rows, columns, 3)
        Picture on white.
    view : View
        The camera at twice the resolution, for drawing on top.
    depth : ndarray, (2 rows, 2 columns)
        Depth of what is seen, inf where nothing is.
    """
    az, el = np.radians([azimuth, elevation])
    toward = np.array([np.cos(el) * np.cos(az), np.cos(el) * np.sin(az), np.sin(el)])
    corners = np.array(list(product(*bounds))) if held is None else held
    cubes = x[:, None, :] + radius[:, None, None] * np.array(list(product((-1.0, 1.0), repeat=3)))
    scene = Scene(x, radius, np.concatenate([corners, cubes.reshape(-1, 3)]))
    distance = 5.0 * float(np.max(np.ptp(scene.hull, axis=0)))
    view = View.fit(scene.hull, toward, distance, 2 * size)
    depth, owner = rasterize(view, x, radius)
    owner[add_floor(view, depth, bounds, ground)] = _FLOOR
    row, column = np.nonzero(owner != _NOTHING)
    u, v = view.tangents()
    rays = np.column_stack([u[column], v[row], np.ones(len(row))]) @ view.axes
    points = view.eye + depth[row, column, None] * rays
    grain = owner[row, column]
    floor = (grain == _FLOOR)[:, None]
    normals = np.where(floor, UP, (points - x[grain]) / radius[grain, None])
    color = np.where(floor, FLOOR_COLOR, np.asarray(rgb)[grain])
    sky = _sky_light(scene, points, normals, owner, lamps)
    pixels = np.ones((*view.shape, 3))
    pixels[row, column] = _shade(scene, points, normals, color, -rays, sky)
    rows, columns = view.shape
    return pixels.reshape(rows // 2, 2, columns // 2, 2, 3).mean(axis=(1, 3)), view, depth


def _sky_light(scene: Scene, points: Array, normals: Array, owner: NDArray[np.intp], lamps: int) -> Array:
    """Light of the sky dome (m,) on the seen points, 1 on open level ground.

    It varies slowly on a grain, so of a block of 2 x 2 rays only those are worked out that do not
    see the same grain as the first: a quarter of the work.
    """
    first = np.repeat(np.repeat(owner[::2, ::2], 2, axis=0), 2, axis=1)
    own = owner != first
    own[::2, ::2] = True
    seen = owner != _NOTHING
    chosen = own[seen]
    some, some_normals = points[chosen].astype(np.float32), normals[chosen].astype(np.float32)
    total = np.zeros(len(some))
    for lamp in sky_lamps(lamps):
        total += shine(scene, some, some_normals, lamp, 500)
    light = np.zeros(owner.shape)
    light[seen & own] = total * (2.0 / lamps)
    spread = np.repeat(np.repeat(light[::2, ::2], 2, axis=0), 2, axis=1)
    sky: Array = np.where(own, light, spread)[seen]
    return sky


def _shade(scene: Scene, points: Array, normals: Array, color: Array, to_eye: Array, sky: Array) -> Array:
    """Colours (m, 3) of the seen points under sky and sun."""
    middle = to_eye.mean(axis=0) / np.linalg.norm(to_eye.mean(axis=0))
    right = np.cross(UP, middle)
    sun = middle + 1.1 * UP - 0.8 * right / max(float(np.linalg.norm(right)), 1e-9)
    sun /= np.linalg.norm(sun)
    direct = shine(scene, points.astype(np.float32), normals.astype(np.float32), sun, 2200)
    halfway = to_eye / np.linalg.norm(to_eye, axis=1, keepdims=True) + sun
    halfway /= np.linalg.norm(halfway, axis=1, keepdims=True)
    gloss = np.maximum(np.einsum("mc,mc->m", normals, halfway), 0.0) ** 60 * (direct > 0.0)
    light = AMBIENT + SKY * sky + SUN * direct
    shaded: Array = np.clip(color * light[:, None] + GLOSS * gloss[:, None], 0.0, 1.0)
    return shaded
