# SPDX-License-Identifier: GPL-2.0-or-later
"""Beds of grains with friction that settled under their weight, in space and in the plane, and a step of them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import coulomb
import numpy as np
from numpy.typing import NDArray
from scenes import GRAVITY, Grains, box_walls, grains, harden, per_atom, state

import nscd_lmp

WIDTH = {2: 6.4, 3: 3.2}  # m, of the floor; boulders of 0.25 to 0.5 m, for which criterion (42) bounds velocities
PAIRS, WALLS = 0.3, 0.8  # friction
DT = 1e-3
TOL = 1e-12


def walls(dim: int, friction: Any = WALLS, sides: bool = True) -> list[nscd_lmp.Plane]:
    """Return the floor, with `sides` the sides too."""
    planes: list[tuple[Any, Any]]
    if dim == 2:
        planes = [((0, 0, 0), (0, 1, 0)), ((0, 0, 0), (1, 0, 0)), ((WIDTH[2], 0, 0), (-1, 0, 0))]
    else:
        planes = [(wall.point, wall.normal) for wall in box_walls(WIDTH[3])]
    return [nscd_lmp.Plane(point, normal, friction=friction) for point, normal in planes[: None if sides else 1]]


def settled(dim: int) -> Grains:
    """Return 60 discs or spheres that fell into the box and came to rest.

    They are kept as numbers. These beds have one solution when they are shaken; most have several in one of the tests,
    and what a bed settles to hangs on the round-off of every step.
    """
    name = {2: "discs.csv", 3: "spheres.csv"}[dim]
    x, y, z, radius, mass = np.loadtxt(Path(__file__).parent / "beds" / name, delimiter=",", skiprows=1).T
    return grains(np.column_stack([x, y, z]), radius, mass)


def shaken(balls: Grains, speed: float, dim: int, seed: int = 1) -> Grains:
    """Return the grains with overlaps of 1 mm and random velocities and surface velocities of the speed, m/s.

    The overlaps keep the contacts shut before law moreau looks.
    """
    random = np.random.default_rng(seed)
    v, turn = random.normal(size=(2, *balls.x.shape)) * speed
    if dim == 2:
        v[:, 2] = turn[:, :2] = 0
    return Grains(0.998 * balls.x, balls.radius, balls.mass, v, turn / balls.radius[:, None])


def pile(dim: int, layers: int) -> Grains:
    """Return a triangle of discs or a tetrahedron of spheres of radius 0.5 m that touch."""
    x = []
    for layer in range(layers):
        n = layers - layer
        if dim == 2:
            x += [(a + layer / 2, 0.5 + layer * np.sqrt(3) / 2, 0) for a in range(n)]
        else:
            corner, height = layer * np.array([0.5, np.sqrt(3) / 6]), 0.5 + layer * np.sqrt(2 / 3)
            x += [
                (corner[0] + a + b / 2, corner[1] + b * np.sqrt(3) / 2, height) for a in range(n) for b in range(n - a)
            ]
    return grains(x, 0.5)


def incline(start: Callable[..., Any], balls: Grains, dim: int, slope: float) -> Any:
    """Return an instance with the grains on a floor that falls along x by the slope, as gravity sees it."""
    lmp = start(balls, DT, gravity=GRAVITY, planar=dim == 2)
    if slope:
        lmp.command(f"fix slope all gravity {slope * GRAVITY} vector 1 0 0")
    return lmp


def one_step(start: Callable[..., Any], balls: Grains, dim: int, **options: Any) -> tuple[NDArray[np.float64], Any]:
    """Return velocities and surface velocities r omega (n, 6) after a step, and what attach returned."""
    lmp = start(balls, DT, gravity=GRAVITY, vmax=10.0, planar=dim == 2)
    settings: dict[str, Any] = {"friction": PAIRS, "walls": walls(dim), "tol": TOL, "maxiter": 1000000} | options
    attached = harden(lmp, **settings)
    lmp.command("run 1")
    return np.hstack([state(lmp)[1], per_atom(lmp, "omega") * balls.radius[:, None]]), attached


def contact_problem(system: nscd_lmp.ContactSystem) -> coulomb.Problem:
    """Return the system as the reference wants it."""
    assert system.slip is not None
    q = np.column_stack([system.velocity, system.slip])
    return coulomb.problem(system.delassus(), q, system.friction, system.dimension)


def reference(systems: list[Any]) -> Callable[[nscd_lmp.ContactSystem], NDArray[np.float64]]:
    """Return a Python solver that keeps each system, the reference's view of it, and the solution it found."""

    def solve(system: nscd_lmp.ContactSystem) -> NDArray[np.float64]:
        given = contact_problem(system)
        systems.append((system, given, coulomb.solve(given)))
        return systems[-1][2]

    return solve


def tangential(rows: dict[str, NDArray[np.float64]]) -> NDArray[np.float64]:
    """Return the tangential impulses of contact rows, (n, 3)."""
    return np.column_stack([rows["impulse_tx"], rows["impulse_ty"], rows["impulse_tz"]])


def impulses(system: nscd_lmp.ContactSystem, rows: dict[str, NDArray[np.float64]]) -> NDArray[np.float64]:
    """Return the impulses of contact rows, (n, d) as the system has them.

    The system must have all contacts of the rows; those that it has beside them have no impulse.
    """
    assert system.tangents is not None
    bodies = np.column_stack([rows["tag_i"] - 1, np.maximum(rows["tag_j"] - 1, -1)]).astype(int)
    normals = np.column_stack([rows["nx"], rows["ny"], rows["nz"]])
    place = {(i, j, *n): k for k, (i, j, n) in enumerate(zip(system.body_i, system.body_j, system.normal, strict=True))}
    at = [place[(i, j, *n)] for (i, j), n in zip(bodies, normals, strict=True)]
    assert len(set(at)) == len(at)
    p = np.zeros((len(system), 1 + system.tangents.shape[1]))
    p[at, 0] = rows["impulse"]
    p[at, 1:] = np.einsum("kij,kj->ki", system.tangents[at], tangential(rows))
    return p
