# SPDX-License-Identifier: GPL-2.0-or-later
"""The angle at which grains flow in a drum that turns, rigid and with springs.

The scene is inputs/in.drum and its twin: 900 grains with friction 0.5, 30 turns a minute. The angle is that of the line
from the middle of the drum to the centre of mass, from the vertical: that of a flat surface. It is the mean over looks
every 0.01 s from a quarter of a turn to three quarters. `deviation` is how far one look is from the next, and
`by_then` the mean over the first half of the looks less that over the second.

    python benchmarks/drum_angle.py
    python benchmarks/drum_angle.py --steps 5e-4 --stiffnesses --seeds 1
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from record import Record, print_table
from script import run_scene

from nscd_lmp.charts.penalty import contact_duration

STEPS, STIFFNESSES = (2e-4, 5e-4), (1e3,)  # s, N/m
PART_OF_CONTACT = 20
LIGHTEST = 2500.0 * 4 / 3 * np.pi * 0.4e-3**3  # kg
RIGID = {"solver": "auto", "tol": 1e-3, "maxiter": 1000, "unconverged": "ignore"}
FIRST, LAST, LOOK = 0.5, 1.5, 0.01  # s; a turn takes 2


def turn(variables: dict[str, Any], dt: float, seconds: tuple[float, float]) -> dict[str, float]:
    """Turn a drum, and return the row."""
    name = "in.drum.granular" if "kn" in variables else "in.drum"
    began, angles = time.process_time(), []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        lmp = run_scene(name, dt=dt, steps=round(seconds[0] / dt), every=10**6, **variables)
        for _ in range(round((seconds[1] - seconds[0]) / LOOK)):
            lmp.command(f"run {round(LOOK / dt)} post no")
            angles.append(float(lmp.extract_variable("angle")))
    given_up = float(lmp.numpy.extract_fix("nscd", 0, 1, 10)) if lmp.has_id("fix", "nscd") else 0.0
    lmp.close()
    half = len(angles) // 2
    return {
        "angle": float(np.mean(angles)),
        "deviation": float(np.std(angles)),
        "by_then": float(np.mean(angles[:half]) - np.mean(angles[half:])),
        "given_up": given_up,
        "cpu_seconds": time.process_time() - began,
    }


def report(rows: Sequence[dict[str, Any]]) -> None:
    """Print the mean and the standard deviation over seeds."""
    groups: dict[str, list[float]] = {}
    for row in rows:
        groups.setdefault(row["kind"], []).append(row["angle"])
    lines = [
        [kind, len(of), float(np.mean(of)), float(np.std(of, ddof=1)) if len(of) > 1 else None]
        for kind, of in groups.items()
    ]
    print_table("a drum that turns", ["", "seeds", "degrees", "deviation"], lines)


def parsed(words: Sequence[str] | None = None) -> argparse.Namespace:
    """Return what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", nargs="*", type=float, default=STEPS, metavar="DT", help="s, rigid")
    parser.add_argument("--stiffnesses", nargs="*", type=float, default=STIFFNESSES, metavar="KN", help="N/m, springs")
    parser.add_argument("--friction", type=float, default=0.5)
    parser.add_argument("--seeds", nargs="+", type=int, default=(1, 2, 3))
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="a few grains and steps, to see that it runs")
    asked = parser.parse_args(words)
    if asked.quick:
        asked.steps, asked.stiffnesses, asked.seeds = (5e-4,), (1e3,), (1,)
    return asked


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    asked = parsed(words)
    record = Record("drum_angle")
    record.print_origin()
    seconds = (0.01, 0.03) if asked.quick else (FIRST, LAST)
    small = {"n": 60} if asked.quick else {}
    kinds = [(f"rigid {dt:g} s", dt, RIGID) for dt in asked.steps]
    for kn in asked.stiffnesses:
        dt = float(f"{contact_duration(kn, LIGHTEST) / PART_OF_CONTACT:.3g}")
        kinds.append((f"springs {kn:g} N/m", dt, {"kn": kn}))
    for seed in asked.seeds:
        for kind, dt, variables in kinds:
            row = turn({**variables, **small, "friction": asked.friction, "seed": seed}, dt, seconds)
            record.add(kind=kind, friction=asked.friction, seed=seed, dt=dt, **row)
            record.write(asked.output / "drum_angle.csv")
    report(record.rows)


if __name__ == "__main__":
    main()
