# SPDX-License-Identifier: GPL-2.0-or-later
"""`nscd_lmp.solve` on problems without LAMMPS: every solver against other methods, and what is refused."""

from __future__ import annotations

import warnings
from typing import Any

import coulomb
import numpy as np
import pytest
from contact_problems import Bodies, assembled, bodies, heap, reference
from scipy import sparse
from scipy.optimize import nnls

import nscd_lmp
from nscd_lmp import ContactProblem, NscdError, solve

pytestmark = pytest.mark.fast

SOLVERS = list(nscd_lmp.SOLVERS)
FRICTIONAL_SOLVERS = list(nscd_lmp.FRICTIONAL_SOLVERS)
TOL = 1e-11  # of the natural map; what velocities are off is that times the condition number on the active set, < 100
NEAR = 1e-8  # times the largest velocity, about 1 m/s

FRICTIONLESS = {
    "full rank": bodies(20, 1, 40, 1),
    "rank-deficient": bodies(20, 1, 10, 1),
    "every contact twice": Bodies(np.repeat(bodies(8, 1, 16, 2).g, 2, axis=0), bodies(8, 1, 16, 2).v, 1),
}
FRICTIONAL = {  # the blocks of a contact are full, and no two tangents respond alike
    "planar": bodies(6, 2, 24, 0),
    "planar, rank-deficient": bodies(6, 2, 8, 0),
    "spatial": bodies(5, 3, 30, 1),
    "spatial, rank-deficient": bodies(5, 3, 9, 1),
}


def pairs(families: dict[str, Bodies]) -> list[tuple[str, str]]:
    """Return every solver with every family it is for; the pairs that fail are in test_solver_families.py."""
    return [
        (name, family)
        for family in families
        for name, solver in nscd_lmp.SOLVERS.items()
        if solver.friction or families[family].dim == 1
    ]


def of_dimensions(*dims: int) -> list[tuple[str, int]]:
    """Return every solver with the dimensions that it takes; 1 is without friction."""
    return [(name, dim) for name, solver in nscd_lmp.SOLVERS.items() for dim in dims if solver.friction or dim == 1]


@pytest.mark.parametrize(("solver", "family"), pairs(FRICTIONLESS))
def test_velocities_are_those_of_non_negative_least_squares(solver: str, family: str) -> None:
    given = FRICTIONLESS[family]
    p, _ = nnls(given.g.T, -given.v)  # u = G (G^T p + v), and p makes |G^T p + v| smallest
    found = solve(given.problem(), solver, tol=TOL, unconverged="error")
    np.testing.assert_allclose(found.velocity, given.w @ p + given.q, rtol=0, atol=NEAR)
    np.testing.assert_allclose(found.velocity, given.w @ found.impulse + given.q, rtol=0, atol=1e-12)


@pytest.mark.parametrize(("solver", "family"), pairs(FRICTIONAL))
def test_velocities_with_friction_are_those_of_the_reference(solver: str, family: str) -> None:
    given = FRICTIONAL[family]
    sight, p = reference(given.w, given.q, 0.3, given.dim)
    found = solve(given.problem(0.3), solver, tol=TOL, unconverged="error")
    assert found.impulse.shape == found.velocity.shape == (len(given.q) // given.dim, given.dim)
    np.testing.assert_allclose(found.velocity, sight.velocity(p), rtol=0, atol=NEAR)
    assert np.abs(coulomb.residual(sight, found.impulse)).max() <= NEAR


@pytest.mark.parametrize("solver", SOLVERS)
def test_zero_rows_get_no_impulse(solver: str) -> None:
    inner = FRICTIONLESS["full rank"]
    keep = np.arange(1, 2 * 20, 2)
    w, q = np.zeros((40, 40)), np.zeros(40)  # q = 0 needs no impulse either
    w[np.ix_(keep, keep)], q[keep], q[::4] = inner.w, inner.q, 1.0
    found = solve(ContactProblem(sparse.csr_array(w), q), solver, tol=TOL, warmstart=np.ones(40), unconverged="error")
    p, _ = nnls(inner.g.T, -inner.v)
    assert not found.impulse[::2].any()
    np.testing.assert_array_equal(found.velocity[::2], q[::2])
    np.testing.assert_allclose(found.velocity[keep], inner.w @ p + inner.q, rtol=0, atol=NEAR)


@pytest.mark.parametrize(("solver", "dim"), of_dimensions(2, 3))
def test_tangents_without_friction_need_no_response(solver: str, dim: int) -> None:
    w = np.kron(np.eye(2), np.diag([2.0, 0, 0][:dim]))
    q = np.array([[-1.0, 0.5, 0.0], [1.0, 0.0, 3.0]])[:, :dim]
    found = solve(ContactProblem(w, q, 0.0, dim), solver, tol=TOL, unconverged="error")
    np.testing.assert_allclose(found.impulse, np.diag([0.5, 0, 0])[:2, :dim], rtol=0, atol=1e-10)
    np.testing.assert_allclose(found.velocity[:, 1:], q[:, 1:], rtol=0, atol=1e-14)


@pytest.mark.parametrize(("solver", "dim"), of_dimensions(2, 3))
def test_contact_of_infinite_friction_sticks(solver: str, dim: int) -> None:
    w, q = np.diag([1.0, 2.0, 2.0][:dim]), np.array([-1.0, 30.0, -40.0])[:dim]
    found = solve(ContactProblem(w, q, np.inf, dim), solver, tol=TOL, unconverged="error")
    np.testing.assert_allclose(found.impulse[0], [1.0, -15.0, 20.0][:dim], rtol=1e-9)


@pytest.mark.parametrize("solver", SOLVERS)
def test_slight_asymmetry_is_solved_as_given(solver: str) -> None:
    inner = FRICTIONLESS["full rank"]
    random = np.random.default_rng(0).normal(size=inner.w.shape)
    w = inner.w + 5e-4 * (random - random.T)
    found = solve(ContactProblem(w, inner.q), solver, tol=TOL, unconverged="error")
    np.testing.assert_allclose(found.velocity, w @ found.impulse + inner.q, rtol=0, atol=1e-12)
    assert np.abs(np.minimum(found.velocity, w.diagonal() * found.impulse)).max() <= NEAR


@pytest.mark.parametrize("dim", [1, 2, 3])
def test_sparse_delassus_is_that_of_lever_arms(dim: int) -> None:
    arrays = heap(dim, np.random.default_rng(3))
    w = ContactProblem.from_spheres(**arrays).delassus()
    assert w.format == "bsr" and w.blocksize == (dim, dim)
    np.testing.assert_allclose(w.toarray(), assembled(arrays), rtol=0, atol=1e-13)
    again = ContactProblem(w, np.zeros(w.shape[0]), 0.0, dim).delassus()
    assert again.format == "bsr"
    np.testing.assert_array_equal(again.toarray(), w.toarray())


@pytest.mark.parametrize(("solver", "dim"), of_dimensions(1, 2, 3))
def test_spheres_and_their_matrix_get_the_same_velocities(solver: str, dim: int) -> None:
    spheres = ContactProblem.from_spheres(**heap(dim, np.random.default_rng(3)))
    matrix = ContactProblem(spheres.delassus(), spheres.q, spheres.mu, dim)
    one, two = (solve(problem, solver, tol=TOL, unconverged="error") for problem in (spheres, matrix))
    np.testing.assert_allclose(one.velocity, two.velocity, rtol=0, atol=NEAR)
    moved = (spheres.delassus() @ one.impulse.ravel()).reshape(one.velocity.shape) + spheres.q
    np.testing.assert_allclose(one.velocity, moved, rtol=0, atol=1e-12)


@pytest.mark.parametrize("solver", SOLVERS)
def test_spheres_that_cannot_move_get_no_impulse(solver: str) -> None:
    normal = np.tile([0.0, 0.0, 1.0], (3, 1))
    q = [-3.0, 0.0, 2.0]
    problem = ContactProblem.from_spheres([0, 1, -1], [-1, -1, 1], [1.0, 0.0], normal, q)
    found = solve(problem, solver, tol=TOL, warmstart=[0.0, 1.0, 1.0], unconverged="error")
    np.testing.assert_allclose(found.impulse, [3.0, 0.0, 0.0], rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.velocity, [0.0, 0.0, 2.0], rtol=0, atol=1e-9)


@pytest.mark.parametrize("dim", [1, 3])
def test_contact_system_of_a_step_becomes_a_problem(dim: int) -> None:
    arrays = heap(dim, np.random.default_rng(5))
    n = len(arrays["velocity"])
    zeros = {"gap": np.zeros(n), "bias": np.zeros(n), "start": np.zeros(n)}
    system = nscd_lmp.ContactSystem(**arrays, **zeros)
    problem = system.problem()
    assert (len(problem), problem.dim) == (n, dim)
    np.testing.assert_allclose(system.delassus(), assembled(arrays), rtol=0, atol=1e-13)


@pytest.mark.parametrize(("solver", "dim"), of_dimensions(1, 2, 3))
def test_no_contacts_are_solved(solver: str, dim: int) -> None:
    mu = None if dim == 1 else 0.3
    empty = np.zeros((0, 3))
    friction = {} if dim == 1 else {"friction": 0.3, "slip": np.zeros((0, dim - 1)), "spin_response": 2.5}
    if dim > 1:
        friction["tangents"] = np.zeros((0, dim - 1, 3))
    none = np.zeros(0, dtype=int)
    for problem in (
        ContactProblem(np.zeros((0, 0)), [], mu, dim),
        ContactProblem(sparse.csc_array((0, 0)), np.zeros((0, dim)), mu, dim),
        ContactProblem.from_spheres(none, none, [1.0], empty, [], **friction),
    ):
        assert problem.delassus().shape == (0, 0)
        found = solve(problem, solver)
        assert found.converged and found.residual == 0
        assert found.impulse.shape == found.velocity.shape == ((0,) if dim == 1 else (0, dim))


@pytest.mark.parametrize("solver", SOLVERS)
def test_hundred_thousand_contacts_apart_are_solved(solver: str) -> None:
    n = 100_000
    random = np.random.default_rng(0)
    mass, q = random.uniform(0.5, 2.0, n), random.normal(size=n)
    spheres = ContactProblem.from_spheres(np.arange(n), np.full(n, -1), 1 / mass, np.tile([0.0, 0.0, 1.0], (n, 1)), q)
    for problem in (spheres, ContactProblem(spheres.delassus(), q)):
        found = solve(problem, solver, unconverged="error")
        np.testing.assert_allclose(found.impulse, np.maximum(0, -q * mass), rtol=0, atol=1e-5)


@pytest.mark.parametrize("kind", ["csr", "csc", "coo", "bsr", "lil", "dok", "dia"])
def test_sparse_formats_are_the_same_problem(kind: str) -> None:
    given = FRICTIONAL["spatial"]
    w = given.problem(0.3).delassus()
    for made in (w.asformat(kind), sparse.csr_matrix(w).asformat(kind)):
        np.testing.assert_array_equal(ContactProblem(made, given.q, 0.3, 3).delassus().toarray(), given.w)


def test_problem_keeps_copies() -> None:
    given = FRICTIONAL["planar"]
    for w in (given.w, sparse.bsr_array(given.w, blocksize=(2, 2))):
        q, mu = given.q, np.full(6, 0.3)
        problem = ContactProblem(w, q, mu, 2)
        kept = problem.delassus().toarray()
        q[:], mu[:] = 0, 0
        (w if isinstance(w, np.ndarray) else w.data)[:] = 0
        np.testing.assert_array_equal(problem.delassus().toarray(), kept)
        assert problem.q.any() and problem.mu is not None and problem.mu.all()
        assert problem.q.shape == (6, 2) and not problem.q.flags.writeable


@pytest.mark.parametrize("solver", SOLVERS)
def test_warm_start_takes_fewer_iterations(solver: str) -> None:
    given = FRICTIONLESS["full rank"]
    cold = solve(given.problem(), solver, tol=TOL)
    nearby = ContactProblem(given.w, given.q * (1 + 1e-6))
    for start in (cold, cold.impulse, cold.impulse[:, None]):
        warm, again = (solve(nearby, solver, tol=TOL, warmstart=begin).iterations for begin in (start, None))
        assert warm < again or warm == again == 1  # one factorisation may do


@pytest.mark.parametrize("criterion", ["natural", "paper"])
@pytest.mark.parametrize("solver", FRICTIONAL_SOLVERS)
def test_history_ends_below_the_tolerance(solver: str, criterion: Any) -> None:
    found = solve(FRICTIONAL["spatial"].problem(0.3), solver, tol=1e-9, criterion=criterion, unconverged="error")
    check_history(found, criterion, 1e-9)


@pytest.mark.parametrize("criterion", ["natural", "paper"])
def test_history_of_a_direct_solver_is_its_outcome(criterion: Any) -> None:
    given = FRICTIONLESS["full rank"].problem()
    found = solve(given, "active_set", tol=1e-9, criterion=criterion, unconverged="error")
    assert len(found.history) == 1
    check_history(found, criterion, 1e-9)


def check_history(found: nscd_lmp.Solution, criterion: str, tol: float) -> None:
    """Assert that the rows are in order and fall below tol with the last one."""
    rows = found.history
    column = rows["relative_residual" if criterion == "natural" else "criterion"]
    assert found.residual == column[-1] < tol <= column[:-1].min(initial=1.0)
    assert len(rows) == 1 or column[-1] < 1e-3 * column[0]
    assert (np.diff(rows["iterations"]) > 0).all() and rows["iterations"][-1] == found.iterations
    parts = rows["motion"] + rows["bipotential"] + rows["penetration"]
    np.testing.assert_allclose(rows["criterion"], parts, rtol=1e-12)
    assert 0 < found.seconds < 10


def test_unconverged_is_warned_of_raised_or_ignored_as_asked() -> None:
    problem = FRICTIONLESS["rank-deficient"].problem()
    with pytest.warns(UserWarning, match=r"auto ended after 3 iterations.*above tol = 1e-08: raise maxiter or tol"):
        found = solve(problem, maxiter=3)
    assert not found.converged and found.iterations == 3 and found.residual > 1e-8
    with pytest.raises(NscdError, match=r"paper criterion at .* m/s, above"):
        solve(problem, maxiter=3, criterion="paper", unconverged="error")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert not solve(problem, maxiter=3, unconverged="ignore").converged
