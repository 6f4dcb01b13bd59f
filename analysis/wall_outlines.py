# SPDX-License-Identifier: GPL-2.0-or-later
"""Outlines of walls: edges, silhouettes, and curves in flat walls and in the box, cut to where grains can be."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray
from wall_mesh import Mesh
from wall_shapes import Block, Curve, Cut, Plane, Sphere, Tube

Array = NDArray[np.floating[Any]]
Wall: TypeAlias = Plane | Block | Sphere | Tube | Mesh
SAMPLES = 1440  # of a curve
HEADROOM = 0.06  # of a wall above the bed, as a share of the bed's height
_SLACK = 1e-10  # share of the size of the box by which points may lie beyond it
_SAME = 1e-6  # share of that size within which curves are one


def compute_bounds_with_walls(walls: Sequence[Wall], x: Array, radius: Array, bounds: Array, whole: bool) -> Array:
    """Box (3, 2) to which walls are cut.

    Walls that end or close within the box, as a sphere, are shown whole. Others, as a high silo, end a little above the
    highest grain unless `whole`.
    """
    shown = np.array(bounds, dtype=np.float64)
    bed = float(np.max(x[:, 2] + radius))
    bed += HEADROOM * (bed - float(np.min(x[:, 2] - radius)))
    tops = [top for top in map(_top, walls) if top <= shown[2, 1]]
    if not whole:
        shown[2, 1] = min(shown[2, 1], max(bed, *tops, -np.inf))
    return shown


def _top(wall: Wall) -> float:
    """Height at which a wall that is round about z, or leans, ends; infinite where it goes on."""
    if isinstance(wall, Mesh):
        return float(wall.triangles[..., 2].max())
    if isinstance(wall, Sphere):
        return float(wall.centre[2] + wall.radius)
    if isinstance(wall, Tube):
        if abs(wall.axis[2]) < 1e-9 and wall.slope == 0.0:
            return float(wall.point[2] + wall.radius)
        ends = np.array([wall.low, wall.high])
        if wall.slope != 0.0 and np.isfinite(ends).all():
            rims = np.abs(wall.radius + wall.slope * ends) * np.sqrt(max(0.0, 1.0 - wall.axis[2] ** 2))
            return float(np.max(wall.point[2] + ends * wall.axis[2] + rims))
    return np.inf


def compute_wall_outlines(walls: Sequence[Wall], x: Array, bounds: Array, eye: Array) -> list[Array]:
    """Lines that show the walls.

    Parameters
    ----------
    walls : sequence of Wall
        Those of `wall_words.read_wall`.
    x : ndarray, (n, 3), float64
        Centres of grains. They tell whether an endless or closed wall holds the grains; other walls end there.
    bounds : ndarray, (3, 2), float64
        Box beyond which nothing is drawn.
    eye : ndarray, (3,), float64
        Place of the camera, for silhouettes.

    Returns
    -------
    outlines : list of ndarray, (n, 3), float64
        Points along each line, all on the surface of their wall.
    """
    box = Block(np.asarray(bounds, dtype=np.float64))
    middle, reach = box.bounds.mean(axis=1), 2.0 * float(np.linalg.norm(np.ptp(box.bounds, axis=1)))
    slack = _SLACK * reach
    holding = [wall for wall in walls if holds(wall, x)]
    cuts = _unlike(
        [*(cut for wall in holding if isinstance(wall, Plane | Block) for cut in wall.cuts), *box.cuts], slack
    )
    found: list[Array] = []
    for wall in walls:
        others = [other for other in holding if other is not wall]

        def margin(points: Array, wall: Wall = wall, others: Sequence[Wall] = others) -> Array:
            limits = [
                box.distance(points),
                *(other.distance(points) for other in others if not isinstance(other, Mesh)),
            ]
            if isinstance(wall, Block | Tube):
                limits.append(wall.extent(points))
            return np.min(limits, axis=0) + slack

        if isinstance(wall, Mesh):
            found += cut_segments(wall.segments(cuts, eye), margin)
        else:
            for curve in wall.curves(cuts, eye, middle, reach):
                found += [new for new in cut_curve(curve, margin) if not _is_among(new, found, _SAME * reach)]
    return found


def holds(wall: Wall, x: Array) -> bool:
    """Whether most grains are on the free side of a half-space, or inside a wall that is endless or closed."""
    if isinstance(wall, Mesh) or (isinstance(wall, Tube) and np.isfinite([wall.low, wall.high]).any()):
        return False
    return bool(np.mean(wall.distance(x) > 0.0) > 0.5)


def _unlike(cuts: Sequence[Cut], slack: float) -> list[Cut]:
    """Leave out planes that are there already."""
    found: list[Cut] = []
    for normal, offset in cuts:
        signs = [float(np.sign(normal @ known)) for known, _ in found]
        same = [
            np.linalg.norm(np.cross(normal, known)) < 1e-9 and abs(sign * offset - at) < slack
            for (known, at), sign in zip(found, signs, strict=True)
        ]
        if not any(same):
            found.append((normal, offset))
    return found


def _is_among(new: Array, found: Sequence[Array], near: float) -> bool:
    """Whether a line has the ends and the middle of another one."""
    for old in found:
        if np.linalg.norm(new[len(new) // 2] - old[len(old) // 2]) < near:
            ends, known = new[[0, -1]], old[[0, -1]]
            if min(np.abs(ends - known).max(), np.abs(ends[::-1] - known).max()) < near:
                return True
    return False


def cut_curve(curve: Curve, margin: Callable[[Array], Array]) -> list[Array]:
    """Pieces of a curve where `margin` is not negative; their ends are points of the curve too, by bisection."""
    t = np.linspace(0.0, 1.0, SAMPLES + 1)
    inside = margin(curve(t)) >= 0.0
    turn = np.flatnonzero(inside[1:] != inside[:-1])
    kept, lost = (np.where(inside[turn] == side, t[turn], t[turn + 1]) for side in (True, False))
    for _ in range(60):
        half = 0.5 * (kept + lost)
        within = margin(curve(half)) >= 0.0
        kept, lost = np.where(within, half, kept), np.where(within, lost, half)
    pieces = []
    for run in np.split(np.arange(len(t)), turn + 1):
        if inside[run[0]]:
            before = kept[turn + 1 == run[0]]
            after = kept[turn == run[-1]]
            pieces.append(curve(np.concatenate([before, t[run], after])))
    if len(pieces) > 1 and inside[0] and np.array_equal(*curve(t[[0, -1]]).round(15)):
        pieces[0] = np.concatenate([pieces.pop(), pieces[0]])
    return pieces


def cut_segments(segments: Array, margin: Callable[[Array], Array]) -> list[Array]:
    """Do the same with many short straight lines, (m, 2, 3), of each of which one piece at most is left."""
    start, end = segments[:, 0], segments[:, 1]
    t = np.linspace(0.0, 1.0, 17)
    points = start[:, None] + t[:, None] * (end - start)[:, None]
    inside = margin(points.reshape(-1, 3)).reshape(points.shape[:2]) >= 0.0
    some = inside.any(axis=1)
    start, end, inside = start[some], end[some], inside[some]
    first, last = np.argmax(inside, axis=1), len(t) - 1 - np.argmax(inside[:, ::-1], axis=1)
    ends = []
    for kept, lost in ((t[first], t[np.maximum(first - 1, 0)]), (t[last], t[np.minimum(last + 1, len(t) - 1)])):
        for _ in range(60):
            half = 0.5 * (kept + lost)
            within = margin(start + half[:, None] * (end - start)) >= 0.0
            kept, lost = np.where(within, half, kept), np.where(within, lost, half)
        ends.append(start + kept[:, None] * (end - start))
    return list(np.stack(ends, axis=1))
