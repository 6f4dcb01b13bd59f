# SPDX-License-Identifier: GPL-2.0-or-later
"""SimBenchmark's 666 balls, inelastic."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from nscd_lmp.charts.cases import penalty_cases, rigid_cases
from nscd_lmp.charts.many_balls import ENGINES, MASS, PUBLISHED, SOURCE, Variant, run_balls
from nscd_lmp.charts.size import Size

ORDER = 70
TITLE = (
    "SimBenchmark's 666 balls: 216 balls fall and spread on a smooth floor, e = 0\n"
    "stars, published: RaiSim, ODE, DART, MuJoCo, Bullet by their first letters, dt 1e-3 s; small letters 1e-2 s"
)
ERRORS = {
    "penetration": "mean over time of the sum of\nsquared penetrations, m²",
    "overlap_max": "largest overlap / radius",
}
NOTES = """10 s. Stars are the engines that SimBenchmark published in 2018, on another machine: compare their
errors, and no more than the order of their seconds. Penalty contacts damp critically (e = 0.13). Seconds are
processor seconds of the one thread, best of 3."""
FLOOR = 1e-17
REFERENCES = [
    (letter, seconds / PUBLISHED, {"penetration": error}, f"{engine}: {SOURCE}")
    for engine, (fine, fine_seconds, coarse, coarse_seconds, _) in ENGINES.items()
    for letter, error, seconds in ((engine[0], fine, fine_seconds), (engine[0].lower(), coarse, coarse_seconds))
]
VARIANT = Variant(restitution=0.0, lowest=0.101)
STEPS = (1e-3, 2e-3, 5e-3, 1e-2)  # s
SOLVERS = ("pdas", "apgs", "auto", "active_set")
STIFFNESSES = (1e5, 1e6, 1e7, 1e8)  # N/m


def cases(size: Size) -> list[dict[str, Any]]:
    """Return the cases."""
    if size is Size.QUICK:
        return [
            *rigid_cases(["gap/pdas"], [1e-2], [1e-7], simulated=0.3),
            *penalty_cases(["gran/hooke/history"], [1e6], MASS, [1 / 4], simulated=0.3),
        ]
    methods = [f"{law}/{solver}" for law in ("gap", "moreau") for solver in SOLVERS]
    return [
        *rigid_cases(methods, STEPS, [1e-7], simulated=10.0),
        *rigid_cases(["gap/pdas"], STEPS, [1e-4], simulated=10.0),
        *penalty_cases(["gran/hooke/history"], STIFFNESSES, MASS, [1 / 10, 1 / 4], simulated=10.0),
        *penalty_cases(["granular/hooke", "granular/hertz"], STIFFNESSES[1:3], MASS, [1 / 4], simulated=10.0),
    ]


def run(folder: Path, **case: Any) -> dict[str, Any]:
    """Run a case."""
    return run_balls(VARIANT, folder, case)
