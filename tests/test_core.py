"""The core's own tests (tests/core: C++, no Python, no LAMMPS), one test here for each one there.

They run under the address and undefined behavior sanitizers, which stop a program at the first fault, those of threads
and ranks under the thread sanitizer too; those that count allocations run without, since both replace ``operator new``.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
SOURCES = ROOT / "tests" / "core"
SANITIZERS = "address,undefined"
THREADED = ("test_halo.cpp", "test_threads.cpp")

Program = Callable[..., str]


def names(*patterns: str) -> list[str]:
    """Return the names of the tests in these C++ files."""
    files = sorted(path for pattern in patterns for path in SOURCES.glob(pattern))
    return [name for file in files for name in re.findall(r"^TEST\((\w+)\)", file.read_text(), re.M)]


def tool(name: str) -> str | None:
    """Return the path of a program, first of those that pip installed."""
    return shutil.which(name, path=sysconfig.get_path("scripts")) or shutil.which(name)


def call(command: list[str], timeout: float) -> str:
    """Return the output of a command that must succeed."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=timeout)
    if done.returncode != 0:
        pytest.fail(f"{' '.join(command)}\n{done.stdout}", pytrace=False)
    return done.stdout


def build(folder: Path, target: str, sanitizers: str) -> Program:
    """Build one program of tests/core; return a function that runs it with the given words."""
    cmake = tool("cmake")
    assert cmake, "cmake is missing: pip install '.[test]' brings it"
    # Sanitizers need no more than -O1 and line numbers, and this compiles in half a minute on two cores.
    configure = [cmake, "--fresh", "-S", str(ROOT), "-B", str(folder), "-DNSCD_CORE_TESTS=ON"]
    configure += ["-DCMAKE_CXX_FLAGS=-O1 -g1", f"-DNSCD_SANITIZE={sanitizers}"]
    configure += [f"-DPython_EXECUTABLE={sys.executable}"]  # that has Eigen's headers, whatever PATH says
    call(configure + (["-G", "Ninja"] if tool("ninja") else []), timeout=60)
    call([cmake, "--build", str(folder), "--target", target, "--parallel", "2"], timeout=280)
    return lambda *words: call([str(folder / "tests" / "core" / target), *words], timeout=120)


@pytest.fixture(scope="module")
def folder(request: pytest.FixtureRequest) -> Callable[[str], Path]:
    """Return a function that names a build folder, kept in pytest's cache: a second run compiles little."""
    if not any(tool(compiler) for compiler in ("c++", "g++", "clang++")):
        pytest.skip("there is no C++ compiler")
    return lambda name: request.config.cache.mkdir(name)


@pytest.fixture(scope="module")
def sanitized(folder: Callable[[str], Path]) -> Program:
    return build(folder("core_sanitized"), "core_tests", SANITIZERS)


@pytest.fixture(scope="module")
def watched(folder: Callable[[str], Path]) -> Program:
    return build(folder("core_threads"), "core_thread_tests", "thread")


@pytest.fixture(scope="module")
def counted(folder: Callable[[str], Path]) -> Program:
    return build(folder("core_plain"), "core_memory_tests", "")


@pytest.mark.parametrize("name", names("test_*.cpp"))
def test_core(sanitized: Program, name: str) -> None:
    assert "1 passed, 0 failed" in sanitized(name)


@pytest.mark.parametrize("name", names(*THREADED))
def test_core_threads(watched: Program, name: str) -> None:
    assert "1 passed, 0 failed" in watched(name)


@pytest.mark.parametrize("name", names("memory/test_*.cpp"))
def test_core_memory(counted: Program, name: str) -> None:
    assert "1 passed, 0 failed" in counted(name)


def test_core_runs_every_test_once(sanitized: Program, counted: Program) -> None:
    assert sorted(sanitized("--list").split()) == sorted(names("test_*.cpp"))
    assert sorted(counted("--list").split()) == sorted(names("memory/test_*.cpp"))


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
