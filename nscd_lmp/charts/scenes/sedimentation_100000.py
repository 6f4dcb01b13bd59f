# SPDX-License-Identifier: GPL-2.0-or-later
"""Sedimentation of 100,000 grains, over a short window."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from nscd_lmp.charts.cases import overlap_cases, penalty_cases, rigid_cases
from nscd_lmp.charts.half_settled import HalfSettled, run_window
from nscd_lmp.charts.sedimentations import ERRORS as ALL_ERRORS
from nscd_lmp.charts.sedimentations import LIGHTEST
from nscd_lmp.charts.size import Size

ORDER = 52
TITLE = "Sedimentation of 100,000 grains in a box, a window when half have landed"
ERRORS = {name: ALL_ERRORS[name] for name in ("overlap_max", "overlap_mean")}
NOTES = """From the state at 0.06 s of the fall, made by law gap with dt 1e-3 s. Rigid contacts run for 0.01 s
after three steps that are not timed, penalty contacts 600 steps after 60, and seconds are scaled to a simulated
second. The overlap of penalty contacts is the largest of 20 looks within those 600 steps: over a longer time it
is larger. Seconds are processor seconds of the one thread."""
RUN = HalfSettled(grains=100_000, start=0.06, window=0.01, penalty_steps=600)
QUICK = HalfSettled(grains=150, start=0.02, window=0.004, penalty_steps=200)


def cases(size: Size) -> list[dict[str, Any]]:
    """Return the cases."""
    if size is Size.QUICK:
        return [
            *rigid_cases(["gap/apgs"], [5e-4], [1e-6], grains=150),
            *penalty_cases(["gran/hooke/history"], [1e3], LIGHTEST, [1 / 4], grains=150),
        ]

    def rigid(method: str, dts: list[float], overlaps: list[float], **tol: float) -> list[dict[str, Any]]:
        return overlap_cases([method], dts, overlaps, grains=100_000, **tol)

    def soft(*stiffnesses: float) -> list[dict[str, Any]]:
        return penalty_cases(["gran/hooke/history"], stiffnesses, LIGHTEST, [1 / 3], grains=100_000)

    # in turns, so that a busy hour hits both families
    return [
        *rigid("gap/apgs", [5e-4], [5e-3, 5e-4]),
        *soft(3e3, 3e5),
        *rigid("gap/apgs", [2.5e-4, 5e-4, 1e-3], [5e-3, 5e-4], tol=1e-5),
        *soft(5e3, 1e5),
        *rigid("gap/apgs", [5e-4], [9e-3, 9e-4], tol=1e-5),
        *rigid_cases(["gap/apgs"], [5e-4], [1e-6], grains=100_000),
        *soft(1e4),
        *rigid("gap/auto", [5e-4], [5e-4]),
        *rigid_cases(["gap/pdas"], [5e-4], [1e-6], grains=100_000),
    ]


def run(folder: Path, **case: Any) -> dict[str, Any]:
    """Run a case."""
    return run_window(RUN if case["grains"] == RUN.grains else QUICK, folder, case)
