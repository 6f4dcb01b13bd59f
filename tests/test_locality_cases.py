# SPDX-License-Identifier: GPL-2.0-or-later
"""Grains that were disturbed by others far away: what they do now is what they do alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from all_pairs import largest_overlap, of_lammps
from scenes import DOORS, FLOOR, GRAVITY, box_walls, cloud, energy, grains, harden, state, trajectory

import nscd_lmp

BOTH = pytest.mark.parametrize("door", DOORS)
LAWS = pytest.mark.parametrize("law", nscd_lmp.LAWS)
R, DT = 0.05, 1e-3  # m, s; all grains weigh 1 kg
KICK = GRAVITY * DT  # m/s, what velocities are worth where grains rest
COLUMN = 30  # balls


def beside_pressed_balls(start: Any, law: str, count: int, force: float, vmax: float = 1.0) -> tuple[Any, Any]:
    """Return a column that rests on the floor beside balls that a force presses on the floor, and its grains."""
    column = [(0.5, 0.5, (2 * k + 1) * R) for k in range(COLUMN)]
    pressed = [(2 + 0.3 * (k % 10), 2 + 0.3 * (k // 10), R) for k in range(count)]
    balls = grains(column + pressed, R, 1.0)
    if law == "moreau":  # round-off does not decide which contacts it sees
        balls.x[:, 2] *= 1 - 1e-4
    lmp = start(balls, DT, gravity=GRAVITY, box=[(0, 6), (0, 6), (-1, 8)], vmax=vmax)
    lmp.commands_list([f"group pressed id {COLUMN + 1}:{len(balls)}", f"fix push pressed addforce 0 0 {-force}"])
    return lmp, grains(balls.x[:COLUMN], R, 1.0)


@BOTH
@LAWS
@pytest.mark.parametrize(("count", "force", "vmax"), [(1, 1e4, 1.0), (100, 1e5, 1.0), (100, 1e5, 200.0)])
@pytest.mark.parametrize("mu", [0.0, 0.5])
def test_column_rests_beside_balls_that_are_pressed_on_the_floor(start, door, law, count, force, vmax, mu):
    # it flew up at 2.2 m/s, with 49 J
    lmp, column = beside_pressed_balls(start, law, count, force, vmax)
    harden(lmp, door, walls=[FLOOR], law=law, friction=mu)
    x, v = (frames[:, :COLUMN] for frames in trajectory(lmp, 100))
    fastest, moved = np.abs(v).max() / KICK, np.abs(x - column.x).max() / R
    gained = energy(column, x, v, GRAVITY).max() - energy(column, column.x, column.v, GRAVITY)
    assert (fastest <= 0.05, moved <= 5e-4, gained <= 2e-3) == (True, True, True), (fastest, moved, gained)


@BOTH
@LAWS
@pytest.mark.parametrize("force", [0.0, 600.0, 1e5])
def test_pair_parts_as_its_restitution_says_while_a_ball_far_away_is_pushed(start, door, law, force):
    # it stuck together: "resting" was what is slower than twice the scene's largest kick
    balls = grains([(0, 0, 0), (2.5 * R, 0, 0), (5, 0, 0)], R, 1.0, v=[(0.5, 0, 0), (-0.5, 0, 0), (0, 0, 0)])
    lmp = start(balls, DT, box=[(-1, 7), (-1, 1), (-1, 200)])
    lmp.commands_list(["group far id 3", f"fix push far addforce 0 0 {force}"])
    harden(lmp, door, law=law, restitution=0.9)
    lmp.command("run 50")
    np.testing.assert_allclose(state(lmp)[1][:2, 0], [-0.45, 0.45], rtol=1e-3)


@BOTH
@LAWS
@pytest.mark.parametrize("e", [0.0, 0.9])
def test_overlap_of_two_grains_at_rest_is_no_speed_while_a_ball_far_away_is_pushed(start, door, law, e):
    # they parted at 1 m/s: the cap of recovery was a share of the scene's largest kick
    lmp = start(grains([(0, 0, 0), (1.98 * R, 0, 0), (5, 0, 0)], R, 1.0), DT, box=[(-1, 7), (-1, 1), (-1, 200)])
    lmp.commands_list(["group far id 3", "fix push far addforce 0 0 1e4"])
    harden(lmp, door, law=law, restitution=e)
    _, v = trajectory(lmp, 20)
    assert np.abs(v[:, :2]).max() <= 1e-6


@BOTH
@pytest.mark.parametrize("overlap", [5e-3, 1e-4])
@pytest.mark.parametrize("mu", [0.0, 0.5])
def test_steps_of_a_bed_that_settles_never_add_up_to_more_than_the_overlap_allowed(start, door, overlap, mu):
    # 5e-3 set, 2.8e-2 reached, and no step flagged
    width = 10 * R
    balls = cloud(80, (0.5 * R, R), width)
    lmp = start(balls, DT, gravity=GRAVITY, box=[(-1, 1 + width)] * 2 + [(-1, 3)], vmax=8.0)
    walls = box_walls(width)
    harden(lmp, door, walls=walls, friction=mu, overlap=overlap, unconverged="error", maxiter=20000)
    worst = 0.0
    lmp.command("run 0 post no")
    for _ in range(60):
        lmp.command("run 10 pre no post no")
        worst = max(worst, largest_overlap(of_lammps(lmp, walls=[(wall.point, wall.normal) for wall in walls])).ratio)
    assert worst <= overlap * (1 + 1e-6)


@BOTH
def test_worst_contact_is_reported_beside_the_mean(start, door):
    # a column that one sweep does not solve, and 100 balls that it does
    lmp, _ = beside_pressed_balls(start, "gap", 100, 1e5)
    attached = harden(lmp, door, walls=[FLOOR], solver="pdas", maxiter=1, unconverged="ignore")
    lmp.command("run 1")
    mean, unsolved, worst = (
        attached.stats[name][-1] if attached else lmp.extract_fix("nscd", 0, 1, column)
        for name, column in (("relative_residual", 6), ("unconverged_steps", 10), ("worst_residual", 12))
    )
    assert (mean < 1e-3, unsolved, worst > 0.1) == (True, 1, True), (mean, worst)
