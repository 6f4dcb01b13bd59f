# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact problems of one step, posed without LAMMPS: where solvers are easy, hard and hopeless."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from settled_bed import open_bed

import nscd_lmp

Array = NDArray[np.float64]
DT = 5e-4  # s
GRAVITY = 9.81  # m/s^2


@dataclass(frozen=True)
class Case:
    """A problem, where to start, and what it is called."""

    name: str
    problem: nscd_lmp.ContactProblem
    start: Array | None = None


def bed(grains: int, folder: Path, friction: float = 0.0) -> list[Case]:
    """Return the problems of a settled bed under ``law gap``: from zero impulses, and from the step before.

    The step before is solved to 1e-10, so that the start is what a run would have.
    """
    lmp, walls, _ = open_bed(grains, folder, DT)
    systems: list[nscd_lmp.ContactSystem] = []

    def solve(system: nscd_lmp.ContactSystem) -> Array:
        systems.append(system)
        found = nscd_lmp.solve(
            system.problem(),
            "auto",
            warmstart=system.start,
            tol=1e-7 if friction else 1e-10,
            maxiter=20000,
            criterion="paper",
            unconverged="ignore",
        )
        return found.impulse

    attached = nscd_lmp.attach(lmp, law="gap", walls=walls, friction=friction, solver=solve, unconverged="ignore")
    lmp.command("run 3 post no")
    attached.detach()
    lmp.close()
    name = f"bed of {grains}" + (f", friction {friction}" if friction else "")
    last = systems[-1].problem()
    return [Case(f"{name}, cold", last), Case(f"{name}, warm", last, systems[-1].start)]


def column(masses: Array, name: str) -> Case:
    """Return the problem of a column of balls on the floor that have fallen for one step, the lowest first."""
    n = len(masses)
    return Case(
        name,
        nscd_lmp.ContactProblem.from_spheres(
            body_i=np.arange(n),
            body_j=np.arange(n) - 1,
            inverse_mass=1 / masses,
            normal=np.tile([0.0, 0.0, 1.0], (n, 1)),
            velocity=np.concatenate([[-GRAVITY * DT], np.zeros(n - 1)]),
        ),
    )


def columns() -> list[Case]:
    """Return columns: long, and with masses that differ by a million."""
    alternating = np.where(np.arange(20) % 2, 1e-3, 1e3)
    return [
        column(np.ones(1000), "column of 1000"),
        column(np.array([1.0, 1e6]), "mass ratio 1e6"),
        column(alternating, "column of 20, mass ratio 1e6"),
    ]


def velocity_error(solution: nscd_lmp.Solution, reference: nscd_lmp.Solution) -> float:
    """Return the largest difference of the contact velocities, m/s."""
    return float(np.abs(solution.velocity - reference.velocity).max(initial=0.0))


__all__ = ["Case", "bed", "columns", "velocity_error"]
