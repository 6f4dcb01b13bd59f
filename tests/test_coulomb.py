# SPDX-License-Identifier: GPL-2.0-or-later
"""The reference of the frictional tests, coulomb.py, on problems that can be solved by hand or by trying all cases."""

from __future__ import annotations

import itertools

import coulomb
import numpy as np
import pytest
from contact_matrices import DISC, SPHERE, inverse_masses, jacobian, near_pairs, tangents

METHODS = {"splitting": coulomb.split, "fixed point": coulomb.fixed_point}
EVERY_METHOD = pytest.mark.parametrize("method", METHODS.values(), ids=METHODS.keys())
EVERY_DIMENSION = pytest.mark.parametrize("dim", [2, 3])
EXACT = 1e-10  # m/s at speeds of 1 m/s: ACCURACY of the natural map, times 10 for what a few contacts pass on


@EVERY_METHOD
@EVERY_DIMENSION
def test_one_contact_opens_sticks_or_slips_as_the_closed_form_says(method, dim):
    random = np.random.default_rng(1)
    met = set()
    for _ in range(50):
        wn, mu = 10 ** random.uniform(-3, 3), random.choice([0.0, 1e-3, 0.3, 2.0])
        diagonal = wn * np.array([1, *[3.5] * (dim - 1)])
        q = random.normal(size=dim) * [1, *[random.choice([0.1, 1, 10])] * (dim - 1)]
        given = coulomb.problem(np.diag(diagonal), q, mu, dim)
        push = max(0.0, -q[0]) / wn
        grip = -q[1:] / diagonal[1:]
        size = np.linalg.norm(grip)
        met.add("open" if push == 0 else "stick" if size <= mu * push else "slip")
        expected = np.array([push, *(grip * min(1.0, mu * push / size))])
        p = coulomb.solve(given, method)
        np.testing.assert_allclose(diagonal * p[0], diagonal * expected, rtol=0, atol=EXACT)
    assert met == {"open", "stick", "slip"}


@EVERY_DIMENSION
def test_one_contact_that_must_stick_does_so_where_friction_of_4_would_slip(dim):
    given = coulomb.problem(np.eye(dim) / 3, [-1.0, *[5.0] * (dim - 1)], np.inf, dim)
    assert np.abs(given.velocity(coulomb.solve(given))).max() <= EXACT


def block(slope, mu, half_length=1.0, height=0.5):
    """Return the problem of a planar block of 2 kg on two feet of a slope, after a kick of 1 m/s by gravity.

    Its centre is at the height over the feet, its moment of inertia 1.5 kg m^2.
    """
    # feet at (-+a, -h): velocities v_y +- a omega and v_x + h omega; tangent (-n_y, n_x) is -x
    g = np.array([[0, 1, -half_length], [-1, 0, -height], [0, 1, half_length], [-1, 0, -height]])
    kick = np.array([np.sin(slope), -np.cos(slope), 0])
    return coulomb.problem(g @ np.diag([1 / 2, 1 / 2, 1 / 1.5]) @ g.T, g @ kick, mu, 2), kick, g


def moved(given, kick, g, p):
    """Return (v_x, v_y, omega) of the block."""
    return kick + np.diag([1 / 2, 1 / 2, 1 / 1.5]) @ g.T @ p.ravel()


@EVERY_METHOD
@pytest.mark.parametrize("mu", [0.0, 0.2, 0.5, 0.6, np.inf])
def test_block_on_two_feet_slides_iff_the_slope_is_above_the_friction(method, mu):
    slope = np.arctan(0.5001)
    given, kick, g = block(slope, mu)
    p = coulomb.solve(given, method)
    speed = max(0.0, np.sin(slope) - mu * np.cos(slope)) if np.isfinite(mu) else 0.0
    np.testing.assert_allclose(moved(given, kick, g, p), [speed, 0, 0], rtol=0, atol=EXACT)
    # statics: the feet share the weight as friction's lever arm over them says
    share = min(mu, np.tan(slope)) * 0.5 / 1.0
    np.testing.assert_allclose(p[:, 0], np.cos(slope) * np.array([1 - share, 1 + share]), rtol=0, atol=10 * EXACT)
    assert np.linalg.matrix_rank(given.w) == 3  # of 4: how the feet share the friction is open


@EVERY_METHOD
@pytest.mark.parametrize("mu", [2.5, np.inf])
def test_block_on_a_steep_slope_tips_over_its_lower_foot(method, mu):
    slope = np.arctan(2.4)  # above a / h = 2, below mu: it turns about the foot at (a, -h) without slip
    given, kick, g = block(slope, mu)
    p = coulomb.solve(given, method)
    # angular momentum about the foot: I + m (a^2 + h^2) = 4 kg m^2, moment of the kick 2 (-a v_y ... ) = 2 (h s - a c)
    turn = -2 * (0.5 * np.sin(slope) - np.cos(slope)) / 4.0
    np.testing.assert_allclose(moved(given, kick, g, p), [-0.5 * turn, -turn, turn], rtol=0, atol=EXACT)
    assert np.abs(p[0]).max() == 0


@EVERY_DIMENSION
def test_convex_relaxation_lifts_what_slides_and_exact_friction_does_not(dim):
    mu, q = 0.5, np.array([-1.0, 8.0, 0.0][:dim])
    diagonal = np.array([1, *[3.5] * (dim - 1)])
    given = coulomb.problem(np.diag(diagonal), q, mu, dim)
    lifted = given.velocity(coulomb.relaxed(given, np.zeros(1)))[0]
    # u in the dual cone, orthogonal to p at its edge: u_n = mu |u_t|. The interior point method ends at 1e-6 or nearer
    assert lifted[0] == pytest.approx(mu * np.linalg.norm(lifted[1:]), abs=1e-5)
    assert lifted[0] > 1
    exact = given.velocity(coulomb.solve(given))[0]
    np.testing.assert_allclose(exact[:2], [0, 8 - 3.5 * mu], rtol=0, atol=EXACT)


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_grain_between_two_walls_may_fall_or_hang_or_anything_between(share):
    # Coulomb's law does not say which: any pressure between the walls, and the friction that goes with it. So where
    # impulses can hold each other within the friction cones, velocities need not be unique, whatever mu > 0
    mu, mass = 0.2, 3.0
    normal = np.array([(1.0, 0, 0), (-1.0, 0, 0)])
    g = jacobian([0, 0], [-1, -1], normal, tangents(normal, 2), [0.5])
    given = coulomb.problem(g * inverse_masses([mass], [0.5], DISC) @ g.T, g @ [0, -1.0, 0, 0, 0, 0], mu, 2)
    p = share * mass / 2 * np.array([(1 / mu, 1), (1 / mu, -1)])
    assert coulomb.error(given, p) <= 1e-15
    np.testing.assert_allclose(given.velocity(p)[:, 1], (1 - share) * np.array([-1, 1]), rtol=0, atol=1e-15)
    # the reference finds one of them
    assert 0 <= given.velocity(coulomb.solve(given))[1, 1] <= 1


@pytest.mark.parametrize("wrong", ["tension", "beyond the cone", "slip within the cone", "lift", "along the slip"])
def test_residual_shows_every_way_of_being_wrong(wrong):
    w = np.diag([1.0, 3.5, 3.5])
    p, u = {
        "tension": ([-0.1, 0, 0], [0, 0, 0]),
        "beyond the cone": ([1, 0.6, 0], [0, -1, 0]),
        "slip within the cone": ([1, 0.4, 0], [0, -1, 0]),
        "lift": ([1, 0.5, 0], [0.2, -1, 0]),
        "along the slip": ([1, 0.5, 0], [0, 1, 0]),
    }[wrong]
    given = coulomb.problem(w, np.array(u) - w @ p, 0.5, 3)
    assert coulomb.error(given, np.array([p], dtype=float)) >= 0.1


def lattice(dim, shape, seed):
    """Return G, M^-1 and velocities of grains about the places of a lattice, in contact with its next ones.

    The lowest layer does not move.
    """
    random = np.random.default_rng(seed)
    x = np.stack(np.meshgrid(*[np.arange(float(n)) for n in (*shape, 1)[:3]], indexing="ij"), axis=-1).reshape(-1, 3)
    fixed = x[:, dim - 1] == 0
    i, j, _ = near_pairs(x, np.full(len(x), 0.5), 0.1)
    x[:, :dim] += random.uniform(-0.1, 0.1, (len(x), dim))
    i, j = i[~(fixed[i] & fixed[j])], j[~(fixed[i] & fixed[j])]
    apart = x[i] - x[j]
    normal = apart / np.linalg.norm(apart, axis=1)[:, None]
    radius = random.uniform(0.4, 0.5, len(x))
    inverse = inverse_masses(10 ** random.uniform(-1, 1, len(x)), radius, DISC if dim == 2 else SPHERE)
    v = random.normal(size=(len(x), 6))
    if dim == 2:
        v[:, [2, 3, 4]] = 0
    inverse.reshape(-1, 6)[fixed] = v[fixed] = 0
    return jacobian(i, j, normal, tangents(normal, dim), radius), inverse, v.ravel(), random


def every_solution(given):
    """Return the velocities of all solutions of a planar problem, by trying all cases: open, stick, slip either way."""
    found: list[np.ndarray] = []
    n = len(given.q)
    for case in itertools.product(("open", "stick", 1.0, -1.0), repeat=n):
        a, b = np.eye(2 * n), np.zeros(2 * n)
        for k, what in enumerate(case):
            if what == "open":
                continue
            a[2 * k], b[2 * k] = given.w[2 * k], -given.q[k, 0]
            if what == "stick":
                a[2 * k + 1], b[2 * k + 1] = given.w[2 * k + 1], -given.q[k, 1]
            else:
                a[2 * k + 1, 2 * k] = what * given.mu[k]
        p = np.asarray(np.linalg.lstsq(a, b, rcond=1e-12)[0], dtype=float).reshape(n, 2)
        u = given.velocity(p)
        if coulomb.error(given, p) <= 1e-9 and not any(np.abs(u - other).max() < 1e-6 for other in found):
            found.append(u)
    return found


def test_planar_clusters_have_the_solutions_that_trying_all_cases_finds():
    counts = []
    for seed in range(40):
        g, inverse, v, random = lattice(2, (2, 3), seed)
        g = g[random.permutation(6)[:4][:, None] * 2 + [0, 1]].reshape(8, -1)  # four contacts: 256 cases
        given = coulomb.problem(g * inverse @ g.T, g @ v, random.choice([0.1, 0.3, 0.8], len(g) // 2), 2)
        solutions = every_solution(given)
        u = given.velocity(coulomb.solve(given))
        assert min(np.abs(u - other).max() for other in solutions) <= EXACT
        counts.append(len(solutions))
    assert counts.count(1) >= 0.9 * len(counts)  # several exist now and then, none never


def test_contacts_that_stick_at_any_cost_may_have_no_solution_or_several():
    counts = np.zeros(5, dtype=int)
    for seed in range(200):
        g, inverse, v, random = lattice(2, (2, 3), seed)
        g = g[random.permutation(6)[:4][:, None] * 2 + [0, 1]].reshape(8, -1)
        given = coulomb.problem(g * inverse @ g.T, g @ v, np.inf, 2)
        found = 0
        for shut in itertools.product((False, True), repeat=4):
            rows = np.repeat(shut, 2)
            p = np.zeros(8)
            p[rows] = np.linalg.lstsq(given.w[np.ix_(rows, rows)], -given.q.ravel()[rows], rcond=1e-12)[0]
            found += coulomb.error(given, p.reshape(4, 2)) <= 1e-9
        counts[min(found, 4)] += 1
    assert counts[1] >= 0.8 * counts.sum()
    assert min(counts[0], counts[2]) >= 3  # of 200


@EVERY_DIMENSION
@pytest.mark.parametrize("seed", range(2))
def test_two_methods_find_the_same_velocities_in_hyperstatic_packings(dim, seed):
    g, inverse, v, random = lattice(dim, (5, 4) if dim == 2 else (3, 3, 3), seed)
    w = g * inverse @ g.T
    given = coulomb.problem(w, g @ v, random.choice([0.0, 0.1, 0.3], len(g) // dim), dim)
    assert np.linalg.matrix_rank(w, tol=1e-9 * np.linalg.norm(w, 2)) < len(w)
    one, other = (coulomb.solve(given, method) for method in METHODS.values())
    assert max(coulomb.error(given, one), coulomb.error(given, other)) <= 1e-11
    difference = given.velocity(one) - given.velocity(other)
    np.testing.assert_allclose(difference, 0, atol=EXACT)
    u, p = given.velocity(one), one
    slips = (p[:, 0] > 1e-9) & (coulomb.norms(u[:, 1:]) > 1e-9)
    assert min((p[:, 0] == 0).sum(), slips.sum(), ((p[:, 0] > 1e-9) & ~slips).sum()) >= 1  # all three kinds


@EVERY_DIMENSION
def test_two_grains_that_turn_like_one_body_have_no_relative_velocity(dim):
    random = np.random.default_rng(2)
    radius = np.array([0.3, 0.7])
    normal = random.normal(size=3) * [1, 1, dim == 3]
    normal /= np.linalg.norm(normal)
    x = np.array([normal * radius.sum(), (0, 0, 0)])
    omega = random.normal(size=3) * [dim == 3, dim == 3, 1]
    v = np.column_stack([random.normal(size=3) + np.cross(omega, x), [omega, omega]]) - 0.0
    g = jacobian([0], [1], [normal], tangents([normal], dim), radius)
    v[:, :3] -= v[0, :3] - np.cross(omega, x[0])
    np.testing.assert_allclose(g @ v.ravel(), 0, atol=1e-14)  # round-off of speeds of 1 m/s


@pytest.mark.parametrize(("dim", "kappa", "expected"), [(3, SPHERE, 3.5), (2, DISC, 3.0), (2, SPHERE, 3.5)])
def test_block_of_one_contact_is_diagonal(dim, kappa, expected):
    normal = np.array([[0.6, 0.8, 0]])
    g = jacobian([0], [1], normal, tangents(normal, dim), [0.2, 0.4])
    w = g * inverse_masses([2.0, 5.0], [0.2, 0.4], kappa) @ g.T
    np.testing.assert_allclose(w, 0.7 * np.diag([1, *[expected] * (dim - 1)]), rtol=0, atol=1e-15)
