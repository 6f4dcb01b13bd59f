# SPDX-License-Identifier: GPL-2.0-or-later
"""Friction and restitution belong to the contact: by pair of atom types and by wall, each at its own closed form."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import materials_scene
import numpy as np
import pytest
from scenes import FLOOR, GRAVITY, grains, harden, start, state
from test_ranks import execute

import nscd_lmp
from nscd_lmp import _core

# Law gap takes the normal where the pair meets. Law moreau takes it where the step sees them overlap: there slip has
# turned the pair by up to a step's way over its distance, 0.02, and so much of slip and impulse are exchanged.
OFF = {"gap": 1e-12, "moreau": 0.02 * materials_scene.SLIP / 2}


@pytest.mark.fast
@pytest.mark.parametrize("door", materials_scene.DOORS)
@pytest.mark.parametrize("law", OFF)
def test_every_pair_and_wall_bounces_and_slides_at_its_own_closed_form(tmp_path: Path, law: str, door: str) -> None:
    through, restarted = materials_scene.run(door, law, tmp_path)
    assert through is not None
    np.testing.assert_allclose(through, materials_scene.expected(), rtol=0, atol=OFF[law])
    np.testing.assert_array_equal(restarted, through)  # a restart keeps types, so materials too


@pytest.mark.parametrize("door", materials_scene.DOORS)
def test_pairs_across_ranks_have_the_same_materials(tmp_path: Path, door: str) -> None:
    answer = tmp_path / "two.npz"
    execute(2, str(Path(materials_scene.__file__)), door, "gap", str(answer))
    for name, v in np.load(answer).items():
        np.testing.assert_allclose(v, materials_scene.expected(), rtol=0, atol=OFF["gap"], err_msg=name)


@pytest.mark.fast
@pytest.mark.parametrize("law", ["gap", "moreau"])
def test_a_collision_of_e_09_leaves_the_resting_contact_beside_it_at_rest(law: str) -> None:
    """A ball that rests on a floor of e 0 is hit along the floor by one of e 0.9, which flies."""
    r, e, speed = 0.01, 0.9, 1.0
    balls = grains([(0, 0, r), (-2 * r - 1.5e-4, 0, r)], r, mass=0.01, v=[(0, 0, 0), (speed, 0, 0)])
    lmp = start(balls, 1e-4, gravity=GRAVITY)
    lmp.command("set atom 2 type 1")
    attached = harden(lmp, law=law, restitution=e, walls=[dataclasses.replace(FLOOR, restitution=0.0)])
    lmp.command("run 20")
    x, v = state(lmp)
    # The turn of the pair's normal while the ball falls by g t^2 / 2 until they meet, and what falls in a step.
    np.testing.assert_allclose(v[:, 0], [speed * (1 + e) / 2, speed * (1 - e) / 2], atol=1e-5)
    assert abs(v[0, 2]) < 1e-6  # it has not hopped
    assert abs(x[0, 2] - r) < 1e-6
    assert attached.stats["unconverged_steps"][-1] == 0


@pytest.mark.fast
@pytest.mark.parametrize("law", ["gap", "moreau"])
def test_a_grain_bounces_off_one_wall_and_stays_on_the_other(law: str) -> None:
    r, drop = 0.01, 0.02
    balls = grains([(0, 0, r + drop)], r)
    walls = [dataclasses.replace(FLOOR, restitution=0.5)]
    lmp = start(balls, 1e-4, gravity=GRAVITY)
    harden(lmp, law=law, walls=walls, restitution=0.0)
    fall = (2 * drop / GRAVITY) ** 0.5
    lmp.command(f"run {round(1.5 * fall / 1e-4)}")  # at the top of the first bounce, a quarter of the drop
    x, v = state(lmp)
    assert x[0, 2] - r == pytest.approx(drop / 4, rel=0.02)  # the step of the impact is 0.3 % of the fall
    assert abs(v[0, 2]) < 0.02 * GRAVITY * fall


@pytest.mark.fast
@pytest.mark.parametrize(
    ("materials", "message"),
    [
        ({(1, 1): nscd_lmp.Material(friction=0.1)}, None),
        ({(1, 3): nscd_lmp.Material(friction=0.1)}, r"there is no atom type 3, the largest is 1"),
        ({(1, 1): nscd_lmp.Material()}, r"behind the two types stand friction, restitution or e_t"),
        ({(1, 1): nscd_lmp.Material(restitution=1.5)}, r"material 1 1: restitution = 1\.5 is outside \[0, 1\]"),
        ({(1, 1): nscd_lmp.Material(friction="glue")}, r"material friction: 'glue' is not a number, nor stick"),  # type: ignore[arg-type]
        ({(1, 1): 0.5}, r"materials: \(1, 1\): 0\.5 must be \(i, j\): nscd_lmp\.Material"),
        ({(1, 1): nscd_lmp.Material(friction=[0.1])}, r"friction = \[0\.1\] must be a number"),  # type: ignore[arg-type]
        ([nscd_lmp.Material(friction=0.1)], r"materials = \[.*\] must be a dict"),
        ({1: nscd_lmp.Material(friction=0.1)}, r"must be \(i, j\): nscd_lmp\.Material"),
    ],
)
def test_materials_that_cannot_be_are_refused(materials: object, message: str | None) -> None:
    lmp = start(grains([(0, 0, 0.01)], 0.01), 1e-4)
    if message is None:
        nscd_lmp.attach(lmp, materials=materials)  # type: ignore[arg-type]
        return
    with pytest.raises(nscd_lmp.NscdError, match=message):
        nscd_lmp.attach(lmp, materials=materials)  # type: ignore[arg-type]


@pytest.mark.fast
def test_python_has_all_parts_of_a_material() -> None:
    """A part that is added in the core has to be given by both classes."""
    parts = list(_core.MATERIAL_PARTS)
    assert [field.name for field in dataclasses.fields(nscd_lmp.Material)] == parts
    for kind, own in ((nscd_lmp.Plane, ["point", "normal"]), (nscd_lmp.Cylinder, ["point", "axis", "radius"])):
        assert [field.name for field in dataclasses.fields(kind)] == [*parts, "motion", *own]


@pytest.mark.fast
def test_a_wall_without_what_types_have_is_told(tmp_path: Path) -> None:
    """Both doors say so; a wall that says 0 is taken at its word."""
    materials = {(1, 1): nscd_lmp.Material(friction=0.5)}
    lmp = start(grains([(0, 0, 0.01)], 0.01), 1e-4)
    with pytest.warns(UserWarning, match="no friction on wall 1, and grains have theirs by types alone"):
        nscd_lmp.attach(lmp, materials=materials, walls=[FLOOR])
    lmp = start(grains([(0, 0, 0.01)], 0.01), 1e-4)
    nscd_lmp.attach(lmp, materials=materials, walls=[dataclasses.replace(FLOOR, friction=0.0)])


@pytest.mark.fast
@pytest.mark.parametrize("walls", [FLOOR, ["plane"], 0])
def test_walls_that_are_none_are_refused(walls: object) -> None:
    lmp = start(grains([(0, 0, 0.01)], 0.01), 1e-4)
    with pytest.raises(nscd_lmp.NscdError, match=r"walls = .* must be a list of walls"):
        nscd_lmp.attach(lmp, walls=walls)  # type: ignore[arg-type]
