# SPDX-License-Identifier: GPL-2.0-or-later
"""Grains that leave the box: `thermo_modify lost` says whether they may, and messages name them."""

from pathlib import Path

import pytest
from lammps import lammps

pytestmark = pytest.mark.fast

SCENE = """
units si
atom_style sphere
boundary f f f
region box block 0 1 0 1 0 1
create_box 1 box
create_atoms 1 single 0.2 0.5 0.5
create_atoms 1 single 0.5 0.5 0.5
create_atoms 1 single 0.8 0.5 0.5
set group all diameter 0.1 density 2500
set atom 1 vx -1
set atom 3 vx 2
pair_style nscd
pair_coeff * *
fix hard all nscd
timestep 1e-2
thermo_style custom step
"""


def opened(log: Path, *more: str) -> lammps:
    """Return the scene; the first grain leaves after 0.2 s, the third after 0.1 s."""
    lmp = lammps(cmdargs=["-screen", "none", "-log", str(log)])
    lmp.commands_string(SCENE)
    lmp.commands_list(list(more))
    return lmp


def test_an_outlet_that_ignores_them_lets_grains_go_without_a_word(tmp_path: Path) -> None:
    lmp = opened(tmp_path / "log", "thermo_modify lost ignore", "run 60")
    assert lmp.extract_global("nlocal") == 1
    lmp.close()
    assert "left the box" not in (tmp_path / "log").read_text()


def test_lost_warn_names_each_grain_once(tmp_path: Path) -> None:
    lmp = opened(tmp_path / "log", "thermo_modify lost warn", "run 60", "run 20")
    lmp.close()
    told = [line for line in (tmp_path / "log").read_text().splitlines() if "left the box" in line]
    assert len(told) == 2
    assert "1 of 3 grains left the box (ID 3)" in told[0]
    assert "1 of 3 grains left the box (ID 1)" in told[1]


@pytest.mark.parametrize("mode", [[], ["thermo_modify lost error"]])
def test_otherwise_the_run_stops_and_the_message_names_them(tmp_path: Path, mode: list[str]) -> None:
    lmp = opened(tmp_path / "log", *mode)
    with pytest.raises(Exception, match=r"1 of 3 grains left the box \(ID 3\): .*thermo_modify lost ignore"):
        lmp.command("run 60")
    lmp.close()


def test_grains_that_a_fix_takes_away_are_not_lost(tmp_path: Path) -> None:
    """fix evaporate and delete_atoms keep LAMMPS' count of atoms."""
    lmp = opened(
        tmp_path / "log",
        "region right block 0.85 1 0 1 0 1",
        "fix out all evaporate 1 5 right 49283",
        "run 10",
        "set atom 1 vx 0",
        "run 40",
        "group middle id 2",
        "delete_atoms group middle",
        "run 10",
    )
    assert lmp.get_natoms() == 1
    lmp.close()
