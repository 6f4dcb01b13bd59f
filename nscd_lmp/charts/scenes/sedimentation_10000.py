# SPDX-License-Identifier: GPL-2.0-or-later
"""Sedimentation of 10,000 grains."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from nscd_lmp.charts.cases import overlap_cases, penalty_cases, rigid_cases
from nscd_lmp.charts.sedimentations import ERRORS as ALL_ERRORS
from nscd_lmp.charts.sedimentations import LIGHTEST, Sedimentation, run_case
from nscd_lmp.charts.size import Size

ORDER = 51
TITLE = "Sedimentation of 10,000 grains in a box, e = 0, without friction"
ERRORS = {name: label for name, label in ALL_ERRORS.items() if name.startswith("overlap")}
NOTES = """0.1 s from the loose cloud. Overlaps: rigid contacts after every step, penalty contacts at 500 times, so
theirs may be somewhat larger. Seconds are processor seconds of the one thread, one run."""
RUN = Sedimentation(grains=10_000, simulated=0.1, window=0.01, fine=None)
QUICK = Sedimentation(grains=120, simulated=0.01, window=0.005, fine=None)


def cases(size: Size) -> list[dict[str, Any]]:
    """Return the cases."""
    if size is Size.QUICK:
        return [
            *rigid_cases(["gap/apgs"], [5e-4], [1e-6], grains=120),
            *penalty_cases(["gran/hooke/history"], [1e3], LIGHTEST, [1 / 4], grains=120),
        ]

    def rigid(method: str, dts: list[float], tols: list[float]) -> list[dict[str, Any]]:
        return rigid_cases([method], dts, tols, grains=10_000)

    def soft(*stiffnesses: float) -> list[dict[str, Any]]:
        return penalty_cases(["gran/hooke/history"], stiffnesses, LIGHTEST, [1 / 3], grains=10_000)

    # in turns, so that a busy hour hits both families
    return [
        *overlap_cases(["gap/apgs"], [5e-4, 1e-3], [5e-3], grains=10_000),
        *rigid("gap/apgs", [5e-4, 1e-3], [1e-6]),
        *soft(3e3, 5e3),
        *overlap_cases(["gap/apgs"], [5e-4, 1e-3], [1e-3, 5e-4], grains=10_000),
        *overlap_cases(["gap/apgs"], [5e-4, 1e-3], [5e-3, 5e-4], grains=10_000, tol=1e-5),
        *rigid("gap/apgs", [5e-4, 1e-3], [1e-7]),
        *soft(1e5),
        *rigid("gap/apgs", [5e-4, 1e-3], [3e-6, 3e-7]),
        *rigid("gap/apgs", [2e-3], [1e-6, 1e-7]),
        *soft(2e5),
        *rigid("gap/pdas", [1e-3], [1e-6]),
        *rigid("gap/auto", [1e-3], [1e-7]),
    ]


def run(folder: Path, **case: Any) -> dict[str, Any]:
    """Run a case."""
    return run_case(RUN if case["grains"] == RUN.grains else QUICK, folder, case)
