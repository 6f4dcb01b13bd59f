# SPDX-License-Identifier: GPL-2.0-or-later
"""nscd-lmp convert: whole scripts, the twins of inputs/ and such as LAMMPS ships."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from pages import blocks
from soft_scripts import PAIRS, SCENE, TAIL, D, converted, lmp, new_lines, pair_lines, run_lammps

from nscd_lmp.conversion.convert import Known, convert

ROOT = Path(__file__).parent.parent

pytestmark = pytest.mark.fast


@pytest.mark.parametrize("script", sorted((ROOT / "inputs").glob("in.*.granular")), ids=lambda path: path.name)
def test_twins_lose_all_springs(script: Path) -> None:
    grains = Known(diameter=1e-3, mass=1.3e-6)
    conversion = convert(script, {}, grains)
    assert not re.search(r"^[^#]*(gran/|wall/gran|nve/sphere)", conversion.text, re.M)
    assert conversion.left_out == []
    assert "pair_style   nscd" in conversion.text and re.search(r"variable +dt index [125]e-[45] ", conversion.text)


def test_converted_twin_runs(tmp_path: Path) -> None:
    (tmp_path / "inputs").symlink_to(ROOT / "inputs")
    conversion = convert(ROOT / "inputs" / "in.drum.granular", {}, Known(diameter=1e-3, mass=1.3e-6))
    (tmp_path / "in.hard").write_text(conversion.text)
    lmp("in.hard", tmp_path, "-var", "n", "50", "-var", "steps", "50")


def test_converted_bounce_has_the_restitution_of_the_springs(tmp_path: Path) -> None:
    """Both scripts in LAMMPS: 0.5 mm of free flight, the bounce, free flight; e is written with three digits."""
    approach = "group a id 1\nvelocity a set 0 0 0.5\ngroup b id 2\nvelocity b set 0 0 -0.5\n"
    text = (
        SCENE
        + pair_lines(PAIRS["hertz"])
        + "\n"
        + approach
        + TAIL.replace("1e-6", "2e-7").replace("run 10", "run 30000")
    )
    soft = run_lammps(text)["v"]
    hard = run_lammps(converted(text, tmp_path).text.replace("run 30000", "run 30"))["v"]
    assert hard[1, 2] - hard[0, 2] == pytest.approx(soft[1, 2] - soft[0, 2], abs=2e-3)


POUR = """atom_style sphere
boundary p p fm
newton off
region reg block -10 10 -10 10 -0.5 16 units box
create_box 1 reg
neighbor 0.2 bin
pair_style gran/hooke/history 4000.0 NULL 100.0 NULL 0.5 1
pair_coeff * *
timestep 0.001
fix 1 all nve/sphere
fix 2 all gravity 1.0 spherical 0.0 -180.0
fix zlower all wall/gran hooke/history 4000.0 NULL 100.0 NULL 0.5 1 zplane 0.0 2000.0
region slab cylinder z 0 0 9 10 15 units box
fix ins all pour 3000 1 300719 vol 0.13 50 region slab
run 25000
"""
MIXER = """variable rlo equal 0.3
variable rhi equal 0.6
variable kn equal 10^5
variable gamma_n equal sqrt(2*${kn}/3)
variable tcol equal PI/sqrt(2*${kn}-${gamma_n}/4.0)
variable dt equal ${tcol}*0.02
timestep ${dt}
atom_style sphere
region box block 0 20 0 20 0 20
create_box 1 box
pair_style gran/hertz/history &
  ${kn} NULL ${gamma_n} NULL 0.5 1
pair_coeff * *
variable theta equal (step/400000)*2*PI
region mixer cylinder z 10 10 10 0 20 rotate v_theta 10 10 0 0 0 1
fix g all gravity 1 vector 0 0 -1
fix 1 all nve/sphere
fix mixwall all wall/gran/region hertz/history &
  ${kn} NULL ${gamma_n} NULL 0.5 1 region mixer
fix ins all pour 1000 1 42424 region box diam range $(2*v_rlo) $(2*v_rhi) dens 1 1
run 200000
"""
COHESIVE = """units lj
atom_style sphere
region box block 0 20 0 20 0 20
create_box 2 box
pair_style granular
pair_coeff 1 * jkr 1000.0 50.0 0.3 10 tangential mindlin 800.0 1.0 0.5 rolling sds 500.0 200.0 0.5 twisting marshall
pair_coeff 2 2 hertz 200.0 20.0 tangential linear_history 300.0 1.0 0.1 rolling sds 200.0 100.0 0.1 twisting marshall
fix 1 all nve/sphere
fix grav all gravity 10.0 vector 0 0 -1
fix ins all pour 1500 1 3123 region box diam range 0.5 1 dens 1 1
fix 3 all wall/gran granular hertz/material 1e5 1e3 0.3 tangential mindlin NULL 1.0 0.5 zplane 0 NULL
timestep 0.001
run 5000
"""


def test_script_like_lammps_pour(tmp_path: Path) -> None:
    """Grains of LAMMPS' default size and density; the step is bounded by gravity."""
    conversion = converted(POUR, tmp_path, Known())
    assert new_lines(conversion) == [
        "pair_style nscd",
        "pair_coeff * * friction 0.5 restitution 0.249",  # exp(-pi z / sqrt(1 - z^2)), z = 50 sqrt(pi/12 / 4000)
        "timestep 0.05 # was 0.001: 50 times that",
        "fix 1 all nscd",
        "fix zlower all wall/nscd zplane 0.0 2000.0 friction 0.5 restitution 0.112",  # z = 50 sqrt(pi/6 / 4000)
    ]
    assert "run 25000 counts steps: as long in time are now 500" in conversion.listing


def test_script_like_lammps_mixer(tmp_path: Path) -> None:
    conversion = converted(MIXER, tmp_path, Known())
    text = conversion.text
    assert re.search(r"^variable dt equal \S+   # was \$\{tcol\}\*0\.02 = \S+: 50 times that$", text, re.M)
    assert "fix mixwall all wall/nscd region mixer friction 0.5 restitution" in text
    assert "region mixer moves" in conversion.listing
    assert "variable theta changes with each step" in conversion.listing


def test_script_with_cohesion_says_what_is_lost_line_by_line(tmp_path: Path) -> None:
    conversion = converted(COHESIVE, tmp_path, Known())
    assert [(note.line, note.text.split()[0]) for note in conversion.left_out] == [
        (6, "rolling"), (6, "twisting"), (6, "cohesion"), (7, "rolling"), (7, "twisting")
    ]  # fmt: skip
    assert "pair_coeff 1 * friction 0.5 restitution" in conversion.text


def test_page_shows_what_the_command_says(tmp_path: Path) -> None:
    page = ROOT / "docs" / "from_pair_granular.md"
    bash, listing, old, new = [block.text for block in blocks(page)]
    script = bash.partition("<<'END'\n")[2].partition("END\n")[0]
    assert converted(script, tmp_path, Known()).listing + "\n\nin.hard: the new script\n" == listing
    walls = converted(script.replace("timestep", old + "timestep"), tmp_path, Known())
    assert [line for line in new_lines(walls) if "wall/" in line] == [
        " ".join(line.split()) for line in new.splitlines()
    ]


DRUM = (
    SCENE.replace("boundary p p p", "boundary f f f")
    + f"""create_atoms 1 single 0.05 0.05 {0.05 + 3 * D}
set group all diameter {D} density 2500
variable theta equal 3.0*step*dt
region drum cylinder y 0.05 0.05 0.03 0 0.1 rotate v_theta 0.05 0.05 0.05 0 1 0
pair_style gran/hooke/history 1e4 NULL 1e5 NULL 0.5 1
pair_coeff * *
fix g all gravity 9.81 vector 0 0 -1
fix drum all wall/gran/region granular hooke 1e4 1e5 damping mass_velocity &
  tangential linear_history 1e4 1 0.5 region drum
fix floor all wall/gran hooke/history 1e4 NULL 1e5 NULL 0.5 1 zplane 0.021 NULL wiggle z 1e-3 0.2 contacts
fix move all nve/sphere
timestep 1e-6
run 10
"""
)


def test_converted_walls_hold_and_move_grains(tmp_path: Path) -> None:
    """A turning drum and a floor in it that shakes; the new script runs as long as it takes to rest on both."""
    text = converted(DRUM, tmp_path).text
    assert "wall/nscd region drum friction 0.5" in text and "wiggle z 1e-3 0.2 contacts" in text
    asked = '\nrun 2000\nvariable f equal f_drum[7]+f_floor[7]\nprint "touch $(v_f) $(f_drum[14]) $(f_floor[10]>=0)"\n'
    (tmp_path / "in.hard").write_text(text + asked)
    told = re.findall(r"^touch (\S+) (\S+) (\S+)$", lmp("in.hard", tmp_path), re.M)
    assert told and float(told[-1][0]) >= 1 and float(told[-1][1]) > 0


def test_walls_that_the_page_shows_are_taken() -> None:
    """Its block of converted walls, in a scene that has the drum."""
    *_, new = [block.text for block in blocks(ROOT / "docs" / "from_pair_granular.md")]
    scene = SCENE.replace("boundary p p p", "boundary f f f") + "region drum cylinder y 0.05 0.05 0.05 0 0.1\n"
    run_lammps(scene + "pair_style nscd\npair_coeff * *\ntimestep 1e-5\nfix hard all nscd\n" + new + "run 10\n")
