# SPDX-License-Identifier: GPL-2.0-or-later
"""Balls that rest on a floor between two sides, on any number of ranks: what the walls carry.

Run by its path under mpiexec, it saves what each wall carries, as the first rank is told it.
"""

from __future__ import annotations

import sys

import numpy as np
from numpy.typing import NDArray

import nscd_lmp

RADIUS, MASS, GRAVITY, PUSH = 0.1, 2.0, 9.81, 3.0  # m, kg, m/s^2, N
PLACES = np.array([(-0.5, 0.2, RADIUS), (-0.3, 0.2, RADIUS), (0.9, 0.4, RADIUS)])  # two touch, one rolls to nowhere
CENTRE = (-0.6, 0.0, 0.0)  # of the side's rotation, about an axis along x, which moves no point of it off its plane


def expected() -> NDArray[np.float64]:
    """Return force, torque and contacts of the floor and of the side that two balls are pushed against."""
    weight = np.array([0, 0, -MASS * GRAVITY])
    feet = PLACES - [0, 0, RADIUS]
    floor = [*3 * weight, *np.cross(feet, weight).sum(axis=0), 3]
    push = np.array([-2 * PUSH, 0, 0])
    touched = np.array([-0.6, 0.2, RADIUS])
    return np.array([floor, [*push, *np.cross(touched - CENTRE, push), 1]])


def run() -> NDArray[np.float64]:
    """Return what the two walls carry in the last of a few steps."""
    walls = [
        nscd_lmp.Planes("z", 0, None),
        nscd_lmp.Plane((-0.6, 0, 0), (1, 0, 0), motion=nscd_lmp.Rotate(1.0, CENTRE, (1, 0, 0))),
    ]
    lmp = nscd_lmp.scene(
        PLACES, RADIUS, mass=MASS, dt=1e-3, gravity=GRAVITY, walls=walls, box=[(-1, 1), (0, 1), (0, 1)],
        setup=["processors * 1 1"], speed=1.0,
    )  # fmt: skip
    lmp.commands_list(["group left id 1 2", f"fix push left addforce {-PUSH} 0 0"])
    attached = nscd_lmp.attach(lmp, criterion="paper", tol=1e-13)
    lmp.command("run 5")
    carried = attached.wall_forces()
    lmp.close()
    return carried


if __name__ == "__main__":
    answer = run()
    from mpi4py import MPI

    if MPI.COMM_WORLD.rank == 0:
        np.save(sys.argv[1], answer)
