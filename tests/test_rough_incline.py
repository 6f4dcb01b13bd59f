# SPDX-License-Identifier: GPL-2.0-or-later
"""The rough incline of the benchmarks keeps its grains, and says what it cannot draw."""

from __future__ import annotations

import csv
import subprocess
import sys
from pathlib import Path

BENCHMARK = Path(__file__).parents[1] / "benchmarks/rough_incline.py"


def run(*words: str) -> subprocess.CompletedProcess[str]:
    """Run the benchmark."""
    return subprocess.run([sys.executable, str(BENCHMARK), *words], capture_output=True, text=True, timeout=300)


def test_a_grain_that_falls_into_a_hole_of_the_base_stays_in_the_box(tmp_path: Path) -> None:
    """Seed 11 draws a base with a hole that a grain fits through. Without the plane below the base this fails:
    a grain reaches the hole after 0.14 s, falls through it, and leaves the box."""
    words = ["--laws", "--stiffnesses", "60", "--seeds", "11", "--seconds", "0.4"]
    done = run(*words, "--output", str(tmp_path))
    assert done.returncode == 0, done.stderr
    with (tmp_path / "rough_incline.csv").open(newline="") as file:
        assert [row["seed"] for row in csv.DictReader(file)] == ["11"]


def test_rows_that_are_not_there_are_told_of_in_one_line(tmp_path: Path) -> None:
    """Fails if a missing table ends in a traceback, or if the line does not name the table."""
    done = run("--draw", "no.csv", "--output", str(tmp_path))
    assert done.returncode == 1
    line = "rough_incline.py: cannot read no.csv: No such file or directory; a run without --draw writes the rows\n"
    assert done.stderr == line
