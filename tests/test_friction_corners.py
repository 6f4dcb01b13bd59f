# SPDX-License-Identifier: GPL-2.0-or-later
"""Corners of friction that once went wrong: no friction in a frictional scene, small grains, two fixes at once."""

from __future__ import annotations

import re

import numpy as np
import pytest
from scenes import DOORS, FLOOR, Grains, grains, harden, state

import nscd_lmp

pytestmark = pytest.mark.fast

BOTH = pytest.mark.parametrize("door", DOORS)
EVERY_SOLVER = pytest.mark.parametrize("solver", nscd_lmp.FRICTIONAL_SOLVERS)
EVERY_LAW = pytest.mark.parametrize("law", nscd_lmp.LAWS)
SMOOTH_FLOOR = nscd_lmp.Plane((0, 0, 0), (0, 0, 1), friction=0.0)
BOX = [(-1.0, 1.0)] * 3


def two(gap: float = 0.0) -> Grains:
    """Return two grains of 1 mm beside each other."""
    return grains([[0, 0, 1e-3], [2e-3 + gap, 0, 1e-3]], 1e-3)


@EVERY_SOLVER
@EVERY_LAW
def test_contact_without_friction_in_a_frictional_scene_does_not_pull(start, solver, law):
    # a wall without friction and a grain that leaves it without any slip: 0 <= 0 in SBP's test for stick
    lmp = start(grains([[0, 0, 0.1]], 0.1, v=[[0, 0, 1.0]]), 1e-3, vmax=2)
    attached = nscd_lmp.attach(lmp, law=law, solver=solver, friction=0.5, walls=[SMOOTH_FLOOR])
    lmp.command("run 5")
    np.testing.assert_array_equal(state(lmp)[1], [[0, 0, 1.0]])
    assert attached.stats["iterations"].max() <= 1


@EVERY_SOLVER
@EVERY_LAW
def test_small_grain_that_falls_on_a_rough_floor_stays_there(start, solver, law):
    # impulses of 1e-6 N s: v p is no number to see a bounce in; 100 tolerances are a thousandth of the impact
    lmp = start(grains([[0, 0, 0.5e-3]], 0.5e-3, v=[[0, 0, -0.2]]), 1e-4, gravity=9.81)
    attached = nscd_lmp.attach(lmp, law=law, solver=solver, friction=0.3, walls=[FLOOR])
    for _ in range(20):
        lmp.command("run 1")
        assert state(lmp)[1][0, 2] < 1e-5
    assert attached.stats["unconverged_steps"][-1] == 0


def test_answer_of_a_python_solver_is_taken_as_it_is(start):
    # three times the inelastic impulse throws the grain up, with friction as without
    def eager(system: nscd_lmp.ContactSystem):
        answer = np.zeros_like(system.start)
        answer[:, 0] = -3 * system.velocity / system.inverse_mass[system.body_i]
        return answer

    lmp = start(grains([[0, 0, 0.1]], 0.1, v=[[0, 0, -1.0]]), 1e-3, vmax=4)
    nscd_lmp.attach(lmp, law="moreau", solver=eager, friction=0.3, walls=[FLOOR], unconverged="ignore")
    lmp.command("run 1")
    assert state(lmp)[1][0, 2] == pytest.approx(2.0, rel=1e-12)


@BOTH
def test_second_fix_on_other_grains_is_refused_or_warned_of(start, door, tmp_path):
    lmp = start(two(), 1e-4)
    lmp.commands_list(["group one id 1", "group other id 2"])
    if door == "python":
        nscd_lmp.attach(lmp, "one")
        with pytest.raises(nscd_lmp.NscdError, match=r"another attach\(\) is at work.*detach\(\) it first"):
            nscd_lmp.attach(lmp, "other")
        return
    log = tmp_path / "log"
    lmp.commands_list([f"log {log}", "fix first one nscd", "fix second other nscd", "run 1", "log none"])
    assert re.search(
        r"WARNING: Fix nscd first: fix second is a second fix nscd.*one fix for the union", log.read_text()
    )


def test_attach_again_after_detach_and_after_clear(start):
    lmp = start(two(), 1e-4)
    nscd_lmp.attach(lmp).detach()
    nscd_lmp.attach(lmp, friction=0.5)
    lmp.command("run 1")


@BOTH
def test_friction_takes_numpy_numbers_and_names_what_is_neither(start, door):
    lmp = start(two(), 1e-4)
    harden(lmp, door, friction=0.3)
    lmp.command("run 1")
    with pytest.raises(nscd_lmp.NscdError, match=r"keyword friction: 'rough' is not a number, nor stick"):
        nscd_lmp.attach(start(two(), 1e-4), friction="rough")  # type: ignore[arg-type]
    nscd_lmp.attach(start(two(), 1e-4), friction=np.float64(0.3), maxiter=np.int64(10))
