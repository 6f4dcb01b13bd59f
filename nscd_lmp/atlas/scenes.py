# SPDX-License-Identifier: GPL-2.0-or-later
"""Small scenes in LAMMPS instances of their own: columns, piles, clusters, boxes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nscd_lmp.door.scene import scene
from nscd_lmp.door.walls import Plane

Array = NDArray[np.float64]

GRAVITY = 9.81  # m/s^2
FLOOR = Plane((0, 0, 0), (0, 0, 1))


@dataclass
class Grains:
    """Spheres in SI units: centres x (n, 3), radius (n,), mass (n,), velocities v (n, 3)."""

    x: Array
    radius: Array
    mass: Array
    v: Array

    def __len__(self) -> int:
        return len(self.x)


def grains(x: Any, radius: Any, mass: Any = None, v: Any = 0.0, density: float = 2500.0) -> Grains:
    """Return grains; scalars are spread over all of them, masses follow from the density (kg/m^3) unless given."""
    x = np.array(x, dtype=float).reshape(-1, 3)
    radius = np.array(np.broadcast_to(radius, len(x)), dtype=float)
    if mass is None:
        mass = density * 4 / 3 * math.pi * radius**3
    mass = np.array(np.broadcast_to(mass, len(x)), dtype=float)
    return Grains(x, radius, mass, np.array(np.broadcast_to(v, x.shape), dtype=float))


def start(balls: Grains, dt: float, *, gravity: float = GRAVITY, reach: float = 0.0, room: float = 0.0) -> Any:
    """Return a silent LAMMPS instance with the grains, ``pair_style zero`` and gravity along -z; no integrator.

    Parameters
    ----------
    balls : Grains
    dt : float, s
    gravity : float, m/s^2
    reach : float
        Metres that the pair cutoff exceeds the largest diameter by.
    room : float
        Metres that the box extends further than 20 of the largest radii round the grains.
    """
    largest = float(balls.radius.max())
    margin = 20 * largest + room
    box = np.column_stack([balls.x.min(axis=0) - margin, balls.x.max(axis=0) + margin])
    lmp = scene(
        balls.x, balls.radius, dt=dt, mass=balls.mass, v=balls.v, box=box, gravity=gravity, speed=0.5 * reach / dt
    )
    # in the order given, also the one map of more than a few grains: its last digits go by the order
    lmp.commands_list([f"neighbor {0.5 * largest!r} nsq", "atom_modify sort 0 0"])
    return lmp


def state(lmp: Any) -> tuple[Array, Array, Array]:
    """Return copies of x, v and omega (n, 3) in the order of the tags."""
    n = lmp.extract_global("nlocal")
    order = np.argsort(lmp.numpy.extract_atom("id")[:n])
    x, v, omega = (lmp.numpy.extract_atom(name)[:n][order] for name in ("x", "v", "omega"))
    return x, v, omega


def column(mass: Any, radius: float = 0.5e-3, gap: float = 0.0) -> Grains:
    """Return grains of these masses (kg) one on another above the floor, a gap (m) below each."""
    n = len(np.atleast_1d(mass))
    heights = [(0.0, 0.0, radius + k * 2 * radius + (k + 1) * gap) for k in range(n)]
    return grains(heights, radius, mass)


def pile(layers: int, radius: float = 0.5e-3) -> Grains:
    """Return a tetrahedron of touching spheres on the floor, from the bottom up: 4 of 2 layers, 10 of 3, 20, 35."""
    x = []
    for layer in range(layers):
        n = layers - layer
        corner = layer * np.array([0.5, math.sqrt(3) / 6])
        height = layer * math.sqrt(2 / 3)
        x += [(corner[0] + a + b / 2, corner[1] + b * math.sqrt(3) / 2, height) for a in range(n) for b in range(n - a)]
    return grains(2 * radius * np.array(x) + (0, 0, radius), radius)


def sides(width: float) -> list[Plane]:
    """Return the floor and the four sides of a width x width box above the corner 0 0 0, m."""
    return [
        FLOOR,
        Plane((0, 0, 0), (1, 0, 0)),
        Plane((width, 0, 0), (-1, 0, 0)),
        Plane((0, 0, 0), (0, 1, 0)),
        Plane((0, width, 0), (0, -1, 0)),
    ]


def overlaps(x: Array, radius: Array, walls: Sequence[Plane]) -> Array:
    """Return overlaps over the smaller radius of all pairs and of all grains with walls, negative for gaps."""
    i, j = np.triu_indices(len(x), 1)
    pairs = (radius[i] + radius[j] - np.linalg.norm(x[i] - x[j], axis=1)) / np.minimum(radius[i], radius[j])
    against = [pairs]
    for wall in walls:
        normal = np.array(wall.normal, dtype=float) / np.linalg.norm(wall.normal)
        against.append((radius - (x - np.array(wall.point)) @ normal) / radius)
    return np.concatenate(against)
