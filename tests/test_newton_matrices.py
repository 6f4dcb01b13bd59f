# SPDX-License-Identifier: GPL-2.0-or-later
"""The formulas of docs/friction.md hold: Newton matrices, closed-form visits, what repeated visits of one contact do.

Nothing compiled is used: these are tests of the derivation. That the compiled laws do the same is for tests/core/.
"""

from __future__ import annotations

from collections.abc import Callable

import coulomb_formulas as cf
import numpy as np
import pytest
from coulomb_formulas import Vector


def problem(rng: np.random.Generator, start: str = "zero") -> tuple[Vector, Vector, float, Vector]:
    """Draw v_free, W (light to heavy; spheres, discs), mu in 1e-6..10 and a start; half of the slips tiny or huge."""
    mu, spin = 10 ** rng.uniform(-6, 1), rng.choice([2.0, 2.5])
    w = 10 ** rng.uniform(-3, 3) * np.array([1, 1 + spin, 1 + spin])
    v_free = rng.normal(size=3)
    if rng.random() < 0.5:
        v_free[1:] *= 10 ** rng.uniform(-8, 2)
    p = rng.normal(size=3) * np.linalg.norm(v_free) / w[0] * 10 ** rng.uniform(-2, 2)
    return v_free, w, mu, p if start == "any" else np.zeros(3)


def state(rng: np.random.Generator) -> tuple[Vector, Vector, Vector, Vector, float, float]:
    """Draw p, v~, v_m, W, mu and rho near 1: scales at which a finite difference means something."""
    w = rng.uniform(0.5, 2) * np.array([1, 3.5, 3.5])
    p = rng.normal(size=3) + rng.choice([-1, 0, 1, 3]) * cf.EYE[0]
    return p, rng.normal(size=3), rng.normal(size=3), w, 10 ** rng.uniform(-1, 0.7), rng.uniform(0.1, 1)


def jacobian(function: Callable[[Vector], Vector], x: Vector, step: float = 1e-6) -> Vector:
    """Central differences, a column for each entry of x."""
    return np.column_stack([(function(x + d) - function(x - d)) / (2 * step) for d in step * np.eye(x.size)])


@pytest.mark.parametrize("law", ["ebp", "eal"])
def test_newton_matrices_are_the_derivatives_of_the_error(law: str) -> None:
    rng, seen = np.random.default_rng(1), {"open": 0, "stick": 0, "slip": 0}
    for _ in range(1000):
        p, v, _, _, mu, rho = state(rng)
        states = {cf.status(law, cf.augmented(law, p + d, v + d, mu, rho), mu) for d in 1e-4 * rng.normal(size=(20, 3))}
        if len(states) > 1 or np.linalg.norm(v[1:]) < 0.05:
            continue  # a kink within the reach of the difference
        seen[states.pop()] += 1
        a_c, b_c = cf.matrices(law, p, v, mu, rho)
        atol = 1e-7 * (1 + mu) ** 2  # rounding 1e-16/1e-6, curvature 1e-12, both times slopes
        np.testing.assert_allclose(jacobian(lambda x: cf.error(law, x, v, mu, rho), p), a_c, rtol=0, atol=atol)  # noqa: B023
        np.testing.assert_allclose(jacobian(lambda x: cf.error(law, p, x, mu, rho), v), b_c, rtol=0, atol=atol)  # noqa: B023
    assert min(seen.values()) > 50, seen


@pytest.mark.parametrize("law", ["ebp", "eal"])
def test_closed_form_is_the_solution_of_the_linear_system(law: str) -> None:
    rng, seen = np.random.default_rng(2), {"open": 0, "stick": 0, "slip": 0}
    for k in range(3000):
        p, v, v_m, w, mu, rho = state(rng)
        if k % 5 == 0:
            v[1:] = 0  # no carried slip: h = -t
        seen[cf.status(law, cf.augmented(law, p, v, mu, rho), mu)] += 1
        for closed, solved in zip(
            cf.visit(law, p, v, v_m, w, mu, rho), cf.newton_step(law, p, v, v_m, w, mu, rho), strict=True
        ):
            np.testing.assert_allclose(closed, solved, rtol=0, atol=1e-9)  # the solve: 1e-16 times cond, below 1e6
    assert min(seen.values()) > 50, seen


@pytest.mark.parametrize("law", ["ebp", "eal"])
def test_linear_system_is_never_singular(law: str) -> None:
    """det(A_c + B_c W) has the closed form of the documents, and it is positive."""
    rng = np.random.default_rng(3)
    for _ in range(2000):
        p, v, _, w, mu, rho = state(rng)
        tau = cf.augmented(law, p, v, mu, rho)
        a_c, b_c = cf.matrices(law, p, v, mu, rho)
        expected = {"open": 1.0, "stick": rho**3 * w.prod()}.get(cf.status(law, tau, mu))
        if expected is None:
            t, b = cf.frame(tau)
            m = 1 - b @ a_c @ b
            lift = mu**2 * w[1] * (1 + cf.slip_of(v, t) @ t) / (1 + mu**2) if law == "ebp" else 0.0
            expected = rho * (w[0] / (1 + mu**2 * (law == "ebp")) + lift) * (1 - m + m * rho * w[1])
        assert expected > 0
        np.testing.assert_allclose(np.linalg.det(a_c + b_c @ np.diag(w)), expected, rtol=1e-9)


def coulomb_step(p_t: Vector, v_t: Vector, wt: float, limit: float, gamma: float) -> Vector:
    """One Newton step on p_t - proj(p_t - gamma u_t / W_tt, B(0, limit)), its derivative by central differences."""

    def function(x: Vector) -> Vector:
        return x - cf.disc(x - gamma / wt * (v_t + wt * (x - p_t)), limit)

    return p_t - np.linalg.solve(jacobian(function, p_t), function(p_t))


def test_pdas_takes_the_newton_step_of_the_complementarity_function() -> None:
    rng, seen = np.random.default_rng(4), 0
    for _ in range(2000):
        p, _, v_m, w, mu, _ = state(rng)
        gamma = rng.uniform(0.2, 2)
        new = cf.pdas_visit(p, v_m, w, mu, gamma)
        size = np.linalg.norm(p[1:] - gamma * v_m[1:] / w[1])
        if new[0] < 0.05 or abs(size / (mu * new[0]) - 1) < 1e-3:
            continue  # open, a limit of nothing, or a kink within the reach of the difference
        seen += size > mu * new[0]
        np.testing.assert_allclose(new[0], p[0] - v_m[0] / w[0], rtol=1e-12)
        # Differences: 1e-9, times the condition of the step, at most 1/gamma, and its length.
        np.testing.assert_allclose(new[1:], coulomb_step(p[1:], v_m[1:], w[1], mu * new[0], gamma), rtol=0, atol=1e-6)
    assert seen > 200


def visits(
    one: Callable[..., tuple[Vector, Vector]], v_free: Vector, w: Vector, p: Vector, exact: Vector, most: int
) -> int | None:
    """Return the visits until W (p - exact) is below 1e-12 of v_free, or None."""
    v, unit = np.zeros(3), 1e-12 * np.linalg.norm(v_free)
    for k in range(1, most + 1):
        p, v = one(p, v, v_free + w * p)
        if np.linalg.norm(w * (p - exact)) < unit:
            return k
    return None


def outcome(law: Callable[..., tuple[Vector, Vector]], start: str, most: int = 100) -> tuple[list[float], int]:
    """Solve 1000 random problems; return mu of those that are not solved, and the most visits that the others took."""
    rng, unsolved, longest = np.random.default_rng(5), [], 0
    for _ in range(1000):
        v_free, w, mu, p = problem(rng, start)
        exact = cf.solution(v_free, w, mu)
        taken = visits(lambda p, v, v_m: law(p, v, v_m, w, mu), v_free, w, p, exact, most)  # noqa: B023
        if taken is None:
            unsolved.append(mu)
        else:
            longest = max(longest, taken)
    return unsolved, longest


@pytest.mark.parametrize("start", ["zero", "any"])
def test_pdas_solves_any_contact_in_one_visit_with_gamma_one(start: str) -> None:
    assert outcome(lambda p, v, v_m, w, mu: (cf.pdas_visit(p, v_m, w, mu, 1.0), v), start) == ([], 1)


@pytest.mark.parametrize("gamma", [0.1, 0.5, 1.5])
def test_pdas_solves_any_contact_with_other_gamma(gamma: float) -> None:
    unsolved, most = outcome(lambda p, v, v_m, w, mu: (cf.pdas_visit(p, v_m, w, mu, gamma), v), "any")
    assert not unsolved and most <= 20


# The default of both laws with friction is 1/4 of 1/W_nn.
@pytest.mark.parametrize("start", ["zero", "any"])
def test_eal_solves_any_contact_with_rho_a_quarter(start: str) -> None:
    unsolved, most = outcome(lambda p, v, v_m, w, mu: cf.visit("eal", p, v, v_m, w, mu, 0.25 / w[0]), start)
    assert not unsolved and most <= 8


@pytest.mark.parametrize("start", ["zero", "any"])
def test_ebp_with_rho_a_quarter_cycles_with_large_mu_only(start: str) -> None:
    unsolved, most = outcome(lambda p, v, v_m, w, mu: cf.visit("ebp", p, v, v_m, w, mu, 0.25 / w[0]), start)
    assert 0 < len(unsolved) < 50 and min(unsolved) > 1 and most <= 12


@pytest.mark.parametrize("law", ["ebp", "eal"])
@pytest.mark.parametrize("rho", [0.25, 1])
@pytest.mark.parametrize("start", ["zero", "any"])
def test_checked_newton_visits_solve_any_contact(law: str, rho: float, start: str) -> None:
    unsolved, most = outcome(lambda p, v, v_m, w, mu: cf.checked_visit(law, p, v, v_m, w, mu, rho / w[0]), start)
    assert not unsolved and most <= 8


@pytest.mark.parametrize("law", ["ebp", "eal"])
def test_unchecked_newton_visits_cycle_where_rho_times_w_tt_is_above_two(law: str) -> None:
    """A sphere at rest that only sticks: slip one way, then the other, for ever."""
    w, v_free, mu = np.array([1, 3.5, 3.5]), np.array([-1.0, 0.01, 0.0]), 0.3
    p, v = np.array([1.0, -0.3, 0.0]), np.array([0.0, 1.0, 0.0])  # it slipped before
    directions = []
    for _ in range(6):
        p, v = cf.visit(law, p, v, v_free + w * p, w, mu, 1.0)
        directions.append(np.sign(p[1]))
    assert directions == [-1, 1, -1, 1, -1, 1]


def test_sbp_closes_a_slip_by_one_minus_rho_w_over_one_plus_mu_squared() -> None:
    w, v_free, rho = np.array([1, 3.5, 3.5]), np.array([-1.0, 90.0, 0.0]), 4 / 9
    for mu in (0.5, 2.0, 5.0):
        p = cf.solution(v_free, w, mu)
        ray = np.array([1, -mu, 0])
        new = cf.sbp_visit(p + 1e-3 * ray, v_free + w * (p + 1e-3 * ray), mu, rho)
        np.testing.assert_allclose(new - p, (1 - rho / (1 + mu**2)) * 1e-3 * ray, rtol=0, atol=1e-12)


def test_sal_closes_the_normal_by_one_minus_rho_w_whatever_mu() -> None:
    w, v_free, rho = np.array([1, 3.5, 3.5]), np.array([-1.0, 90.0, 0.0]), 4 / 9
    for mu in (0.5, 2.0, 5.0):
        p, ray = cf.solution(v_free, w, mu), np.array([1e-3, 0, 0])
        new = cf.sal_visit(p + ray, v_free + w * (p + ray), mu, rho)
        np.testing.assert_allclose(new - p, (1 - rho) * 1e-3 * np.array([1, -mu, 0]), rtol=0, atol=1e-12)


def test_cone_without_correction_lifts_a_sliding_contact() -> None:
    """proj(p - rho v, K_mu) alone solves the convex relaxation, whose sliding contact opens with v_n = mu |v_t|."""
    w, v_free, mu = np.array([1, 3.5, 3.5]), np.array([-1.0, 3.0, 0.0]), 0.4
    p = np.zeros(3)
    for _ in range(300):
        p = cf.cone(p - 0.4 * (v_free + w * p), mu)
    v = v_free + w * p
    assert v[1] > 1 and abs(v[0] - mu * v[1]) < 1e-12
    v = v_free + w * cf.solution(v_free, w, mu)
    assert v[1] > 1 and abs(v[0]) < 1e-12


def test_smallest_rotation_of_the_warm_start_keeps_lengths_and_stays_tangential() -> None:
    rng = np.random.default_rng(6)
    for _ in range(200):
        old, new = (n / np.linalg.norm(n) for n in rng.normal(size=(2, 3)))
        tangential = np.cross(old, rng.normal(size=3))
        result = cf.turned(tangential, old, new)
        np.testing.assert_allclose(result @ new, 0, rtol=0, atol=1e-12)
        np.testing.assert_allclose(result @ result, tangential @ tangential, rtol=1e-12)
        axis = np.cross(old, new)  # what lies along the axis is left alone
        np.testing.assert_allclose(cf.turned(axis, old, new), axis, rtol=0, atol=1e-12)
