# SPDX-License-Identifier: GPL-2.0-or-later
"""Why some problems with friction are never solved by sweeps: near their best impulses a sweep leads away from them.

Grains of 0.25 to 0.5 mm fall into a box. Problems that 300 sweeps of `apgs` do not solve to 1e-3 get 4000. Near the
best impulses each contact is open, sticks or slips. As long as that stays, a sweep of exact visits is linear: the error
after it is that before it times G = 1 - (D + L)^-1 A. A is W between what each contact is free in. Where it slips,
p_t = mu p_n goes with p_n against the slip, so A is not symmetric and need not be positive.

repelled        eigenvalues of G above 1 + 1e-6 in magnitude: with one of them no start nearby leads to a solution
growth          the largest of them, minus 1
negative        eigenvalues of A with a real part below -1e-7, its diagonal scaled to 1: no share of a visit's step
                (under-relaxation) attracts there either
grown           what 200 plain sweeps multiply the residual by, from these impulses
changed         contacts that change between stick, slip and open in these sweeps

    python benchmarks/repelling_contacts.py
    python benchmarks/repelling_contacts.py --frictions 0.8 --problems 3
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import scipy.linalg
from box import box_walls
from friction_accuracy import WIDTHS
from numpy.typing import NDArray
from record import Record, print_table
from script import open_scene

import nscd_lmp

Array = NDArray[np.float64]
Problem = tuple[nscd_lmp.ContactProblem, Array]

DT, STEPS = 2e-4, 600  # s, and of them
TOL, FEW, MANY, PLAIN = 1e-3, 300, 4000, 200  # sweeps
FRICTIONS = (0.3, 0.5, 0.8)
APART, BELOW = 1e-6, -1e-7


class Statuses:
    """What the contacts do at impulses p: the projections of the natural map."""

    def __init__(self, problem: nscd_lmp.ContactProblem, impulse: Array) -> None:
        assert problem.mu is not None
        self.mu, self.impulse, self.W = problem.mu, impulse, problem.delassus().tocsr()
        self.velocity = np.asarray(self.W @ impulse.ravel()).reshape(-1, 3) + problem.q
        aim = impulse - self.velocity / self.W.diagonal().reshape(-1, 3)
        self.tangent = aim[:, 1:]
        self.pushes = aim[:, 0] > 0
        self.slips = self.pushes & (np.linalg.norm(self.tangent, axis=1) > self.mu * impulse[:, 0].clip(0))

    def as_numbers(self) -> NDArray[np.int64]:
        """Return 0 for open, 1 for stick, 2 for slip."""
        return self.pushes.astype(np.int64) + self.slips

    def matrix(self) -> Array:
        """Return A, its diagonal scaled to 1."""
        rows, columns, added = [], [], []

        def free_in(contact: int, row: Array, column: Array, more: float = 0.0) -> None:
            for vectors, part in ((rows, row), (columns, column)):
                vector = np.zeros(3 * len(self.mu))
                vector[3 * contact : 3 * contact + 3] = part
                vectors.append(vector)
            added.append(more)

        unit = np.eye(3)
        for k in np.flatnonzero(self.pushes):
            if not self.slips[k]:
                for axis in unit:
                    free_in(k, axis, axis)
                continue
            t = self.tangent[k] / np.linalg.norm(self.tangent[k])
            radius = self.mu[k] * self.impulse[k, 0]
            turns = float(np.linalg.norm(self.velocity[k, 1:])) / radius if radius > 0 else np.inf
            free_in(k, unit[0], np.array([1, *(self.mu[k] * t)]))
            if np.isfinite(turns):  # across the slip: the direction of p_t turns with that of u_t
                across = np.array([0, -t[1], t[0]])
                free_in(k, across, across, turns)
        A = np.array(rows) @ np.asarray(self.W @ np.array(columns).T) + np.diag(added)
        scale = 1 / np.sqrt(np.diag(A))
        return np.asarray(scale[:, None] * A * scale)


def hard_problems(grains: int, friction: float, few: int) -> dict[int, Problem]:
    """Return the problems of a fall that `few` sweeps leave unsolved, and the impulses that they started from."""
    found: dict[int, Problem] = {}

    def solver(system: nscd_lmp.ContactSystem) -> Any:
        problem, start = system.problem(), np.array(system.start)
        answer = nscd_lmp.solve(problem, "apgs", tol=TOL, maxiter=few, warmstart=start, unconverged="ignore")
        if not answer.converged:
            found[int(lmp.extract_global("ntimestep"))] = problem, start
        return answer.impulse

    lmp = open_scene("in.sedimentation", n=grains, lx=WIDTHS[grains], dt=DT)
    walls = box_walls(WIDTHS[grains])
    nscd_lmp.attach(lmp, friction=friction, solver=solver, walls=walls, unconverged="ignore")
    lmp.command(f"run {STEPS} post no")
    lmp.close()
    return found


def look_at(problem: nscd_lmp.ContactProblem, start: Array, many: int = MANY) -> dict[str, Any]:
    """Return what many sweeps leave, and where plain ones lead from there."""
    options: dict[str, Any] = {"unconverged": "ignore"}
    hard = nscd_lmp.solve(problem, "apgs", tol=TOL, maxiter=16 * many, warmstart=start, **options)
    best = nscd_lmp.solve(problem, "apgs", tol=1e-9, maxiter=many, warmstart=start, **options)
    statuses = Statuses(problem, best.impulse)
    A = statuses.matrix()
    growth = np.abs(np.linalg.eigvals(np.eye(len(A)) - scipy.linalg.solve_triangular(np.tril(A), A, lower=True)))
    answer, changed = best, np.zeros(len(problem), dtype=bool)
    for _ in range(PLAIN):
        answer = nscd_lmp.solve(problem, "pdas", tol=1e-12, maxiter=1, warmstart=answer.impulse, **options)
        changed |= Statuses(problem, answer.impulse).as_numbers() != statuses.as_numbers()
    return {
        "contacts": len(problem),
        "slip": int(statuses.slips.sum()),
        "stick": int((statuses.pushes & ~statuses.slips).sum()),
        "sweeps": hard.iterations if hard.converged else None,
        "residual": best.residual,
        "repelled": int((growth > 1 + APART).sum()),
        "growth": float(growth.max() - 1),
        "negative": int((np.linalg.eigvals(A).real < BELOW).sum()),
        "grown": answer.residual / best.residual,
        "changed": int(changed.sum()),
    }


def main(arguments: Sequence[str] | None = None) -> None:
    """Print a table of the problems; write repelling_contacts.csv."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--grains", type=int, default=500, choices=sorted(WIDTHS))
    parser.add_argument("--frictions", type=float, nargs="+", default=FRICTIONS)
    parser.add_argument("--problems", type=int, default=9, help="so many a friction, spread over the fall")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="one easy problem, to see that it runs")
    asked = parser.parse_args(arguments)
    few, many = FEW, MANY
    if asked.quick:
        asked.grains, asked.frictions, asked.problems, few, many = 60, FRICTIONS[-1:], 1, 10, 50
    record, rows = Record("repelling_contacts"), []
    for friction in asked.frictions:
        found = hard_problems(asked.grains, friction, few)
        steps = sorted(found)
        places = np.linspace(0, len(steps) - 1, min(asked.problems, len(steps))).round().astype(int)
        for step in (steps[k] for k in places):
            row = {"friction": friction, "hard": len(steps), "step": step, **look_at(*found[step], many)}
            record.add(**row)
            rows.append(row)
            record.write(asked.output / "repelling_contacts.csv")
    if rows:
        print_table("Sweeps near the best impulses", list(rows[0]), [list(row.values()) for row in rows])


if __name__ == "__main__":
    main()
