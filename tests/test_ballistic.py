# SPDX-License-Identifier: GPL-2.0-or-later
"""Trajectories between impacts: exactness, order in dt, and the sum of bounces that Zeno's ball makes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scenes import FLOOR, GRAVITY, grains, harden, trajectory

import nscd_lmp

LAWS = list(nscd_lmp.LAWS)
RADIUS = 0.5  # m


def parabola(x0, v0, t):
    """Return the positions (len(t), 3) of free flight."""
    return x0 + np.outer(t, v0) - 0.5 * GRAVITY * np.outer(t**2, (0, 0, 1))


@pytest.mark.parametrize("dt", [1e-2, 1e-3])
@pytest.mark.parametrize("law", LAWS)
def test_free_flight_is_exact_to_round_off(start, law, dt):
    x0, v0, steps = np.array([0.1, -0.2, 0.7]), np.array([3.0, 1.0, 4.0]), round(0.5 / dt)
    lmp = start(grains(x0, RADIUS, v=v0), dt, gravity=GRAVITY, vmax=8.0, box=[(-4, 4)] * 3)
    harden(lmp, law=law, walls=[FLOOR])
    x, _ = trajectory(lmp, steps)
    # a few roundings of 2e-16 a step on coordinates near 1 m, for 500 steps
    exact = parabola(x0, v0, dt * np.arange(1, steps + 1))
    np.testing.assert_allclose(x[:, 0], exact, rtol=0, atol=steps * 1e-15)


@pytest.mark.parametrize("e", [0.0, 1.0])
@pytest.mark.parametrize("law", LAWS)
def test_near_misses_do_not_bend_a_flight(start, law, e):
    # One ball turns 1e-4 m under a ceiling, another passes one at rest with a clearance of 1e-4 m; a step
    # moves them by 2e-3 m, so law gap looks at both as contacts. (Its linearised gap would touch below (v
    # dt)^2 / 4r = 2e-6 m.)
    dt, steps, clearance = 1e-3, 200, 1e-4
    ceiling = nscd_lmp.Plane((0, 0, 1.0 + RADIUS + clearance), (0, 0, -1))
    x0 = np.array([[0, 0, 1.0 - GRAVITY * 0.1**2 / 2], [-0.2, 3, -5], [0, 3, -5 + 2 * RADIUS + clearance]])
    v0 = np.array([[2.0, 0, GRAVITY * 0.1], [2.0, 0, 0], [0, 0, 0]])
    lmp = start(grains(x0, RADIUS, v=v0), dt, gravity=GRAVITY, vmax=4.0)
    harden(lmp, law=law, restitution=e, walls=[ceiling])
    x, _ = trajectory(lmp, steps)
    for ball in range(3):
        exact = parabola(x0[ball], v0[ball], dt * np.arange(1, steps + 1))
        np.testing.assert_allclose(x[:, ball], exact, rtol=0, atol=steps * 2e-15)  # coordinates up to 5 m


@pytest.mark.parametrize("theta", [0.0, 0.25, 0.5, 0.75, 1.0])
def test_theta_of_law_moreau_shifts_the_parabola_by_its_first_order_term(start, theta):
    # x_k = parabola - (theta - 1/2) g dt t, by summing (13); so the order is 1 but for theta = 1/2
    x0, v0, dt, steps = np.array([0.0, 0.0, 5.0]), np.array([0.0, 0.0, 1.0]), 1e-3, 500
    lmp = start(grains(x0, RADIUS, v=v0), dt, gravity=GRAVITY, vmax=8.0)
    harden(lmp, law="moreau", theta=theta, walls=[FLOOR])
    x, _ = trajectory(lmp, steps)
    t = dt * np.arange(1, steps + 1)
    expected = parabola(x0, v0, t)[:, 2] - (theta - 0.5) * GRAVITY * dt * t
    np.testing.assert_allclose(x[:, 0, 2], expected, rtol=0, atol=steps * 4e-15)  # coordinates near 5 m


@pytest.mark.parametrize("e", [0.5, 1.0])
@pytest.mark.parametrize("law", LAWS)
def test_trajectory_through_an_impact_is_first_order(start, law, e):
    drop = 0.2
    speed, fall = math.sqrt(2 * GRAVITY * drop), math.sqrt(2 * drop / GRAVITY)
    since = 0.5 * e * speed / GRAVITY
    exact = RADIUS + e * speed * since - 0.5 * GRAVITY * since**2
    errors = []
    for dt in (8e-4, 4e-4, 2e-4, 1e-4):
        steps = math.ceil((fall + since) / dt)
        step = (fall + since) / steps
        lmp = start(grains((0, 0, RADIUS + drop), RADIUS), step, gravity=GRAVITY, vmax=4.0)
        harden(lmp, law=law, restitution=e, walls=[FLOOR])
        x, _ = trajectory(lmp, steps)
        errors.append(abs(x[-1, 0, 2] - exact) / step)
    # the impact comes up to a step early or late, where the speed jumps by (1 + e) v, and errs by e g dt in
    # speed
    assert max(errors) <= (1 + e) * speed + 2 * e * GRAVITY * since


def bounces(start, law, e, dt, drop=0.05):
    """Return (times, v_z) of a ball dropped from `drop` for 1.3 times the time that Zeno's sum gives it."""
    speed = math.sqrt(2 * GRAVITY * drop)
    stop = speed / GRAVITY * (1 + e) / (1 - e)
    lmp = start(grains((0, 0, RADIUS + drop), RADIUS), dt, gravity=GRAVITY, vmax=2.0)
    harden(lmp, law=law, restitution=e, tol=1e-12, walls=[FLOOR])
    x, v = trajectory(lmp, round(1.3 * stop / dt) + 100)
    return stop, speed, dt * np.arange(1, len(v) + 1), v[:, 0, 2], x[:, 0, 2] - RADIUS


@pytest.mark.parametrize("dt", [4e-4, 2e-4, 1e-4])
@pytest.mark.parametrize("e", [0.3, 0.5, 0.8])
@pytest.mark.parametrize("law", LAWS)
def test_zeno_bounce_stops_at_the_sum_of_its_flights(start, law, e, dt):
    stop, _, t, v, height = bounces(start, law, e, dt)
    stopped = t[np.abs(v) > 0.5 * GRAVITY * dt].max()
    # an impact errs by up to g dt in speed, 2 dt / (1 - e) in all later flights, and there are about log(v /
    # g dt) / log(1 / e) of them, with both signs: 20 steps hold for all, at every dt, so the error is O(dt)
    assert abs(stopped - stop) <= 20 * dt
    assert np.abs(v[t > stopped + 100 * dt]).max(initial=0) <= 1e-12  # and then it is at rest
    # moreau keeps the overlap of the last hops that could not leave it: a few g dt in speed for a step
    assert abs(height[-1]) <= (10 * GRAVITY * dt**2 if law == "moreau" else 1e-15)


@pytest.mark.parametrize("e", [0.3, 0.5, 0.8])
@pytest.mark.parametrize("law", LAWS)
def test_rebounds_form_a_geometric_sequence(start, law, e):
    dt = 5e-5
    _, speed, _, v, _ = bounces(start, law, e, dt)
    rebounds = v[1:][(v[1:] > 0) & (v[:-1] < 0)]
    count = int(math.log(50 * GRAVITY * dt / speed) / math.log(e))  # those well above the speed of a step's gravity
    expected = speed * e ** np.arange(1, count + 1)
    # each impact comes within a step of its time, g dt in speed, which the next ones multiply by e: a series
    assert np.abs(rebounds[:count] - expected).max() <= 2 * GRAVITY * dt / (1 - e)
