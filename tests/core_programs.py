# SPDX-License-Identifier: GPL-2.0-or-later
"""The programs of tests/core: built by CMake, run with words."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import sysconfig
import xml.etree.ElementTree as ElementTree
from collections.abc import Sequence
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
SOURCES = ROOT / "tests" / "core"
SANITIZERS = "address,undefined"


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


class Program:
    """A program of tests/core. Its tests run once, those that are wanted in a few processes."""

    AT_A_TIME = 40  # so that no process takes minutes, even under sanitizers

    def __init__(self, path: Path, wanted: Sequence[str]) -> None:
        self.path, self.wanted, self.failures = path, list(wanted), dict[str, str]()

    def names(self) -> list[str]:
        """Return the names of its tests."""
        return [line for line in call([str(self.path), "-ltc"], 60).splitlines() if re.fullmatch(r"\w+", line)]

    def run(self, names: Sequence[str]) -> dict[str, str]:
        """Run tests; return what each failed by, ``""`` for those that passed."""
        report = self.path.with_suffix(".xml")
        report.unlink(missing_ok=True)
        words = [str(self.path), f"-tc={','.join(names)}", "--reporters=junit", f"--out={report}"]
        done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=600)
        try:
            cases = list(ElementTree.parse(report).iter("testcase"))
        except (OSError, ElementTree.ParseError):  # a sanitizer, or a crash, has ended it
            return {name: self.alone(name) for name in names}
        found = {case.attrib["name"]: "\n".join(f.attrib["message"] + (f.text or "") for f in case) for case in cases}
        if done.returncode != 0 and not any(found.values()):  # a report may not know all that fails
            return {name: done.stdout for name in names}
        return found

    def alone(self, name: str) -> str:
        """Run one test; return what it failed by."""
        words = [str(self.path), f"-tc={name}"]
        done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120)
        return "" if done.returncode == 0 else done.stdout

    def check(self, name: str) -> None:
        """Fail with what a test failed by."""
        if failure := self.failure(name):
            pytest.fail(failure, pytrace=False)

    def failure(self, name: str) -> str:
        """Return what a test failed by, ``""`` if it passed; those that are wanted beside it run too."""
        if name not in self.failures:
            first = self.wanted.index(name) // self.AT_A_TIME * self.AT_A_TIME
            self.failures |= self.run(self.wanted[first : first + self.AT_A_TIME])
        return self.failures.get(name, f"{self.path.name} has no such test")


def build(folder: Path, target: str, sanitizers: str, wanted: Sequence[str], *options: str) -> Program:
    """Build one program of tests/core, with more words for CMake; `wanted` are the tests that it is to run."""
    cmake = tool("cmake")
    assert cmake, "cmake is missing: pip install '.[test]' brings it"
    if not any((Path(root) / "include/doctest/doctest.h").exists() for root in ("/usr", "/usr/local", sys.prefix)):
        pytest.skip("there is no doctest: apt-get install doctest-dev")
    # Sanitizers need no more than -O1 and line numbers, and this compiles in half a minute on two cores.
    # Not --fresh, which takes what is compiled away too.
    (folder / "CMakeCache.txt").unlink(missing_ok=True)
    configure = [cmake, "-S", str(ROOT), "-B", str(folder), "-DNSCD_CORE_TESTS=ON"]
    configure += ["-DCMAKE_CXX_FLAGS=-O1 -g1", f"-DNSCD_SANITIZE={sanitizers}"]
    configure += [f"-DPython_EXECUTABLE={sys.executable}", *options]  # that has Eigen's headers, whatever PATH says
    call(configure + (["-G", "Ninja"] if tool("ninja") else []), timeout=60)
    call([cmake, "--build", str(folder), "--target", target, "--parallel", "2"], timeout=700)
    return Program(folder / "tests" / "core" / target, wanted)
