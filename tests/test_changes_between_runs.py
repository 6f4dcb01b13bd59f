# SPDX-License-Identifier: GPL-2.0-or-later
"""Fixes, settings and grains that change after the contact fix was made, through both doors."""

from __future__ import annotations

import numpy as np
import pytest
from scenes import DOORS, FLOOR, GRAVITY, forces, grains, harden, refusal, state, trajectory

import nscd_lmp

BOTH = pytest.mark.parametrize("door", DOORS)
LAWS = list(nscd_lmp.LAWS)


def by_command(lmp, lines, folder):
    for line in lines:
        lmp.command(line)


def by_file(lmp, lines, folder):
    (folder / "in.more").write_text("\n".join(lines) + "\n")
    lmp.file(str(folder / "in.more"))


WAYS = {
    "command": by_command,
    "commands_list": lambda lmp, lines, folder: lmp.commands_list(lines),
    "commands_string": lambda lmp, lines, folder: lmp.commands_string("\n".join(lines)),
    "file": by_file,
}


@pytest.mark.parametrize("way", WAYS)
@BOTH
def test_fixes_of_force_count_wherever_they_stand(start, tmp_path, door, way):
    # forces from fixes that come after the contact fix, in whatever way LAMMPS is told; a ball at rest bears
    # both
    push, mass, dt = 2.0, 3.0, 1e-3
    lmp = start(grains((0, 0, 0.5), 0.5, mass=mass), dt)
    attached = harden(lmp, door, walls=[FLOOR], law="gap", tol=1e-12)
    lines = [
        f"fix push all addforce 0 0 {-push}",
        f"fix gravity all gravity {GRAVITY} vector 0 0 -1",
        "run 3",
    ]
    if attached and way == "file":
        # a script's commands cannot be looked at, so the run is refused rather than its forces missed
        with pytest.raises(nscd_lmp.NscdError, match="fix gravity was defined after attach"):
            WAYS[way](lmp, lines, tmp_path)
        return
    WAYS[way](lmp, lines, tmp_path)
    weight = push + mass * GRAVITY
    measured = attached.contacts["impulse"][0] if attached else lmp.numpy.extract_fix("nscd", 2, 2)[0, 9]
    assert measured == pytest.approx(weight * dt, rel=1e-9)  # tol over W p = 1e-12 / 1e-2
    assert forces(lmp)[0, 2] == pytest.approx(weight, rel=1e-9)


@pytest.mark.parametrize("way", WAYS)
@BOTH
def test_second_integrator_is_refused_in_whatever_way_it_comes(start, tmp_path, door, way):
    balls = grains((0, 0, 1.0), 0.5, v=(0, 0, -1.0))
    lmp = start(balls, 1e-3)
    harden(lmp, door, walls=[FLOOR])
    with pytest.raises(refusal(door), match=r"fix other (\(style nve\)|was defined after attach)"):
        WAYS[way](lmp, ["fix other all nve", "run 3"], tmp_path)
    assert state(lmp)[0].tolist() == balls.x.tolist()


@BOTH
def test_neighbor_settings_that_change_later_are_looked_at_again(start, door):
    # after the contact fix the list is made too short for these balls: refused, or the contact is found
    balls = grains([(0, 0, 0.5), (0, 0, 1.6)], 0.5, v=[(0, 0, 0), (0, 0, -1.0)])
    lmp = start(balls, 1e-2, vmax=4.0)
    harden(lmp, door, walls=[FLOOR])
    lmp.commands_list(["pair_style zero 0.5", "pair_coeff * *", "neighbor 0.1 nsq", "comm_modify cutoff 3.0"])
    with pytest.raises(refusal(door), match="contacts could be missed"):
        lmp.command("run 30")


@BOTH
def test_neighbor_settings_that_grow_later_are_accepted(start, door):
    balls = grains([(0, 0, 0.5), (0, 0, 1.6)], 0.5, v=[(0, 0, 0), (0, 0, -1.0)])
    lmp = start(balls, 1e-2, vmax=0.0)
    lmp.command("neighbor 1e-3 nsq")
    harden(lmp, door, walls=[FLOOR], law="gap", tol=1e-12)
    lmp.commands_list(["pair_style zero 1.5", "pair_coeff * *", "neighbor 0.3 nsq"])
    x, _ = trajectory(lmp, 30)
    assert x[-1, 1, 2] == pytest.approx(1.5, abs=1e-10)


@BOTH
@pytest.mark.parametrize("law", LAWS)
def test_grains_may_come_and_go_between_runs(start, door, law):
    # a column whose upper half is taken away and put back, larger and heavier: the floor bears what is there
    lmp = start(grains([(0, 0, 0.5 + k) for k in range(4)], 0.5, mass=1000.0), 1e-3, gravity=GRAVITY)
    harden(lmp, door, walls=[FLOOR], law=law, tol=1e-12, maxiter=100000)
    lmp.command("run 2")
    assert forces(lmp)[0, 2] == pytest.approx(1000 * GRAVITY, rel=1e-8)
    lmp.commands_list(["group gone id 3 4", "delete_atoms group gone compress no", "run 2"])
    x, _ = state(lmp)
    np.testing.assert_allclose(x[:, 2], [0.5, 1.5], rtol=0, atol=1e-10)
    top = float(x[1, 2]) + 0.5 + 0.6
    lmp.commands_list([f"create_atoms 1 single 0 0 {top!r}", "group new id 3", "set group new diameter 1.2 mass 3000"])
    lmp.commands_list(["pair_style zero 1.4", "pair_coeff * *", "run 3"])
    before = state(lmp)[0]
    lmp.command("run 50")
    np.testing.assert_allclose(state(lmp)[0], before, rtol=0, atol=1e-10)
    # the mean contact force on each is its weight; tol times the sweeps of a decade over g dt
    np.testing.assert_allclose(forces(lmp)[:, 2], GRAVITY * np.array([1000, 1000, 3000]), rtol=1e-7)


@pytest.mark.parametrize("first", DOORS)
def test_both_doors_on_the_same_grains_are_refused(start, first):
    balls = grains((0, 0, 1.0), 0.5, v=(0, 0, -1.0))
    lmp = start(balls, 1e-3)
    with pytest.raises(Exception, match=r"fix nscd|remove that fix"):
        for door in (first, *(other for other in DOORS if other != first)):
            harden(lmp, door, walls=[FLOOR])
        lmp.command("run 1")
    assert state(lmp)[0].tolist() == balls.x.tolist()
