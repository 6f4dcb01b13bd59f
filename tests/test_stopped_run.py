# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs that cannot go on stop with their reason, keep the last good step, and leave LAMMPS usable."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scenes import DOORS, FLOOR, GRAVITY, grains, harden, refusal, state

import nscd_lmp

pytestmark = pytest.mark.fast

BOTH = pytest.mark.parametrize("door", DOORS)
RADIUS = 0.01


@BOTH
def test_grain_that_leaves_a_fixed_box_stops_the_run(start, door):
    balls = grains([(0, 0, 0), (0, 0, 0.05)], RADIUS, v=[(0, 0, 0), (0, 0, 1.0)])
    lmp = start(balls, 1e-3, box=[(-0.1, 0.1)] * 3)
    harden(lmp, door)
    with pytest.raises(refusal(door), match=r"1 of 2 grains left the box( \(ID 2\))?: close it with wall planes"):
        lmp.command("run 100")
    assert np.isfinite(state(lmp)[0]).all()


@BOTH
@pytest.mark.parametrize("at", [1, 7])
def test_step_that_is_not_solved_stops_the_run_under_unconverged_error(start, door, at):
    # a column of ten falls on the floor: one sweep does not do
    balls = grains([(0, 0, RADIUS * (2 * k + 1) + 2e-5) for k in range(10)], RADIUS, mass=1.0)
    lmp = start(balls, 1e-4 if at == 7 else 1e-2, gravity=GRAVITY)
    harden(lmp, door, walls=[FLOOR], maxiter=1, unconverged="error", law="moreau")
    good = start(balls, 1e-4 if at == 7 else 1e-2, gravity=GRAVITY)
    harden(good, door, walls=[FLOOR], law="moreau")
    with pytest.raises(refusal(door), match=r"not solved: .* after 1 iterations, tol is 0.001: raise maxiter or tol"):
        lmp.command("run 2000")
    steps = lmp.extract_global("ntimestep") - 1
    good.command(f"run {steps}")
    np.testing.assert_array_equal(state(lmp)[0], state(good)[0])
    np.testing.assert_array_equal(state(lmp)[1], state(good)[1])


@pytest.mark.parametrize("policy", ["warn", "ignore"])
def test_unconverged_steps_are_counted_and_only_warned_about_if_asked(start, recwarn, policy):
    balls = grains([(0, 0, RADIUS * (2 * k + 1)) for k in range(10)], RADIUS, mass=1.0)
    lmp = start(balls, 1e-2, gravity=GRAVITY)
    attached = harden(lmp, walls=[FLOOR], maxiter=1, unconverged=policy)
    lmp.command("run 5")
    assert attached.stats["unconverged_steps"].tolist() == [1, 2, 3, 4, 5]
    told = [str(one.message).partition(":")[0].partition(", and")[0] for one in recwarn]
    overlap = "grains overlap by up to 0.68 of the smaller radius"
    assert told == ["5 of 5 steps were given up above tol 0.001 or overlap 0.0005"] * (policy == "warn") + [overlap]


class Fault(Exception):
    """Raised by a solver of these tests."""


def failing(at: int, fault):
    """Return a solver that is right (one contact) until call number `at`, then gives what fault() gives."""
    calls = []

    def solve(system):
        calls.append(len(system))
        if len(calls) == at:
            return fault()
        return np.maximum(0, -system.velocity / system.delassus().diagonal())

    return solve


def raise_fault():
    raise Fault("no solution for 1 contact")


def interrupt():
    raise KeyboardInterrupt


@pytest.mark.parametrize(
    ("fault", "kind", "message"),
    [
        (raise_fault, Fault, "no solution for 1 contact"),
        (interrupt, KeyboardInterrupt, None),
        (lambda: np.zeros(3), nscd_lmp.NscdError, "returned 3 impulses for 1 contacts"),
        (lambda: np.zeros((1, 1)), Exception, "(?i)impulses|dimension|shape|cast"),
        (lambda: np.array([math.nan]), nscd_lmp.NscdError, "not a number|not a finite number|diverged"),
        (lambda: None, (TypeError, ValueError, nscd_lmp.NscdError), "."),
        (lambda: "many", (TypeError, ValueError), "."),
    ],
)
@pytest.mark.parametrize("at", [1, 5])
def test_fault_in_a_python_solver_stops_the_run_and_reaches_the_caller(start, at, fault, kind, message):
    balls = grains((0, 0, RADIUS), RADIUS)
    lmp, good = start(balls, 1e-4, gravity=GRAVITY), start(balls, 1e-4, gravity=GRAVITY)
    attached = harden(lmp, solver=failing(at, fault), walls=[FLOOR])
    with pytest.raises(kind, match=message):
        lmp.command("run 100")
    # x and v are those of the last good step
    harden(good, walls=[FLOOR], solver=failing(0, None))
    if at > 1:
        good.command(f"run {at - 1}")
    np.testing.assert_array_equal(state(lmp)[0], state(good)[0])
    np.testing.assert_array_equal(state(lmp)[1], state(good)[1])
    assert len(attached.stats) == at - 1
    # and LAMMPS goes on
    lmp.command("run 3")
    assert len(attached.stats) == at + 2
    attached.detach()
    harden(lmp, walls=[FLOOR])
    lmp.command("run 3")
