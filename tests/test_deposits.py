# SPDX-License-Identifier: GPL-2.0-or-later
"""How dense grains lie that have fallen, without friction and with much of it: what packings are known for.

Random close packing of frictionless spheres is 0.64 with 6 contacts a grain (here beside a floor, of grains of 0.9 to
1.1 mm, and at the end of a fall: 0.638 and 5.85); with friction 1 a loose one is 0.55 to 0.58 with 4 and a little more
(0.578 and 4.36). The scene, and the values over many seeds: benchmarks/deposits.py, docs/how_large_a_step.md.
"""

from __future__ import annotations

import csv
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
# Fraction and contacts a grain; one deposit is off by 0.002 and 0.02 from the next.
KNOWN = {0.0: (0.638, 5.85), 1.0: (0.578, 4.36)}


def test_deposits_are_as_dense_as_they_are_known_to_be(tmp_path: Path) -> None:
    words = [sys.executable, str(ROOT / "benchmarks/deposits.py"), "--steps", "--frictions", *map(str, KNOWN)]
    subprocess.run([*words, "--seeds", "1", "--output", str(tmp_path)], check=True, capture_output=True, timeout=300)
    with (tmp_path / "deposits.csv").open(newline="") as file:
        found = {float(row["friction"]): row for row in csv.DictReader(file)}
    assert found.keys() == KNOWN.keys()
    for friction, (fraction, contacts) in KNOWN.items():
        assert float(found[friction]["fraction"]) == pytest.approx(fraction, abs=0.008)
        assert float(found[friction]["contacts"]) == pytest.approx(contacts, rel=0.03)
