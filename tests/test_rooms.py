# SPDX-License-Identifier: GPL-2.0-or-later
"""Rooms of the core: includes point down, every file is in a room, and every room says what it is for.

Which room is on which floor is read from the table of ``nscd_lmp/core/README.md``.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import pytest

CORE = Path(__file__).parent.parent / "nscd_lmp" / "core"
TABLE = (CORE / "README.md").read_text()
FILES = {path.relative_to(CORE).as_posix(): path.read_text() for path in sorted(CORE.rglob("*")) if path.is_file()}
ROOMS = {
    "solver", "solver/local", "solver/global", "scene", "scene/drift", "scene/list",
    "base", "contact", "obstacle", "parallel", "problem", "settings", "warm_start", "scheme", "step",
}  # fmt: skip
SYSTEM = {"pthread.h", "sched.h", "signal.h"}  # threads on their processors


def floors(table: str) -> dict[str, int]:
    """Return the floor of each room."""
    rows = re.findall(r"^\| (\d+) \| ([^|]+) \|", table, re.M)
    return {room: int(floor) for floor, rooms in rows for room in re.findall(r"`([\w/]+)`", rooms)}


def room_of(path: str) -> str:
    return path.rpartition("/")[0]


def include_fault(path: str, words: str, files: Mapping[str, str], floor: Mapping[str, int]) -> str | None:
    """Say what is wrong with one include, ``"..."`` or ``<...>``; None for nothing."""
    name = words[1:-1]
    if words.startswith("<"):  # the standard library has no file endings; LAMMPS, Python and MPI have
        known = re.fullmatch(r"\w+", name) or name.startswith("Eigen/") or name in SYSTEM
        return None if known else f"{path} includes {name}, which the core must not know"
    if name not in files:
        return f"{path} includes {name}, which is no file of the core: room/file.hpp"
    if floor.get(room_of(name), 0) > floor.get(room_of(path), 99):
        return f"{path} includes {name}, which is above it"
    return None


def faults(files: Mapping[str, str], floor: Mapping[str, int]) -> list[str]:
    """Return what is wrong with these files of the core, by their paths from its root."""
    sources = {path: text for path, text in files.items() if path.endswith((".hpp", ".cpp"))}
    found = [f"{path} is in no room" for path in sources if room_of(path) not in floor]
    found += [f"{room} has no README.md" for room in floor if f"{room}/README.md" not in files]
    for path, text in sources.items():
        for words in re.findall(r"^\s*#\s*include\s*(\S+)", text, re.M):
            found += filter(None, [include_fault(path, words, sources, floor)])
    return found


def test_files_of_the_core_keep_to_their_rooms() -> None:
    assert faults(FILES, floors(TABLE)) == []


def test_the_table_has_all_rooms() -> None:
    floor = floors(TABLE)
    assert set(floor) == ROOMS
    assert sorted(set(floor.values())) == list(range(1, 11))
    assert sum(path.endswith((".hpp", ".cpp")) for path in FILES) > 100


LOW, HIGH = "cellar/low.hpp", "attic/high.hpp"
HOUSE = {LOW: "", HIGH: f'#include "{LOW}"\n#include <vector>\n', "cellar/README.md": "", "attic/README.md": ""}
FLOORS = {"cellar": 1, "attic": 2}


def test_a_house_in_order_has_no_faults() -> None:
    assert faults(HOUSE, FLOORS) == []


@pytest.mark.parametrize(
    ("path", "text", "fault"),
    [
        (LOW, f'#include "{HIGH}"', f"{LOW} includes {HIGH}, which is above it"),
        (LOW, f'  #  include "{HIGH}"  // why', f"{LOW} includes {HIGH}, which is above it"),
        (HIGH, '#include "low.hpp"', f"{HIGH} includes low.hpp, which is no file of the core"),
        (HIGH, '#include "../cellar/low.hpp"', f"{HIGH} includes ../cellar/low.hpp, which is no file of the core"),
        (HIGH, "#include <mpi.h>", f"{HIGH} includes mpi.h, which the core must not know"),
        (HIGH, "#include <Python.h>", f"{HIGH} includes Python.h, which the core must not know"),
        (HIGH, "#include <nanobind/nanobind.h>", f"{HIGH} includes nanobind/nanobind.h"),
        (HIGH, '#include "atom.h"', f"{HIGH} includes atom.h, which is no file of the core"),
        ("loose.cpp", "", "loose.cpp is in no room"),
        ("garden/shed.hpp", "", "garden/shed.hpp is in no room"),
        ("attic/box/toy.cpp", "", "attic/box/toy.cpp is in no room"),
    ],
)
def test_faults_are_found(path: str, text: str, fault: str) -> None:
    (found,) = faults(HOUSE | {path: text}, FLOORS)
    assert found.startswith(fault)


def test_a_room_without_a_readme_is_found() -> None:
    assert faults({path: text for path, text in HOUSE.items() if "attic/R" not in path}, FLOORS) == [
        "attic has no README.md"
    ]
