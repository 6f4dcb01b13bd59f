# SPDX-License-Identifier: GPL-2.0-or-later
"""Every solver on every family of problems, against references that share no method with it; what fails must say so.

Velocities are compared, not impulses, which are not unique where W is rank-deficient.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import coulomb
import numpy as np
import pytest
from contact_problems import Answer, Array, Pile, assembled, column, heap, lattice, nearest, random_bed

import nscd_lmp
from nscd_lmp import ContactProblem, solve

LOCAL_LAWS = list(nscd_lmp.LOCAL_LAWS)
FRICTIONAL_SOLVERS = list(nscd_lmp.FRICTIONAL_SOLVERS)
DOORS = ("spheres", "matrix")
TOL, BUDGET = 1e-10, 10000  # of the natural map; iterations
TOL_WITH_FRICTION, BUDGET_WITH_FRICTION = 1e-11, 30000
NINE = np.ones(9)
FRICTIONLESS = {
    "bed, shaken": random_bed(40, 1, shaken=True),
    "bed, falling": random_bed(40, 2, shaken=False),
    "column of 3": column(np.ones(3)),
    "column of 30": column(np.ones(30)),
    "heavy on light, 1e2": column(np.append(NINE, 1e2)),
    "heavy on light, 1e6": column(np.append(NINE, 1e6)),
    "light on heavy, 1e2": column(np.append(1e2, NINE)),
    "light on heavy, 1e6": column(np.append(1e6, NINE)),
    "masses in turn, 1e2": column(np.tile([1, 1e2], 10)),
    "masses in turn, 1e6": column(np.tile([1, 1e6], 10)),
    "hyperstatic lattice": lattice(3, 5),
    "every contact twice": random_bed(30, 3, shaken=True).doubled(),
    "rows of zeros": random_bed(30, 4, shaken=True).with_rows_of_zeros(),
}
LONG = "a sweep hands a push on by one contact: 0.93 N^2 sweeps a decade, and more with rho < 1"
HEAVY = "sweeps grow with the mass ratio, as a visit takes a light ball's share off a heavy one's fall: 2e4 and more"
ROOT = "momentum needs the square root of the sweeps of NLGS, which are above 3e6: 2e4 to 9e4"
LINKED = "contacts that stick lock each other: the smallest eigenvalue of W is 4e-6 of the largest, 1e6 sweeps"
FAILING = {
    **{(name, "column of 30"): LONG for name in ("sbp", "sal")},
    **{(name, "heavy on light, 1e2"): HEAVY for name in LOCAL_LAWS},
    **{(name, "heavy on light, 1e6"): HEAVY for name in LOCAL_LAWS},
    **{(name, "masses in turn, 1e2"): HEAVY for name in LOCAL_LAWS},
    **{(name, "masses in turn, 1e6"): HEAVY for name in LOCAL_LAWS},
    ("apgs", "heavy on light, 1e6"): ROOT,
    ("apgs", "masses in turn, 1e6"): ROOT,
    **{(name, "planar, stick, locked"): LINKED for name in LOCAL_LAWS},
}


@dataclass(frozen=True)
class Frictional:
    """A heap with friction, as solvers and as the reference see it, and the velocities (n, dim) wanted."""

    doors: dict[str, ContactProblem]
    sight: coulomb.Problem
    velocity: Array


@cache
def rubbing(dim: int, mu: float, seed: int) -> Frictional:
    """Return a heap with the reference's velocities."""
    arrays = heap(dim, np.random.default_rng(seed)) | {"friction": mu}
    return posed(arrays, dim, None)


@cache
def sticking(dim: int, mu: float, seed: int) -> Frictional:
    """Return a heap that comes to rest: impulses well inside their cones are what makes q."""
    random = np.random.default_rng(seed)
    arrays = heap(dim, random)
    n = len(arrays["velocity"])
    p = np.column_stack([random.uniform(0.5, 1.0, n), random.uniform(-0.2, 0.2, (n, dim - 1))])
    q = -(assembled(arrays) @ p.ravel()).reshape(n, dim)
    return posed(arrays | {"friction": mu, "velocity": q[:, 0], "slip": q[:, 1:]}, dim, np.zeros((n, dim)))


def posed(arrays: dict[str, Any], dim: int, velocity: Array | None) -> Frictional:
    """Return the heap of these arrays; without velocities, the reference looks for them."""
    spheres, w = ContactProblem.from_spheres(**arrays), assembled(arrays)
    sight = coulomb.problem(w, spheres.q, arrays["friction"], dim)
    if velocity is None:
        velocity = sight.velocity(coulomb.solve(sight))
    return Frictional({"spheres": spheres, "matrix": ContactProblem(w, spheres.q, spheres.mu, dim)}, sight, velocity)


FRICTIONAL = {
    **{f"planar, {mu}": (rubbing, 2, mu, 1) for mu in (0.1, 0.3, 0.8)},
    **{f"spatial, {mu}": (rubbing, 3, mu, 3) for mu in (0.1, 0.3, 0.8)},
    "planar, stick": (sticking, 2, np.inf, 1),
    "spatial, stick": (sticking, 3, np.inf, 4),
    "spatial, 0.8, at rest": (sticking, 3, 0.8, 3),
    "planar, stick, locked": (sticking, 2, np.inf, 3),
}


def frictional(family: str) -> Frictional:
    """Return the problem of a name; made once."""
    make, *arguments = FRICTIONAL[family]
    return make(*arguments)


def pairs(solvers: Any, families: Any) -> list[tuple[str, str]]:
    """Return every solver with every family but those that are known to fail: test_solvers_that_fail_say_so."""
    return [(name, family) for name in solvers for family in families if (name, family) not in FAILING]


@cache
def frictionless(family: str) -> tuple[dict[str, ContactProblem], Answer]:
    """Return the problem of a name in two ways, and its solution."""
    given = FRICTIONLESS[family]
    return given.doors(), nearest(given.bodies())


def tolerance(answer: Answer) -> float:
    """Return `tol` of a frictionless problem.

    Where masses differ by 1e6, impulses of 1e4 N s and more cancel on balls of 1 kg: round-off is all that W p + q
    holds below 1e-9 of q.
    """
    return max(TOL, 10 * answer.round_off)


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize(("solver", "family"), pairs(nscd_lmp.SOLVERS, FRICTIONLESS))
def test_velocities_are_those_of_non_negative_least_squares(solver: str, family: str, door: str) -> None:
    doors, answer = frictionless(family)
    tol = tolerance(answer)
    found = solve(doors[door], solver, tol=tol, maxiter=BUDGET, unconverged="error")
    # the natural map bounds the velocities of the contacts that push, and they move the others
    near = tol * float(np.linalg.norm(doors[door].q)) * (1 + answer.growth)
    np.testing.assert_allclose(found.velocity, answer.u, rtol=0, atol=near)
    assert (found.impulse * doors["matrix"].delassus().diagonal()).min() >= -near


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize(("solver", "family"), pairs(FRICTIONAL_SOLVERS, FRICTIONAL))
def test_velocities_with_friction_are_those_of_the_reference(solver: str, family: str, door: str) -> None:
    given = frictional(family)
    options: dict[str, Any] = {"tol": TOL_WITH_FRICTION, "maxiter": BUDGET_WITH_FRICTION}
    found = solve(given.doors[door], solver, unconverged="error", **options)
    # tol |q| is 1e-10 m/s; where slip turns, velocities are off by up to 200 times that
    np.testing.assert_allclose(found.velocity, given.velocity, rtol=0, atol=2e-8)
    assert np.abs(coulomb.residual(given.sight, found.impulse)).max() <= 1e-9


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize(("solver", "family"), FAILING)
def test_solvers_that_fail_say_so(solver: str, family: str, door: str) -> None:
    if family in FRICTIONAL:
        doors, tol, maxiter = frictional(family).doors, TOL_WITH_FRICTION, BUDGET_WITH_FRICTION
    else:
        doors, answer = frictionless(family)
        tol, maxiter = tolerance(answer), BUDGET
    with pytest.warns(UserWarning, match=f"solver {solver} ended after {maxiter} iterations"):
        found = solve(doors[door], solver, tol=tol, maxiter=maxiter)
    assert not found.converged and found.iterations == maxiter and found.residual > tol, FAILING[solver, family]
    assert np.isfinite(found.impulse).all() and np.isfinite(found.velocity).all()


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("solver", nscd_lmp.SOLVERS)
def test_problems_without_a_solution_are_never_called_solved(solver: str, door: str) -> None:
    # a ball between a floor and a lid that come closer
    given = Pile(np.zeros(2, int), np.full(2, -1), np.array([[0, 0, 1.0], [0, 0, -1.0]]), np.ones(1), np.zeros((1, 3)))
    q = [-1.0, -2.0]
    matrix = ContactProblem(given.bodies().w, q)
    spheres = ContactProblem.from_spheres(given.body_i, given.body_j, given.inverse_mass, given.normal, q)
    found = solve({"spheres": spheres, "matrix": matrix}[door], solver, maxiter=500, unconverged="ignore")
    assert not found.converged and found.residual > 0.1
    assert np.isfinite(found.impulse).all()


@pytest.mark.parametrize("family", [name for name in FRICTIONLESS if np.ptp(FRICTIONLESS[name].normal) == 1])
def test_the_reference_has_the_impulses_of_columns_in_closed_form(family: str) -> None:
    given, (_, answer) = FRICTIONLESS[family], frictionless(family)
    above = np.cumsum(1 / given.inverse_mass[::-1])[::-1]  # the lowest contact stops all masses
    np.testing.assert_allclose(answer.p, 1e-2 * above, rtol=1e-9)
    np.testing.assert_allclose(answer.u, 0, atol=1e-2 * max(1e-12, 10 * answer.round_off))


def test_families_are_what_their_names_say() -> None:
    singular = {"bed, falling": 0.95, "hyperstatic lattice": 81 / 90, "every contact twice": 0.5, "rows of zeros": 0.96}
    for name, share in singular.items():
        g = FRICTIONLESS[name].bodies().g
        assert np.linalg.matrix_rank(g, tol=1e-10) <= share * len(g)
    assert set(FRICTIONLESS) | set(FRICTIONAL) >= {family for _, family in FAILING}


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("solver", nscd_lmp.SOLVERS)
def test_the_same_call_gives_the_same_bits(solver: str, door: str) -> None:
    problems = [frictionless(name)[0][door] for name in ("bed, falling", "every contact twice", "column of 30")]
    if nscd_lmp.SOLVERS[solver].friction:
        problems += [frictional(name).doors[door] for name in ("planar, 0.3", "spatial, 0.3")]
    for problem in problems:
        one, two = (solve(problem, solver, maxiter=300, unconverged="ignore") for _ in range(2))
        assert one.iterations == two.iterations
        assert one.impulse.tobytes() == two.impulse.tobytes()
        assert one.velocity.tobytes() == two.velocity.tobytes()


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("masses", ["in turn", "at random", "heavy on light"])
def test_auto_ends_where_apgs_alone_does_not(masses: str, door: str) -> None:
    kinds = {
        "in turn": np.tile([1.0, 1e6], 150),
        "at random": 10 ** np.random.default_rng(1).uniform(0, 6, 300),
        "heavy on light": np.append(np.ones(299), 1e6),
    }
    mass = kinds[masses]
    given = column(mass)
    carried = np.cumsum(mass[::-1])[::-1]  # p / 1e-2 m/s: it cancels in W p + q, and |q| = 1e-2 m/s
    round_off = np.finfo(float).eps * float(np.linalg.norm(np.abs(given.bodies().w) @ carried))
    options: dict[str, Any] = {"tol": max(1e-8, 10 * round_off), "maxiter": 2000, "unconverged": "ignore"}
    alone, relay = (solve(given.doors()[door], solver, **options) for solver in ("apgs", "auto"))
    assert not alone.converged and alone.iterations == 2000
    assert relay.converged and relay.iterations < 200
    assert np.abs(relay.velocity).max() <= options["tol"] * 1e-2


def true_residual(problem: Any, solution: Any) -> float:
    """Return the relative natural map of the impulses alone, W p + q formed anew."""
    u = problem.delassus() @ solution.impulse + problem.q
    w = problem.delassus().diagonal()
    return float(np.linalg.norm(np.minimum(u, w * solution.impulse)) / np.linalg.norm(problem.q))


@pytest.mark.parametrize("solver", ["apgs", "auto", "active_set"])
def test_claims_hold_for_the_impulses_alone(solver):
    # thousands of sweeps, in which momentum makes round-off between bodies and impulses grow
    problem = nscd_lmp.ContactProblem.from_spheres(
        body_i=np.arange(1000),
        body_j=np.arange(1000) - 1,
        inverse_mass=np.ones(1000),
        normal=np.tile([0.0, 0.0, 1.0], (1000, 1)),
        velocity=np.concatenate([[-5e-3], np.zeros(999)]),
    )
    found = nscd_lmp.solve(problem, solver, tol=1e-8)
    assert found.converged
    assert true_residual(problem, found) < 1e-8


@pytest.mark.parametrize("solver", nscd_lmp.SOLVERS)
def test_impulses_too_large_for_their_digits_are_not_called_a_solution(solver):
    # two grains pushed together from both sides: no solution, and at 1e16 N s a change of 1 m/s is round-off
    squeezed = nscd_lmp.ContactProblem([[1.0, -1.0], [-1.0, 1.0]], [-1.0, -1.0])
    found = nscd_lmp.solve(squeezed, solver, warmstart=[1e16, 1e16], maxiter=200, unconverged="ignore")
    assert not found.converged


def test_auto_ends_where_the_active_set_has_reached_round_off():
    masses = np.where(np.arange(300) % 2, 1.0, 1e6)
    problem = nscd_lmp.ContactProblem.from_spheres(
        body_i=np.arange(300),
        body_j=np.arange(300) - 1,
        inverse_mass=1 / masses,
        normal=np.tile([0.0, 0.0, 1.0], (300, 1)),
        velocity=np.concatenate([[-5e-3], np.zeros(299)]),
    )
    best = nscd_lmp.solve(problem, "active_set", tol=1e-12, unconverged="ignore")
    found = nscd_lmp.solve(problem, "auto", tol=1e-12, unconverged="ignore")
    assert not found.converged
    assert found.iterations < 200
    assert true_residual(problem, found) <= 10 * true_residual(problem, best)


def test_frames_in_single_precision_are_made_orthonormal():
    rng = np.random.default_rng(0)
    normal = rng.normal(size=(40, 3))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    first = np.cross(normal, rng.normal(size=(40, 3)))
    first /= np.linalg.norm(first, axis=1)[:, None]
    frames = [part.astype(np.float32) for part in (normal, np.stack([first, np.cross(normal, first)], axis=1))]
    i = rng.integers(0, 20, 40)
    problem = nscd_lmp.ContactProblem.from_spheres(
        i, np.where(rng.random(40) < 0.2, -1, (i + 1) % 20), np.ones(20), frames[0], rng.uniform(-1, 1, 40),
        friction=0.3, tangents=frames[1], slip=rng.uniform(-1, 1, (40, 2)), spin_response=2.5,
    )  # fmt: skip
    found = nscd_lmp.solve(problem, "pdas", tol=1e-10, maxiter=100000)
    w = problem.delassus()
    formed = (w @ found.impulse.ravel()).reshape(-1, 3) + problem.q
    np.testing.assert_allclose(
        found.velocity, formed, rtol=0, atol=1e-12 * (1 + abs(w).sum(axis=1).max() * abs(found.impulse).max())
    )
