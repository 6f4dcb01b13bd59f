# SPDX-License-Identifier: GPL-2.0-or-later
"""What a fix wall/nscd tells: forces, torques and contacts of its grains, its motion, and rows by atom."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scenes import GRAVITY, cloud, grains, per_atom, state
from walled import ANGLE, CONTACTS, EXACT, FORCE, RATE, SHIFT, TORQUE, VELOCITY, numbers, walled

pytestmark = pytest.mark.fast

R, MASS = 0.1, 2.0
ROWS = ("touches", "fx", "fy", "fz", "x", "y", "z", "radius")  # as fix wall/gran has them


def bed(count=60, seed=1):
    """Return grains of two sizes above the floor of a box of 1 x 1."""
    balls = cloud(count, (0.06, 0.11), 1.0, seed, loose=1.001)
    balls.x[:, :2] -= 0.5
    return balls


BOXES = {
    "slabs": [
        *("fix w1 all wall/nscd xplane -0.5 0.5", "fix w2 all wall/nscd yplane -0.5 0.5"),
        "fix w3 all wall/nscd zplane 0 NULL",
    ],
    "region": ["region r block -0.5 0.5 -0.5 0.5 0 5", "fix w1 all wall/nscd region r"],
    "cylinder": ["fix w1 all wall/nscd zcylinder 0.71", "fix w2 all wall/nscd plane 0 0 0 0 0 1"],
    "bowl": ["region r sphere 0 0 2 2", "fix w1 all wall/nscd region r"],
}  # fmt: skip


@pytest.mark.parametrize("walls", BOXES)
@pytest.mark.parametrize("mu", [0, 0.5])
def test_walls_carry_the_weight_of_a_bed_at_rest(walls, mu):
    """All together: M g down, no force sideways, and the torque of the weight."""
    balls = bed(25)
    balls.x[:, 2] += 0.2  # the bowl is as high as that at the rim of the bed
    lmp = walled(balls, f"fix hard all nscd friction {mu} tol 1e-7", *BOXES[walls], dt=2e-3, box=5.0)
    names = [line.split()[1] for line in BOXES[walls] if line.startswith("fix")]
    lmp.commands_list(["fix brake all viscous 20", "run 6000"])
    x = state(lmp)[0]
    weight = balls.mass.sum() * GRAVITY
    force = sum(numbers(lmp, FORCE, 3, name) for name in names)
    torque = sum(numbers(lmp, TORQUE, 3, name) for name in names)
    np.testing.assert_allclose(force, [0, 0, -weight], atol=1e-6 * weight)
    of_weight = np.cross(x, np.outer(balls.mass, (0, 0, -GRAVITY))).sum(axis=0)
    np.testing.assert_allclose(torque, of_weight, atol=1e-5 * weight)
    lmp.close()


@pytest.mark.parametrize("wall", ["zplane 0 NULL shear x 0.5", "region r", "ycylinder 3"])
def test_rows_by_atom_add_up_to_the_force_on_the_wall(wall):
    balls = bed(30)
    if wall == "ycylinder 3":
        balls.x[:, 2] -= 2.8
    lmp = walled(balls, "region r block -0.5 0.5 -0.5 0.5 0 5", "fix hard all nscd friction 0.5", dt=2e-3, box=5.0)
    lmp.commands_list([f"fix w all wall/nscd {wall} contacts", "run 300"])
    rows = lmp.numpy.extract_fix("w", 1, 2)[: len(balls)]
    order = np.argsort(lmp.numpy.extract_atom("id")[: len(balls)])
    row = dict(zip(ROWS, np.array(rows)[order].T, strict=True))
    touches = row["touches"] == 1
    assert touches.any() and set(row["touches"]) <= {0, 1}
    total = [row[name].sum() for name in ("fx", "fy", "fz")]
    np.testing.assert_allclose(total, -numbers(lmp, FORCE), rtol=1e-12, atol=1e-12)
    assert (row["radius"][touches] == balls.radius[touches]).all() and (row["radius"][~touches] == 0).all()
    from_centre = np.stack([row[name] for name in "xyz"], axis=1) - state(lmp)[0]
    np.testing.assert_allclose(np.linalg.norm(from_centre, axis=1)[touches], balls.radius[touches], rtol=1e-3)
    if wall != "region r":
        assert touches.sum() == numbers(lmp, CONTACTS, 1)[0]
    lmp.close()


def test_rows_by_atom_can_be_dumped_and_reduced(tmp_path):
    lmp = walled(bed(30), "fix hard all nscd", "fix w all wall/nscd zplane 0 NULL contacts", dt=2e-3)
    lmp.commands_list(["compute up all reduce sum f_w[4]", "compute touch all reduce sum f_w[1]"])
    lmp.commands_list(["thermo_style custom step f_w[3] f_w[7] c_up c_touch", "thermo 10"])
    lmp.commands_list([f"dump d all custom 100 {tmp_path}/rows id f_w[*]", "run 200"])
    assert lmp.extract_compute("up", 0, 0) == pytest.approx(-numbers(lmp, FORCE)[2], rel=1e-12)
    assert lmp.extract_compute("touch", 0, 0) == numbers(lmp, CONTACTS, 1)[0]
    last = np.loadtxt((tmp_path / "rows").read_text().split("ITEM: ATOMS")[-1].split("\n")[1:])
    assert last[:, 4].sum() == pytest.approx(-numbers(lmp, FORCE)[2], rel=1e-4)
    lmp.close()


def test_a_ball_that_touches_twice_has_the_place_of_the_stronger_contact_and_the_sum_of_forces():
    """In a gutter of two planes of 30 and 60 degrees; statics gives both forces."""
    low, high = math.radians(30), math.radians(60)
    lmp = walled(grains([0, 0, 2 * R], R, MASS), f"fix hard all nscd {EXACT}")
    for plane, slope in (("a", low), ("b", -high)):
        lmp.command(f"region {plane} plane 0 0 0 {-math.sin(slope)!r} 0 {math.cos(slope)!r}")
    lmp.commands_list(["region r intersect 2 a b", "fix w all wall/nscd region r contacts", "run 1000"])
    row = lmp.numpy.extract_fix("w", 1, 2)[0]
    assert numbers(lmp, CONTACTS, 1)[0] == 2 and row[0] == 1
    assert row[1:4] == pytest.approx([0, 0, MASS * GRAVITY], abs=1e-6)
    normal = np.array([-math.sin(low), 0, math.cos(low)])
    assert row[4:7] == pytest.approx(state(lmp)[0][0] - R * normal, abs=1e-9)
    lmp.close()


def test_torque_is_about_the_point_of_the_rotation():
    """A ball on a lever that is held level for a moment: m g times the arm."""
    lmp = walled(grains([0.7, 0, R], R, MASS), "fix hard all nscd", dt=1e-4)
    lmp.command("fix about_origin all wall/nscd plane 0 0 0 0 0 1")
    lmp.command("run 1")
    assert numbers(lmp, TORQUE, 3, "about_origin") == pytest.approx([0, 0.7 * MASS * GRAVITY, 0], rel=1e-6)
    lmp.commands_list(["unfix about_origin", "variable t equal 0", "variable s equal 1e-9*step"])
    lmp.commands_list(["fix w all wall/nscd plane 0 0 0 0 0 1 rotate v_t 0.5 0 0 0 1 0", "run 1"])
    assert numbers(lmp, TORQUE) == pytest.approx([0, 0.2 * MASS * GRAVITY, 0], rel=1e-6)
    lmp.commands_list(["unfix w", "region r plane 0 0 0 0 0 1 rotate v_t 0.5 0 0 0 1 0"])
    lmp.commands_list(["fix w all wall/nscd region r", "run 1"])
    assert numbers(lmp, TORQUE) == pytest.approx([0, 0.2 * MASS * GRAVITY, 0], rel=1e-6)
    lmp.close()


def test_a_drum_gives_grains_what_they_gain_and_dissipate():
    """Its torque times its rate, over a few thousand steps of a flow."""
    balls, dt, omega, steps = bed(40, seed=4), 1e-3, math.pi, 2000
    balls.x[:, 2] -= 0.6
    lmp = walled(balls, "fix hard all nscd friction 0.5 tol 1e-5", dt=dt)
    lmp.command("fix w all wall/nscd ycylinder 0.95 friction 0.5 rotate 2 0 0 0 0 1 0")
    lmp.command("fix ends all wall/nscd yplane -0.5 0.5 friction 0")

    def energy():
        x, v = state(lmp)
        w = per_atom(lmp, "omega")
        spin = 0.4 * balls.radius**2 * (w**2).sum(axis=1)
        return float((balls.mass * (0.5 * (v**2).sum(axis=1) + 0.5 * spin + GRAVITY * x[:, 2])).sum())

    started = energy()
    lmp.commands_list([f"fix mean all ave/time 1 {steps} {steps} f_w[5]", f"run {steps}"])
    work = -lmp.extract_fix("mean", 0, 0) * omega * steps * dt
    spent = energy() - started + lmp.extract_fix("hard", 0, 1, 8)
    assert work == pytest.approx(spent, rel=5e-3)  # of first order in the step
    lmp.close()


def test_motion_is_told_at_the_end_of_the_step():
    lmp = walled(grains([0, 0, 1], R, MASS), "fix hard all nscd", dt=1e-3)
    lmp.commands_list(["variable x equal 0.1*step*dt", "variable t equal 3*step*dt"])
    lmp.command("fix w all wall/nscd plane 0 0 -1 0 0 1 wiggle x 0.2 0.5 rotate 4 0 0 0 0 0 1 shear y 0.3")
    lmp.command("fix v all wall/nscd zplane -2 NULL move v_x NULL NULL rotate v_t 0 0 0 0 0 1")
    lmp.command("run 100")
    way = [0.2 * (1 - math.cos(4 * math.pi * t)) for t in (0.099, 0.1)]
    assert numbers(lmp, SHIFT) == pytest.approx([way[1], 0, 0])
    assert numbers(lmp, VELOCITY) == pytest.approx([(way[1] - way[0]) / 1e-3, 0.3, 0])
    assert numbers(lmp, ANGLE, 1)[0] == pytest.approx(0.05 * math.pi) and numbers(lmp, RATE, 1)[0] == pytest.approx(
        math.pi / 2
    )
    assert numbers(lmp, SHIFT, 3, "v") == pytest.approx([0.01, 0, 0])
    assert numbers(lmp, VELOCITY, 3, "v") == pytest.approx([0.1, 0, 0])
    assert numbers(lmp, ANGLE, 1, "v")[0] == pytest.approx(0.3) and numbers(lmp, RATE, 1, "v")[0] == pytest.approx(3)
    lmp.close()
