# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls of the Python door: each kind and each motion at a closed form, and what walls carry."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import walls_scene
from scenes import GRAVITY, grains, per_atom, start, state, trajectory
from test_ranks import execute

import nscd_lmp
from nscd_lmp import Cylinder, Mesh, Plane, Planes, Rotate, Shear, Wiggle

pytestmark = pytest.mark.fast

R, DT = 0.05, 1e-3  # m, s


def ball(x: tuple[float, float, float], gravity: float = GRAVITY, **options: Any) -> Any:
    """Return LAMMPS with one ball."""
    return start(grains(x, R, mass=2.0, **options), DT, gravity=gravity, vmax=4.0)


def test_a_ball_swings_in_a_cylinder_as_a_pendulum() -> None:
    """A lying cylinder, slanted in the horizontal plane; speed at the lowest point by energy, period by the sine."""
    angle, length = 0.1, 0.4
    axis = np.array([math.cos(0.3), math.sin(0.3), 0])
    across = np.array([-axis[1], axis[0], 0])
    out = math.sin(angle) * across - math.cos(angle) * np.array([0, 0, 1])
    point = np.array([0.2, -0.1, 1.0])
    lmp = ball(tuple(point + length * out))
    nscd_lmp.attach(lmp, walls=[Cylinder(point, -3 * axis, length + R)])
    x, v = (rows[:, 0] for rows in trajectory(lmp, 700))
    off = np.linalg.norm(np.cross(x - point, axis), axis=1) - length
    assert np.abs(off).max() < 1e-6  # of an arc of 4e-4 m a step, the bend is 5e-8 m
    fastest = math.sqrt(2 * GRAVITY * length * (1 - math.cos(angle)))
    assert np.abs(v @ across).max() == pytest.approx(fastest, rel=1e-3)  # second order in dt over the period
    assert np.abs(v @ axis).max() < 1e-12
    half = math.pi * math.sqrt(length / GRAVITY) * (1 + angle**2 / 16)
    turn = DT * (1 + np.flatnonzero(np.diff(np.sign(v @ across)))[0] + 0.5)
    assert turn == pytest.approx(half, abs=2 * DT)


def test_a_ball_on_a_belt_rolls_at_two_sevenths_of_its_speed() -> None:
    lmp = ball((0, 0, R))
    nscd_lmp.attach(lmp, walls=[Planes("z", 0, friction=0.3, motion=Shear("x", 0.7))])
    # slip ends after V / (7/2 mu g) = 0.068 s
    lmp.command("run 100")
    _, v = state(lmp)
    np.testing.assert_allclose(v[0], [0.2, 0, 0], rtol=0, atol=1e-7)
    # What is at the belt has its speed: v - r w = V.
    np.testing.assert_allclose(per_atom(lmp, "omega")[0], [0, -0.5 / R, 0], rtol=0, atol=1e-5)


def test_a_ball_stays_on_a_plate_that_swings_at_less_than_g() -> None:
    amplitude, period = 0.02, 0.4  # m, s: 0.5 g
    lmp = ball((0, 0, R))
    nscd_lmp.attach(lmp, walls=[Plane((0, 0, 0), (0, 0, 1), motion=[Wiggle("z", amplitude, period)])])
    lmp.command("run 50")  # time counts from attach, over all runs
    lmp.command("run 150")
    x, v = state(lmp)
    rate = 2 * math.pi / period
    # Impulses of lasting contacts act in the middle of the step: its end is off by what they differ by from its mean.
    off = amplitude * (rate * DT) ** 2
    assert x[0, 2] - R == pytest.approx(amplitude * (1 - math.cos(rate * 0.2)), abs=0.51 * off)
    assert v[0, 2] == pytest.approx(0, abs=off / DT)


def test_motion_begins_where_attach_is_called() -> None:
    """Steps before it do not count, and a wall that is attached anew begins anew."""
    lmp = ball((0, 0, R), gravity=0.0)
    wall = Plane((0, 0, 0), (0, 0, 1), motion=Wiggle("z", 0.02, 0.4))
    lmp.command("run 50")
    for top in (R + 0.04, R + 0.04):  # it pushes the ball up once, with 2 pi A / T = 0.31 m/s
        attached = nscd_lmp.attach(lmp, walls=[wall])
        lmp.command("run 100")
        x, v = state(lmp)
        assert v[0, 2] == pytest.approx(2 * math.pi * 0.02 / 0.4, rel=1e-3)
        attached.detach()
        lmp.commands_list([f"set atom 1 z {R}", "velocity all set 0 0 0"])
        assert x[0, 2] < top


def test_a_ball_that_rolls_on_a_turntable_goes_round_with_two_sevenths_of_its_rate() -> None:
    rate, v0 = 2.0, np.array([0.3, 0.0, 0.0])  # rad/s, m/s
    x0 = np.array([0.4, 0.2, R])
    # rolls: v + w x (-r n) = rate n x x
    omega = np.array([rate * x0[0] - v0[1], rate * x0[1] + v0[0], 0]) / R
    lmp = start(grains(x0, R, mass=2.0, v=v0, omega=omega), DT, gravity=GRAVITY, vmax=4.0)
    table = Planes("z", lo=0, friction="stick", motion=Rotate(2 * math.pi / rate, (0, 0, 0), (0, 0, 3)))
    nscd_lmp.attach(lmp, walls=[table])
    lmp.command("run 1500")
    _, v = state(lmp)
    turned = 2 / 7 * rate * 1.5
    np.testing.assert_allclose(v[0, :2], 0.3 * np.array([math.cos(turned), math.sin(turned)]), rtol=0, atol=1e-3)


def test_motions_of_a_wall_add_up() -> None:
    """A plate that turns about its normal, swings along it, and has a belt: the ball on its axis rolls on the belt."""
    lmp = ball((0, 0, R))
    motion = [Rotate(1e6, (0, 0, 0), (0, 0, 1)), Wiggle("z", 0.01, 0.4), Shear("y", -0.7)]
    nscd_lmp.attach(lmp, walls=[Planes("z", 0, friction="stick", motion=motion)])
    lmp.command("run 200")
    x, v = state(lmp)
    assert v[0, 1] == pytest.approx(-0.2, abs=1e-5)
    # as above, and twice that, since a ball that sticks is turned about its foot
    assert x[0, 2] - R == pytest.approx(0.02, abs=0.01 * (2 * math.pi * DT / 0.4) ** 2)


def test_walls_carry_what_rests_on_them_and_leans_on_them() -> None:
    carried = walls_scene.run()
    # the balls sink into the walls by round-off, and the last sweep corrects 1e-13 m/s
    np.testing.assert_allclose(carried, walls_scene.expected(), rtol=0, atol=1e-8)


def test_walls_carry_grains_of_all_ranks(tmp_path: Path) -> None:
    answer = tmp_path / "two.npy"
    execute(2, str(Path(walls_scene.__file__)), str(answer))
    np.testing.assert_allclose(np.load(answer), walls_scene.expected(), rtol=0, atol=1e-8)


def test_walls_carry_nothing_before_a_step_and_scenes_without_walls_have_no_row() -> None:
    lmp = ball((0, 0, R))
    attached = nscd_lmp.attach(lmp, walls=[Planes("z", 0), Planes("x", None, 7)])
    np.testing.assert_array_equal(attached.wall_forces(), np.zeros((2, 7)))
    attached.detach()
    attached = nscd_lmp.attach(lmp)
    lmp.command("run 1")
    assert attached.wall_forces().shape == (0, 7)


@pytest.mark.parametrize(
    ("wall", "message"),
    [
        (lambda: Planes("u", 0), r"Planes: across = 'u' must be 'x', 'y' or 'z'"),  # type: ignore[arg-type]
        (lambda: Planes("z", "low"), r"Planes: lo = 'low' must be a number"),  # type: ignore[arg-type]
        (lambda: Planes("z"), r"wall 1: both sides are NULL: give one of them a place"),
        (lambda: Planes("z", 1, 0), r"wall 1: lo = 1 must be below hi = 0"),
        (lambda: Cylinder((0, 0, 0), (0, 0), 1), r"Cylinder: axis = \(0, 0\) must be three numbers"),
        (lambda: Mesh(3), "Mesh: path = 3 must be the name of an STL file"),
        (lambda: Mesh("none.stl"), r"wall 1: file .none.stl. .*"),
        (lambda: Cylinder((0, 0, 0), (0, 0, 1), -1), r"wall 1: the radius -1 must be > 0"),
        (lambda: Wiggle("z", 1, 0), r"Wiggle: period = 0 s must be a finite number above 0"),
        (lambda: Rotate(1, (0, 0, 0), (0, 0, 0)), r"Rotate: axis = \(0, 0, 0\) must be a vector other than"),
        (lambda: Planes("z", 0, motion=Shear("w", 1)), r"Shear: along = 'w' must be"),  # type: ignore[arg-type]
        (lambda: Planes("z", 0, motion=3), r"Planes: motion = 3 must be nscd_lmp\.Wiggle"),  # type: ignore[arg-type]
        (lambda: Planes("z", 0, motion=[Shear("x", 1), Shear("y", 1)]), r"wall 1: shear is given twice"),
    ],
)
def test_walls_that_cannot_be_are_refused(wall: Any, message: str) -> None:
    lmp = ball((0, 0, R))
    with pytest.raises(nscd_lmp.NscdError, match=message):
        nscd_lmp.attach(lmp, walls=[wall()])


def test_scenes_reckon_with_all_kinds_of_walls() -> None:
    """`scene` makes lists for the fall to a wall, and for a wall that moves; none of them stops the run."""
    walls = [
        Cylinder((0, 0, 0.5), (1, 0, 0), 0.5, friction=0.5, motion=Rotate(0.25, (0, 0, 0.5), (1, 0, 0))),
        Planes("x", -0.2, 0.2, motion=Wiggle("x", 1e-3, 0.02)),
    ]
    places = [(0.1 * i, 0.11 * j, 0.5 + 0.1 * k) for i in (-1, 0, 1) for j in (-1, 1) for k in range(3)]
    lmp = nscd_lmp.scene(places, 0.04, density=2500, dt=DT, gravity=GRAVITY, walls=walls)
    attached = nscd_lmp.attach(lmp, friction=0.5)
    lmp.command("run 500")
    x, _ = state(lmp)
    assert (np.hypot(x[:, 1], x[:, 2] - 0.5) < 0.46 + 1e-4).all()
    assert attached.wall_forces()[0, 6] > 0
    lmp.close()
