# SPDX-License-Identifier: GPL-2.0-or-later
"""One grain on a plane with friction: sliding into rolling, inclines, the walls' own coefficients.

Spins are given as surface speeds r omega, counted positive where they roll forward.
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
    LAWS_AND_ALL_KINDS,
    LAWS_AND_KINDS,
    RADIUS,
    SOLVED,
    SOLVERS,
    STEP_ERROR,
    TOUCH,
)
from parameters import every_two_meet
from scenes import GRAVITY, grains, harden, trajectory

import nscd_lmp


@pytest.fixture
def slope(start):
    """Return a function that puts a grain on a plane through 0, with speeds v downhill and spin, and runs it.

    It returns the components of v along downhill, normal and sideways, and the spin, after every step.
    """

    def run(kind, law, steps, angle=0.0, v=0.0, spin=0.0, wall=None, **options):
        frame = kind.frame(angle)
        ball = grains((RADIUS - TOUCH) * frame[1], RADIUS, v=v * frame[0], omega=spin / RADIUS * frame[2])
        lmp = start(ball, DT, gravity=GRAVITY, planar=kind.planar, vmax=4.0, box=[(-30, 30)] * 3)
        plane = nscd_lmp.Plane((0, 0, 0), frame[1], friction=wall)
        harden(lmp, law=law, inertia=kind.inertia, walls=[plane], **SOLVED, **options)
        x, v, omega = trajectory(lmp, steps, spins=True)
        turned = omega[:, 0] @ frame.T * RADIUS
        np.testing.assert_array_equal(turned[:, :2][np.abs(turned[:, :2]) > STEP_ERROR * steps], [])  # no other spin
        return x[:, 0] @ frame.T, v[:, 0] @ frame.T, turned[:, 2]

    return run


@every_two_meet(
    {"solver": SOLVERS, "law, kind": LAWS_AND_ALL_KINDS, "v0, spins": [(1.0, 0.0), (0.0, 1.0), (1.0, -1.0)]}
)
def test_sliding_grain_rolls_once_friction_has_stopped_its_slip(slope, solver, law, kind, v0, spins):
    # slip v - s falls by kappa mu g dt a step; sphere without spin: 5/7 v0 from 2 v0 / (7 mu g) on, disc: 2/3 v0 from
    # v0 / (3 mu g) on. The third case: back spin of k v0 stops the grain dead, its slip kappa v0 takes as long as v0.
    spin0, mu = spins * (kind.k if spins < 0 else 1), 0.3
    slip = v0 - spin0
    sign, duration = np.sign(slip), abs(slip) / (kind.kappa * mu * GRAVITY)
    steps = math.ceil(duration / DT) + 20
    x, v, spin = slope(kind, law, steps, v=v0, spin=spin0, solver=solver, friction=mu)
    t = DT * np.arange(1, steps + 1)
    slides = t < duration
    expected = np.where(slides, v0 - sign * mu * GRAVITY * t, v0 - slip / kind.kappa)
    turning = np.where(slides, spin0 + sign * kind.k * mu * GRAVITY * t, expected)
    np.testing.assert_allclose(v[:, 0], expected, rtol=0, atol=steps * STEP_ERROR)
    np.testing.assert_allclose(spin, turning, rtol=0, atol=steps * STEP_ERROR)
    np.testing.assert_allclose(v[:, 1:], 0, atol=STEP_ERROR)
    # the step in which sliding ends moves as if it ended in its middle: mu g dt^2 / 8, and half of it after it
    distance = v0 * duration - sign * mu * GRAVITY * duration**2 / 2 + expected[-1] * (t[-1] - duration)
    assert x[-1, 0] == pytest.approx(distance, abs=mu * GRAVITY * DT**2)


@BOTH_KINDS
@EVERY_LAW
@EVERY_SOLVER
def test_grain_that_sticks_rolls_at_once(slope, solver, law, kind):
    _, v, spin = slope(kind, law, 20, v=1.0, solver=solver, friction="stick")
    np.testing.assert_allclose(v[:, 0], 1 - 1 / kind.kappa, rtol=0, atol=20 * STEP_ERROR)
    np.testing.assert_allclose(spin, v[:, 0], rtol=0, atol=STEP_ERROR)


@every_two_meet({"solver": SOLVERS, "law, kind": LAWS_AND_KINDS, "ratio": [0.5, 1 - 1e-6, 1 + 1e-6, 2.0]})
def test_grain_on_an_incline_rolls_up_to_kappa_mu_and_slides_beyond(slope, solver, law, kind, ratio):
    # ratio: tan(angle) over kappa mu, that is 7/2 mu for spheres and 3 mu for discs
    angle, steps = 0.5, 50
    mu = math.tan(angle) / (kind.kappa * ratio)
    x, v, spin = slope(kind, law, steps, angle=angle, solver=solver, friction=mu)
    t = DT * np.arange(1, steps + 1)
    pull, grip = GRAVITY * math.sin(angle), mu * GRAVITY * math.cos(angle)
    speed, turning = (pull * kind.k / kind.kappa,) * 2 if ratio < 1 else (pull - grip, kind.k * grip)
    np.testing.assert_allclose(v[:, 0], speed * t, rtol=0, atol=steps * STEP_ERROR)  # sphere that rolls: 5/7 g sin
    np.testing.assert_allclose(spin, turning * t, rtol=0, atol=steps * STEP_ERROR)
    slip = v[:, 0] - spin
    if ratio < 1:
        np.testing.assert_allclose(slip, 0, atol=STEP_ERROR)
    else:
        assert slip[-1] >= 0.99 * (1 - 1 / ratio) * pull * t[-1] > 100 * STEP_ERROR
    # exact Coulomb: what slides does not lift
    np.testing.assert_allclose(v[:, 1:], 0, atol=STEP_ERROR)
    np.testing.assert_allclose(x[:, 1], RADIUS, rtol=0, atol=TOUCH + steps * DT * STEP_ERROR)


@every_two_meet({"solver": SOLVERS, "law, kind": LAWS_AND_KINDS, "angle": [0.1, 1.5]})
def test_grain_that_sticks_rolls_down_any_incline(slope, solver, law, kind, angle):
    steps = 50
    _, v, spin = slope(kind, law, steps, angle=angle, solver=solver, friction="stick")
    expected = GRAVITY * math.sin(angle) * kind.k / kind.kappa * DT * np.arange(1, steps + 1)
    np.testing.assert_allclose(v[:, 0], expected, rtol=0, atol=steps * STEP_ERROR)
    np.testing.assert_allclose(spin, expected, rtol=0, atol=steps * STEP_ERROR)


OWN = [(0.5, 0.1, 0.1), (0.1, 0.5, 0.5), (0.0, 0.2, 0.2), (0.2, None, 0.2), ("stick", 0.1, 0.1)]


@pytest.mark.parametrize(("pairs", "wall", "felt"), OWN)
@BOTH_KINDS
@EVERY_LAW
def test_wall_has_its_own_friction_or_that_of_the_pairs(slope, law, kind, pairs, wall, felt):
    _, v, spin = slope(kind, law, 20, v=1.0, friction=pairs, wall=wall)
    t = DT * np.arange(1, 21)
    np.testing.assert_allclose(v[:, 0], 1 - felt * GRAVITY * t, rtol=0, atol=20 * STEP_ERROR)
    np.testing.assert_allclose(spin, kind.k * felt * GRAVITY * t, rtol=0, atol=20 * STEP_ERROR)


@every_two_meet({"solver": SOLVERS, "law, kind": LAWS_AND_KINDS, "pairs": [0.5, "stick"]})
def test_wall_without_friction_in_a_scene_with_friction_neither_slows_nor_turns(slope, solver, law, kind, pairs):
    _, v, spin = slope(kind, law, 20, v=1.0, spin=0.3, solver=solver, friction=pairs, wall=0.0)
    np.testing.assert_allclose(v[:, 0], 1.0, rtol=1e-15)  # a rounding when it is turned into the frame
    np.testing.assert_allclose(spin, 0.3, rtol=1e-14)
