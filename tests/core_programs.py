# SPDX-License-Identifier: GPL-2.0-or-later
"""The programs of tests/core: built by CMake, run with words."""

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


def build(folder: Path, target: str, sanitizers: str, *options: str) -> Program:
    """Build one program of tests/core, with more words for CMake; return a function that runs it with words."""
    cmake = tool("cmake")
    assert cmake, "cmake is missing: pip install '.[test]' brings it"
    # Sanitizers need no more than -O1 and line numbers, and this compiles in half a minute on two cores.
    configure = [cmake, "--fresh", "-S", str(ROOT), "-B", str(folder), "-DNSCD_CORE_TESTS=ON"]
    configure += ["-DCMAKE_CXX_FLAGS=-O1 -g1", f"-DNSCD_SANITIZE={sanitizers}"]
    configure += [f"-DPython_EXECUTABLE={sys.executable}", *options]  # that has Eigen's headers, whatever PATH says
    call(configure + (["-G", "Ninja"] if tool("ninja") else []), timeout=60)
    call([cmake, "--build", str(folder), "--target", target, "--parallel", "2"], timeout=700)
    return lambda *words: call([str(folder / "tests" / "core" / target), *words], timeout=120)
