# SPDX-License-Identifier: GPL-2.0-or-later
"""Sedimentation of 500 grains, section 5.2 of the paper."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from nscd_lmp.charts.cases import overlap_cases, penalty_cases, rigid_cases
from nscd_lmp.charts.methods import penalty_methods, rigid_methods
from nscd_lmp.charts.sedimentations import ERRORS, LIGHTEST, Sedimentation, run_case
from nscd_lmp.charts.size import Size

__all__ = ["ERRORS", "cases", "run"]

ORDER = 50
TITLE = "Sedimentation of 500 grains in a box, e = 0, without friction"
NOTES = """0.05 s from the loose cloud: most of the fall, and the impact of all layers. Overlaps: rigid contacts
after every step, penalty contacts three times a contact duration. Distance: places at 0.01 s against law gap with
dt 2e-5 s and tol 1e-10, root mean square over the grains; two such references with dt 1e-5 and 2e-5 s differ by
0.005 radii then, and by 0.04 at 0.02 s: later trajectories have diverged. Height: mean height over the whole run
against the same reference; two references differ by 0.3 %, root mean square. Penalty contacts damp critically (e =
0.13), so they cannot come nearer than that. Seconds are processor seconds of the one thread, best of 2."""
RUN = Sedimentation(grains=500, simulated=0.05, window=0.01, fine=(2e-5, 1e-10))
QUICK = Sedimentation(grains=60, simulated=0.01, window=0.005, fine=(1e-4, 1e-9), repeats=1)

OVERLAPS = (5e-3, 1e-3, 5e-4)  # of the smallest radius, a step
STEPS = (2e-4, 5e-4, 1e-3, 2e-3)  # s
TOLERANCES = (1e-5, 1e-6, 1e-7)  # m/s
BETWEEN = (3e-6,)  # near overlaps of 1 %
PAPER_STEPS = (5e-5, 2e-4)
FAST = ("apgs", "auto", "pdas", "active_set")  # at all tolerances, the others at one
STIFFNESSES = (3e2, 1e3, 1.5e3, 2e3, 2e4, 1e5, 3e5)  # N/m
PARTS = (1 / 4, 1 / 3)  # of the shortest contact: longer steps lose atoms
CAREFUL = (1e3, 1e5)  # N/m, also at a tenth of a contact


def cases(size: Size) -> list[dict[str, Any]]:
    """Return the cases."""
    if size is Size.QUICK:
        return [
            *rigid_cases(["gap/apgs", "gap/pdas", "moreau/pdas"], [5e-4], [1e-6], grains=60),
            *penalty_cases(["gran/hooke/history"], [1e3], LIGHTEST, [1 / 4], grains=60),
        ]
    others = [name for name in rigid_methods(laws=["gap"]) if name.partition("/")[2] not in FAST]
    soft = penalty_methods()[::-1]
    # rigid and penalty in turns, so that a busy hour hits both
    return [
        *rigid_cases(["gap/apgs"], STEPS, TOLERANCES + BETWEEN, grains=500),
        *overlap_cases(["gap/apgs"], STEPS[1:], OVERLAPS, grains=500),
        *overlap_cases(["gap/apgs"], STEPS[1:], OVERLAPS, grains=500, tol=1e-5),
        *penalty_cases(soft[:1], STIFFNESSES, LIGHTEST, PARTS, grains=500),
        *rigid_cases([f"gap/{solver}" for solver in FAST[1:]], STEPS, TOLERANCES, grains=500),
        *penalty_cases(soft[:1], CAREFUL, LIGHTEST, [1 / 10], grains=500),
        *penalty_cases(soft[1:], STIFFNESSES[1::2], LIGHTEST, PARTS[:1], grains=500),
        *rigid_cases([f"moreau/{solver}" for solver in FAST[:3]], PAPER_STEPS, TOLERANCES[1:2], grains=500),
        *rigid_cases(others, STEPS[1:3], TOLERANCES[1:2], grains=500),
    ]


def run(folder: Path, **case: Any) -> dict[str, Any]:
    """Run a case."""
    return run_case(RUN if case["grains"] == RUN.grains else QUICK, folder, case)
