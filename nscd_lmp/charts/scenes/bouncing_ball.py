# SPDX-License-Identifier: GPL-2.0-or-later
"""A ball bounces until it rests."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from nscd_lmp.charts.cases import Case
from nscd_lmp.charts.grains import fastest_run, per_grain
from nscd_lmp.charts.methods import Contacts
from nscd_lmp.charts.overlap import largest_overlap
from nscd_lmp.charts.penalty import contact_duration
from nscd_lmp.charts.scenes import _lone_balls as lone
from nscd_lmp.charts.size import Size

ORDER = 20
TITLE = "Bouncing ball: heights e² h, e⁴ h, ..., and the time of rest"
ERRORS = {
    "height_error": "error of the heights of six bounces,\nlargest / height of fall",
    "rest_error": "error of the time of rest / that time",
    "overlap": "largest overlap / radius",
}
NOTES = """A ball of 1 cm falls from h = 0.5 m on a floor, e = 0.6 (10 of them, each alone). Its n-th bounce is e^(2n)
h high, and it rests after sqrt(2 h/g) (1 + e)/(1 - e) = 1.28 s and infinitely many of them. Compared are the heights of
the first six, and the time after which it stays below h/1000, which is in the sixth."""
FLOOR = 1e-12  # rounding of thousands of steps

BALLS = 10
HEIGHT, RESTITUTION = 0.5, 0.6  # m
LOW = 1e-3 * HEIGHT  # m; below, the ball is taken to rest
BOUNCES = 6
DURATION = 1.5  # s
DTS = (3e-3, 3e-4, 3e-5)  # s
STIFFNESSES = (1e5, 1e6, 1e7, 1e8)  # N/m
FALL = math.sqrt(2 * HEIGHT / lone.GRAVITY)  # s
SPEED = lone.GRAVITY * FALL


def cases(size: Size) -> list[Case]:
    """Return the cases."""
    return lone.all_cases(size, STIFFNESSES, lone.mass(), friction=False, dts=DTS)


def apex(n: int) -> float:
    """Return when the ball is highest in its n-th bounce, s."""
    return FALL * (1 + 2 * sum(RESTITUTION**k for k in range(1, n)) + RESTITUTION**n)


def below(time: float, z: float, v: float) -> float:
    """Return when a ball at height z (m) with velocity v (m/s) at a time (s) will have fallen below LOW."""
    return time + (v + math.sqrt(max(v**2 + 2 * lone.GRAVITY * (z - LOW), 0.0))) / lone.GRAVITY


def rest() -> float:
    """Return the closed form of the time of rest, s."""
    return below(apex(BOUNCES), RESTITUTION ** (2 * BOUNCES) * HEIGHT, 0.0)


def run(folder: Path, **case: Any) -> dict[str, Any]:
    """Run a case, and compare with the closed form."""
    begin = partial(
        lone.open_balls, folder, case, HEIGHT, np.zeros((BALLS, 3)), restitution=RESTITUTION, speed=1.05 * SPEED
    )
    steps = round(DURATION / case["dt"])
    seconds, contacts = fastest_run(begin, steps, lone.REPEATS)
    result = {**seconds, "simulated": steps * case["dt"], **lone.counts(contacts)}
    result["overlap"] = lone.overlap(contacts) if lone.is_rigid(case) else _penalty_overlap(begin(), case)
    contacts.lmp.close()
    return result | _bounces(begin(), case["dt"])


def _bounces(contacts: Contacts, dt: float) -> dict[str, float]:
    """Look at the ball in each of its bounces, near where it is highest; from there on it flies as it must."""
    worst, rests, done = 0.0, FALL, 0
    for n in range(1, BOUNCES + 1):
        steps = round(apex(n) / dt)
        contacts.run(steps - done)
        done = steps
        z = per_grain(contacts.lmp, "x")[0, 2] - lone.RADIUS
        v = per_grain(contacts.lmp, "v")[0, 2]
        height = z + v**2 / (2 * lone.GRAVITY)
        worst = max(worst, abs(height - RESTITUTION ** (2 * n) * HEIGHT))
        if height > LOW:
            rests = below(done * dt, z, v)
    return {"height_error": worst / HEIGHT, "rest_error": abs(rests / rest() - 1)}


def _penalty_overlap(contacts: Contacts, case: dict[str, Any]) -> float:
    """Look at every step of the first impact, which is the hardest."""
    first = int(0.999 * FALL / case["dt"])
    last = int((FALL + 2 * contact_duration(case["stiffness"], lone.mass())) / case["dt"])
    return largest_overlap(contacts, [lone.FLOOR], last, first)
