# SPDX-License-Identifier: GPL-2.0-or-later
"""SimBenchmark's 666 balls, elastic."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from nscd_lmp.charts.cases import penalty_cases, rigid_cases
from nscd_lmp.charts.many_balls import ENGINES, MASS, PUBLISHED, SOURCE, Variant, run_balls
from nscd_lmp.charts.size import Size

ORDER = 71
TITLE = (
    "SimBenchmark's 666 balls, elastic: 216 balls bounce on a smooth floor, e = 1\n"
    "stars, published: RaiSim, ODE, DART, Bullet by their first letters"
)
ERRORS = {"energy": "mean over time of (E - E0)², J²", "overlap_max": "largest overlap / radius"}
NOTES = """10 s; the energy is 34 kJ. Stars are the engines that SimBenchmark published in 2018 with dt 1e-3 s, on
another machine: for this variant it has errors alone, drawn at the seconds of the inelastic one. Energies of
penalty contacts include what their springs hold. Seconds are processor seconds of the one thread, best of 3."""
FLOOR = 1e-20
REFERENCES = [
    (engine[0], seconds / PUBLISHED, {"energy": elastic}, f"{engine}: {SOURCE}")
    for engine, (_, seconds, _, _, elastic) in ENGINES.items()
    if elastic is not None
]
VARIANT = Variant(restitution=1.0, lowest=1.101)
STEPS = (1e-3, 2e-3, 5e-3, 1e-2)  # s
STIFFNESSES = (1e6, 1e7, 1e8)  # N/m


def cases(size: Size) -> list[dict[str, Any]]:
    """Return the cases."""
    if size is Size.QUICK:
        return [
            *rigid_cases(["gap/pdas"], [1e-2], [1e-10], simulated=0.6),
            *penalty_cases(["gran/hooke/history"], [1e6], MASS, [1 / 10], simulated=0.6),
        ]
    methods = [f"{law}/{solver}" for law in ("gap", "moreau") for solver in ("pdas", "apgs", "auto")]
    return [
        *rigid_cases(methods, STEPS, [1e-10], simulated=10.0),
        *rigid_cases([f"{law}/pdas" for law in ("gap", "moreau")], STEPS, [1e-7], simulated=10.0),
        *penalty_cases(["gran/hooke/history"], STIFFNESSES, MASS, [1 / 20, 1 / 10], simulated=10.0),
        *penalty_cases(["granular/hooke"], STIFFNESSES[:2], MASS, [1 / 10], simulated=10.0),
    ]


def run(folder: Path, **case: Any) -> dict[str, Any]:
    """Run a case."""
    return run_balls(VARIANT, folder, case)
