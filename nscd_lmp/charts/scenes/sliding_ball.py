# SPDX-License-Identifier: GPL-2.0-or-later
"""Balls with back spin slide to a stop."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from nscd_lmp.charts.cases import Case
from nscd_lmp.charts.grains import fastest_run, per_grain
from nscd_lmp.charts.scenes import _lone_balls as lone
from nscd_lmp.charts.size import Size

ORDER = 10
TITLE = "Sliding ball: friction stops it after v0²/(2 mu g)"
ERRORS = {
    "distance_error": "error of the distance slid,\nlargest / distance",
    "creep": "speed when it should rest,\nlargest / initial speed",
    "overlap": "overlap / radius",
}
NOTES = """A ball slides at v0 with the back spin 5/2 v0/r: friction stops both at once, after v0^2/(2 mu g), and there
it stays. 100 balls of 1 cm, each alone, v0 = 0.5 to 1.5 m/s, mu = 0.3, e = 0; they start with the gap 0 and are looked
at after 0.6 s, when the fastest has rested for 0.09 s."""
FLOOR = 1e-12  # rounding of thousands of steps

FRICTION = 0.3
DURATION = 0.6  # s
STIFFNESSES = (1e3, 1e4, 1e5, 1e6)  # N/m
SPEEDS = np.linspace(0.5, 1.5, lone.BALLS)  # m/s


def cases(size: Size) -> list[Case]:
    """Return the cases."""
    return lone.all_cases(size, STIFFNESSES, lone.mass(), friction=True)


def run(folder: Path, **case: Any) -> dict[str, Any]:
    """Run a case, and compare with the closed form."""
    spin = -2.5 * SPEEDS
    begin = partial(lone.open_balls, folder, case, 0.0, lone.along(SPEEDS), spin, friction=FRICTION, speed=1.5)
    steps = round(DURATION / case["dt"])
    seconds, contacts = fastest_run(begin, steps, lone.REPEATS)
    distance = SPEEDS**2 / (2 * FRICTION * lone.GRAVITY)
    velocity, omega = (per_grain(contacts.lmp, name) for name in ("v", "omega"))
    fastest = np.maximum(np.abs(velocity).max(axis=1), lone.RADIUS * np.abs(omega).max(axis=1))
    return {
        "distance_error": float(np.abs(lone.travelled(contacts.lmp) / distance - 1).max()),
        "creep": float((fastest / SPEEDS).max()),
        "overlap": lone.overlap(contacts),
        **seconds,
        "simulated": steps * case["dt"],
        **lone.counts(contacts),
    }
