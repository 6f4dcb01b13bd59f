# SPDX-License-Identifier: GPL-2.0-or-later
"""fix wall/nscd: closed forms of curved walls and of walls that move, by its own words and by regions of LAMMPS.

Regions of every kind are in test_wall_regions.py, what a wall carries in test_wall_output.py, groups, restarts and
other changes in test_wall_scenes.py, the promise on overlap in test_wall_overlap.py, bad input in test_wall_errors.py.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scenes import GRAVITY, grains, per_atom, state
from walled import ANGLE, CONTACTS, EXACT, FORCE, RATE, SHIFT, VELOCITY, height, numbers, series, walled

pytestmark = pytest.mark.fast

R, MASS = 0.1, 2.0
WEIGHT = MASS * GRAVITY


def period(places, dt):
    """Return the period of an oscillation about 0, from its downward passages, which are interpolated."""
    falls = np.flatnonzero((places[:-1] > 0) & (places[1:] <= 0))
    at = falls + places[falls] / (places[falls] - places[falls + 1])
    return (at[-1] - at[0]) / (len(at) - 1) * dt


CYLINDERS = ["ycylinder 1", "cylinder 0 5 0 0 -2 0 1", "region c"]


@pytest.mark.parametrize("rolls", [False, True])
@pytest.mark.parametrize("wall", CYLINDERS)
def test_a_ball_swings_in_a_cylinder_as_a_pendulum(wall, rolls):
    """Of length L = R - r, and of 7/5 of its inertia if it rolls; 1 + theta^2/16 is what a finite swing adds."""
    length, angle, dt = 1 - R, 0.1, 2e-3
    ball = grains([length * math.sin(angle), 0, -length * math.cos(angle)], R, MASS)
    lmp = walled(ball, "region c cylinder y 0 0 1 INF INF", f"fix hard all nscd {EXACT}", dt=dt)
    lmp.command(f"fix w all wall/nscd {wall}" + " stick" * rolls)
    x = series(lmp, 3000, lambda lmp: state(lmp)[0][0], every=4)
    expected = 2 * math.pi * math.sqrt((1.4 if rolls else 1) * length / GRAVITY) * (1 + angle**2 / 16)
    assert period(x[:, 0], 4 * dt) == pytest.approx(expected, rel=2e-4)  # of second order in dt
    assert np.hypot(x[:, 0], x[:, 2]).max() < length * (1 + 1e-5)
    lmp.close()


@pytest.mark.parametrize("direction", [(1, 0), (0.6, 0.8)])
@pytest.mark.parametrize("rolls", [False, True])
def test_a_ball_swings_in_a_bowl_in_any_direction(direction, rolls):
    length, angle, dt = 1 - R, 0.1, 2e-3
    out = length * math.sin(angle)
    ball = grains([out * direction[0], out * direction[1], -length * math.cos(angle)], R, MASS)
    lmp = walled(ball, "region s sphere 0 0 0 1", f"fix hard all nscd {EXACT}", dt=dt)
    lmp.command("fix w all wall/nscd region s" + " friction 5" * rolls)
    x = series(lmp, 3000, lambda lmp: state(lmp)[0][0], every=4)
    along, across = x[:, :2] @ direction, x[:, :2] @ (-direction[1], direction[0])
    expected = 2 * math.pi * math.sqrt((1.4 if rolls else 1) * length / GRAVITY) * (1 + angle**2 / 16)
    assert period(along, 4 * dt) == pytest.approx(expected, rel=2e-4)
    assert np.abs(across).max() < 1e-6 * out
    lmp.close()


# A plate whose place is A (1 - cos w t), as LAMMPS' wiggle has it, by the fix, by its variables and by a region's.
RATE_OF_PLATE = 10.0  # rad/s
PLATES = {
    "wiggle": ("zplane 0 NULL wiggle z {a} {period}",),
    "move": ("zplane 0 NULL move NULL NULL v_z",),
    "region": ("region plate",),
}


def plate(kind, gamma, dt):
    amplitude = gamma * GRAVITY / RATE_OF_PLATE**2
    lmp = walled(grains([0, 0, R], R, MASS), f"variable z equal {amplitude!r}*(1-cos({RATE_OF_PLATE}*step*dt))", dt=dt)
    lmp.command("region plate plane 0 0 0 0 0 1 move NULL NULL v_z")
    words = PLATES[kind][0].format(a=repr(amplitude), period=repr(2 * math.pi / RATE_OF_PLATE))
    lmp.commands_list([f"fix hard all nscd {EXACT}", f"fix w all wall/nscd {words}"])
    return lmp, amplitude


@pytest.mark.parametrize("kind", PLATES)
def test_a_plate_that_shakes_gently_keeps_its_ball(kind):
    """Gamma = 0.9: it pushes the ball with m (g + A w^2 cos w t) and never loses it."""
    dt, w = 1e-3, RATE_OF_PLATE
    lmp, amplitude = plate(kind, 0.9, dt)
    told = series(lmp, 1300, lambda lmp: [height(lmp), *numbers(lmp, 0, 15)])
    time = dt * np.arange(1, 1301)
    pushes, place = told[:, 1 + FORCE + 2], amplitude * (1 - np.cos(w * time))
    assert (told[:, 1 + CONTACTS] == 1).all() and (pushes < 0).all()
    expected = WEIGHT + MASS * amplitude * w * w * np.cos(w * (time - dt))
    # behind the jolt that it begins with
    np.testing.assert_allclose(-pushes[1:], expected[1:], atol=2e-2 * WEIGHT)
    np.testing.assert_allclose(told[:, 0], R + place, atol=amplitude * w * w * dt * dt)
    np.testing.assert_allclose(told[:, 1 + SHIFT + 2], place, atol=1e-12)
    mean_velocity = np.diff(place, prepend=0.0) / dt
    np.testing.assert_allclose(told[:, 1 + VELOCITY + 2], mean_velocity, atol=1e-9)
    lmp.close()


@pytest.mark.parametrize("kind", PLATES)
@pytest.mark.parametrize("dt", [1e-3, 2.5e-4])
def test_a_plate_that_shakes_hard_throws_its_ball(kind, dt):
    """Gamma = 2: it leaves where the plate falls as fast as it does, and lands where its parabola meets the plate."""
    w = RATE_OF_PLATE
    lmp, amplitude = plate(kind, 2.0, dt)
    leaves = math.acos(-0.5) / w
    up, start = amplitude * w * math.sin(w * leaves), amplitude * (1 - math.cos(w * leaves))
    t = np.arange(leaves + 0.05, 1.0, 1e-5)
    above = start + up * (t - leaves) - 0.5 * GRAVITY * (t - leaves) ** 2 - amplitude * (1 - np.cos(w * t))
    lands = t[np.flatnonzero(above <= 0)[0]]
    pushed = series(lmp, round(1.1 * lands / dt), lambda lmp: numbers(lmp, CONTACTS, 1)[0]) > 0
    left = np.flatnonzero(~pushed)[0]
    landed = left + np.flatnonzero(pushed[left:])[0]
    assert (left + 0.5) * dt == pytest.approx(leaves, abs=1.1 * dt)
    assert (landed + 0.5) * dt == pytest.approx(lands, abs=2 * dt)
    lmp.close()


BELTS = ["plane 0 0 0 0 0 3", "zplane 0 NULL", "region floor"]


@pytest.mark.parametrize("wall", BELTS)
@pytest.mark.parametrize("mu", [0.1, 0.4])
def test_a_belt_drags_a_ball_and_leaves_it_at_two_sevenths(wall, mu):
    speed, dt = 0.5, 1e-3
    slips = 2 * speed / (7 * mu * GRAVITY)
    lmp = walled(grains([0, 0, R], R, MASS), "region floor plane 0 0 0 0 0 1", f"fix hard all nscd {EXACT}", dt=dt)
    lmp.command(f"fix w all wall/nscd {wall} friction {mu} shear y {speed}")
    steps = int(slips / dt)
    lmp.command(f"run {steps}")
    assert state(lmp)[1][0, 1] == pytest.approx(mu * GRAVITY * steps * dt, rel=1e-9)
    assert numbers(lmp, VELOCITY) == pytest.approx([0, speed, 0]) and numbers(lmp, SHIFT) == pytest.approx([0, 0, 0])
    assert numbers(lmp, FORCE) == pytest.approx([0, -mu * WEIGHT, -WEIGHT], rel=1e-9)
    lmp.command("run 500")
    assert state(lmp)[1][0] == pytest.approx([0, 2 * speed / 7, 0], abs=1e-9)
    lmp.close()


TURNTABLES = [
    "plane 0 0 0 0 0 1 rotate {period} 0 0 0 0 0 1",
    "plane 0 0 0 0 0 1 rotate v_theta 0 0 0 0 0 1",
    "region table",
]


@pytest.mark.parametrize("wall", TURNTABLES)
def test_a_ball_circles_on_a_turntable_with_two_sevenths_of_its_speed(wall):
    omega, speed, dt = 2.0, 0.3, 1e-3
    slow = 2 / 7 * omega
    # it rolls from the start: the surface runs with omega x r there
    ball = grains([1, 0, R], R, MASS, v=[0, speed, 0], omega=[(omega - speed) / R, 0, 0])
    lmp = walled(ball, f"variable theta equal {omega}*step*dt", f"fix hard all nscd {EXACT}", dt=dt)
    lmp.command("region table plane 0 0 0 0 0 1 rotate v_theta 0 0 0 0 0 1")
    lmp.command(f"fix w all wall/nscd {wall.format(period=repr(2 * math.pi / omega))} stick")
    steps = 10 * round(0.2 * math.pi / slow / dt)
    x = series(lmp, steps, lambda lmp: state(lmp)[0][0], every=10)
    centre = np.array([1 - speed / slow, 0])
    radii = np.linalg.norm(x[:, :2] - centre, axis=1)
    np.testing.assert_allclose(radii, speed / slow, rtol=2e-3)  # of first order in dt
    np.testing.assert_allclose(x[-1, :2], [1, 0], atol=5e-3)
    assert numbers(lmp, RATE, 1)[0] == pytest.approx(omega, rel=1e-9)
    assert numbers(lmp, ANGLE, 1)[0] == pytest.approx(omega * steps * dt, rel=1e-9)
    lmp.close()


DRUMS = ["ycylinder 1 rotate {period} 0 0 0 0 1 0", "region drum", "ycylinder 1 rotate v_theta 0 0 0 0 1 0"]


@pytest.mark.parametrize("wall", DRUMS)
def test_a_ball_spins_at_the_bottom_of_a_turning_drum(wall):
    """As the drum's surface runs there: it neither slips nor climbs. One that starts without spin gets there."""
    omega, dt = 2.0, 1e-3
    lmp = walled(
        grains([0, 0, -1 + R], R, MASS, omega=[0, omega / R, 0]), f"variable theta equal {omega}*step*dt", dt=dt
    )
    lmp.command("region drum cylinder y 0 0 1 INF INF rotate v_theta 0 0 0 0 1 0")
    lmp.command(f"fix hard all nscd {EXACT}")
    lmp.command(f"fix w all wall/nscd {wall.format(period=repr(2 * math.pi / omega))} friction 0.5")
    lmp.command("run 1000")
    x, v = state(lmp)
    assert np.abs(x[0] - (0, 0, -1 + R)).max() < 1e-6 and np.abs(v).max() < 1e-5
    assert per_atom(lmp, "omega")[0] == pytest.approx([0, omega / R, 0], abs=1e-5)
    assert lmp.extract_fix("hard", 0, 1, 9) < 1e-8
    lmp.close()


@pytest.mark.parametrize(("degrees", "rolls"), [(20, True), (60, False)])
@pytest.mark.parametrize("kind", ["plane", "region"])
def test_a_ball_rolls_or_slides_down_a_tilted_plane(kind, degrees, rolls):
    """It rolls up to tan = 7/2 mu, with 5/7 g sin; beyond it slides with g (sin - mu cos)."""
    mu, slope = 0.3, math.radians(degrees)
    assert rolls == (math.tan(slope) < 3.5 * mu)
    normal = np.array([math.sin(slope), 0, math.cos(slope)])
    words = "0 0 0 " + " ".join(repr(float(n)) for n in normal)
    lmp = walled(grains(R * normal, R, MASS), f"region hill plane {words}", f"fix hard all nscd {EXACT}")
    lmp.command("fix w all wall/nscd " + {"plane": f"plane {words}", "region": "region hill"}[kind] + f" friction {mu}")
    lmp.command("run 200")
    along = state(lmp)[1][0] @ (math.cos(slope), 0, -math.sin(slope))
    fall = math.sin(slope) * 5 / 7 if rolls else math.sin(slope) - mu * math.cos(slope)
    assert along == pytest.approx(fall * GRAVITY * 0.2, rel=1e-6)
    lmp.close()


@pytest.mark.parametrize("e", [0, 0.5, 1])
@pytest.mark.parametrize("wall", ["zplane 0 NULL", "region floor", "region bowl"])
def test_a_wall_has_its_own_restitution(wall, e):
    lmp = walled(grains([0, 0, 0.5], R, MASS, v=[0, 0, -1]), "region floor plane 0 0 0 0 0 1", gravity=(0, 0, 0))
    lmp.commands_list(["region bowl sphere 0 0 2 2", f"fix hard all nscd {EXACT}"])
    lmp.command(f"fix w all wall/nscd {wall} restitution {e}")
    lmp.command("run 800")
    assert state(lmp)[1][0] == pytest.approx([0, 0, e], abs=1e-9)
    lmp.close()


def test_friction_of_a_wall_alone_gives_grains_spins():
    """The fix nscd before it has none."""
    lmp = walled(
        grains([0, 0, R], R, MASS, v=[1, 0, 0]), f"fix hard all nscd {EXACT}", "fix w all wall/nscd zplane 0 1 stick"
    )
    lmp.command("run 10")
    assert state(lmp)[1][0, 0] == pytest.approx(5 / 7)
    assert per_atom(lmp, "omega")[0, 1] == pytest.approx(5 / 7 / R)
    lmp.close()
