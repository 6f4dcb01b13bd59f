# SPDX-License-Identifier: GPL-2.0-or-later
"""At which angle grains on a rough incline stop, and at which they flow on.

The flow of rough_incline.py, 1200 grains in 12 layers with friction 0.5, runs at 24 degrees for 0.25 s. Then the
incline is turned to another angle, and what happens within the time is a row: the mean velocity along the slope over
sqrt(g d) in the last tenth of the time, and when it fell below a hundredth for good. Such a flow has stopped.

    python benchmarks/incline_stop.py
    python benchmarks/incline_stop.py --angles 21 22 --steps 2e-4 --seeds 1 --seconds 3
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from record import Record, print_table
from rough_incline import SIDE, SPEED, State, now, rigid, start

Array = NDArray[np.float64]

ANGLES = (18.0, 20.0, 21.0, 22.0, 23.0, 24.0)  # degrees
STEPS, BEFORE, LOOK = (5e-4,), 0.25, 0.02  # s
STOPPED = 1e-2  # of sqrt(g d)


def flowing(seed: int, seconds: float) -> tuple[State, Array]:
    """Return a flow of 24 degrees, and the diameters of its grains (m)."""
    state, diameters = start(seed)
    lmp = rigid(state, diameters, 2e-4, "gap")
    lmp.command(f"run {round(seconds / 2e-4)} post no")
    x, v, omega = now(lmp)
    lmp.close()
    return (x, v, omega), diameters


def turned(state: State, diameters: Array, angle: float, dt: float, seconds: float) -> dict[str, float]:
    """Turn a flow to the angle (degrees), and return what happens to it."""
    began, speeds = time.process_time(), []
    lmp = rigid(state, diameters, dt, "gap", angle=float(np.radians(angle)))
    for _ in range(max(1, round(seconds / LOOK))):
        lmp.command(f"run {round(LOOK / dt)} post no")
        speeds.append(float(now(lmp)[1][SIDE**2 :, 0].mean() / SPEED))
    lmp.close()
    fast = np.flatnonzero(np.abs(speeds) >= STOPPED)
    stops = float((fast[-1] + 2) * LOOK) if len(fast) else LOOK
    return {
        "velocity": float(np.mean(speeds[-max(1, len(speeds) // 10) :])),
        "stopped_after": stops if stops <= seconds else float("nan"),
        "seconds": seconds,
        "cpu_seconds": time.process_time() - began,
    }


def report(rows: Sequence[dict[str, Any]]) -> None:
    """Print a line for each run."""
    columns = ["angle", "dt", "seed", "velocity", "stopped_after"]
    lines = [[row[name] for name in columns] for row in sorted(rows, key=lambda row: (row["angle"], row["seed"]))]
    names = ["degrees", "dt, s", "seed", "velocity / sqrt(g d)", "stopped after, s"]
    print_table("a flow that is turned to an angle", names, lines)


def parsed(words: Sequence[str] | None = None) -> argparse.Namespace:
    """Return what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--angles", nargs="+", type=float, default=ANGLES, metavar="A", help="degrees")
    parser.add_argument("--steps", nargs="+", type=float, default=STEPS, metavar="DT", help="s")
    parser.add_argument("--seeds", nargs="+", type=int, default=(1, 2))
    parser.add_argument("--seconds", type=float, default=2.0, help="of every run after the turn")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="a few steps, to see that it runs")
    asked = parser.parse_args(words)
    if asked.quick:
        asked.angles, asked.seeds, asked.seconds = (18.0,), (1,), 0.04
    return asked


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    asked = parsed(words)
    record = Record("incline_stop")
    record.print_origin()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # grains that flow pass each other: so they shall
        for seed in asked.seeds:
            state, diameters = flowing(seed, 0.01 if asked.quick else BEFORE)
            for dt in asked.steps:
                for angle in asked.angles:
                    row = turned(state, diameters, angle, dt, asked.seconds)
                    record.add(angle=angle, dt=dt, seed=seed, **row)
                    record.write(asked.output / "incline_stop.csv")
    report(record.rows)


if __name__ == "__main__":
    main()
