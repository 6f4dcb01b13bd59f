# SPDX-License-Identifier: GPL-2.0-or-later
"""Contacts that resist rolling and bodies that are no spheres, which only tests have: every solver takes them.

They show that a part of a contact, and the dynamics of bodies, are a file each (`tests/core/parts`). Answers are judged
by an assembly of their own (contact_parts.py) and by natural maps that share no code with the package (coulomb.py).
"""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import contact_parts
import coulomb
import numpy as np
import pytest
from contact_parts import Array, Assembly, random_assembly
from core_programs import build

SOLVERS = ("sbp", "sal", "ebp", "eal", "pdas", "apgs", "auto", "interior_point")
TOL = 1e-10  # of the natural map over |q|
SEEDS = range(6)


@dataclass(frozen=True)
class Answer:
    """What one solver found, by one door: on bodies, or on their matrix."""

    solver: str
    door: str
    converged: bool
    impulses: Array  # (n, 8), p_n, p_t and p_r in space, and p_w


Solve = Callable[[Assembly], list[Answer]]


@pytest.fixture(scope="module")
def solve(build_folder: Callable[[str], Path]) -> Solve:
    # Not under sanitizers, which make its many templates take minutes to compile.
    program = build(build_folder("core_plain"), "core_solve_parts", "", []).path

    def run(assembly: Assembly) -> list[Answer]:
        words = [str(program), assembly.kind, repr(TOL), "20000"]
        done = subprocess.run(words, input=assembly.text(), capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stderr
        answers = []
        for line in done.stdout.splitlines():
            solver, door, converged, _, _, *numbers = line.split()
            impulses = np.array([float.fromhex(x) for x in numbers]).reshape(-1, 8)
            answers.append(Answer(solver, door, converged == "1", impulses))
        return answers

    return run


def error(assembly: Assembly, impulses: Array) -> float:
    """Return the natural map over |q|."""
    given = assembly.problem()
    left = coulomb.residual(given, assembly.along_axes(impulses))
    return float(np.linalg.norm(left) / np.linalg.norm(given.q))


@pytest.mark.parametrize("kind", contact_parts.KINDS)
def test_every_solver_takes_a_part_and_dynamics_that_it_does_not_know(solve: Solve, kind: str) -> None:
    for seed in SEEDS:
        assembly = random_assembly(kind, seed)
        answers = solve(assembly)
        assert {(a.solver, a.door) for a in answers} == {(s, door) for s in SOLVERS for door in ("bodies", "matrix")}
        for answer in answers:
            assert answer.converged, answer
            assert error(assembly, answer.impulses) < 10 * TOL, answer


def test_spheres_are_rigid_bodies_of_their_inertia(solve: Solve) -> None:
    spheres = random_assembly("rolling_spheres", 7)
    radius = np.linspace(0.3, 0.9, len(spheres.inverse_mass))
    rolling = radius[spheres.i] * radius[spheres.j] / (radius[spheres.i] + radius[spheres.j])
    spheres = replace(spheres, weight_i=rolling / radius[spheres.i], weight_j=rolling / radius[spheres.j])
    bodies = replace(
        spheres,
        kind="rolling_bodies",
        inverse_inertia=spheres.inverse_inertia / radius[:, None, None] ** 2,
        spin=spheres.spin / radius[:, None],
        arm_i=-radius[spheres.i, None] * spheres.normal,
        arm_j=radius[spheres.j, None] * spheres.normal,
        weight_i=rolling,
        weight_j=rolling,
    )
    np.testing.assert_allclose(bodies.problem().w, spheres.problem().w, atol=1e-13)
    np.testing.assert_allclose(bodies.problem().q, spheres.problem().q, atol=1e-13)
    for answer in (*solve(spheres), *solve(bodies)):
        assert answer.converged and error(spheres, answer.impulses) < 10 * TOL, answer


def test_the_judge_sees_a_rolling_moment_that_is_too_small(solve: Solve) -> None:
    assembly = random_assembly("rolling_spheres", 1)
    impulses = solve(assembly)[0].impulses.copy()
    k = int(np.linalg.norm(impulses[:, 4:7], axis=1).argmax())
    impulses[k, 4:7] *= 0.99
    assert error(assembly, impulses) > 1e-4


def test_the_judge_sees_a_twisting_moment_that_is_too_small(solve: Solve) -> None:
    assembly = random_assembly("twisting_spheres", 1)
    impulses = solve(assembly)[0].impulses.copy()
    impulses[np.abs(impulses[:, 7]).argmax(), 7] *= 0.99
    assert error(assembly, impulses) > 1e-4


def test_parts_have_something_to_do(solve: Solve) -> None:
    """Contacts that roll, that stick and that are open, all of them among the problems."""
    rolls = sticks = opens = 0
    for seed in SEEDS:
        assembly = random_assembly("rolling_spheres", seed)
        p = solve(assembly)[0].impulses
        moment, bound = np.linalg.norm(p[:, 4:7], axis=1), assembly.mu_r * p[:, 0]
        rolls += int(((moment > 0.999 * bound) & (bound > 0)).sum())
        sticks += int(((moment < 0.99 * bound) & (bound > 0)).sum())
        opens += int((p[:, 0] == 0).sum())
    assert min(rolls, sticks, opens) > 3
