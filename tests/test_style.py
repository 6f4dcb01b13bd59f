# SPDX-License-Identifier: GPL-2.0-or-later
"""Lint, format and types: what `ruff check`, `ruff format --check` and `mypy` say."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent


def python_module(*words: str, cwd: Path = ROOT) -> None:
    """Run ``python -m`` with these words; fail with what it printed."""
    done = subprocess.run([sys.executable, "-m", *words], cwd=cwd, capture_output=True, text=True, timeout=300)
    if done.returncode != 0:
        pytest.fail(done.stdout + done.stderr, pytrace=False)


@pytest.mark.fast
def test_ruff_finds_nothing() -> None:
    python_module("ruff", "check", "--no-cache", "--output-format", "concise")


@pytest.mark.fast
def test_ruff_would_change_nothing() -> None:
    python_module("ruff", "format", "--check", "--no-cache")


# The installed package, since only it has the stubs of the compiled module; not from the repository's root,
# where the package's source folder would come first.
def test_types_of_the_package_hold(tmp_path: Path) -> None:
    words = ["--config-file", str(ROOT / "pyproject.toml"), "--cache-dir", str(tmp_path), "-p", "nscd_lmp"]
    python_module("mypy", *words, cwd=tmp_path)


def test_types_of_the_repository_hold(tmp_path: Path) -> None:
    python_module("mypy", "--cache-dir", str(tmp_path))


def lines() -> list[tuple[str, str]]:
    """Return the lines of all C++ files with their places."""
    return [
        (f"{path.relative_to(ROOT)}:{number}", line)
        for folder in ("nscd_lmp", "tests/core")
        for path in sorted((ROOT / folder).rglob("*.[ch]pp"))
        for number, line in enumerate(path.read_text().splitlines(), 1)
    ]


@pytest.mark.fast
def test_lines_of_cpp_files_have_120_characters_at_most() -> None:
    assert [place for place, line in lines() if len(line) > 120] == []


def hot_functions() -> dict[str, str]:
    """Return the bodies of the functions that are compiled for several processors (base/hot.hpp), by place."""
    bodies = {}
    for path in sorted((ROOT / "nscd_lmp").rglob("*.[ch]pp")):
        for part in re.split(r"\bNSCD_HOT\b(?! __attr)", path.read_text())[1:]:
            head, brace, rest = part.partition("\n{\n")
            if brace:  # without comments
                bodies[f"{path.relative_to(ROOT)}: {head.split('(')[0].split()[-1]}"] = re.sub(
                    "//.*", "", rest.partition("\n}")[0]
                )
    return bodies


# Compiled for AVX2 they take 32 bytes for granted, which the baseline does not give: a run in Python crashed.
@pytest.mark.fast
def test_members_of_vector_type_are_aligned() -> None:
    plain = re.compile(r"^ +(Vec4|Body) \w+(\{[^}]*\})?(, \w+(\{[^}]*\})?)*;")
    assert [place for place, line in lines() if ".hpp:" in place and plain.match(line)] == []


# GCC takes them for functions that never throw: an exception that leaves one ends the program.
@pytest.mark.fast
def test_hot_functions_raise_no_errors() -> None:
    bodies = hot_functions()
    assert len(bodies) > 20
    assert [place for place, body in bodies.items() if re.search(r"\b(fail|refuse\w*|require\w*|throw)\b", body)] == []


# Ten values in a row say nothing, and one that is left out moves the others.
def test_registered_entries_name_their_members() -> None:
    entry = re.compile(r"\bRegister(?:Solver|Scheme) \w+\((?:\w+(?:<\w+>)?\()?\s*\{\s*(\S+)")
    places = [ROOT / folder for folder in ("nscd_lmp", "docs")]
    files = [path for place in places for path in place.rglob("*") if path.suffix in (".cpp", ".md")]
    first = [word for path in files for word in entry.findall(path.read_text())]
    assert len(first) >= 14 and set(first) == {".order"}


def test_every_source_file_names_its_licence() -> None:
    """First line, or second behind a ``#!``."""
    folders = ("nscd_lmp", "analysis", "benchmarks", "docs", "inputs", "tests", "cmake", ".ci")
    files = [path for folder in folders for path in (ROOT / folder).rglob("*") if path.is_file()]
    sources = [
        path
        for path in [ROOT / "CMakeLists.txt", *files]
        if path.suffix in (".py", ".cpp", ".hpp", ".cmake")
        or path.name == "CMakeLists.txt"
        or path.relative_to(ROOT).parts[0] in ("inputs", ".ci")
    ]
    named = re.compile(r"(#!.*\n)?(//|#) SPDX-License-Identifier: GPL-2\.0-or-later\n")
    assert [str(path.relative_to(ROOT)) for path in sources if not named.match(path.read_text())] == []
    assert 'license = "GPL-2.0-or-later"' in (ROOT / "pyproject.toml").read_text()
