# SPDX-License-Identifier: GPL-2.0-or-later
"""Oblique impacts with friction, of grains on a wall and of two grains: stick or slip, angles, spins, momenta."""

from __future__ import annotations

import numpy as np
import pytest
from grain_kinds import (
    BOTH_KINDS,
    DT,
    EVERY_KIND,
    EVERY_LAW,
    EVERY_SOLVER,
    LAWS_AND_ALL_KINDS,
    LAWS_AND_KINDS,
    RADIUS,
    SOLVED,
    SOLVERS,
    STEP_ERROR,
    TOUCH,
)
from parameters import every_two_meet
from scenes import grains, harden, per_atom, state

import nscd_lmp

E_VALUES = (0.0, 0.5, 1.0)
BOTH_E = [(0.0, 0.0), (0.0, 1.0), (0.5, 0.0), (0.5, 0.5), (1.0, 0.5), (1.0, 1.0)]
# Of the slip up to which an impact sticks.
SHARES = np.array([0.0, 0.1, 0.5, 0.9, 1 - 1e-6, 1 + 1e-6, 1.1, 2.0, 4.0])
# tol is on the mean of criterion (42), so one of 50 contacts may have all of it; its terms are velocities and, the
# masses being 1 kg and impulses 1 N s, as large as the velocities that they stand for.
IMPACT_TOL = 1e-13
IMPACT_ERROR = 50 * IMPACT_TOL


@pytest.fixture
def impacts(start):
    """Return a function that throws grains at a wall, all at once and far apart, and runs the step of the impact.

    It takes and returns speeds along the wall, speeds from the wall, and spins, arrays of length n.
    """

    def run(kind, law, along, normal, spin, **options):
        frame, n = kind.frame(), len(along)
        along, normal, spin = (np.broadcast_to(values, n) for values in (along, normal, spin))
        v = np.outer(along, frame[0]) + np.outer(normal, frame[1])
        places = np.outer(np.arange(n) * 4 * RADIUS, frame[2] if not kind.planar else frame[0])
        # where the law seeks the contact: moreau half a step on
        x = places + (RADIUS - TOUCH) * frame[1] - (0.5 * DT * v if law == "moreau" else 0)
        balls = grains(x, RADIUS, mass=1.0, v=v, omega=np.outer(spin / RADIUS, frame[2]))
        lmp = start(balls, DT, planar=kind.planar, vmax=100)
        walls = [nscd_lmp.Plane((0, 0, 0), frame[1])]
        attached = harden(lmp, law=law, inertia=kind.inertia, walls=walls, **(SOLVED | {"tol": IMPACT_TOL} | options))
        lmp.command("run 1")
        after, omega = state(lmp)[1] @ frame.T, per_atom(lmp, "omega") @ frame.T * RADIUS
        np.testing.assert_allclose(after[:, 2], 0, atol=IMPACT_ERROR)
        np.testing.assert_allclose(omega[:, :2], 0, atol=IMPACT_ERROR)
        return after[:, 0], after[:, 1], omega[:, 2], attached

    return run


@every_two_meet({"solver": SOLVERS, "law, kind": LAWS_AND_ALL_KINDS, "e": E_VALUES})
def test_impact_sticks_up_to_kappa_mu_1_plus_e_and_rebounds_at_the_angle_of_coulomb_s_law(
    impacts, solver, law, kind, e
):
    mu, speed = 0.3, 1.0
    limit = kind.kappa * mu * (1 + e) * speed  # sphere: v_t <= 3.5 mu (1 + e) v_n
    along = limit * SHARES
    v_t, v_n, spin, attached = impacts(kind, law, along, -speed, 0.0, solver=solver, friction=mu, restitution=e)
    np.testing.assert_allclose(v_n, e * speed, rtol=0, atol=IMPACT_ERROR)
    slip = v_t - spin
    np.testing.assert_allclose(slip[SHARES < 1], 0, atol=IMPACT_ERROR)
    np.testing.assert_allclose(slip[SHARES > 1], (along - limit)[SHARES > 1], rtol=0, atol=IMPACT_ERROR)
    np.testing.assert_allclose(spin[SHARES < 1], (along / kind.kappa * kind.k)[SHARES < 1], rtol=0, atol=IMPACT_ERROR)
    if e > 0:  # tan of the angle from the normal: 5/7 tan / e for spheres that stick, (tan - mu (1 + e)) / e beyond
        incidence = along / speed
        rebound = np.where(SHARES < 1, kind.k / kind.kappa * incidence, incidence - mu * (1 + e)) / e
        np.testing.assert_allclose(v_t / v_n, rebound, rtol=0, atol=10 * IMPACT_ERROR)
    # friction at its limit where it slides, and nowhere above it; rows come in any order
    rows = attached.contacts
    order = np.argsort(rows["tag_i"])
    tangential = np.linalg.norm([rows[f"impulse_t{axis}"] for axis in "xyz"], axis=0)[order]
    expected = np.minimum(1, SHARES) * mu * rows["impulse"][order]
    np.testing.assert_allclose(tangential, expected, rtol=0, atol=IMPACT_ERROR)


@every_two_meet({"solver": SOLVERS, "e, e_t": BOTH_E, "law, kind": LAWS_AND_KINDS})
def test_impact_with_spin_reverses_e_t_of_its_slip_or_slides(impacts, solver, law, kind, e, e_t):
    # slip u = v_t - s; sticks iff (1 + e_t) |u| <= kappa mu (1 + e) v_n, then leaves with -e_t u
    mu, speed, spin0 = 0.2, 1.0, np.array([0.0, 0.7, -0.7])
    limit = kind.kappa * mu * (1 + e) * speed / (1 + e_t)
    slips = limit * np.array([*SHARES, *-SHARES[1:]])
    slip, before = (values.ravel() for values in np.meshgrid(slips, spin0))
    v_t, v_n, spin, _ = impacts(
        kind, law, before + slip, -speed, before, solver=solver, friction=mu, restitution=e, e_t=e_t
    )
    sticks = np.abs(slip) < limit
    push = np.where(sticks, -(1 + e_t) * slip / kind.kappa, -mu * (1 + e) * speed * np.sign(slip))
    np.testing.assert_allclose(v_n, e * speed, rtol=0, atol=IMPACT_ERROR)
    np.testing.assert_allclose(v_t, before + slip + push, rtol=0, atol=IMPACT_ERROR)
    np.testing.assert_allclose(spin, before - kind.k * push, rtol=0, atol=IMPACT_ERROR)
    np.testing.assert_allclose((v_t - spin)[sticks], -e_t * slip[sticks], rtol=0, atol=IMPACT_ERROR)


@BOTH_KINDS
@EVERY_LAW
@EVERY_SOLVER
def test_impact_with_friction_10_is_solved_by_every_law(impacts, solver, law, kind):
    along = np.array([0.3, 3.0, 100.0])
    options = {"solver": solver, "friction": 10.0, "restitution": 0.5, "tol": 1e-11}
    v_t, v_n, spin, _ = impacts(kind, law, along, -1.0, 0.0, **options)
    push = np.minimum(along / kind.kappa, 15.0)
    # an error of SBP shrinks by 1 - 4/9 / (1 + mu^2) a visit: what is left is up to 230 times what a visit corrects,
    # and mu times that along the wall
    np.testing.assert_allclose(v_n, 0.5, rtol=0, atol=230e-11)
    np.testing.assert_allclose(v_t, along - push, rtol=0, atol=2300e-11)
    np.testing.assert_allclose(spin, kind.k * push, rtol=0, atol=6000e-11)


# Not e = 0 with e_t > 0: a contact that stays closed and may not slip stops whatever slip an impact has reversed; law
# gap does it in the same step if v_n = 0 is missed by a rounding that presses.
@every_two_meet(
    {
        "solver": SOLVERS,
        "e, e_t": [both for both in BOTH_E if both != (0.0, 1.0)],
        "law, kind": LAWS_AND_KINDS,
    }
)
def test_impact_under_stick_never_slides(impacts, solver, law, kind, e, e_t):
    slip = np.array([0.0, 1e-6, 1.0, -1.0, 10.0])
    v_t, v_n, spin, _ = impacts(
        kind, law, slip + 0.5, -0.1, 0.5, solver=solver, friction="stick", restitution=e, e_t=e_t
    )
    push = -(1 + e_t) * slip / kind.kappa
    np.testing.assert_allclose(v_n, 0.1 * e, rtol=0, atol=IMPACT_ERROR)
    np.testing.assert_allclose(v_t, slip + 0.5 + push, rtol=0, atol=IMPACT_ERROR)
    np.testing.assert_allclose(spin, 0.5 - kind.k * push, rtol=0, atol=IMPACT_ERROR)


def pair(kind, law):
    """Return two unequal grains that touch where the law seeks contacts, their normal and what they touch with."""
    if kind.planar:
        normal, v, omega = np.array([0.6, -0.8, 0]), [(-1.0, 0.5, 0), (0.5, -0.25, 0)], [(0, 0, 1.3), (0, 0, -0.4)]
    else:
        normal, v = np.array([2.0, -1.0, 2.0]) / 3, [(-1.0, 0.5, 0.25), (0.5, -0.25, 1.0)]
        omega = [(0.3, -1.0, 0.8), (0.5, 0.6, -0.7)]
    radius, mass, v = np.array([0.25, 0.5]), np.array([40.0, 500.0]), np.array(v)
    x = np.array([(0.75 - TOUCH) * normal, (0, 0, 0)]) - (0.5 * DT * v if law == "moreau" else 0)
    return grains(x, radius, mass, v, omega=omega), normal


def contact_velocity(normal, radius, v, omega):
    """Return the velocity of the contact point of grain 0 relative to that of grain 1."""
    arms = np.array([-radius[0] * normal, radius[1] * normal])
    points = v + np.cross(omega, arms)
    return points[0] - points[1]


@every_two_meet(
    {
        "solver": SOLVERS,
        "e, e_t, friction": [
            (*both, mu) for both in [(0.0, 0.0), (0.5, 0.0), (0.5, 1.0), (1.0, 0.5)] for mu in (0.05, 1.0)
        ],
        "law, kind": LAWS_AND_KINDS,
    }
)
def test_two_unequal_grains_exchange_the_impulse_of_coulomb_s_law(start, solver, law, kind, e, e_t, friction):
    balls, normal = pair(kind, law)
    options = SOLVED | {"friction": friction, "restitution": e, "e_t": e_t, "inertia": kind.inertia}
    lmp = start(balls, DT, planar=kind.planar, vmax=4.0)
    harden(lmp, law=law, solver=solver, **options)
    lmp.command("run 1")
    u = contact_velocity(normal, balls.radius, balls.v, balls.omega)
    mass = 1 / (1 / balls.mass).sum()
    press = -(1 + e) * mass * (u @ normal)
    slip = u - (u @ normal) * normal
    tangential = -(1 + e_t) * mass * slip / kind.kappa
    reach = friction * press / np.linalg.norm(tangential)
    assert (reach > 1) == (friction == 1.0)  # one slides, the other sticks
    tangential *= min(1.0, reach)
    impulse = press * normal + tangential
    v, omega = state(lmp)[1], per_atom(lmp, "omega")
    np.testing.assert_allclose(v, balls.v + np.outer([1, -1], impulse) / balls.mass[:, None], rtol=0, atol=STEP_ERROR)
    # torques about the centres: -r_i n x p and r_j n x (-p)
    inertia = balls.mass * balls.radius**2 / kind.k
    turned = balls.omega - np.outer(balls.radius / inertia, np.cross(normal, impulse))
    np.testing.assert_allclose(omega, turned, rtol=0, atol=STEP_ERROR / balls.radius.min())
    # what the contact conserves: momentum, and angular momentum about any point, to round-off of 1e3 kg m/s
    np.testing.assert_allclose(balls.mass @ (v - balls.v), 0, atol=1e-12)
    place = np.array([(0.75 - TOUCH) * normal, (0, 0, 0)]) + np.array([1.0, 2.0, 0])
    orbits = np.cross(place, balls.mass[:, None] * (v - balls.v)) + inertia[:, None] * (omega - balls.omega)
    np.testing.assert_allclose(orbits.sum(axis=0), 0, atol=1e-12)


@pytest.mark.parametrize("friction", [0.2, "stick"])
@EVERY_KIND
def test_law_moreau_keeps_the_angular_momentum_of_a_flight_with_an_impact(start, kind, friction):
    # x_{k+1} = q_m + dt/2 v_{k+1}, impulses act at q_m: what the scheme keeps has no error but the overlap there
    balls, _ = pair(kind, "moreau")
    options = SOLVED | {"friction": friction, "restitution": 0.5, "e_t": 0.3, "inertia": kind.inertia}
    lmp = start(balls, DT, planar=kind.planar, vmax=4.0)
    harden(lmp, law="moreau", **options)
    inertia = balls.mass * balls.radius**2 / kind.k

    def momentum(x, v, omega):
        return (np.cross(x, balls.mass[:, None] * v) + inertia[:, None] * omega).sum(axis=0)

    lmp.command("run 20")
    x, v = state(lmp)
    after = momentum(x, v, per_atom(lmp, "omega"))
    np.testing.assert_allclose(after, momentum(balls.x, balls.v, balls.omega), rtol=0, atol=1e-11)
