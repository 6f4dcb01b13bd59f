# SPDX-License-Identifier: GPL-2.0-or-later
"""A loose cloud of discs over a floor between two sides: the planar scene."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nscd_lmp import Plane, scene

RMIN, RMAX, DENSITY, GRAVITY = 0.25e-3, 0.5e-3, 2500.0, 9.81  # m, m, kg/m^2, m/s^2; radii as in in.sedimentation
DEPTH = 20  # discs from the floor to the surface of a bed, however wide: a deep one takes more iterations
LOOSE = 1.02  # edge of a cell of the initial cloud / (2 rmax)
SEED = 2


def open_discs(grains: int, dt: float) -> tuple[Any, list[Plane]]:
    """Return LAMMPS with discs at rest in the plane z = 0 and a step of `dt`, and the walls.

    Each disc lies anywhere in a cell of its own, so none overlap.
    """
    edge = 2 * RMAX * LOOSE
    cells = math.ceil(grains / DEPTH)
    width, height = cells * edge, math.ceil(grains / cells) * edge
    fastest = math.sqrt(2 * GRAVITY * height)
    x, radius = _loose(grains, cells, edge)
    box = [(-RMAX, width + RMAX), (-RMAX, height + RMAX)]
    lmp = scene(
        x, radius, dt=dt, mass=DENSITY * np.pi * radius**2, box=box, dimension=2, gravity=GRAVITY, speed=fastest,
        skin=0.4 * RMAX + 2 * dt * fastest,
    )  # fmt: skip
    return lmp, [Plane((0, 0, 0), (0, 1, 0)), Plane((0, 0, 0), (1, 0, 0)), Plane((width, 0, 0), (-1, 0, 0))]


def _loose(grains: int, cells: int, edge: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return centres (n, 2) and radii."""
    random = np.random.default_rng(SEED)
    radius = random.uniform(RMIN, RMAX, grains)
    x = np.stack([np.arange(grains) % cells, np.arange(grains) // cells], axis=1)
    return (x + 0.5) * edge + random.uniform(-1, 1, (grains, 2)) * (edge / 2 - radius)[:, None], radius
