# SPDX-License-Identifier: GPL-2.0-or-later
"""Many balls on a floor, so far apart that each is a scene of its own: one ball alone is too quick to time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nscd_lmp.charts.cases import Case, penalty_cases, rigid_cases
from nscd_lmp.charts.grains import open_lammps, per_grain
from nscd_lmp.charts.methods import METHODS, RIGID, Contacts, penalty_methods, rigid_methods, start
from nscd_lmp.charts.overlap import Overlaps
from nscd_lmp.charts.size import Size
from nscd_lmp.door.walls import Plane

Array = NDArray[np.float64]

BALLS = 100
GRAVITY = 9.81  # m/s^2
RADIUS, DENSITY = 0.01, 2500.0  # m, kg/m^3: the ball of inputs/in.slide
SPACING = 0.2  # m; more than what two balls move in a step
FLOOR = Plane((0, 0, 0), (0, 0, 1))
REPEATS = 3

DTS = (1e-2, 1e-3, 1e-4)
TOLS = (1e-3, 1e-6, 1e-9)
QUICK_METHODS = ("gap/apgs", "gap/pdas", "moreau/pdas")


def mass(radius: float = RADIUS, density: float = DENSITY) -> float:
    """Return the mass of a ball, kg."""
    return density * 4 / 3 * math.pi * radius**3


def all_cases(
    size: Size, stiffnesses: Sequence[float], ball: float, *, friction: bool, dts: Sequence[float] = DTS
) -> list[Case]:
    """Return the cases of a scene of balls of a mass (kg); `stiffnesses` in N/m, softest first."""
    if size is Size.QUICK:
        rigid = rigid_cases(QUICK_METHODS, dts[:2], TOLS[1:2])
        return rigid + penalty_cases(penalty_methods(), stiffnesses[1:2], ball, (0.1,))
    rigid = rigid_cases(rigid_methods(friction=friction), dts, TOLS)
    return rigid + penalty_cases(penalty_methods(), stiffnesses, ball)


def open_balls(
    folder: Path,
    case: dict[str, Any],
    height: ArrayLike,
    v: Array,
    spin: ArrayLike = 0.0,
    *,
    radius: float = RADIUS,
    density: float = DENSITY,
    gravity: float = GRAVITY,
    **contact: Any,
) -> Contacts:
    """Return the contacts of the balls, thrown along x or down.

    Parameters
    ----------
    height : array_like
        Of the lowest points above the floor, m.
    v : ndarray, shape (balls, 3)
        m/s.
    spin : array_like
        Speed of the surface about y, positive for rolling along x, m/s.
    contact
        As of :func:`nscd_lmp.charts.methods.start`.
    """
    number = np.arange(len(v))
    x = np.zeros((len(v), 3))
    x[:, 0], x[:, 1] = SPACING * (number // 10), SPACING * (number % 10)
    x[:, 2] = radius + np.asarray(height)
    omega = np.zeros((len(v), 3))
    omega[:, 1] = np.asarray(spin) / radius
    box = [(-1.0, 5.0), (-1.0, 3.0), (-0.1, 2.0)]
    lmp = open_lammps(folder, x, radius, mass(radius, density), v, omega, box=box, gravity=gravity)
    return start(lmp, case["method"], case, [FLOOR], skin=radius, **contact)


def along(speeds: ArrayLike, down: ArrayLike = 0.0) -> Array:
    """Return velocities (BALLS, 3) with components along x and down."""
    v = np.zeros((BALLS, 3))
    v[:, 0], v[:, 2] = speeds, -np.asarray(down)
    return v


def travelled(lmp: Any) -> Array:
    """Return how far the balls have gone along x, m."""
    return per_grain(lmp, "x")[:, 0] - SPACING * (np.arange(BALLS) // 10)


def overlap(contacts: Contacts) -> float:
    """Return the largest overlap over radius: of every step of rigid contacts, of penalty contacts that at the end."""
    if contacts.method.family == RIGID:
        return float(contacts.totals()["worst_overlap_ratio"] or 0.0)
    return Overlaps(per_grain(contacts.lmp, "radius"), [FLOOR]).largest_ratio(per_grain(contacts.lmp, "x"))


def counts(contacts: Contacts) -> dict[str, float | None]:
    """Return iterations and steps above tol since the start; None of penalty contacts."""
    return {name: contacts.totals()[name] for name in ("iterations", "unconverged_steps")}


def is_rigid(case: dict[str, Any]) -> bool:
    """Return whether a case has rigid contacts."""
    return METHODS[case["method"]].family == RIGID
