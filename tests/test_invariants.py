# SPDX-License-Identifier: GPL-2.0-or-later
"""What no scene may break: momentum, energy, symmetry of pairs. The same bits for the same input: test_doors.py."""

from __future__ import annotations

import numpy as np
import pytest
from scenes import DOORS, FLOOR, GRAVITY, box_walls, cloud, energy, grains, harden, state, trajectory

import nscd_lmp

LAWS = list(nscd_lmp.LAWS)
RADIUS, SIDE = 0.5, 4.2  # m


def gas(start, setup=(), seed=1):
    """Return 64 boulders that fill a fifth of a periodic box of 4.2 m, at random speeds of 1 m/s."""
    balls = cloud(64, (0.25, RADIUS), SIDE, seed)
    balls.v[:] = np.random.default_rng(seed).normal(size=balls.x.shape)
    box = [(0, SIDE), (0, SIDE), (0, SIDE)]
    return start(balls, 1e-3, box=box, boundary="p p p", vmax=10.0, setup=setup), balls


@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("law", LAWS)
def test_gas_in_a_periodic_box_keeps_its_momentum_and_makes_no_energy(start, law, e):
    lmp, balls = gas(start)
    attached = harden(lmp, law=law, restitution=e, tol=1e-10, maxiter=100000, unconverged="error")
    _, v = trajectory(lmp, 500)
    momentum = (balls.mass[:, None] * v).sum(axis=1)
    before = balls.mass[:, None] * balls.v
    # an impulse is added here and subtracted there: round-off, 1e-16 an impact and grain, with random signs
    np.testing.assert_allclose(
        momentum, np.tile(before.sum(axis=0), (500, 1)), rtol=0, atol=1e-14 * np.abs(before).sum()
    )
    kinetic = np.append(energy(balls, balls.x, balls.v), energy(balls, balls.x, v))
    # p (v + v') / 2 with v' off by the tolerance: up to 1e-10 m/s on 1e3 N s and ten contacts a step
    assert np.diff(kinetic).max() <= 1e-6
    if e == 1:
        assert kinetic[-1] == pytest.approx(kinetic[0], abs=500 * 1e-6)
    else:
        assert kinetic[-1] < 0.6 * kinetic[0]  # hundreds of impacts took their share
    # without forces the contacts' account is complete, under every law
    assert attached.stats["dissipated_energy"][-1] == pytest.approx(kinetic[0] - kinetic[-1], abs=1e-8)


@pytest.mark.parametrize("door", DOORS)
def test_ghost_velocities_are_not_needed(start, door):
    ends = []
    for velocities in ("yes", "no"):
        lmp, _ = gas(start)
        lmp.command(f"comm_modify vel {velocities}")
        harden(lmp, door, restitution=0.5)
        lmp.command("run 500")
        ends.append(np.hstack(state(lmp)))
    np.testing.assert_array_equal(ends[0], ends[1])


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("law", LAWS)
def test_newton_on_and_off_list_the_same_contacts(start, door, law):
    # `newton off` lists a pair across the box twice, `newton on` once
    ends = []
    for newton in ("on", "off"):
        lmp, _ = gas(start, [f"newton {newton}"])
        harden(lmp, door, law=law, restitution=0.5, tol=1e-12)
        lmp.command("run 100")
        ends.append(np.hstack(state(lmp)))
    # the order of contacts may differ, so round-off does: 1e-12 m/s, times what 100 steps of impacts make of
    # it
    np.testing.assert_allclose(ends[0], ends[1], rtol=0, atol=1e-9)


@pytest.mark.parametrize("law", LAWS)
def test_pair_that_meets_on_both_sides_of_a_periodic_box_has_two_contacts(start, law):
    # two balls fill a periodic tube; pushed into each other they cannot move, from either side
    balls = grains([(0.5, 0, 0), (1.5, 0, 0)], RADIUS, v=[(1.0, 0, 0), (-1.0, 0, 0)])
    lmp = start(balls, 1e-3, box=[(0, 2), (-2, 2), (-2, 2)], boundary="p f f")
    attached = harden(lmp, law=law, tol=1e-12)
    lmp.command("run 3")
    contacts = attached.contacts
    # moreau sees only the side that closes; the side that opens has a gap of 1e-3 m half a step on
    assert len(contacts["gap"]) == (1 if law == "moreau" else 2)
    np.testing.assert_allclose(state(lmp)[1], 0, atol=1e-11)  # a few tol


@pytest.mark.parametrize(("law", "expected"), [("moreau", [-0.6, 0.4, 0.4, 0.4, 0.4]), ("gap", [0, 0, 0, 0, 1.0])])
def test_newton_s_cradle_answers_as_the_law_says(start, law, expected):
    # moreau: (21) on all five contacts at once; the four at rest leave together, at 2 / N, the first returns
    # at 2 / N - 1. gap: impacts propagate from ball to ball within the step, and the last one leaves, as in
    # the toy. (hundred balls are as good as five, below)
    x = [(-0.01, 0, 0), *((k, 0, 0) for k in range(1, 5))]
    balls = grains(x, RADIUS, mass=2.0, v=[(1.0, 0, 0)] + [(0, 0, 0)] * 4)
    lmp = start(balls, 1e-3)
    harden(lmp, law=law, restitution=1.0, tol=1e-13, maxiter=100000)
    lmp.command("run 30")
    # criterion 1e-13 on the column-like chain of four: times the 15 sweeps of a decade
    np.testing.assert_allclose(state(lmp)[1][:, 0], expected, rtol=0, atol=1e-11)


@pytest.mark.parametrize("door", DOORS)
def test_impact_passes_a_row_of_a_hundred_balls_in_a_step(start, door):
    # a round of impacts for each ball: 99, where a dense bed gets 50
    balls = grains([(k, 0, 0) for k in range(100)], RADIUS, mass=2.0, v=[(1.0, 0, 0)] + [(0, 0, 0)] * 99)
    lmp = start(balls, 1e-3)
    harden(lmp, door, restitution=1.0, tol=1e-13)
    lmp.command("run 1")
    np.testing.assert_allclose(state(lmp)[1][:, 0], [0] * 99 + [1.0], rtol=0, atol=1e-11)  # 99 times tol


def pressed_to_the_wall(heavy: float) -> tuple[int, list[float]]:
    """Return how many elastic impacts a ball of 1 kg at a wall has with one of `heavy` kg, and the velocities after."""
    u, v, impacts = -1.0, 0.0, 0
    while v > u or v < 0:
        if v > u:
            mean = (heavy * u + v) / (heavy + 1)
            u, v = 2 * mean - u, 2 * mean - v
        else:
            v = -v
        impacts += 1
    return impacts, [v, u]


@pytest.mark.parametrize(("heavy", "digits"), [(1e2, 31), (1e4, 314)])
def test_impacts_between_a_heavy_ball_and_a_wall_are_the_digits_of_pi(start, heavy, digits):
    # Galperin's billiard, all of it in one step, of two contacts
    impacts, after = pressed_to_the_wall(heavy)
    assert impacts == digits
    lmp = start(grains([(RADIUS, 0, 0), (3 * RADIUS, 0, 0)], RADIUS, mass=[1.0, heavy], v=[(0,) * 3, (-1.0, 0, 0)]),
                1e-3, vmax=200.0)  # fmt: skip
    harden(lmp, restitution=1.0, tol=1e-11, walls=[nscd_lmp.Plane((0, 0, 0), (1, 0, 0))])
    lmp.command("run 1")
    # tol of each impact, times their number
    np.testing.assert_allclose(state(lmp)[1][:, 0], after, rtol=0, atol=1e-8)


@pytest.mark.parametrize("law", LAWS)
def test_newton_s_cradle_keeps_momentum_and_energy_under_every_law(start, law):
    balls = grains([(k, 0, 0) for k in range(5)], RADIUS, mass=2.0, v=[(1.0, 0, 0)] * 2 + [(0, 0, 0)] * 3)
    lmp = start(balls, 1e-3)
    harden(lmp, law=law, restitution=1.0, tol=1e-13, maxiter=100000)
    lmp.command("run 30")
    v = state(lmp)[1][:, 0]
    assert v.sum() == pytest.approx(2.0, abs=1e-12)
    assert (v**2).sum() == pytest.approx(2.0, abs=1e-10)


@pytest.mark.parametrize("gap", [1e-3, 2e-2])
@pytest.mark.parametrize("law", LAWS)
def test_impact_runs_down_a_chain_of_ever_lighter_balls(start, law, gap):
    # each ball of a tenth of the mass leaves with 20/11 of the speed: 20 m/s at the end, of which no grain
    # had any sign when the step began. A step moves the first ball by 1e-2 m, so impacts come several to a
    # step or one.
    mass = 10.0 ** np.arange(6, 0, -1)
    balls = grains([(k * (1 + gap), 0, 0) for k in range(6)], RADIUS, mass=mass, v=[(1.0, 0, 0)] + [(0, 0, 0)] * 5)
    lmp = start(balls, 1e-2, vmax=20.0)
    attached = harden(lmp, law=law, restitution=1.0, tol=1e-12, maxiter=100000, unconverged="ignore")
    lmp.command("run 40")
    speed = 9 / 11 * (20 / 11) ** np.arange(6)
    speed[-1] = (20 / 11) ** 5
    # tol over the impulse of the lightest ball, 1e2 N s, times the sweeps; then a factor of 20 down the chain
    np.testing.assert_allclose(state(lmp)[1][:, 0], speed, rtol=0, atol=1e-9)
    if law == "gap":
        assert attached.stats["largest_overlap"].max() < 1e-12


def heap():
    """Return about 30 boulders in random places of a box of 1.9 m; many overlap by half a radius and more."""
    random = np.random.default_rng(1)
    places = random.uniform(0.25, 1.65, (60, 3))
    kept = [places[0]]
    for place in places[1:]:
        if (np.linalg.norm(np.array(kept) - place, axis=1) > 0.3).all():
            kept.append(place)
    return grains(kept, 0.25)


@pytest.mark.parametrize("law", LAWS)
def test_overlapping_start_without_gravity_stays_where_it_is(start, law):
    balls = heap()
    lmp = start(balls, 1e-3)
    attached = harden(lmp, law=law, tol=1e-9, maxiter=100000)
    _, v = trajectory(lmp, 500)
    assert attached.stats["largest_overlap_ratio"][0] > 0.5
    # law gap gives an overlap back at no more than tol when no force acts; the sum over a chain is a few tol
    assert np.abs(v).max() <= 10 * 1e-9


@pytest.mark.parametrize("law", LAWS)
def test_overlapping_start_under_gravity_does_not_explode(start, law):
    balls = heap()
    lmp = start(balls, 1e-3, gravity=GRAVITY, vmax=10.0)
    attached = harden(lmp, law=law, tol=1e-9, maxiter=100000, walls=box_walls(1.9))
    x, v = trajectory(lmp, 1500)
    total = energy(balls, x, v, GRAVITY)
    begin = energy(balls, balls.x, balls.v, GRAVITY)
    assert total.max() <= begin * (1 + 1e-12)
    assert np.abs(v).max() <= np.sqrt(2 * GRAVITY * balls.x[:, 2].max())  # nothing is faster than by falling
    ratio = attached.stats["largest_overlap_ratio"]
    assert ratio[-1] < ratio[0]


@pytest.mark.parametrize("e", [0.0, 0.5])
@pytest.mark.parametrize("law", LAWS)
def test_energy_of_a_falling_cloud_never_exceeds_its_start_and_dies_down(start, law, e):
    balls, dt = cloud(27, (0.25, 0.5), 3.2), 2e-3
    lmp = start(balls, dt, gravity=GRAVITY, vmax=20.0)
    harden(lmp, law=law, restitution=e, tol=1e-6, maxiter=2000, walls=box_walls(3.2), unconverged="ignore")
    x, v = trajectory(lmp, 2500, 10)
    total = energy(balls, x, v, GRAVITY)
    begin = energy(balls, balls.x, balls.v, GRAVITY)
    assert total.max() <= begin * (1 + 1e-14)
    # 4 s after the fall; without friction a grain may still slide on the floor
    assert energy(balls, x[-20:], v[-20:]).max() <= 1e-3 * (begin - total[-1])


@pytest.mark.parametrize("theta", [0.0, 0.25, 0.5, 0.75, 1.0])
def test_theta_of_a_bouncing_ball_shifts_its_energy_by_no_more_than_one_step_of_its_fall(start, theta):
    # A step of free flight changes the energy by -(theta - 1/2) m (g dt)^2, and an impact at e = 1 by +(theta
    # - 1/2) 2 m g dt v, which is what a flight of 2 v / g has taken: no drift for any theta, none at all at
    # 1/2
    dt, drop, mass = 1e-3, 0.2, 1.0
    balls = grains((0, 0, RADIUS + drop), RADIUS, mass=mass)
    lmp = start(balls, dt, gravity=GRAVITY, vmax=4.0)
    harden(lmp, law="moreau", theta=theta, restitution=1.0, walls=[FLOOR], tol=1e-12)
    x, v = trajectory(lmp, 5000)
    error = energy(balls, x, v, GRAVITY) - energy(balls, balls.x, balls.v, GRAVITY)
    flight = -(theta - 0.5) * mass * (GRAVITY * dt) ** 2
    # round-off of energies of 7 J
    np.testing.assert_allclose(error[:150], flight * np.arange(1, 151), rtol=0, atol=1e-13)
    speed = np.sqrt(2 * GRAVITY * drop)
    # the impacts come up to a step off their time: a g dt more
    assert np.abs(error).max() <= abs(theta - 0.5) * mass * GRAVITY * dt * (speed + 2 * GRAVITY * dt) + 1e-12


@pytest.mark.parametrize("law", LAWS)
def test_mirrored_scene_moves_mirrored(start, law):
    # reflection is exact in floating point, so only the order of contacts could tell the scenes apart
    ends = []
    for sign in (1.0, -1.0):
        balls = cloud(20, (0.25, 0.5), 2.1)
        balls.x -= (1.05, 1.05, 0)
        balls.v[:] = (0.5, 0.2, -0.5)
        balls.x[:, 0] *= sign
        balls.v[:, 0] *= sign
        lmp = start(balls, 1e-3, gravity=GRAVITY, vmax=8.0, box=[(-30, 30), (-30, 30), (-1, 30)])
        harden(lmp, law=law, tol=1e-12, maxiter=100000, walls=[FLOOR])
        x, _ = trajectory(lmp, 300, 300)
        ends.append(x[0] * (sign, 1, 1))
    # tolerance times the few tens of steps in contact
    np.testing.assert_allclose(ends[0], ends[1], rtol=0, atol=1e-9)
