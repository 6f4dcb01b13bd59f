# SPDX-License-Identifier: GPL-2.0-or-later
"""The rooms of the Python package: imports point down, run in no circle, and none goes to the package itself."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

import nscd_lmp

pytestmark = pytest.mark.fast

PACKAGE = Path(__file__).parent.parent / "nscd_lmp"
# From below, those of a line side by side. The last are what users import (``__init__``) and start.
ROOMS = (
    ("_core", "_version"),
    ("_choices",),
    ("problems",),
    ("door",),
    ("sweeps",),
    ("charts", "atlas", "conversion"),
    ("commands",),
    ("cli", "__init__"),
    ("__main__",),
)
ELSEWHERE = ("plugin", "core", "bindings")  # C++, and a module of the script door that LAMMPS finds by itself
Edge = tuple[str, str, int]  # who imports what, in which line


def module_name(path: Path, package: Path) -> str:
    """Return a file's place in the package, with dots: ``door.attach``, ``__init__``, ``atlas.__init__``."""
    return ".".join(path.relative_to(package).with_suffix("").parts)


def modules(package: Path) -> dict[str, ast.Module]:
    """Return the parsed modules of the package by name."""
    paths = [path for path in sorted(package.rglob("*.py")) if path.relative_to(package).parts[0] not in ELSEWHERE]
    return {module_name(path, package): ast.parse(path.read_text(encoding="utf-8")) for path in paths}


@cache
def imports(package: Path) -> list[Edge]:
    """Return all imports within the package: of modules, in functions, and for types alone."""
    parsed = modules(package)
    known = {*parsed, "_core.__init__", "_core"}
    return [
        (name, target, line)
        for name, tree in parsed.items()
        for imported, line in _imported(tree, name, package.name)
        if (target := _resolved(imported, known)) != name
    ]


def _imported(tree: ast.Module, name: str, root: str) -> Iterator[tuple[str, int]]:
    """Return what a module imports of the package, as dotted names below it; ``""`` is the package itself."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            above = [root, *name.split(".")][: -node.level] if node.level else []
            base = ".".join([*above, *filter(None, [node.module])])
            names = [f"{base}.{alias.name}" for alias in node.names]
        else:
            continue
        yield from ((one[len(root) + 1 :], node.lineno) for one in names if one.split(".")[0] == root)


def _resolved(imported: str, known: set[str]) -> str:
    """Return the module that a dotted name lies in: the name itself, or the nearest above it."""
    parts = imported.split(".") if imported else []
    while parts:
        for name in (".".join(parts), ".".join([*parts, "__init__"])):
            if name in known:
                return name
        parts.pop()
    return "__init__"


def circles(edges: list[Edge]) -> list[list[str]]:
    """Return the circles that following the imports depth first meets, each from its first module on."""
    targets: dict[str, set[str]] = {}
    for name, target, _ in edges:
        targets.setdefault(name, set()).add(target)
    found: list[list[str]] = []
    done: set[str] = set()

    def follow(name: str, path: list[str]) -> None:
        if name in path:
            found.append(path[path.index(name) :])
        elif name not in done:
            for target in sorted(targets.get(name, ())):
                follow(target, [*path, name])
            done.add(name)

    for name in sorted(targets):
        follow(name, [])
    return found


def against_the_direction(edges: list[Edge]) -> list[str]:
    """Return the imports that go to a room above, or to another one of the same level."""
    level = {room: height for height, rooms in enumerate(ROOMS) for room in rooms}
    wrong = []
    for name, target, line in edges:
        room, other = name.split(".")[0], target.split(".")[0]
        if room != other and level[other] >= level[room]:
            wrong.append(f"{name.replace('.', '/')}.py:{line} imports {target}")
    return wrong


def test_every_module_is_in_a_room() -> None:
    rooms = {name.split(".")[0] for name in modules(PACKAGE)}
    assert rooms == {room for rooms in ROOMS for room in rooms} - {"_core"}


def test_imports_run_in_no_circle() -> None:
    edges = imports(PACKAGE)
    assert len(edges) > 200
    assert circles(edges) == []


def test_imports_point_down() -> None:
    assert against_the_direction(imports(PACKAGE)) == []


def test_nothing_imports_the_package_itself() -> None:
    assert [(name, line) for name, target, line in imports(PACKAGE) if target == "__init__"] == []


def test_public_names_are_those_that_are_listed() -> None:
    code = "import nscd_lmp; print(*(name for name in vars(nscd_lmp) if name[0] != '_'))"
    done = subprocess.run([sys.executable, "-I", "-c", code], capture_output=True, text=True, check=True, cwd="/")
    rooms = {"door", "problems", "sweeps"}
    assert set(done.stdout.split()) == {name for name in nscd_lmp.__all__ if name[0] != "_"} | rooms


# the questions above can be answered with no

CIRCLE = "from nscd_lmp.door.walls import Plane"


@pytest.mark.parametrize(
    "text",
    [
        CIRCLE,
        "import nscd_lmp.door.walls",
        "from .walls import Plane",
        "from nscd_lmp.door import walls",
        f"def f():\n    {CIRCLE}",
        f"from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    {CIRCLE}",
    ],
)
def test_circle_is_found_wherever_the_import_stands(tmp_path: Path, text: str) -> None:
    package = write(tmp_path, {"door/walls": "from nscd_lmp.door import create", "door/create": text})
    assert circles(imports(package)) == [["door.create", "door.walls"]]


@pytest.mark.parametrize(
    ("files", "wrong"),
    [
        ({"door/a": "from nscd_lmp import Plane"}, ["door/a.py:1 imports __init__"]),
        ({"door/a": "\nimport nscd_lmp"}, ["door/a.py:2 imports __init__"]),
        ({"problems/a": "from nscd_lmp.door.b import c", "door/b": ""}, ["problems/a.py:1 imports door.b"]),
        ({"charts/a": "from nscd_lmp.atlas import b", "atlas/b": ""}, ["charts/a.py:1 imports atlas.b"]),
        ({"atlas/__init__": "", "sweeps/a": "from nscd_lmp.atlas import b"}, ["sweeps/a.py:1 imports atlas.__init__"]),
        ({"door/a": "from nscd_lmp import _core", "sweeps/b": "from nscd_lmp.door.a import c"}, []),
    ],
)
def test_import_against_the_direction_is_found(tmp_path: Path, files: dict[str, str], wrong: list[str]) -> None:
    assert against_the_direction(imports(write(tmp_path, files))) == wrong


def write(folder: Path, files: dict[str, str]) -> Path:
    """Write a package of these modules; return its folder."""
    package = folder / "nscd_lmp"
    for name, text in ({"__init__": ""} | files).items():
        path = package / f"{name}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return package
