# SPDX-License-Identifier: GPL-2.0-or-later
"""Balls hit a wall at all angles."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from nscd_lmp.charts.cases import Case
from nscd_lmp.charts.grains import fastest_run, per_grain
from nscd_lmp.charts.overlap import largest_overlap
from nscd_lmp.charts.penalty import contact_duration
from nscd_lmp.charts.scenes import _lone_balls as lone
from nscd_lmp.charts.size import Size

ORDER = 30
TITLE = "Oblique impact: stick or slip by the angle, rigid-body theory"
ERRORS = {
    "tangential_error": "error of the velocity along the wall,\nlargest / impact speed",
    "normal_error": "error of the velocity from the wall,\nlargest / impact speed",
    "overlap": "largest overlap / radius",
}
NOTES = """100 balls hit a wall at 1 m/s, at angles of 0 to 85 degrees from its normal, without gravity. With e, mu and
e_t of Foerster et al. (1994) for cellulose acetate the impact sticks and reverses e_t of the slip where
(1 + e_t) tan(angle) <= 7/2 mu (1 + e), and slides beyond (Walton's model). Penalty contacts have the tangential
stiffness by which a contact that sticks reverses e_t of its slip; between sticking and sliding they do both in one
impact, which this theory does not have: their error there does not go away with stiffness."""
FLOOR = 1e-12  # rounding of thousands of steps

RADIUS, DENSITY = 3e-3, 1319.0  # m, kg/m^3
RESTITUTION, FRICTION, E_T = 0.87, 0.25, 0.43
SPEED = 1.0  # m/s
IMPACT, DURATION = 0.02, 0.04  # s
DTS = (3e-3, 1e-3, 1e-4)  # s; law moreau looks half a step ahead, and refuses to find a ball inside a wall
STIFFNESSES = (1e4, 1e5, 1e6, 1e7)  # N/m
ANGLES = np.radians(np.linspace(0, 85, lone.BALLS))


def cases(size: Size) -> list[Case]:
    """Return the cases."""
    return lone.all_cases(size, STIFFNESSES, lone.mass(RADIUS, DENSITY), friction=True, dts=DTS)


def closed_form() -> tuple[lone.Array, lone.Array]:
    """Return the velocities along and from the wall after the impacts, m/s."""
    v_t, v_n = SPEED * np.sin(ANGLES), SPEED * np.cos(ANGLES)
    sticks = 2 / 7 * (1 + E_T) * v_t
    slides = FRICTION * (1 + RESTITUTION) * v_n
    return v_t - np.minimum(sticks, slides), RESTITUTION * v_n


def run(folder: Path, **case: Any) -> dict[str, Any]:
    """Run a case, and compare with the closed form."""
    v = lone.along(SPEED * np.sin(ANGLES), SPEED * np.cos(ANGLES))
    begin = partial(
        lone.open_balls, folder, case, IMPACT * -v[:, 2], v, radius=RADIUS, density=DENSITY, gravity=0.0,
        restitution=RESTITUTION, friction=FRICTION, e_t=E_T, speed=SPEED,
    )  # fmt: skip
    steps = round(DURATION / case["dt"])
    seconds, contacts = fastest_run(begin, steps, lone.REPEATS)
    expected_t, expected_n = closed_form()
    after = per_grain(contacts.lmp, "v")
    result = {
        "tangential_error": float(np.abs(after[:, 0] - expected_t).max()) / SPEED,
        "normal_error": float(np.abs(after[:, 2] - expected_n).max()) / SPEED,
        **seconds,
        "simulated": steps * case["dt"],
        **lone.counts(contacts),
    }
    if lone.is_rigid(case):
        return result | {"overlap": lone.overlap(contacts)}
    # looked at in a run of its own, from the impact to its end
    first = int(IMPACT / case["dt"])
    last = first + int(4 * contact_duration(case["stiffness"], lone.mass(RADIUS, DENSITY)) / case["dt"])
    return result | {"overlap": largest_overlap(begin(), [lone.FLOOR], last, first)}
