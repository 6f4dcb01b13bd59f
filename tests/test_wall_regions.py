# SPDX-License-Identifier: GPL-2.0-or-later
"""fix wall/nscd with regions of LAMMPS: gaps and normals of every shape, parts that move, and sides that are open."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from scenes import GRAVITY, grains, per_atom, state
from walled import ANGLE, EXACT, FORCE, RATE, SHIFT, VELOCITY, height, numbers, series, walled

from nscd_lmp import _core

pytestmark = pytest.mark.fast

PROBE, PROBES = 0.35, 1500
SPHERE = "region a sphere -0.3 0 0 0.8"
BLOCK = "region b block 0 1 -0.4 0.4 -0.4 0.4"
SHAPES = {
    "block": ["region r block -1 1 -1 1 -1 1"],
    "block, some faces at infinity": ["region r block -1 INF EDGE 1 INF 0.5"],
    "block, one face open": ["region r block -1 1 -1 1 -1 1 open 6"],
    "block, outside": ["region r block -0.5 0.5 -0.5 0.5 -0.5 0.5 side out"],
    "sphere": ["region r sphere 0 0 0 1"],
    "sphere, outside": ["region r sphere 0 0 0 0.8 side out"],
    "cylinder": ["region r cylinder z 0.1 0 1 -0.7 0.8"],
    "cylinder, outside": ["region r cylinder x 0.1 0 0.7 -0.7 0.8 side out"],
    "cylinder, open at an end": ["region r cylinder y 0 0 1 -0.7 0.8 open 2"],
    "cone along z": ["region r cone z 0 0 0.3 1.2 -0.7 0.8"],
    "cone along x": ["region r cone x 0 0 1.2 0.3 -0.7 0.8"],
    "cone along y, open at both ends": ["region r cone y 0 0 0.3 1.2 -0.7 0.8 open 1 open 2"],
    "cone, outside": ["region r cone z 0 0 0.3 1.2 -0.7 0.8 side out"],
    "prism": ["region r prism -1 1 -1 1 -1 1 0.4 0.2 -0.3"],
    "prism, outside": ["region r prism -0.6 0.6 -0.6 0.6 -0.6 0.6 0.4 0.2 -0.3 side out"],
    "plane": ["region r plane 0.1 0 0 1 2 3"],
    "union": [SPHERE, BLOCK, "region r union 2 a b"],
    "intersection": [SPHERE, "region b block -0.2 1 -0.6 0.6 -0.6 0.6", "region r intersect 2 a b"],
    "intersection, outside": [SPHERE, "region b block -0.2 1 -0.6 0.6 -0.6 0.6", "region r intersect 2 a b side out"],
    "block with a hole": [
        *("region a block -1 1 -1 1 -1 1", "region b sphere 0 0 0 0.5 side out"),
        "region r intersect 2 a b",
    ],
    "intersection with a union": [
        "region a block -1 1 -1 1 -1 1",
        "region b sphere 0 0 0 0.5 side out",
        "region c cylinder z 0 0 0.3 -2 2",
        "region d union 2 b c",
        "region r intersect 2 a d",
    ],
    "pipe in a block, as an intersection": [
        *("region a block -1 1 -1 1 -1 1", "region b cylinder z 0 0 0.5 -0.6 0.6 open 1 open 2"),
        "region r intersect 2 a b",
    ],
    "pipe in a block, as a union": [
        *("region a block -1 1 -1 1 -1 1", "region b cylinder z 0 0 0.5 -0.6 0.6 open 1 open 2"),
        "region r union 2 a b",
    ],
    "hopper of two open parts": [
        *("region a cone z 0 0 0.2 1 -1 0 open 1 open 2", "region b cylinder z 0 0 1 0 1 open 1 open 2"),
        "region r union 2 a b",
    ],
    "union of parts that have turned and moved": [
        *("variable turn equal 0.7", "variable way equal 0.2"),
        "region a sphere -0.3 0 0 0.8 move NULL v_way NULL",
        "region b block 0 1 -0.4 0.4 -0.4 0.4 rotate v_turn 0 0 0 1 1 0",
        "region r union 2 a b",
    ],
    "block that has turned and moved": [
        "variable turn equal 0.7",
        "variable way equal 0.2",
        "region r block -1 1 -0.6 0.6 -1 1 rotate v_turn 0.3 0 0 1 1 0 move v_way NULL NULL",
    ],
}  # fmt: skip


def probes():
    """Return grains without mass to speak of anywhere, which do not touch each other."""
    return grains(np.random.default_rng(3).uniform(-1.6, 1.6, (PROBES, 3)), PROBE, 1.0)


def probed(*region, integrator):
    """Return LAMMPS with the probes whose centres are in region r, as group inside, and an integrator."""
    lmp = walled(probes(), "neigh_modify exclude group all all", *region, "group inside region r", gravity=(0, 0, 0))
    lmp.commands_list(integrator)
    return lmp


def springs(*region):
    """Return what LAMMPS' own wall of springs presses each probe by, over its stiffness: (n, 3), m."""
    wall = f"fix w inside wall/region r harmonic 0.5 1.0 {PROBE}"  # 2 epsilon is the stiffness
    lmp = probed(*region, integrator=[wall, "fix move all nve/sphere", "run 0"])
    pressed = per_atom(lmp, "f")
    lmp.close()
    return pressed


def overlaps(*region):
    """Return the same of fix wall/nscd, by the rows of its contacts: the sum of overlap times normal."""
    lmp = probed(*region, integrator=["fix hard inside nscd", "fix w inside wall/nscd region r", "run 1"])
    rows = np.array(lmp.numpy.extract_fix("hard", 2, 2))
    lmp.close()
    column = {name: k for k, name in enumerate(_core.CONTACT_COLUMNS)}
    normals = rows[:, [column[name] for name in ("nx", "ny", "nz")]]
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, rtol=1e-12)
    pressed = np.zeros((PROBES, 3))
    np.add.at(
        pressed, rows[:, column["tag_i"]].astype(int) - 1, np.maximum(0, -rows[:, column["gap"]])[:, None] * normals
    )
    return pressed


@pytest.mark.overlaps_not_asked("probes pass through each other")
@pytest.mark.parametrize("shape", SHAPES)
def test_gaps_and_normals_are_those_of_lammps_own_wall(shape):
    """At hundreds of random places, those near several faces and near rims among them."""
    theirs, ours = springs(*SHAPES[shape]), overlaps(*SHAPES[shape])
    assert (np.linalg.norm(theirs, axis=1) > 0).sum() > 20
    np.testing.assert_allclose(ours, theirs, atol=1e-14)


@pytest.mark.overlaps_not_asked("probes pass through each other")
def test_outside_of_a_union_is_met_although_lammps_own_wall_is_wrong_there():
    """LAMMPS overwrites the distance there (region_union.cpp); the reference is numpy's."""
    x = probes().x
    from_ball = x - (-0.3, 0, 0)
    away = np.linalg.norm(from_ball, axis=1)
    low, high = np.array([0, -0.4, -0.4]), np.array([1, 0.4, 0.4])
    on_block = np.clip(x, low, high)
    from_block = x - on_block
    far = np.linalg.norm(from_block, axis=1)
    outside = (away > 0.8) & (far > 0)
    on_ball = x - from_ball * (1 - 0.8 / away)[:, None]
    expected = np.zeros_like(x)
    seen = outside & (away - 0.8 < PROBE) & ~((on_ball > low) & (on_ball < high)).all(axis=1)
    expected[seen] += (from_ball * ((PROBE - away + 0.8) / away)[:, None])[seen]
    seen = outside & (far < PROBE) & (np.linalg.norm(on_block - (-0.3, 0, 0), axis=1) > 0.8)
    expected[seen] += (from_block * ((PROBE - far) / np.maximum(far, 1e-9))[:, None])[seen]
    assert (np.linalg.norm(expected, axis=1) > 0).sum() > 100
    np.testing.assert_allclose(overlaps(SPHERE, BLOCK, "region r union 2 a b side out"), expected, atol=1e-12)


R, MASS = 0.1, 2.0


def test_only_the_part_of_a_union_that_moves_moves_grains():
    """A piston in a union with a floor: one ball rests on the floor, the other rides on the piston."""
    lmp = walled(grains([[-1, 0, R], [1, 0, 0.5 + R]], R, MASS), "variable up equal 0.3*step*dt")
    lmp.commands_list(
        [
            *("region floor block -2 2 -1 1 -1 0", "region piston block 0.5 1.5 -1 1 -0.5 0.5 move NULL NULL v_up"),
            *("region both union 2 floor piston side out", f"fix hard all nscd {EXACT}"),
            *("fix w all wall/nscd region both", "run 500"),
        ]
    )
    x, v = state(lmp)
    np.testing.assert_allclose(x, [[-1, 0, R], [1, 0, 0.5 + R + 0.15]], atol=1e-9)
    np.testing.assert_allclose(v, [[0, 0, 0], [0, 0, 0.3]], atol=1e-9)
    assert numbers(lmp, SHIFT) == pytest.approx([0, 0, 0.15]) and numbers(lmp, VELOCITY) == pytest.approx([0, 0, 0.3])
    assert numbers(lmp, FORCE) == pytest.approx([0, 0, -2 * MASS * GRAVITY], rel=1e-9)
    lmp.close()


def test_only_the_part_of_an_intersection_that_moves_moves_grains():
    """A box with a lid that comes down on a ball in zero gravity; the floor stands."""
    lmp = walled(grains([[0, 0, 0]], R, MASS), "variable down equal -0.5*step*dt", gravity=(0, 0, 0))
    lmp.commands_list(
        [
            *("region low block -1 1 -1 1 -1 2", "region lid plane 0 0 0.2 0 0 -1 move NULL NULL v_down"),
            *("region r intersect 2 low lid", f"fix hard all nscd {EXACT}", "fix w all wall/nscd region r", "run 1000"),
        ]
    )
    assert state(lmp)[0][0, 2] == pytest.approx(0.2 - 0.5 - R, abs=1e-9)
    assert state(lmp)[1][0, 2] == pytest.approx(-0.5, abs=1e-9)
    lmp.close()


def test_a_region_that_turns_and_moves_carries_its_ball():
    """A flat cylinder about x, turned and shifted evenly, with the ball stuck to its inside in zero gravity."""
    omega, speed = 1.5, 0.4
    ball = grains([0, 0, -1 + R], R, MASS, v=[speed, omega * (1 - R), 0], omega=[omega, 0, 0])
    lmp = walled(ball, f"variable t equal {omega}*step*dt", f"variable s equal {speed}*step*dt", gravity=(0, 0, 0))
    lmp.command("region r cylinder x 0 0 1 -1 1 rotate v_t 0 0 0 1 0 0 move v_s NULL NULL")
    lmp.commands_list(["fix hard all nscd", "fix w all wall/nscd region r stick"])
    x = series(lmp, 1000, lambda lmp: state(lmp)[0][0], every=50)
    time = 0.05 * np.arange(1, 21)
    expected = np.stack([speed * time, (1 - R) * np.sin(omega * time), -(1 - R) * np.cos(omega * time)], axis=1)
    np.testing.assert_allclose(x, expected, atol=2e-3 * (1 - R))  # of first order in the step
    assert numbers(lmp, ANGLE, 1)[0] == pytest.approx(omega) and numbers(lmp, RATE, 1)[0] == pytest.approx(omega)
    lmp.close()


def test_grains_leave_a_cylinder_by_its_open_end_and_cannot_come_back_in_through_its_wall():
    lmp = walled(grains([[0, 0, 0.3], [0, 1 + 2 * R, 0.3]], R, MASS, v=[[0, 0, -3], [0, -1, 0]]), gravity=(0, 0, 0))
    lmp.commands_list(["region pipe cylinder z 0 0 1 0 1 open 1 open 3", f"fix hard all nscd {EXACT} restitution 1"])
    lmp.commands_list(["fix w all wall/nscd region pipe", "run 300"])
    x, v = state(lmp)
    assert x[0, 2] == pytest.approx(0.3 - 0.9) and v[1] == pytest.approx([0, -1, 0])  # open 3: the curved side
    lmp.command("region pipe delete")
    lmp.commands_list(["region pipe cylinder z 0 0 0.6 0 1 open 1 open 2", "run 300"])
    assert state(lmp)[1][1] == pytest.approx([0, 1, 0], abs=1e-9)
    lmp.close()


def test_a_funnel_lets_grains_through():
    """A cone with open ends: none is stuck in its wall, all come out below."""
    x = np.array([[0.25 * i, 0.25 * j, 0.9] for i in (-1, 0, 1) for j in (-1, 0, 1)])
    lmp = walled(grains(x, R, MASS), "region funnel cone z 0 0 0.35 1 0 1 open 1 open 2", dt=2e-3, box=4.0)
    lmp.commands_list(
        ["fix hard all nscd", "fix w all wall/nscd region funnel", "fix floor all wall/nscd zplane -3 NULL"]
    )
    largest = series(lmp, 1000, lambda lmp: lmp.extract_fix("hard", 0, 1, 9), every=10)
    assert largest.max() < 5e-4
    assert (state(lmp)[0][:, 2] < -1).all()
    lmp.close()


@pytest.mark.overlaps_not_asked("the rim is no wall to LAMMPS")
def test_a_grain_falls_through_a_hole_that_is_too_small_and_the_run_tells(tmp_path):
    """A rim between two parts of a region has no surface: a limit of regions, which docs/wall_nscd.md names."""
    lmp = walled(grains([0.05, 0, 0.15], R, MASS), "region plate plane 0 0 0 0 0 1", "fix hard all nscd")
    lmp.commands_list(["region hole cylinder z 0 0 0.08 -2 0.5", "region r union 2 plate hole"])
    lmp.commands_list(["fix w all wall/nscd region r", f"log {tmp_path}/log", "run 300", "log none"])
    assert height(lmp) < -0.2
    assert re.search(
        r"WARNING: Fix nscd hard: grains overlap by up to 0\.\d+ of the smaller radius", (tmp_path / "log").read_text()
    )
    lmp.close()


def test_in_a_plane_the_faces_of_a_block_across_z_are_none():
    ball = grains([0, -1 + R, 0], R, MASS, v=[0.5, 0, 0])
    lmp = walled(ball, "region r block -1 1 -1 1 -0.05 0.05", gravity=(0, -GRAVITY, 0), boundary="f f p", dimension=2)
    lmp.commands_list(
        ["fix flat all enforce2d", "fix hard all nscd friction 0.5", "fix w all wall/nscd region r", "run 200"]
    )
    x, v = state(lmp)
    assert x[0, 1:] == pytest.approx([-1 + R, 0], abs=1e-9)
    assert v[0] == pytest.approx([0.5 / 1.5, 0, 0], rel=1e-3)  # a disc: 1/2 m r^2
    assert numbers(lmp, FORCE) == pytest.approx([0, -MASS * GRAVITY, 0], rel=1e-3, abs=1e-9)
    lmp.close()


def test_a_prism_holds_a_ball_in_its_slanted_corner():
    """Without friction the forces of floor and slanted side are those of statics."""
    lmp = walled(grains([0, 0, 0], R, MASS), "region r prism -1 1 -1 1 -1 1 0 0.8 0", gravity=(-3, 0, -GRAVITY))
    lmp.commands_list([f"fix hard all nscd {EXACT} friction 0", "fix w all wall/nscd region r", "run 3000"])
    x, v = state(lmp)
    assert np.abs(v).max() < 1e-9 and height(lmp) == pytest.approx(-1 + R, abs=1e-6)
    assert numbers(lmp, FORCE) == pytest.approx([-3 * MASS, 0, -GRAVITY * MASS], rel=1e-6, abs=1e-9)
    # the side x = -1 slants by 0.8 over the height 2
    from_side = (x[0, 0] + 1 - 0.4 * (x[0, 2] + 1)) * math.cos(math.atan(0.4))
    assert from_side == pytest.approx(R, abs=1e-6)
    lmp.close()
