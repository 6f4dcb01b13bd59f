# SPDX-License-Identifier: GPL-2.0-or-later
"""Balls thrown along a floor slide until they roll."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from nscd_lmp.charts.cases import Case
from nscd_lmp.charts.grains import fastest_run, per_grain
from nscd_lmp.charts.scenes import _lone_balls as lone
from nscd_lmp.charts.size import Size

ORDER = 40
TITLE = "Slide to roll: 5/7 of the speed is left"
ERRORS = {
    "speed_error": "error of the rolling speed,\nlargest / initial speed",
    "distance_error": "error of the distance,\nlargest / distance",
    "overlap": "overlap / radius",
}
NOTES = """A ball thrown without spin slides until t1 = 2 v0/(7 mu g), then rolls at 5/7 v0. 100 balls of 1 cm, each
alone, v0 = 0.5 to 1.5 m/s, mu = 0.3, e = 0; they start with the gap 0 and are looked at after 0.3 s, when the fastest
has rolled for 0.15 s."""
FLOOR = 1e-12  # rounding of thousands of steps

FRICTION = 0.3
DURATION = 0.3  # s
STIFFNESSES = (1e3, 1e4, 1e5, 1e6)  # N/m
SPEEDS = np.linspace(0.5, 1.5, lone.BALLS)  # m/s


def cases(size: Size) -> list[Case]:
    """Return the cases."""
    return lone.all_cases(size, STIFFNESSES, lone.mass(), friction=True)


def run(folder: Path, **case: Any) -> dict[str, Any]:
    """Run a case, and compare with the closed form."""
    begin = partial(lone.open_balls, folder, case, 0.0, lone.along(SPEEDS), friction=FRICTION, speed=1.5)
    steps = round(DURATION / case["dt"])
    seconds, contacts = fastest_run(begin, steps, lone.REPEATS)
    slides = 2 * SPEEDS / (7 * FRICTION * lone.GRAVITY)
    rolls = steps * case["dt"] - slides
    distance = SPEEDS * slides - FRICTION * lone.GRAVITY * slides**2 / 2 + 5 / 7 * SPEEDS * rolls
    v = per_grain(contacts.lmp, "v")[:, 0]
    return {
        "speed_error": float(np.abs(v / SPEEDS - 5 / 7).max()),
        "distance_error": float(np.abs(lone.travelled(contacts.lmp) / distance - 1).max()),
        "overlap": lone.overlap(contacts),
        **seconds,
        "simulated": steps * case["dt"],
        **lone.counts(contacts),
    }
