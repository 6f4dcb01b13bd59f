# SPDX-License-Identifier: GPL-2.0-or-later
"""SimBenchmark's "666 balls": 6 x 6 x 6 spheres that fall on a floor without friction and spread.

Source: D. Kang and J. Hwangbo, SimBenchmark (2018), leggedrobotics.github.io/SimBenchmark. Its numbers for other
engines were taken on an Intel i7-7700HQ.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nscd_lmp.charts.beds import fastest, follow, steps_between_looks
from nscd_lmp.charts.grains import open_lammps, per_grain
from nscd_lmp.charts.methods import Contacts, start
from nscd_lmp.charts.overlap import Overlaps
from nscd_lmp.charts.sedimentations import costs
from nscd_lmp.door.walls import Plane

SOURCE = "Kang & Hwangbo, SimBenchmark (2018), Intel i7-7700HQ"
RADIUS, MASS, SPACING, PLAY, GRAVITY = 0.1, 10.0, 0.21, 1e-3, 9.81  # m, kg, m, m, m/s^2
FLOOR_PLANE = Plane((0, 0, 0), (0, 0, 1))
FASTEST = 20.0  # m/s, for the neighbor cutoff
SEED = 666
MOST_LOOKS = 20_000

# engine: error (m^2) and seconds at dt 1e-3, the same at dt 1e-2, error of the elastic variant (J^2) at dt 1e-3
ENGINES: dict[str, tuple[float, float, float, float, float | None]] = {
    "RaiSim": (1.35e-4, 1.51, 1.53e-2, 0.17, 8.4),
    "ODE Dantzig": (1.55e-4, 10.6, 1.61e-2, 1.36, 112.0),
    "DART Dantzig": (2.8e-4, 22.9, 215.0, 3.1, 3.5e5),
    "MuJoCo PGS": (9.5e-2, 13.2, 0.93, 1.7, None),
    "Bullet": (0.38, 12.0, 37.0, 2.0, 4.2e4),
}
PUBLISHED = 10.0  # s, simulated


@dataclass(frozen=True)
class Variant:
    """Restitution, and height of the lowest centre (m)."""

    restitution: float
    lowest: float


def places(lowest: float) -> NDArray[np.float64]:
    """Return the centres (216, 3) in m."""
    grid = np.stack(np.meshgrid(*[SPACING * np.arange(6)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    return grid + np.random.default_rng(SEED).uniform(0, PLAY, grid.shape) + (0, 0, lowest)


def begin(variant: Variant, folder: Path, case: dict[str, Any]) -> Contacts:
    """Open LAMMPS with the balls and their contacts."""
    wide = [(-200.0, 200.0), (-200.0, 200.0), (-1.0, 20.0)]  # the floor has no end: no ball gets there in 10 s
    lmp = open_lammps(folder, places(variant.lowest), RADIUS, MASS, box=wide, gravity=GRAVITY)
    return start(
        lmp, case["method"], case, [FLOOR_PLANE], variant.restitution, speed=FASTEST, skin=RADIUS,
        options="maxiter 10000",
    )  # fmt: skip


def run_balls(variant: Variant, folder: Path, case: dict[str, Any]) -> dict[str, Any]:
    """Run a case: watched, then timed.

    Returns
    -------
    dict
        ``penetration``, the mean over time of the sum of squared penetrations (m^2), ``energy``, the mean of
        (E - E0)^2 (J^2), ``overlap_max`` over the radius, and what it cost.
    """
    steps = round(case["simulated"] / case["dt"])
    contacts = begin(variant, folder, case)
    lmp = contacts.lmp
    probe = Overlaps(per_grain(lmp, "radius"), [FLOOR_PLANE])
    squares, energies, largest = [], [], 0.0
    spring = case.get("stiffness") or 0.0  # N/m; of hertz, which is not linear, what it holds is not known here

    def energy() -> float:
        x, v = per_grain(lmp, "x"), per_grain(lmp, "v")
        return MASS * float(0.5 * (v**2).sum() + GRAVITY * x[:, 2].sum())

    def look(_: int) -> None:
        nonlocal largest
        depth, smaller = probe.look(per_grain(lmp, "x"))
        squares.append(float((depth**2).sum()))
        largest = max(largest, float((depth / smaller).max(initial=0.0)))
        energies.append((energy() + 0.5 * spring * squares[-1] - first) ** 2)

    first = energy()
    watched = follow(contacts, steps, steps_between_looks(case, MASS, steps, MOST_LOOKS), look)
    totals = contacts.totals()
    lmp.close()
    seconds = fastest(lambda: begin(variant, folder, case), steps, 3)
    spent = costs(seconds, watched, totals, case["simulated"], steps)
    del spent["simulated"]  # a variable of the case
    return {
        "penetration": float(np.mean(squares)),
        "energy": float(np.mean(energies)),
        "overlap_max": largest,
        **spent,
    }
