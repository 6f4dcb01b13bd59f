# SPDX-License-Identifier: GPL-2.0-or-later
"""The core's own tests (tests/core: C++, no Python, no LAMMPS), one test here for each one there.

They run under the address and undefined behavior sanitizers, which stop a program at the first fault, those of threads
and ranks under the thread sanitizer too; those that count allocations run without, since both replace ``operator new``.
All run once more as clang compiles them, if there is one: everything else may be GCC's.
"""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from core_programs import SANITIZERS, Program, build, call, names, tool

THREADED = ("test_halo.cpp", "test_threads.cpp")

Folder = Callable[[str], Path]


def wanted(request: pytest.FixtureRequest, test: str) -> list[str]:
    """Return the names that a test of this file is asked for in this session."""
    items = [item for item in request.session.items if isinstance(item, pytest.Function) and item.originalname == test]
    return [item.callspec.params["name"] for item in items]


@pytest.fixture(scope="module")
def sanitized(build_folder: Folder, request: pytest.FixtureRequest) -> Program:
    return build(build_folder("core_sanitized"), "core_tests", SANITIZERS, wanted(request, "test_core"))


@pytest.fixture(scope="module")
def watched(build_folder: Folder, request: pytest.FixtureRequest) -> Program:
    return build(build_folder("core_threads"), "core_thread_tests", "thread", wanted(request, "test_core_threads"))


@pytest.fixture(scope="module")
def counted(build_folder: Folder, request: pytest.FixtureRequest) -> Program:
    return build(build_folder("core_plain"), "core_memory_tests", "", wanted(request, "test_core_memory"))


@pytest.fixture(scope="module")
def by_clang(build_folder: Folder, request: pytest.FixtureRequest) -> Program:
    compiler = tool("clang++")
    if compiler is None:
        pytest.skip("there is no clang++: apt-get install clang")
    names_wanted = wanted(request, "test_core_compiled_by_clang")
    return build(build_folder("core_clang"), "core_tests", "", names_wanted, f"-DCMAKE_CXX_COMPILER={compiler}")


@pytest.mark.parametrize("name", names("test_*.cpp"))
def test_core(sanitized: Program, name: str) -> None:
    sanitized.check(name)


@pytest.mark.parametrize("name", names(*THREADED))
def test_core_threads(watched: Program, name: str) -> None:
    watched.check(name)


@pytest.mark.parametrize("name", names("memory/test_*.cpp"))
def test_core_memory(counted: Program, name: str) -> None:
    counted.check(name)


@pytest.mark.parametrize("name", names("test_*.cpp"))
def test_core_compiled_by_clang(by_clang: Program, name: str) -> None:
    by_clang.check(name)


def test_core_has_every_test_once(sanitized: Program, counted: Program) -> None:
    assert sorted(sanitized.names()) == sorted(names("test_*.cpp"))
    assert sorted(counted.names()) == sorted(names("memory/test_*.cpp"))


def test_sanitizers_stop_the_program(tmp_path: Path) -> None:
    """Sanitizers that report nothing prove nothing: one fault of each kind must be found."""
    compiler = next(filter(None, map(tool, ("c++", "g++", "clang++"))), None)
    if compiler is None:
        pytest.skip("there is no C++ compiler")
    both = "std::thread t([&] { ++n; }); ++n; t.join(); return n == 0;"
    for fault, sanitizers in (
        ("int *p = new int[n]; int v = p[n]; delete[] p; return v;", SANITIZERS),
        ("return 2147483647 + n > 0;", SANITIZERS),
        (both, "thread"),
    ):
        (tmp_path / "fault.cpp").write_text(f"#include <thread>\nint main(int n, char **) {{ {fault} }}\n")
        flags = [f"-fsanitize={sanitizers}", "-fno-sanitize-recover=all", "-pthread", "-std=c++20"]
        call([compiler, *flags, str(tmp_path / "fault.cpp"), "-o", str(tmp_path / "fault")], timeout=60)
        assert subprocess.run([tmp_path / "fault"], capture_output=True).returncode != 0
