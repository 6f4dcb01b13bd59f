# SPDX-License-Identifier: GPL-2.0-or-later
"""nscd-lmp convert: lines that change, lines that stay, and nothing that is lost without a word."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from nscd_lmp._core import NscdError
from soft_scripts import DENSITY, PAIRS, SCENE, TAIL, D, converted, lmp, new_lines, restitution_in

from nscd_lmp import cli
from nscd_lmp.conversion.convert import Known
from nscd_lmp.conversion.script import commands_of
from nscd_lmp.conversion.steps import proposed, short

pytestmark = pytest.mark.fast

# what changes, what stays


def test_three_kinds_of_lines_change_and_the_step(tmp_path: Path) -> None:
    text = SCENE + PAIRS["hooke"] + "\nfix g all gravity 9.81 vector 0 0 -1" + TAIL
    conversion = converted(text, tmp_path)
    assert new_lines(conversion)[0] == "pair_style nscd"
    assert new_lines(conversion)[2:] == ["fix move all nscd", "timestep 5e-5 # was 1e-6: 50 times that"]
    assert conversion.left_out == []
    kept = [line for line in text.splitlines() if line in conversion.text.splitlines()]
    assert len(kept) == len(text.splitlines()) - 4
    assert "run 10 counts steps" in conversion.listing


def test_continued_lines_comments_and_quotes(tmp_path: Path) -> None:
    style = 'pair_style  gran/hooke/history &\n  1e4 NULL &\n "5e2" NULL 0.5 0  # springs\npair_coeff * * # all\n'
    conversion = converted(SCENE + style + 'print "pair # style"' + TAIL, tmp_path)
    assert conversion.changes[0].new == "pair_style  nscd   # springs"
    assert conversion.changes[0].last - conversion.changes[0].first == 2
    assert 'print "pair # style"' in conversion.text
    assert new_lines(conversion)[1].endswith("# all")


@pytest.mark.parametrize(
    ("text", "commands"),
    [
        ("run 1 # a & b\nrun 2", ["run 1", "run 2"]),
        ("run 1 # a &\nrun 2\nrun 3", ["run 1 ", "run 3"]),  # as LAMMPS: a comment goes on too
        ('print """a # b\nc""" # d\nrun 1', ['print """a # b\nc"""', "run 1"]),
        ("print 'a \"#\" b'\n\n  run 1", ["print 'a \"#\" b'", "  run 1"]),
        ("run &\n  1 &", ["run    1 &"]),
    ],
)
def test_commands_are_those_of_lammps(text: str, commands: list[str]) -> None:
    found = [command.text.rstrip() for command in commands_of(text.splitlines())]
    assert found == [command.rstrip() for command in commands]


def test_variables_are_resolved_and_friction_keeps_its_name(tmp_path: Path) -> None:
    head = 'variable mu index 0.3\nvariable kn equal 10^4\nvariable c string "${kn} NULL $(v_kn/20)"\n'
    style = "pair_style gran/hooke/history $c NULL ${mu} 0\npair_coeff * *"
    conversion = converted(head + SCENE + style + TAIL, tmp_path)
    plain = converted(SCENE + "pair_style gran/hooke/history 1e4 NULL 5e2 NULL 0.3 0\npair_coeff * *" + TAIL, tmp_path)
    assert "friction ${mu} restitution" in conversion.text
    assert restitution_in(conversion, "pair_coeff") == restitution_in(plain, "pair_coeff")
    given = converted(head + SCENE + style + TAIL, tmp_path, kn="2e4")
    assert restitution_in(given, "pair_coeff") != restitution_in(plain, "pair_coeff")


def test_step_changes_where_it_is_defined(tmp_path: Path) -> None:
    text = "variable dt index 1e-6 # s\n" + SCENE + PAIRS["hooke"] + TAIL.replace("1e-6", "${dt}")
    gravity = "fix g all gravity 9.81 vector 0 0 -1\n"
    conversion = converted(text.replace("fix move", gravity + "fix move"), tmp_path)
    assert new_lines(conversion)[0] == "variable dt index 5e-5 # was 1e-6: 50 times that; s"
    assert "timestep ${dt}" in conversion.text
    asked = converted(text, tmp_path, Known(speed=1.0, timestep=3e-5))
    assert "variable dt index 3e-5   # was 1e-6: as asked for" in asked.text


def test_every_step_changes_where_there_are_several(tmp_path: Path) -> None:
    text = (
        SCENE + PAIRS["hooke"] + "\nfix g all gravity 9.81 vector 0 0 -1" + TAIL + "timestep 2e-6\nrun 1000\ntimestep 0"
    )
    conversion = converted(text, tmp_path)
    assert [line for line in new_lines(conversion) if "timestep" in line] == [
        "timestep 5e-5 # was 1e-6: 50 times that",
        "timestep 1e-4 # was 2e-6: 50 times that",
    ]
    assert "run 1000 counts steps: as long in time are now 20" in conversion.listing
    assert ["timestep 0: no number above 0" in note.text for note in conversion.left_out] == [True]


def test_steps_are_bounded_by_what_flows_allow() -> None:
    class Seen:
        diameter, gravity, speed = 1e-3, 9.81, None

    grains: Any = Seen()
    assert proposed(1e-6, grains) == (5e-5, "50 times that")
    assert proposed(1e-4, grains) == (5e-4, "dt sqrt(g/d) of 0.05")
    grains.speed = 10.0
    assert proposed(1e-4, grains) == (1e-5, "dt v/d of 0.1")
    assert [short(value) for value in (2e-4, 0.5, 5e-5, 1)] == ["2e-4", "0.5", "5e-5", "1"]


def test_step_that_is_large_already_stays(tmp_path: Path) -> None:
    text = SCENE + PAIRS["hooke"] + "\nfix g all gravity 9.81 vector 0 0 -1" + TAIL.replace("1e-6", "5e-3")
    conversion = converted(text, tmp_path)
    assert "timestep 5e-3" in conversion.text
    assert "may not be worth it" in conversion.listing


@pytest.mark.parametrize(("option", "inertia"), [("", "sphere"), (" disc", "disc")])
def test_planar_grains_stay_what_they_are(option: str, inertia: str, tmp_path: Path) -> None:
    text = SCENE.replace("atom_style", "dimension 2\natom_style") + PAIRS["hooke"]
    conversion = converted(text + TAIL.replace("nve/sphere", "nve/sphere" + option), tmp_path)
    assert f"fix move all nscd inertia {inertia}" in conversion.text
    smooth = converted((text + TAIL).replace("0.5 1", "0 1"), tmp_path)
    assert "fix move all nscd\n" in smooth.text  # which is an error with `inertia`


WALL = "fix w all wall/gran hooke 1e4 NULL 5e2 NULL 0.5 1 "


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("zplane 0 NULL", "wall/nscd zplane 0 NULL friction 0.5 restitution E"),
        ("xplane ${lo} 2", "wall/nscd xplane ${lo} 2 friction 0.5 restitution E"),
        ("zcylinder 3 shear z 0.1", "wall/nscd zcylinder 3 friction 0.5 restitution E shear z 0.1"),
        (
            "yplane 0 1 wiggle y 0.1 2 contacts",
            "wall/nscd yplane 0 1 friction 0.5 restitution E wiggle y 0.1 2 contacts",
        ),
        ("region r", "wall/nscd region r friction 0.5 restitution E"),
    ],
)
def test_walls(old: str, new: str, tmp_path: Path) -> None:
    text = "variable lo index 1\n" + SCENE + PAIRS["hooke"] + "\n" + WALL + old + TAIL
    wall = WALL.replace("wall/gran", "wall/gran/region") if "region" in old else WALL
    conversion = converted(text.replace(WALL, wall), tmp_path)
    (line,) = [line for line in new_lines(conversion) if line.startswith("fix w")]
    assert re.sub(r"restitution \S+", "restitution E", line) == "fix w all " + new


LEFT_OUT = {
    "rolling sds 1 2 0.1": "rolling friction",
    "twisting marshall": "twisting friction",
    "heat area 0.1": "heat",
}


@pytest.mark.parametrize("model", LEFT_OUT)
def test_what_hard_contacts_lack_is_told(model: str, tmp_path: Path) -> None:
    text = (
        f"pair_style granular\npair_coeff * * hooke 1e4 50 tangential linear_history 1 1 0.4 {model} damping velocity"
    )
    conversion = converted(SCENE + text + TAIL, tmp_path)
    (note,) = conversion.left_out
    assert LEFT_OUT[model] in note.text and note.line == 12
    assert f"# not converted: {note.text}\npair_coeff * * friction 0.4 restitution" in conversion.text
    none = converted(SCENE + text.replace(model, "rolling none twisting none") + TAIL, tmp_path)
    assert none.left_out == []


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("fix t all nvt/sphere temp 1 1 1", "thermostat"),
        ("fix h all heat/flow constant 1", "heat"),
        ("fix r all rigid molecule", "several spheres"),
        ("thermo_style custom step press", "impulses"),
        ("pair_style hybrid gran/hooke 1 NULL 1 NULL 0.5 1 lj/cut 2", "by hand"),
        ("compute c all pair/local force", "forces of the pair style"),
        ('if "1 > 0" then "fix x all nve/sphere"', "by hand"),
        ("fix 2 all nve/sphere update dipole", "dipoles"),
    ],
)
def test_other_lines_without_a_counterpart_are_told(line: str, reason: str, tmp_path: Path) -> None:
    conversion = converted(SCENE + PAIRS["hooke"] + "\n" + line + TAIL, tmp_path)
    assert [reason in note.text for note in conversion.left_out] == [True]


@pytest.mark.parametrize("normal", ["jkr 1e4 50 0.3 10", "dmt 1e4 50 0.3 10"])
def test_cohesion_is_told(normal: str, tmp_path: Path) -> None:
    text = f"pair_style granular\npair_coeff * * {normal} tangential mindlin NULL 1 0.4"
    conversion = converted(SCENE + text + TAIL, tmp_path)
    assert ["cohesion" in note.text for note in conversion.left_out] == [True]


def test_elastic_gas_is_not_worth_it(tmp_path: Path) -> None:
    assert "not be worth it" in converted(SCENE + PAIRS["hooke"].replace("5e2", "0") + TAIL, tmp_path).listing


# bad input, and the program


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("pair_style lj/cut 2.5\npair_coeff * * 1 1", "nothing to convert"),
        ("pair_style gran/hooke 1e4 NULL ${gn} NULL 0.5 1\npair_coeff * *", "line 11: .*'gn'.* --variable gn VALUE"),
        ("pair_style gran/hooke 1e4 NULL v_g NULL 0.5 1\npair_coeff * *", "gamma_n is 'v_g'"),
        ("pair_style gran/hooke 1e4 NULL\npair_coeff * *", "line 11: hooke has Kn Kt"),
        ("pair_style gran/history 1e4 50 0.5 0\npair_coeff * *", "pair_style gran/history is not known"),
        ("pair_style granular\npair_coeff * * spring 1 2", "line 12: 'spring' is no normal model"),
        ("pair_style granular\npair_coeff * * hooke 1 2 tangential mindlin 1", "mindlin has 3 numbers behind it"),
        (PAIRS["hooke"] + "\nfix w all wall/gran zplane 0 2e3 50 0.5", "no model 'zplane'"),
        (PAIRS["hooke"] + f"\n{WALL}zplane 0", "'zplane' is no wall with all its numbers"),
        (PAIRS["hooke"] + f"\n{WALL}zplane 0 NULL turn", "'turn' is no keyword"),
        (PAIRS["hooke"] + "\ntimestep", "line 13: 'timestep' lacks words"),
        (PAIRS["hooke"] + "\nfix p all pour 3 1 5 diam", "line 13: .* lacks words"),
    ],
)
def test_bad_scripts_are_refused(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(NscdError, match=message):
        converted(SCENE + text + TAIL, tmp_path)


@pytest.mark.parametrize("line", ["read_data data.grains", "set group all diameter v_d", "include in.grains"])
def test_unknown_grains_are_asked_for(line: str, tmp_path: Path) -> None:
    text = "\n".join(one for one in SCENE.splitlines() if not one.startswith("set")) + f"\n{line}\n"
    text = "variable d atom 1e-3\n" + text + PAIRS["hooke"] + TAIL
    with pytest.raises(NscdError, match=r"needs the mass of a grain.*--diameter D and --density RHO.*or --mass M"):
        converted(text, tmp_path, Known())
    told = converted(text, tmp_path, Known(diameter=D, density=DENSITY))
    whole = converted(SCENE + PAIRS["hooke"] + TAIL, tmp_path)
    assert restitution_in(told, "pair_coeff") == restitution_in(whole, "pair_coeff")


def test_command_lists_and_writes(tmp_path: Path, monkeypatch: Any, capsys: Any) -> None:
    monkeypatch.chdir(tmp_path)
    text = SCENE + "pair_style gran/hooke 1e4 NULL ${gn} NULL 0.5 1\npair_coeff * *" + TAIL
    Path("in.soft").write_text(text)
    assert cli.main(["convert", "in.soft"]) == 1
    assert "--variable gn VALUE" in capsys.readouterr().err
    assert cli.main(["convert", "in.soft", "--variable", "gn", "5e2", "--write", "in.hard"]) == 0
    shown = capsys.readouterr().out
    assert "   11 - pair_style gran/hooke 1e4" in shown and "\n      + pair_style nscd\n" in shown
    assert Path("in.soft").read_text() == text
    lmp("in.hard", tmp_path)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["in.none"], "there is no script 'in.none'"),
        (["in.soft", "--write", "in.soft"], "would overwrite the script"),
        (["in.soft", "--variable", "a b", "1"], "--variable a b: a name has letters"),
        (["in.soft", "--diameter", "-1"], "--diameter -1 should be above 0"),
    ],
)
def test_bad_command_lines_exit_1(
    words: list[str], message: str, tmp_path: Path, monkeypatch: Any, capsys: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("in.soft").write_text(SCENE + PAIRS["hooke"] + TAIL)
    assert cli.main(["convert", *words]) == 1
    assert message in capsys.readouterr().err
