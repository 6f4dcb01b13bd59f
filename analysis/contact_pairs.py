# SPDX-License-Identifier: GPL-2.0-or-later
"""Pairs of spheres, and spheres and planes, that touch or nearly touch; gaps in float64.

MDAnalysis finds the candidates, in float32 and with a margin for its rounding; each gap is then
computed anew in float64. Two traps of ``self_capped_distance`` shape this file. Its grid has cells
of at least 1 length unit (it was made for angstroms), so a bed in metres falls into one cell and
the search becomes quadratic: coordinates are scaled by the largest radius first. And its box is
periodic in all directions or in none, and sees one image of a neighbor only: images of the grains
near periodic faces are added instead, which also is right for a box thinner than two cutoffs.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from MDAnalysis.lib.distances import self_capped_distance
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True)
class Contacts:
    """Contacts of one configuration, each once.

    Attributes
    ----------
    i, j : ndarray, (m,), intp
        Grain indices. j is -1 - k for a contact with plane k. i = j is possible in a small
        periodic box, where a grain meets its own image.
    gap : ndarray, (m,), float64
        Distance of the surfaces, negative where they overlap; length unit of the positions.
    """

    i: Indices
    j: Indices
    gap: Array

    def joined(self, other: Contacts) -> Contacts:
        """Both sets in one."""
        return Contacts(
            np.concatenate([self.i, other.i]),
            np.concatenate([self.j, other.j]),
            np.concatenate([self.gap, other.gap]),
        )


def is_planar(x: Array) -> bool:
    """Whether several grains all have the same z, as in a run with ``dimension 2``."""
    return len(x) > 1 and bool(np.ptp(x[:, 2]) == 0.0)


def unit_planes(planes: ArrayLike | None) -> tuple[Array, Array]:
    """Split rows ``x y z nx ny nz`` into points (k, 3) and unit normals (k, 3).

    Raises
    ------
    ValueError
        A row has not 6 numbers, or its normal is zero.
    """
    rows = np.asarray([] if planes is None else planes, dtype=np.float64)
    if rows.size == 0:
        return np.empty((0, 3)), np.empty((0, 3))
    if rows.ndim != 2 or rows.shape[1] != 6:
        raise ValueError(f"planes have shape {rows.shape}, rows of 6 are needed: x y z nx ny nz")
    length = np.linalg.norm(rows[:, 3:], axis=1, keepdims=True)
    if np.any(length == 0.0):
        raise ValueError("a plane has normal 0 0 0; give one that points to the grains")
    return rows[:, :3], rows[:, 3:] / length


def require_finite(x: Array, radius: Array) -> None:
    """Raise ValueError for grains that are nowhere: they would touch nothing, and the others as ever."""
    wrong = np.flatnonzero(~(np.isfinite(x).all(axis=1) & np.isfinite(radius)))
    if len(wrong):
        raise ValueError(
            f"{len(wrong)} of {len(x)} grains, the first of index {wrong[0]}, have a position or radius that is not a"
            " finite number: the run exploded before; look at an earlier frame"
        )


def find_wall_contacts(x: Array, radius: Array, planes: ArrayLike | None, reach: float = 0.0) -> Contacts:
    """Contacts with planes whose normals point to the grains.

    Parameters
    ----------
    x : ndarray, (n, 3), float64
        Positions.
    radius : ndarray, (n,), float64
        Radii.
    planes : array_like, (k, 6), or None
        Rows ``x y z nx ny nz``.
    reach : float
        Largest gap that counts, as a fraction of the grain's radius.
    """
    require_finite(x, radius)
    points, normals = unit_planes(planes)
    gap = np.einsum("kc,nkc->nk", normals, x[:, None, :] - points) - radius[:, None]
    i, k = np.nonzero(gap <= reach * radius[:, None])
    return Contacts(i, -1 - k, gap[i, k])


def find_grain_contacts(
    x: Array,
    radius: Array,
    bounds: Array,
    periodic: NDArray[np.bool_],
    reach: float = 0.0,
) -> Contacts:
    """Contacts of grains with each other.

    Parameters
    ----------
    x : ndarray, (n, 3), float64
        Positions, inside the box or not.
    radius : ndarray, (n,), float64
        Radii.
    bounds : ndarray, (3, 2), float64
        Lower and upper box faces.
    periodic : ndarray, (3,), bool
        Periodic axes. z is taken as not periodic where all grains have the same z: that is a
        planar run, for which LAMMPS asks for a periodic z, maybe thinner than a grain.
    reach : float
        Largest gap that counts, as a fraction of the mean radius of the pair.

    Raises
    ------
    ValueError
        Arrays of different length, a radius that is not positive, or numbers that are not finite.
    """
    if x.shape != (len(radius), 3) or np.any(radius <= 0.0):
        raise ValueError(
            f"positions have shape {x.shape}, radii {radius.shape} with smallest"
            f" {radius.min(initial=np.inf):g}; (n, 3), (n,) and radii > 0 are needed"
        )
    require_finite(x, radius)
    cyclic = periodic & np.array([True, True, not is_planar(x)])
    cutoff = radius.max() * (2.0 + max(reach, 0.0))
    images, parent, shift = _with_images(x, bounds, cyclic, cutoff)
    first, second = _candidates(images, radius.max(), cutoff)
    keep = _counted_once(first, second, parent, shift, len(x))
    first, second = first[keep], second[keep]
    i, j = parent[first], parent[second]
    distance = np.linalg.norm(images[second] - images[first], axis=1)
    gap = distance - (radius[i] + radius[j])
    near = gap <= reach * 0.5 * (radius[i] + radius[j])
    return Contacts(i[near], j[near], gap[near])


def _with_images(
    x: Array, bounds: Array, cyclic: NDArray[np.bool_], cutoff: float
) -> tuple[Array, Indices, NDArray[np.intp]]:
    """Grains wrapped into the box, then their images within the cutoff of it.

    Returns positions (m, 3), the grain of each (m,), and its shift in boxes (m, 3).
    """
    low, length = bounds[:, 0], bounds[:, 1] - bounds[:, 0]
    home = np.where(cyclic, x - length * np.floor((x - low) / length), x)
    layers = np.where(cyclic, np.ceil(cutoff / length), 0).astype(int)
    positions, parents, shifts = [home], [np.arange(len(x))], [np.zeros(x.shape, dtype=np.intp)]
    for step in product(*(range(-n, n + 1) for n in layers)):
        if not any(step):
            continue
        moved = home + np.array(step) * length
        near = (moved >= low - cutoff) & (moved <= low + length + cutoff)
        chosen = np.flatnonzero(np.all(near | ~cyclic, axis=1))
        positions.append(moved[chosen])
        parents.append(chosen)
        shifts.append(np.tile(np.array(step, dtype=np.intp), (len(chosen), 1)))
    return np.concatenate(positions), np.concatenate(parents), np.concatenate(shifts)


def _candidates(positions: Array, unit: float, cutoff: float) -> tuple[Indices, Indices]:
    """Index pairs closer than the cutoff, and a few more."""
    if len(positions) < 2:
        return np.empty(0, dtype=np.intp), np.empty(0, dtype=np.intp)
    scaled = (positions - positions.min(axis=0)) / unit
    margin = 4.0 * float(np.finfo(np.float32).eps) * (1.0 + scaled.max())
    pairs = self_capped_distance(scaled.astype(np.float32), cutoff / unit + margin, return_distances=False)
    pairs = np.sort(np.asarray(pairs, dtype=np.intp).reshape(-1, 2), axis=1)
    return pairs[:, 0], pairs[:, 1]


def _counted_once(
    first: Indices, second: Indices, parent: Indices, shift: NDArray[np.intp], n_grains: int
) -> NDArray[np.bool_]:
    """Choose one of the two mirror pairs (i, image of j) and (j, image of i); first < second."""
    home, away = first < n_grains, second >= n_grains
    i, j = parent[first], parent[second]
    own_image = i == j
    ahead = np.array([tuple(s) > (0, 0, 0) for s in shift[second]], dtype=bool)
    chosen: NDArray[np.bool_] = home & (~away | (~own_image & (i < j)) | (own_image & ahead))
    return chosen
