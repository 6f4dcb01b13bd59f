# SPDX-License-Identifier: GPL-2.0-or-later
"""A bed with friction that has come to rest stays where it is."""

from __future__ import annotations

import csv
import subprocess
import sys
from pathlib import Path

BENCHMARK = Path(__file__).parents[1] / "benchmarks/long_rest.py"
STEPS = 100_000
SMALL = 1e-14  # of sqrt(g d) and sqrt(g / d)


def test_a_bed_at_rest_does_not_drift(tmp_path: Path) -> None:
    """40 grains in a box, level and tilted by 10 degrees, for 100,000 steps; benchmarks/long_rest.py has a million.

    Measured there, six beds: no grain leaves its place by a bit, velocities and spins stay below 1e-16, and the overlap
    stays that of the first look. Fails if impulses of a step do not balance those of gravity (g dt is 2e-2 in these
    units), or if a step leaves a remainder that adds up to 1e-9 d. It fails without warm start (grains have moved by
    1e-3 d after 4000 steps), with accuracy loose (2e-3 d), and with law moreau, which leaves overlaps of 3 %.
    """
    words = [sys.executable, str(BENCHMARK), "--steps", str(STEPS), "--seeds", "1", "--output", str(tmp_path)]
    subprocess.run(words, check=True, capture_output=True, timeout=300)
    with (tmp_path / "long_rest.csv").open(newline="") as file:
        looks = list(csv.DictReader(file))
    assert {look["case"] for look in looks} == {"level", "tilted"}
    assert max(int(look["step"]) for look in looks) == STEPS
    for case in ("level", "tilted"):
        mine = [look for look in looks if look["case"] == case]
        for look in mine:
            assert float(look["moved"]) <= STEPS * SMALL
            assert abs(float(look["rise"])) <= STEPS * SMALL
            assert float(look["fastest"]) <= SMALL  # and with it the energy, the spins and the momentum
        # what the first steps of the rest had, which the default accuracy bounds by 5e-4
        overlaps = [float(look["overlap_ratio"]) for look in mine[1:]]
        assert max(overlaps) <= 5e-4 and max(overlaps) <= 1.001 * overlaps[0]
        # Contacts that push nothing may open and shut at round-off; none that carries does
        contacts = [int(look["contacts"]) for look in mine]
        assert max(contacts) - min(contacts) <= 5
