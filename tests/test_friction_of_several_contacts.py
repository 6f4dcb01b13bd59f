# SPDX-License-Identifier: GPL-2.0-or-later
"""Grains with several contacts with friction at once: corners, piles, rollers and belts.

Places and velocities are given in a plane of their own, along the ground and above it; spins as surface speeds r omega,
counted positive where they roll forward.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from grain_kinds import (
    BOTH_KINDS,
    DT,
    EVERY_LAW,
    EVERY_SOLVER,
    LAWS_AND_KINDS,
    RADIUS,
    SOLVED,
    SOLVERS,
    STEP_ERROR,
    TOUCH,
)
from parameters import every_two_meet
from scenes import GRAVITY, grains, harden, per_atom, state

import nscd_lmp


@pytest.fixture
def scene(start):
    """Return a function that starts grains at places (a, b), a along the ground and b above it.

    The first spins by `spin`; all but the grain `free` are obstacles, which the commands of `motion` move.
    """

    def make(kind, law, places, walls, spin=0.0, free="all", motion=None, **options):
        frame = np.eye(3)[[0, 1, 2]] if kind.planar else np.eye(3)[[0, 2, 1]]
        axis = np.cross(frame[1], frame[0])
        omega = np.zeros((len(places), 3))
        omega[0] = spin / RADIUS * axis
        balls = grains(np.array(places) @ frame[:2], RADIUS, omega=omega)
        lmp = start(balls, DT, gravity=GRAVITY, planar=kind.planar, vmax=4.0)
        if free != "all":
            lmp.commands_list([f"group free id {free}", "group driven subtract all free"])
            free = "free"
        for command in motion(frame, axis) if motion else ():
            lmp.command(command)
        planes = [nscd_lmp.Plane(a * frame[0] + b * frame[1], n @ frame[:2], friction=mu) for (a, b), n, mu in walls]
        made = harden(lmp, group=free, law=law, inertia=kind.inertia, walls=planes, **(SOLVED | options))
        return lmp, made, lambda: (state(lmp)[1] @ frame.T, per_atom(lmp, "omega") @ axis * RADIUS)

    return make


def words(vector) -> str:
    """Return the components as words of a LAMMPS command."""
    return " ".join(repr(float(component)) for component in vector)


UP, FORWARD = np.array([0, 1.0]), np.array([1.0, 0])
GROUND = ((0, 0), UP, None)
CORNER = [GROUND, ((-RADIUS, 0), FORWARD, None)]


def braked_in_the_corner(kind, mu, steps):
    """Return the spin after so many steps in the corner, from -2 m/s on.

    Its floor pushes it into the wall, which carries mu of what the floor carries and holds mu of that up: the floor
    carries 1 / (1 + mu^2) of the weight, both brake.
    """
    return -2.0 + kind.k * mu * GRAVITY * (1 + mu) / (1 + mu**2) * steps * DT


@every_two_meet({"solver": SOLVERS, "law, kind": LAWS_AND_KINDS, "mu": [0.1, 0.5, 0.9]})
def test_grain_that_spins_in_a_corner_stays_there_and_slows_down(scene, solver, law, kind, mu):
    lmp, _, motion = scene(kind, law, [(0, RADIUS)], CORNER, spin=-2.0, solver=solver, friction=mu)
    lmp.command("run 40")
    v, spin = motion()
    np.testing.assert_allclose(v, 0, atol=STEP_ERROR)
    # a visit to the floor after one to the wall changes the floor's impulse by -mu^2 of its last change: what a
    # sweep leaves is up to 1 / (1 - mu^2) times what it corrected
    assert spin[0] == pytest.approx(braked_in_the_corner(kind, mu, 40), abs=40 * STEP_ERROR / (1 - mu**2))


@BOTH_KINDS
@EVERY_LAW
@EVERY_SOLVER
def test_corner_of_friction_1_is_solved_or_reported_and_damped_visits_solve_it(scene, solver, law, kind):
    # -mu^2 is -1: exact visits go to and fro for ever. Projections that go only part of the way (rho < 1) settle.
    options = {"solver": solver, "friction": 1.0, "maxiter": 1000, "unconverged": "ignore"}
    # a little inside both, or what a step leaves of a velocity would part them under law moreau
    lmp, attached, motion = scene(kind, law, [(-TOUCH, RADIUS - TOUCH)], CORNER, spin=-2.0, **options)
    lmp.command("run 40")
    v, spin = motion()
    solved = attached.stats["unconverged_steps"][-1] == 0
    assert solved or solver not in ("sbp", "sal")
    if solved:
        assert spin[0] == pytest.approx(braked_in_the_corner(kind, 1.0, 40), abs=100 * 40 * STEP_ERROR)
        np.testing.assert_allclose(v, 0, atol=100 * STEP_ERROR)


@every_two_meet(
    {
        "solver": SOLVERS,
        "mu, stop": [(0.3, 0.0), (0.3, 0.5), (0.6, 0.9), (0.3, 1.05), (0.3, "stick")],
        "law, kind": LAWS_AND_KINDS,
    }
)
def test_roller_turns_a_grain_that_leans_on_a_stop_unless_the_stop_holds_it(scene, solver, law, kind, mu, stop):
    # The roller below drags with mu N, so that is what the stop carries; turning, the grain slides up the stop, which
    # pulls down by stop mu N: N = m g / (1 - stop mu), torque (1 - stop) mu N. From stop = 1 on it cannot turn.
    place, walls = [(0, RADIUS), (0, -RADIUS)], [((RADIUS, 0), -FORWARD, stop)]
    turning = 0.2  # s a turn: a surface speed of 16 m/s, never reached

    def roller(frame, axis):
        yield f"fix roller driven move rotate {words(-RADIUS * frame[1])} {words(axis)} {turning}"

    lmp, _, motion = scene(kind, law, place, walls, free="1", motion=roller, solver=solver, friction=mu)
    steps, hold = 50, 1.0 if stop == "stick" else min(stop, 1.0)
    lmp.command(f"run {steps}")
    v, spin = motion()
    np.testing.assert_allclose(v[0], 0, atol=STEP_ERROR)
    expected = -kind.k * (1 - hold) * mu * GRAVITY / (1 - hold * mu) * steps * DT
    assert spin[0] == pytest.approx(expected, abs=steps * STEP_ERROR)


@pytest.mark.parametrize("mu", [0.2, 0.5])
@BOTH_KINDS
@EVERY_LAW
def test_grain_in_the_groove_of_two_rollers_is_turned_up_to_their_speed(scene, law, kind, mu):
    # contact normals at 45 degrees: both drag it the same way, so one carries more; together (1 + mu^2) cos 45 times
    # their sum is the weight
    side, speed = (2 * RADIUS - TOUCH) / math.sqrt(2), 1.0

    def rollers(frame, axis):
        for number, a in ((2, -side), (3, side)):
            yield f"group roller{number} id {number}"
            centre = words(a * frame[0] - side * frame[1])
            period = repr(2 * math.pi * RADIUS / speed)
            yield f"fix roller{number} roller{number} move rotate {centre} {words(axis)} {period}"

    places = [(0, 0), (-side, -side), (side, -side)]
    lmp, _, motion = scene(kind, law, places, [], free="1", motion=rollers, friction=mu)
    rate = kind.k * mu * GRAVITY / ((1 + mu**2) * math.cos(math.pi / 4))
    before = int(speed / rate / DT)
    for steps, expected in ((before, -rate * before * DT), (50, -speed)):
        lmp.command(f"run {steps}")
        v, spin = motion()
        np.testing.assert_allclose(v[0], 0, atol=100 * STEP_ERROR)
        assert spin[0] == pytest.approx(expected, abs=(before + 50) * STEP_ERROR)


@every_two_meet(
    {"solver": SOLVERS, "law, kind": LAWS_AND_KINDS, "mu, drags": [(0.2, True), (0.2, False), ("stick", False)]}
)
def test_moving_obstacle_drags_the_grain_on_it_along(scene, solver, law, kind, mu, drags):
    # one step: mu g dt if the belt is faster than kappa times that, else until nothing slips. It is below the grain
    # where the contact is sought: at the start of the step, under law moreau halfway.
    speed = 1.0 if drags or mu == "stick" else 0.9 * kind.kappa * mu * GRAVITY * DT

    def belt(frame, axis):
        yield f"fix belt driven move linear {words(speed * frame[0])}"

    places = [(0, RADIUS), (-speed * DT / 2 if law == "moreau" else 0, -RADIUS)]
    lmp, _, motion = scene(kind, law, places, [], free="1", motion=belt, solver=solver, friction=mu)
    lmp.command("run 1")
    v, spin = motion()
    push = mu * GRAVITY * DT if drags else speed / kind.kappa
    np.testing.assert_allclose(v[0], (push, 0, 0), rtol=0, atol=STEP_ERROR)
    assert spin[0] == pytest.approx(-kind.k * push, abs=STEP_ERROR)


@every_two_meet(
    {
        "solver": SOLVERS,
        "law, kind": LAWS_AND_KINDS,
        "pairs, ground": [(1.02, 1.02), (0.98, 1.02), (1.02, 0.98), ("stick", "stick")],
    }
)
def test_grain_on_two_stands_iff_both_coefficients_reach_the_angle_of_the_pile(scene, solver, law, kind, pairs, ground):
    # Contacts between grains at `angle` from the vertical: both forces on a lower grain but its weight go through its
    # contact with the ground, so friction between grains needs tan(angle / 2); the ground carries 3/2 weights where
    # the upper contact carries 1/2, so it needs a third of that
    angle = math.radians(35)
    need = math.tan(angle / 2)
    side, top = 2 * RADIUS * math.sin(angle), RADIUS + 2 * RADIUS * math.cos(angle)
    places = [(-side, RADIUS - TOUCH), (side, RADIUS - TOUCH), (0, top - 3 * TOUCH)]
    stands = "stick" in (pairs, ground) or min(pairs, ground) > 1
    pair, wall = (mu if mu == "stick" else mu * share for mu, share in ((pairs, need), (ground, need / 3)))
    lmp, _, motion = scene(kind, law, places, [(*GROUND[:2], wall)], solver=solver, friction=pair)
    lmp.command("run 100")
    v, spin = motion()
    if stands:
        np.testing.assert_allclose(np.column_stack([v, spin]), 0, atol=100 * STEP_ERROR)
    else:
        assert v[2, 1] < -1e-3 and v[1, 0] > 1e-3 and v[0, 0] == pytest.approx(-v[1, 0], abs=1e-9)
