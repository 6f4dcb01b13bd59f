# SPDX-License-Identifier: GPL-2.0-or-later
"""The two doors with friction: the same bits in x, v, omega, f, torque and contacts; what each says and hands out."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from grain_kinds import LAWS, SOLVERS
from parameters import every_two_meet
from scenes import (
    DOORS,
    FLOOR,
    GRAVITY,
    cloud,
    forces,
    grains,
    harden,
    per_atom,
    small_bed,
    state,
)

import nscd_lmp

BOTH = pytest.mark.parametrize("door", DOORS)
PLANAR = pytest.mark.parametrize("planar", [False, True], ids=["spatial", "planar"])
DT = 1e-4


def own(walls, *friction):
    """Return the walls with coefficients of their own, as far as they are given."""
    friction += (None,) * (len(walls) - len(friction))
    return [nscd_lmp.Plane(wall.point, wall.normal, friction=mu) for wall, mu in zip(walls, friction, strict=True)]


def bed(start, planar: bool):
    """Return an instance with grains that fall, with spins, into a small box; they, and its walls."""
    if not planar:
        lmp, balls, walls = small_bed(start, "f f f")
        spins = 100 * np.random.default_rng(2).normal(size=balls.x.shape)
        lmp.numpy.extract_atom("omega")[: len(balls)] = spins
        return lmp, balls, walls
    n, cell = 40, 1.02e-3
    random = np.random.default_rng(1)
    radius, number = random.uniform(0.25e-3, 0.5e-3, n), np.arange(n)
    places = (np.stack([number % 4, number // 4, 0 * number], axis=1) + 0.5) * cell * (1, 1, 0)
    play = (cell / 2 - radius)[:, None] * (1, 1, 0)
    omega = 100 * random.normal(size=(n, 3)) * (0, 0, 1)
    balls = grains(places + random.uniform(-1, 1, (n, 3)) * play, radius, omega=omega)
    box = [(-1e-4, 4.2e-3), (-1e-4, 11e-3), (0, 0)]
    lmp = start(balls, DT, gravity=GRAVITY, box=box, planar=True)
    lmp.command("fix flat all enforce2d")
    walls = [nscd_lmp.Plane((0, 0, 0), normal) for normal in ((0, 1, 0), (1, 0, 0))]
    return lmp, balls, [*walls, nscd_lmp.Plane((4.1e-3, 0, 0), (-1, 0, 0))]


def everything(lmp):
    """Return x, v, omega, f and torque, (n, 15)."""
    return np.hstack([*state(lmp), per_atom(lmp, "omega"), forces(lmp), per_atom(lmp, "torque")])


def contact_rows(lmp, attached):
    """Return the contacts of the last step from either door."""
    if attached:
        return np.array(list(attached.contacts.values())).T
    return lmp.numpy.extract_fix("nscd", 2, 2).copy()


# Pairs' friction, walls' own, e, e_t.
SCENES = [
    (0.3, (), 0.0, 0.0),
    (0.3, (0.0, "stick", 0.1), 0.0, 0.0),
    ("stick", (0.2,), 0.0, 0.0),
    (0.0, (0.5,), 0.0, 0.0),
    (0.4, (), 0.5, 0.3),
]


@every_two_meet(
    {
        "solver": SOLVERS,
        "law, planar": list(itertools.product(LAWS, (False, True))),
        "friction, walls, e, e_t": SCENES,
    }
)
def test_doors_give_the_same_bits_and_columns(start, solver, law, planar, friction, walls, e, e_t):
    ends, rows, columns = [], [], []
    for door in DOORS:
        lmp, _, planes = bed(start, planar)
        options = {"friction": friction, "restitution": e, "e_t": e_t, "walls": own(planes, *walls)}
        attached = harden(lmp, door, law=law, solver=solver, maxiter=50, unconverged="ignore", **options)
        lmp.command("run 150")
        lmp.command("run 50")  # a second run reneighbors first and starts from the kept impulses
        ends.append(everything(lmp))
        rows.append(contact_rows(lmp, attached))
        if attached:
            columns.append([attached.stats[name][-1] for name in nscd_lmp._core.REPORT_COLUMNS])
        else:
            columns.append([lmp.extract_fix("nscd", 0, 1, column) for column in range(len(columns[0]))])
    np.testing.assert_array_equal(ends[0], ends[1])
    np.testing.assert_array_equal(rows[0], rows[1])
    assert columns[0] == columns[1]
    assert rows[0].shape[1] == 13
    assert len(rows[0]) > 10 and np.abs(ends[0][:, 12:]).max() > 0


@PLANAR
@BOTH
def test_impulses_lie_in_the_cone_of_their_contact_and_add_up_to_forces_and_torques(start, door, planar):
    lmp, balls, planes = bed(start, planar)
    pairs, walls = 0.3, (0.0, 0.5, 0.1)
    attached = harden(lmp, door, friction=pairs, walls=own(planes, *walls), unconverged="ignore")
    lmp.command("run 300")
    rows = contact_rows(lmp, attached)
    tag_i, tag_j, normal, press, tangential = rows[:, 0], rows[:, 1], rows[:, 5:8], rows[:, 9], rows[:, 10:]
    coefficients = np.array([*walls, *[pairs] * (len(planes) - 3), pairs])
    mu = coefficients[np.where(tag_j < 0, -1 - tag_j, -1).astype(int)]
    # round-off of impulses of 1e-9 N s
    assert (np.linalg.norm(tangential, axis=1) <= mu * press * (1 + 1e-12) + 1e-22).all()
    assert (np.linalg.norm(tangential, axis=1) > 0).sum() > 10
    np.testing.assert_allclose((normal * tangential).sum(axis=1), 0, atol=1e-22)
    force, torque = np.zeros((2, len(balls), 3))
    for i, j, n, p, p_t in zip(tag_i.astype(int) - 1, tag_j.astype(int) - 1, normal, press, tangential, strict=True):
        for grain, sign in ((i, 1), (j, -1))[: 1 if j < 0 else 2]:
            force[grain] += sign * (p * n + p_t) / DT
            torque[grain] -= balls.radius[grain] * np.cross(n, p_t) / DT  # arm and force both turn round
    # sums of about six forces of 1e-5 N; velocities of 0.1 m/s times m / dt = 1e-2
    np.testing.assert_allclose(forces(lmp), force, rtol=0, atol=1e-17)
    np.testing.assert_allclose(per_atom(lmp, "torque"), torque, rtol=0, atol=1e-19)


@PLANAR
@BOTH
def test_friction_that_is_0_everywhere_is_the_frictionless_model_bit_for_bit(start, door, planar):
    ends = []
    for options in ({}, {"friction": 0.0}, {"friction": 0, "own": (0.0, 0.0)}):
        lmp, _, planes = bed(start, planar)
        spins = per_atom(lmp, "omega")
        walls = own(planes, *options.pop("own", ()))
        attached = harden(lmp, door, restitution=0.3, walls=walls, **options)
        lmp.command("run 200")
        ends.append(everything(lmp))
        assert contact_rows(lmp, attached).shape[1] == 10
        assert attached is None or "frictionless: 1 unknown per contact, no spins" in attached.description
        np.testing.assert_array_equal(per_atom(lmp, "omega"), spins)
    np.testing.assert_array_equal(ends[0], ends[1])
    np.testing.assert_array_equal(ends[0], ends[2])


@BOTH
def test_frictionless_scene_leaves_torques_to_other_fixes(start, door):
    lmp, _, walls = bed(start, False)
    lmp.command("fix brake all viscous/sphere 1e-12")
    harden(lmp, door, walls=walls)
    spins = per_atom(lmp, "omega")
    lmp.command("run 100")
    np.testing.assert_array_equal(per_atom(lmp, "torque"), -1e-12 * spins)


@BOTH
def test_torques_of_other_fixes_turn_grains_where_there_is_friction(start, door):
    # I dw/dt = -c w, a step forward in time: (1 - c dt / I)^n
    balls = grains((0, 0, 5.0), 0.5, mass=2.0, omega=(1.0, -2.0, 3.0))
    lmp = start(balls, 1e-3)
    lmp.command("fix brake all viscous/sphere 0.7")
    harden(lmp, door, friction=0.3)
    lmp.command("run 50")
    expected = balls.omega * (1 - 0.7 * 1e-3 / (0.4 * 2.0 * 0.5**2)) ** 50
    np.testing.assert_allclose(per_atom(lmp, "omega"), expected, rtol=1e-13)
    # of contacts, of which there are none: a rounding of I w / dt
    np.testing.assert_allclose(per_atom(lmp, "torque"), 0, atol=1e-12)


@BOTH
def test_obstacles_keep_their_spins(start, door):
    balls = grains([(0, 0, 0), (0, 0, 1.0)], 0.5, omega=[(0, 3.0, 0), (0, 0, 0)])
    lmp = start(balls, 1e-3, gravity=GRAVITY)
    lmp.command("group free id 2")
    harden(lmp, door, "free", friction=0.3, tol=1e-12)
    lmp.command("run 1")
    np.testing.assert_array_equal(per_atom(lmp, "omega")[0], (0, 3.0, 0))
    # the surface below moves along x: mu g dt, though nothing else does
    np.testing.assert_allclose(state(lmp)[1], [(0, 0, 0), (0.3 * GRAVITY * 1e-3, 0, 0)], rtol=0, atol=4e-12)


@PLANAR
@BOTH
def test_several_runs_and_a_second_instance_give_the_same_bits(start, door, planar):
    ends = []
    for pieces in ((200,), (200,), (60, 139, 1)):
        lmp, _, planes = bed(start, planar)
        harden(lmp, door, friction=0.3, walls=own(planes, "stick", 0.1))
        for number, steps in enumerate(pieces):
            lmp.command(f"run {steps}" + (" pre no" if number else ""))
        ends.append(everything(lmp))
    np.testing.assert_array_equal(ends[0], ends[1])
    np.testing.assert_array_equal(ends[0], ends[2])


@BOTH
def test_ghosts_need_no_velocities_or_spins_of_their_own(start, door):
    ends = []
    for velocities in ("yes", "no"):
        balls = cloud(64, (0.25, 0.5), 4.2)
        random = np.random.default_rng(1)
        balls.v[:], balls.omega[:] = random.normal(size=balls.x.shape), random.normal(size=balls.x.shape)
        lmp = start(balls, 1e-3, box=[(0, 4.2)] * 3, boundary="p p p", vmax=10.0)
        lmp.command(f"comm_modify vel {velocities}")
        harden(lmp, door, friction=0.3, restitution=0.5, e_t=0.5)
        lmp.command("run 300")
        ends.append(everything(lmp))
    np.testing.assert_array_equal(ends[0], ends[1])


@pytest.mark.parametrize(("keywords", "columns"), [("friction 0.3", 13), ("stick e_t 0.1", 13), ("", 10)])
def test_dump_local_has_13_columns_with_friction_and_10_without(start, tmp_path, keywords, columns):
    lmp = start(grains((0, 0, 0.5), 0.5, mass=2.0, v=(1.0, 0, 0)), 1e-3, gravity=GRAVITY, vmax=4.0)
    lmp.command(f"fix nscd all nscd {keywords} criterion paper tol 1e-12 wall plane 0 0 0 0 0 1")
    names = [f"f_nscd[{column}]" for column in range(1, columns + 1)]
    with pytest.raises(Exception, match="nscd vector is accessed out-of-range"):
        lmp.command(f"dump more all local 1 {tmp_path / 'more'} f_nscd[{columns + 1}]")
        lmp.command("run 0")
    lmp.command(f"dump c all local 1 {tmp_path / 'rows'} {' '.join(names)}")
    lmp.commands_list(["dump_modify c format float %.17g", "run 1"])
    (last,) = (tmp_path / "rows").read_text().splitlines()[-1:]
    row = [float(word) for word in last.split()]
    assert len(row) == columns
    expected = {"friction 0.3": -0.3 * GRAVITY * 1e-3, "stick e_t 0.1": -1 / 3.5}.get(keywords)
    if expected:
        assert row[10:] == pytest.approx([2.0 * expected, 0, 0], abs=1e-11)


SPATIAL, FLAT = "spatial: 3 unknowns per contact, spins of", "planar: 2 unknowns per contact, spins about z of"


@pytest.mark.parametrize(
    ("planar", "options", "said"),
    [
        (False, {}, "frictionless: 1 unknown per contact, no spins"),
        (False, {"friction": 0.3}, f"friction 0.3; {SPATIAL} spheres"),
        (False, {"friction": "stick", "e_t": 0.5}, f"friction stick; {SPATIAL} spheres"),
        (
            False,
            {"friction": 0.3, "walls": own([FLOOR, FLOOR], 0.0, "stick")},
            f"friction 0.3, 0 on wall 1, stick on wall 2; {SPATIAL} spheres",
        ),
        (True, {"friction": 0.25}, f"friction 0.25; {FLAT} discs"),
        (True, {"friction": 1.0, "inertia": "sphere"}, f"friction 1; {FLAT} spheres"),
    ],
)
@BOTH
def test_log_and_description_tell_model_and_friction(start, tmp_path, door, planar, options, said):
    lmp = start(grains((0, 0, 0.5 * (not planar)), 0.5), DT, planar=planar)
    log = tmp_path / "log"
    lmp.command(f"log {log}")
    attached = harden(lmp, door, **options)
    lmp.command("run 1")
    lmp.command("log none")
    told = attached.description if attached else log.read_text()
    assert f"; {said}; " in told
    assert ("impacts with restitution 0, tangential 0.5" in told) == ("e_t" in options)
    # what the log says stands in a line of its own
    assert attached or [line for line in told.splitlines() if line.startswith("fix nscd nscd: law gap, auto, ")]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("wall plane 0 0 0 0 0 1 friction 0.1", "friction 0, 0.1 on wall 1;"),
        ("wall plane 0 0 0 0 0 1 friction stick", "friction 0, stick on wall 1;"),
        ("wall plane 0 0 0 0 0 1 stick", "friction 0, stick on wall 1;"),
        ("wall plane 0 0 0 0 0 1 tol 1e-9 friction 0.1", "friction 0.1;"),
        ("friction 0.2 wall plane 0 0 0 0 0 1 friction 0.1", "friction 0.2, 0.1 on wall 1;"),
    ],
)
def test_friction_right_behind_a_wall_is_the_wall_s(start, tmp_path, words, said):
    lmp = start(grains((0, 0, 0.5), 0.5), DT)
    log = tmp_path / "log"
    lmp.commands_list([f"log {log}", f"fix nscd all nscd {words}", "run 1", "log none"])
    (line,) = [line for line in log.read_text().splitlines() if line.startswith("fix nscd nscd: ")]
    assert f"; {said} spatial" in line
