# SPDX-License-Identifier: GPL-2.0-or-later
"""The true largest overlap of a scene, from all pairs of grains and all walls: numpy, and nothing of the package."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
FEW = 150  # grains: so many are looked at pair by pair, more by a tree


@dataclass
class Surface:
    """A wall by the distance (m) of points (n, 3) to it; it touches the atoms that have one of the bits `groups`."""

    distance: Callable[[Array], Array]
    groups: int = 1


@dataclass
class Spheres:
    """Centres x (n, 3) and radius (n,), m, of grains in a box; `moves` (n,) tells grains from obstacles.

    The rows of `edges` (3, 3) are the box's edge vectors. `walls` are pairs of a point and a normal of any length, or
    surfaces, which know the atoms' groups by `mask` (n,).
    """

    x: Array
    radius: Array
    tag: NDArray[np.int64]
    moves: NDArray[np.bool_]
    edges: Array
    periodic: Sequence[bool] = (False, False, False)
    walls: Sequence[tuple[Any, Any] | Surface] = field(default_factory=list)
    mask: NDArray[np.int64] | None = None


@dataclass
class Overlaps:
    """The largest overlap (m) and the largest over the smaller radius of its pair, 0 if nothing overlaps, and where."""

    largest: float = 0.0
    ratio: float = 0.0
    where: str = "nowhere"

    def see(self, overlap: Array, smaller: Array, names: Sequence[str]) -> None:
        """Take the overlaps (m) of some pairs into account."""
        if not len(overlap):
            return
        self.largest = max(self.largest, float(overlap.max()))
        ratio = overlap / smaller
        k = int(ratio.argmax())
        if ratio[k] > self.ratio:
            self.ratio, self.where = float(ratio[k]), names[k]


def largest_overlap(spheres: Spheres) -> Overlaps:
    """Return what overlaps most: pairs of a grain with a grain or an obstacle, and grains with walls."""
    assert np.isfinite(spheres.x).all(), f"positions of grains {spheres.tag[~np.isfinite(spheres.x).all(axis=1)]}"
    found = Overlaps()
    i, j = _all_pairs(len(spheres.x)) if len(spheres.x) <= FEW else _near_pairs(spheres)
    count = spheres.moves[i] | spheres.moves[j]
    i, j = i[count], j[count]
    distance = _distance(spheres, spheres.x[i] - spheres.x[j])
    overlap = spheres.radius[i] + spheres.radius[j] - distance
    near = np.flatnonzero(overlap > 0)
    i, j = i[near], j[near]
    names = [f"grains {a} and {b}" for a, b in zip(spheres.tag[i], spheres.tag[j], strict=True)]
    found.see(overlap[near], np.minimum(spheres.radius[i], spheres.radius[j]), names)
    for number, wall in enumerate(spheres.walls, 1):
        surface = wall if isinstance(wall, Surface) else plane(*wall)
        overlap = spheres.radius - surface.distance(spheres.x)
        touches = spheres.moves if spheres.mask is None else spheres.moves & (spheres.mask & surface.groups != 0)
        inside = np.flatnonzero((overlap > 0) & touches)
        names = [f"grain {tag} and wall {number}" for tag in spheres.tag[inside]]
        found.see(overlap[inside], spheres.radius[inside], names)
    return found


def plane(point: Any, normal: Any) -> Surface:
    """Return the plane through a point, with a normal of any length into the free side."""
    unit = np.asarray(normal, dtype=float) / np.linalg.norm(normal)
    return Surface(lambda x: (x - np.asarray(point, dtype=float)) @ unit)


def cylinder(point: Any, axis: Any, radius: float) -> Surface:
    """Return the inside of a cylinder about an axis through a point."""
    unit = np.asarray(axis, dtype=float) / np.linalg.norm(axis)

    def distance(x: Array) -> Array:
        out = x - np.asarray(point, dtype=float)
        return radius - np.linalg.norm(out - np.outer(out @ unit, unit), axis=1)

    return Surface(distance)


def _all_pairs(n: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the two indices of every pair."""
    return np.triu_indices(n, 1)


def _distance(spheres: Spheres, apart: Array) -> Array:
    """Return the distances (m) of vectors, to the nearest image where the box is periodic."""
    apart = apart - _whole_edges(spheres, apart)
    if not np.any(spheres.periodic):
        return np.linalg.norm(apart, axis=1)
    # in a slanted box the nearest image may lie in a cell beside
    turns = [(-1, 0, 1) if periodic else (0,) for periodic in spheres.periodic]
    images = [np.linalg.norm(apart + np.array(turn) @ spheres.edges, axis=1) for turn in itertools.product(*turns)]
    return np.min(images, axis=0)


def _whole_edges(spheres: Spheres, apart: Array) -> Array:
    """Return the whole periodic edges in each vector."""
    share = apart @ np.linalg.inv(spheres.edges)
    return np.where(spheres.periodic, np.rint(share), 0) @ spheres.edges


def _near_pairs(spheres: Spheres) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the indices of all pairs that may overlap, by trees; some may come twice.

    Larger grains are asked for their neighbours that are no larger, by classes of a factor of two in radius.
    """
    from scipy.spatial import cKDTree  # Debian's Python, which has few grains, lacks it

    x, owner = _with_images(spheres)
    size = np.floor(np.log2(spheres.radius / spheres.radius.min())).astype(int)
    first, second = [], []
    for large in np.unique(size):
        reach = spheres.radius[size == large].max()
        smaller = np.flatnonzero(size[owner] <= large)
        asked = np.flatnonzero(size == large)
        near = cKDTree(x[smaller]).query_ball_point(x[asked], spheres.radius[asked] + reach)
        first.append(np.repeat(asked, [len(some) for some in near]))
        second.append(owner[smaller[np.concatenate([np.asarray(some, dtype=int) for some in near])]])
    i, j = np.concatenate(first), np.concatenate(second)
    return i[i != j], j[i != j]


def _with_images(spheres: Spheres) -> tuple[Array, NDArray[np.int64]]:
    """Return the centres, moved into the box, with those of images that touch it, and whose they are."""
    inverse = np.linalg.inv(spheres.edges)
    share = spheres.x @ inverse
    share -= np.where(spheres.periodic, np.floor(share), 0)
    # the columns of the inverse are the faces' normals over the heights
    margin = 2 * spheres.radius.max() * np.linalg.norm(inverse, axis=0)
    reach = [int(np.ceil(edge)) if periodic else 0 for edge, periodic in zip(margin, spheres.periodic, strict=True)]
    places, owners = [share], [np.arange(len(share))]
    for turn in itertools.product(*(range(-k, k + 1) for k in reach)):
        if not any(turn):
            continue
        moved = share + turn
        near = np.flatnonzero(((moved >= -margin) & (moved <= 1 + margin) | ~np.array(spheres.periodic)).all(axis=1))
        places.append(moved[near])
        owners.append(near)
    return np.concatenate(places) @ spheres.edges, np.concatenate(owners)


def of_lammps(lmp: Any, group: str = "all", walls: Sequence[tuple[Any, Any] | Surface] = ()) -> Spheres:
    """Return the grains of a live LAMMPS object as they are now; atoms outside the group are obstacles.

    On several ranks all of them must call this, and each has all grains.
    """
    n = lmp.extract_global("nlocal")
    bit = 1 << lmp.available_ids("group").index(group) if group != "all" else 1
    own = [np.array(lmp.numpy.extract_atom(name)[:n]) for name in ("x", "radius", "id", "mask")]
    if lmp.extract_setting("world_size") > 1:
        parts = lmp.get_mpi_comm().allgather(own)
        own = [np.concatenate([part[k] for part in parts]) for k in range(len(own))]
    x, radius, tag, mask = own
    low, high, xy, yz, xz, periodic, _ = lmp.extract_box()
    edges = np.array([[high[0] - low[0], 0, 0], [xy, high[1] - low[1], 0], [xz, yz, high[2] - low[2]]])
    moves = (mask & bit) != 0
    return Spheres(x, radius, tag.astype(int), moves, edges, [bool(p) for p in periodic], walls, mask)


def of_dump(path: Path, walls: Sequence[tuple[Any, Any] | Surface] = ()) -> Iterator[tuple[int, Spheres]]:
    """Yield step and grains of each frame of a text dump with columns id, x, y, z and radius; all of them move."""
    lines = iter(Path(path).read_text().splitlines())
    for line in lines:
        if line != "ITEM: TIMESTEP":
            continue
        step = int(next(lines))
        next(lines)
        count = int(next(lines))
        kinds = next(lines).removeprefix("ITEM: BOX BOUNDS").split()
        bounds = [[float(word) for word in next(lines).split()] for _ in range(3)]
        columns = next(lines).removeprefix("ITEM: ATOMS").split()
        rows = np.array([next(lines).split() for _ in range(count)], dtype=float).reshape(count, len(columns))
        value = {name: rows[:, k] for k, name in enumerate(columns)}
        x = np.column_stack([value[axis] for axis in "xyz"])
        tag = value["id"].astype(int)
        moves = np.ones(count, dtype=bool)
        yield (
            step,
            Spheres(x, value["radius"], tag, moves, _edges(bounds), [kind[0] == "p" for kind in kinds[-3:]], walls),
        )


def _edges(bounds: list[list[float]]) -> Array:
    """Return the edge vectors from a dump's box, whose bounds of a slanted one are those of its corners."""
    xy, xz, yz = (row[2] if len(row) > 2 else 0.0 for row in bounds)
    lx = bounds[0][1] - max(0.0, xy, xz, xy + xz) - bounds[0][0] + min(0.0, xy, xz, xy + xz)
    ly = bounds[1][1] - max(0.0, yz) - bounds[1][0] + min(0.0, yz)
    return np.array([[lx, 0, 0], [xy, ly, 0], [xz, yz, bounds[2][1] - bounds[2][0]]])
