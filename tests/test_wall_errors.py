# SPDX-License-Identifier: GPL-2.0-or-later
"""What fix wall/nscd refuses, and the words in which it does: each says what to do."""

from __future__ import annotations

import re

import pytest
from scenes import grains
from walled import walled

pytestmark = pytest.mark.fast

KINDS = "region, plane, mesh, xplane, yplane, zplane, xcylinder, ycylinder, zcylinder, cylinder"
VARIABLES = [
    *("variable x equal 0.1*step*dt", "variable atoms atom x", "variable size equal 1+step"),
    *("variable huge equal 1.0e300*1.0e300", "variable up equal 0.5*(step>2)"),
]  # fmt: skip


def refused(*commands, boundary="f f f"):
    """Return the error of these commands, behind a ball at rest and a fix nscd, without the place in the source."""
    lmp = walled(grains([0, 0, 0.1], 0.1, 2.0), *VARIABLES, "fix hard all nscd", boundary=boundary)
    with pytest.raises(Exception, match="ERROR: ") as told:
        lmp.commands_list(list(commands))
    lmp.close()
    return re.sub(r" \(\S+:\d+\)$", "", str(told.value).split("\n")[0]).removeprefix("ERROR: ")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("", "give a wall: region ID, or a kind such as zplane lo hi"),
        ("zplain 0 NULL", f"unknown wall 'zplain': choose one of {KINDS}"),
        ("region", "too few words: give `region ID`"),
        ("region nowhere", "there is no region nowhere: define it before the fix"),
        ("zplane 0", "too few words: give `zplane lo hi`"),
        ("zplane NULL NULL", "both sides are NULL: give one of them a place"),
        ("zplane 1 0", "lo = 1 must be below hi = 0"),
        ("zplane low 0", "keyword wall/nscd zplane: 'low' is not a number or NULL"),
        ("plane 0 0 0 0 0 0", "the normal is (0, 0, 0); give a vector that points into the free side"),
        ("plane 0 0 0 0 0", "too few words: give `plane x y z nx ny nz`"),
        ("zcylinder -1", "the radius -1 must be > 0"),
        ("zcylinder", "too few words: give `zcylinder R`"),
        (
            "cylinder 0 0 0 0 0 0 1",
            "the axis needs a point and a vector of finite numbers that is not (0, 0, 0)",
        ),
        ("cylinder 0 0 0 1 0 0", "too few words: give `cylinder x y z ax ay az R`"),
    ],
)
def test_walls_that_are_none(words, message):
    assert refused(f"fix w all wall/nscd {words}") == f"Fix wall/nscd w: {message}"


TWO_MOTIONS = "it moves by variables and by wiggle, shear or a period at once: use one of them"
ZERO_AXIS = "rotate: the axis must be a vector other than (0, 0, 0)"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            "hooke 1e5",
            "unknown keyword 'hooke': choose one of friction, restitution, e_t, contacts, wiggle, shear, rotate, move",
        ),
        ("friction", "keyword wall/nscd friction needs a value"),
        ("friction glue", "keyword wall/nscd friction: 'glue' is not a number, nor stick"),
        ("friction 0.1 friction 0.2", "friction is given twice: give it once"),
        ("friction 0.1 stick", "stick is given twice: give it once"),
        ("contacts contacts", "contacts is given twice: give it once"),
        ("wiggle z 0.1", "too few words: give `wiggle dim A T`"),
        ("wiggle q 0.1 1", "wiggle: 'q' is no direction: give x, y or z"),
        ("wiggle z 0.1 0", "wiggle: the period 0 must be > 0"),
        ("wiggle z 0.1 1 wiggle x 0.1 1", "wiggle is given twice: give it once"),
        ("shear z", "too few words: give `shear dim V`"),
        ("rotate 1 0 0 0 0 0", "too few words: give `rotate T x y z ax ay az`"),
        ("rotate 1 0 0 0 0 0 0", ZERO_AXIS),
        ("rotate 0 0 0 0 0 0 1", "rotate: the period 0 must be > 0"),
        ("rotate v_x 0 0 0 0 0", "too few words: give `rotate v_theta x y z ax ay az`"),
        ("rotate v_x 0 0 0 0 0 0", ZERO_AXIS),
        ("rotate v_x 0 0 0 0 0 up", "rotate: 'up' is not a number"),
        ("rotate v_x 0 0 0 0 0 1 rotate v_x 0 0 0 0 0 1", "rotate is given twice: give it once"),
        ("move v_x NULL", "too few words: give `move v_x v_y v_z`"),
        ("move 1 NULL NULL", "move: '1' is neither a variable, v_NAME, nor NULL"),
        ("move NULL NULL NULL", "move: all three are NULL: give a variable for one of them, or leave move out"),
        ("move v_x NULL NULL move v_x NULL NULL", "move is given twice: give it once"),
        ("wiggle z 0.1 1 move v_x NULL NULL", TWO_MOTIONS),
        ("rotate v_x 0 0 0 0 0 1 rotate 1 0 0 0 0 0 1", TWO_MOTIONS),
    ],
)
def test_keywords_that_cannot_be(words, message):
    assert refused(f"fix w all wall/nscd zplane 0 NULL {words}") == f"Fix wall/nscd w: {message}"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("friction -1", "friction = -1 must be >= 0, or `stick` for contacts that do not slip"),
        ("restitution 2", "restitution = 2 is outside [0, 1]"),
        ("e_t 0.5", "e_t = 0.5 has no effect without friction: give `friction`, or leave e_t out"),
        ("move v_none NULL NULL", "there is no variable none: define it ahead of the run"),
        ("rotate v_none 0 0 0 0 0 1", "there is no variable none: define it ahead of the run"),
        ("move v_atoms NULL NULL", "variable atoms is not of style equal: a wall moves by one that is"),
        ("move v_huge NULL NULL", "variable huge is inf, which is no place and no angle"),
    ],
)
def test_numbers_and_variables_that_cannot_be(words, message):
    said = refused(f"fix w all wall/nscd zplane 0 NULL {words}", "run 0")
    assert said == f"Fix nscd hard: fix w: {message}"


def test_a_variable_that_is_deleted_between_runs():
    said = refused("fix w all wall/nscd zplane 0 NULL move v_x NULL NULL", "run 1", "variable x delete", "run 1")
    assert said == "Fix nscd hard: fix w: there is no variable x: define it ahead of the run"


@pytest.mark.parametrize(
    ("region", "words", "message"),
    [
        ("sphere 0 0 0 v_size", "", "region r has a size that varies: walls keep their shape; use `move`, or a mesh"),
        (
            "ellipsoid 0 0 0 1 2 3",
            "",
            "region r is an ellipsoid, of which LAMMPS gives no normals: use a sphere or a mesh",
        ),
        (
            "sphere 0 0 0 1 move v_x NULL NULL",
            " wiggle z 0.1 1",
            "region r moves, and so would its wall: give the motion to one of them",
        ),
    ],
)
def test_regions_that_are_no_walls(region, words, message):
    assert refused(f"region r {region}", f"fix w all wall/nscd region r{words}") == f"Fix wall/nscd w: {message}"


@pytest.mark.parametrize("part", ["sphere 0 0 0 v_size", "ellipsoid 0 0 0 1 2 3"])
def test_parts_of_regions_are_looked_at(part):
    said = refused(
        f"region a {part}", "region b sphere 0 0 0 1", "region r union 2 a b", "fix w all wall/nscd region r"
    )
    assert said.startswith("Fix wall/nscd w: region a ")


def test_a_region_that_is_deleted_between_runs():
    said = refused("region r sphere 0 0 0 1", "fix w all wall/nscd region r", "run 1", "region r delete", "run 1")
    assert said == "Fix nscd hard: fix w: region r is not there any more: unfix w, or define the region again"


def test_a_cone_along_y_with_ends():
    said = refused("region r cone y 0 0 0.3 1 -1 1", "fix w all wall/nscd region r", "run 0")
    assert said.startswith("Fix nscd hard: LAMMPS gives a surface of region r near (")
    assert said.endswith(
        ") a normal that is not perpendicular to it, as it does at the ends of a cone along y: turn the scene, or use "
        "a mesh"
    )


@pytest.mark.parametrize("region", ["sphere 5 0 0 1", "sphere 0 0 0 1 side out", "block -1 1 -1 1 0.2 1"])
def test_grains_on_the_wrong_side_of_a_region(region):
    assert refused(f"region r {region}", "fix w all wall/nscd region r", "run 1") == (
        "Fix nscd hard: grain 1 is beyond the wall of fix w: its centre is not in region r, whose surface can hold it "
        "from there alone: start it inside, give the region another `side`, or the fix a group without it; take a "
        "smaller timestep if it was inside before (step 1)"
    )


def test_grains_of_another_group_may_be_on_the_wrong_side():
    lmp = walled(
        grains([[0, 0, 0], [2, 0, 0]], 0.1, 2.0), "group one id 1", "fix hard all nscd", "region r sphere 0 0 0 1"
    )
    lmp.commands_list(["fix w one wall/nscd region r", "run 10"])
    lmp.close()


def test_grains_on_the_wrong_side_of_a_plane():
    said = refused("fix w all wall/nscd zplane 0.3 NULL", "run 1")
    assert said.startswith(
        "Fix nscd hard: grain 1 is 0.3 inside fix w, more than its radius 0.1: start it on the side "
    )


@pytest.mark.parametrize("wall", ["zplane -1 NULL", "region r"])
@pytest.mark.parametrize("other", ["", " friction 0.5", " contacts"])
def test_one_wall_as_two_fixes(wall, other):
    said = refused(
        "region r sphere 0 0 0 1",
        f"fix w all wall/nscd {wall}",
        f"fix v all wall/nscd {wall}{other}",
        "run 0",
    )
    assert said == "Fix wall/nscd v is the same wall as fix w, and grains would touch both: remove one"


def test_a_wall_without_a_fix_nscd():
    said = refused("unfix hard", "fix w all wall/nscd zplane -1 NULL", "run 0")
    assert said == "Fix wall/nscd w needs a fix nscd, which solves its contacts: add `fix ID group nscd`"


@pytest.mark.parametrize(
    ("boundary", "wall", "message"),
    [
        (
            "f f p",
            "zplane -1 NULL",
            "fix w: it lies across z, and the box is periodic in z: use a boundary that is not periodic",
        ),
        (
            "f f p",
            "xcylinder 3.05",
            "fix w: it does not lie alike on the two faces of the box in z, in which the box is periodic, and a grain "
            "there would miss a part of it: use a boundary that is not periodic, or a wall that ends a radius ahead of "
            "the faces or goes on alike by a radius beyond them",
        ),
        (
            "p f f",
            "zplane -1 NULL rotate 1 0 0 0 0 0 1",
            "fix w: it rotates about an axis that is not along x, in which the box is periodic, and grains touch it at "
            "the box' faces: use that axis, or a boundary that is not periodic",
        ),
    ],
)
def test_periodic_boxes_that_a_wall_does_not_repeat_in(boundary, wall, message):
    said = refused("region r sphere 2 0 0 2.5", f"fix w all wall/nscd {wall}", "run 0", boundary=boundary)
    assert said == f"Fix nscd hard: {message}"


def test_a_region_that_a_periodic_box_cuts_is_told_of(tmp_path):
    """It is no error: LAMMPS' users have such regions, where no grain gets to."""
    lmp = walled(grains([0, 0, 0.1], 0.1, 2.0), "fix hard all nscd", boundary="p f f")
    log = tmp_path / "log"
    lmp.commands_list([f"log {log}", "region r sphere 2 0 0 2.5", "fix w all wall/nscd region r", "run 0", "run 0"])
    lmp.close()
    told = [line for line in log.read_text().splitlines() if "it does not lie alike" in line]
    assert len(told) == 1
    assert "Fix nscd hard: fix w: it does not lie alike on the two faces of the box in x" in told[0]


@pytest.mark.parametrize("wall", ["zcylinder 3 rotate 1 0 0 0 0 0 1", "cylinder 0 0 0 0 0 1 2.5 rotate 1 0 0 0 0 0 1"])
def test_a_wall_that_ends_within_a_periodic_box_is_none_at_its_faces(wall):
    """Also one that just fits in: no centre of a grain gets to the faces."""
    lmp = walled(grains([0, 0, 0.1], 0.1, 2.0), "fix hard all nscd", f"fix w all wall/nscd {wall}", boundary="p p f")
    lmp.command("run 2")
    lmp.close()


@pytest.mark.parametrize(
    ("wall", "message"),
    [
        ("zplane -1 NULL wiggle z 0.1 1", "wall 1 moves: use a fix wall/nscd for it, with the same words"),
        ("zplane -1 NULL shear x 1", "wall 1 moves: use a fix wall/nscd for it, with the same words"),
        ("region r", "a region has a fix of its own as a wall: `fix ID group wall/nscd region ...`"),
    ],
)
def test_walls_of_fix_nscd_stand_and_are_simple(wall, message):
    assert refused("unfix hard", f"fix hard all nscd wall {wall}") == f"Fix nscd hard: {message}"


@pytest.mark.parametrize(
    ("wall", "message"),
    [
        ("zplane 0 1", "planes across z do not fit a planar scene (dimension 2): use dimension 3"),
        (
            "yplane -1 1 wiggle z 0.1 1",
            "it moves along z, but the scene is planar (dimension 2): move it along x or y, or use dimension 3",
        ),
        (
            "yplane -1 1 move NULL NULL v_z",
            "it moves along z, but the scene is planar (dimension 2): move it along x or y, or use dimension 3",
        ),
        (
            "yplane -1 1 rotate 1 0 0 0 0 1 0",
            "it rotates out of the plane of the scene (dimension 2): give it the axis 0 0 1, or use dimension 3",
        ),
        (
            "xcylinder 1",
            "its axis is not along z, but the scene is planar (dimension 2): use that axis, or dimension 3",
        ),
    ],
)
def test_walls_that_do_not_fit_a_plane(wall, message):
    lmp = walled(grains([0, 0, 0], 0.1, 2.0), "fix hard all nscd", dimension=2, boundary="f f p", gravity=(0, -9.81, 0))
    with pytest.raises(Exception, match=re.escape(f"fix w: {message}")):
        lmp.commands_list(["variable z equal 0.1", f"fix w all wall/nscd {wall}", "run 0"])
    lmp.close()
