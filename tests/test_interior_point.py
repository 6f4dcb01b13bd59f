# SPDX-License-Identifier: GPL-2.0-or-later
"""The interior point solver from Python: what it is for, and what it says where it fails."""

from __future__ import annotations

import coulomb
import numpy as np
import pytest
from contact_problems import bodies, heap, reference

from nscd_lmp import ContactProblem, solve

pytestmark = pytest.mark.fast

TOL = 1e-11  # of the natural map, which is round-off where the last steps are Newton's
NEAR = 1e-8  # m/s, of velocities of 1 m/s


@pytest.mark.parametrize(("dim", "contacts", "freedoms"), [(2, 30, 90), (2, 30, 20), (3, 30, 120), (3, 30, 30)])
def test_velocities_are_those_of_the_reference(dim: int, contacts: int, freedoms: int) -> None:
    given = bodies(contacts, dim, freedoms, seed=5)
    sight, p = reference(given.w, given.q, 0.1, dim)
    found = solve(given.problem(0.1), "interior_point", tol=TOL, unconverged="error")
    assert found.iterations < 60
    np.testing.assert_allclose(found.velocity, sight.velocity(p), rtol=0, atol=NEAR)
    assert np.abs(coulomb.residual(sight, found.impulse)).max() <= NEAR


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("dim", [2, 3])
def test_heaps_with_and_without_friction_are_solved_to_round_off(dim: int, seed: int) -> None:
    problem = ContactProblem.from_spheres(**heap(dim, np.random.default_rng(seed)))
    assert problem.mu is not None and 0 in problem.mu
    found = solve(problem, "interior_point", tol=1e-13, unconverged="error")
    swept = solve(problem, "pdas", tol=TOL, maxiter=100_000, unconverged="error")
    np.testing.assert_allclose(found.velocity, swept.velocity, rtol=0, atol=NEAR)


def test_start_from_sweeps_saves_most_of_the_factorisations() -> None:
    problem = ContactProblem.from_spheres(**heap(3, np.random.default_rng(3)))
    swept = solve(problem, "apgs", tol=1e-5, unconverged="error")
    cold = solve(problem, "interior_point", tol=TOL, unconverged="error")
    warm = solve(problem, "interior_point", tol=TOL, warmstart=swept, unconverged="error")
    assert warm.iterations <= cold.iterations / 2
    np.testing.assert_allclose(warm.velocity, cold.velocity, rtol=0, atol=NEAR)


def test_too_few_factorisations_leave_nothing_worse_than_the_start() -> None:
    given = bodies(30, 3, 30, seed=5)
    ends = {
        k: solve(given.problem(0.1), "interior_point", tol=TOL, maxiter=k, unconverged="ignore") for k in (1, 5, 60)
    }
    start = np.linalg.norm(np.minimum(given.q[::3], 0)) / np.linalg.norm(given.q)  # the natural map of no impulses
    assert ends[60].residual < TOL < ends[5].residual <= ends[1].residual <= start * (1 + 1e-12)
    assert [ends[k].iterations for k in (1, 5)] == [1, 5] and not ends[5].converged


def test_history_has_a_row_for_each_factorisation() -> None:
    found = solve(bodies(30, 3, 30, seed=5).problem(0.1), "interior_point", tol=TOL, unconverged="error")
    np.testing.assert_array_equal(found.history["iterations"], np.arange(1, found.iterations + 1))
    assert (np.diff(found.history["relative_residual"]) <= 0).all()
    assert found.history["relative_residual"][-1] == found.residual
