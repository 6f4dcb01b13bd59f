# SPDX-License-Identifier: GPL-2.0-or-later
"""What the presets of `accuracy` cost with friction, and what of it users see; and springs on the same scene.

Grains of 0.25 to 0.5 mm fall from a lattice into a box (0.15 s). Then gravity is tilted by 12 degrees (0.1 s).

rigid     law gap, a run for each accuracy, coefficient, step and seed, and its twin without friction. Seconds are
          processor time of the first 0.15 s. Forces are means of 10 samples in the 0.01 s after them. Creep is the
          median displacement in the last 0.05 s
springs   gran/hooke/history with tangential springs, the same grains for 0.15 s, at steps that are a part of the
          shortest contact. A run ends early when a grain is lost
norms     problems of a run, with more and more sweeps: the natural map beside the last correction over the impulses,
          as LMGC90 has it

    python benchmarks/friction_accuracy.py
    python benchmarks/friction_accuracy.py --parts rigid --grains 2000 --frictions 0.5 --steps 2e-4
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from box import box_walls
from numpy.typing import NDArray
from penetration import Penetration
from record import Record, print_table
from script import open_scene

import nscd_lmp
from nscd_lmp.charts.penalty import Spring, contact_duration

Array = NDArray[np.float64]

WIDTHS = {60: 3.1e-3, 500: 6.3e-3, 2000: 12e-3, 10000: 20e-3}  # m, of the box
ACCURACIES = ("loose", "normal", "tight")
FRICTIONS = (0.3, 0.5, 0.8)
STEPS = (2e-4, 5e-4, 1e-3)  # s
STIFFNESSES = (1e3, 1e4, 1e5)  # N/m: overlaps of about 1 % and 0.1 % lie between them
PARTS_OF_CONTACT = (4, 5, 7, 10, 15)  # steps of springs: the shortest contact over these
SETTLED, SAMPLED, TILTED = 0.15, 0.01, 0.1  # s
SAMPLES = 10
LOOKS = 3000  # at the overlap of springs
TILT = math.radians(12)
GRAVITY = 9.81
DENSITY = 2500.0
SMALLEST = 0.25e-3  # m
SWEEPS = (3, 10, 30, 100, 300, 1000)


@dataclass(frozen=True)
class Times:
    """How long a scene falls and is tilted, s."""

    settled: float = SETTLED
    tilted: float = TILTED


@dataclass(frozen=True)
class Case:
    """One scene, one way to run it."""

    grains: int
    accuracy: str
    friction: float
    dt: float
    seed: int


class Bed:
    """The grains in LAMMPS, in the order of their tags, and the fix that moves them."""

    def __init__(self, case: Case, **more: Any) -> None:
        width = WIDTHS[case.grains]
        self.case, self.walls = case, box_walls(width)
        self.lmp = open_scene("in.sedimentation", n=case.grains, lx=width, seed=case.seed, dt=case.dt)
        self.hard = nscd_lmp.attach(
            self.lmp, friction=case.friction, accuracy=case.accuracy, walls=self.walls, unconverged="ignore", **more
        )
        self.mass = self.of_atoms("rmass")

    def of_atoms(self, name: str) -> Array:
        """Return a copy of an array of the atoms, by tag."""
        n = self.case.grains
        order = np.argsort(self.lmp.numpy.extract_atom("id")[:n])
        return np.array(self.lmp.numpy.extract_atom(name)[:n][order])

    def run(self, duration: float) -> float:
        """Return the processor seconds of this many simulated ones."""
        began = time.thread_time()
        self.lmp.command(f"run {round(duration / self.case.dt)} post no")
        return time.thread_time() - began

    def tilt(self) -> None:
        """Turn gravity about y."""
        down = f"{math.sin(TILT)!r} 0 {-math.cos(TILT)!r}"
        self.lmp.commands_list(["unfix gravity", f"fix gravity all gravity {GRAVITY} vector {down}"])

    def forces(self) -> dict[str, float]:
        """Return what the contacts of the last step carry, over weights, and how many push."""
        contacts, z = self.hard.contacts, self.of_atoms("x")[:, 2]
        i, j = contacts["tag_i"].astype(int) - 1, contacts["tag_j"].astype(int)
        push, weight = contacts["impulse"], GRAVITY * self.case.dt * float(self.mass.sum())
        loaded = push > 0
        upward = push * contacts["nz"] + contacts.get("impulse_tz", 0.0)
        middle = float(np.median(z))
        pairs = j > 0
        over_i, over_j = z[i] > middle, np.where(pairs, z[np.maximum(j - 1, 0)], z[i]) > middle
        across = float((upward * (over_i.astype(int) - over_j)).sum())
        return {
            "pushing_contacts": float(loaded.sum()),
            "strong_contacts": float((push > 0.01 * push[loaded].mean()).sum()),
            "floor_ratio": float(upward[j == -1].sum()) / weight,
            "walls_ratio": float(push[j < -1].sum()) / weight,
            "force_sum_ratio": float(push.sum()) / weight,
            "force_variation": float(push[loaded].std() / push[loaded].mean()),
            "stress_ratio": across / (GRAVITY * self.case.dt * float(self.mass[z > middle].sum())),
        }


def rigid(case: Case, times: Times) -> dict[str, Any]:
    """Return what a run cost and what it left."""
    bed = Bed(case)
    seconds = bed.run(times.settled)
    fall = bed.hard.stats
    height = float(np.average(bed.of_atoms("x")[:, 2], weights=bed.mass))
    samples = []
    for _ in range(SAMPLES):
        bed.run(max(SAMPLED / SAMPLES, case.dt))
        samples.append(bed.forces())
    bed.tilt()
    before = len(bed.hard.stats)
    bed.run(times.tilted / 2)
    middle, tilted_first = bed.of_atoms("x"), bed.hard.stats
    bed.run(times.tilted / 2)
    moved, stats = np.sqrt(((bed.of_atoms("x") - middle) ** 2).sum(axis=1)), bed.hard.stats
    bed.lmp.close()
    tilted = stats[before:]
    return {
        "cpu_seconds": seconds,
        "contacts_seconds": float(fall["seconds_contacts"].sum()),
        "solver_seconds": float(fall["seconds_solver"].sum()),
        "steps": len(fall),
        "sweeps_per_step": float(fall["iterations"].mean()),
        "accepted_steps": int(fall["accepted_steps"][-1]),
        "given_up_steps": int(fall["unconverged_steps"][-1]),
        "median_residual": float(np.median(fall["relative_residual"])),
        "largest_residual": float(fall["relative_residual"].max()),
        "overlap_ratio": float(fall["largest_overlap_ratio"].max()),
        "height": height,
        **{name: float(np.mean([sample[name] for sample in samples])) for name in samples[0]},
        "tilted_sweeps_per_step": float(tilted["iterations"].mean()),
        "tilted_accepted_steps": int(tilted_first["accepted_steps"][-1] + stats["accepted_steps"][-1]),
        "tilted_given_up_steps": int(tilted_first["unconverged_steps"][-1] + stats["unconverged_steps"][-1]),
        "tilted_overlap_ratio": float(tilted["largest_overlap_ratio"].max()),
        "creep": float(np.median(moved)),
    }


def run_rigid(cases: Sequence[Case], times: Times, record: Record) -> list[dict[str, Any]]:
    """Run all cases, each beside a twin without friction; return their rows."""
    rows = []
    for case in cases:
        row = {"part": "rigid", **vars(case), **rigid(case, times)}
        twin = Bed(Case(case.grains, case.accuracy, 0.0, case.dt, case.seed))
        row["frictionless_cpu_seconds"] = twin.run(times.settled)
        row["frictionless_sweeps_per_step"] = float(twin.hard.stats["iterations"].mean())
        row["frictionless_overlap_ratio"] = float(twin.hard.stats["largest_overlap_ratio"].max())
        twin.lmp.close()
        record.add(**row)
        rows.append(row)
    return rows


def springs(grains: int, friction: float, stiffness: float, part: int, seed: int, times: Times) -> dict[str, Any]:
    """Return seconds and largest overlap of springs at a step of the shortest contact / part."""
    width = WIDTHS[grains]
    lightest = DENSITY * 4 / 3 * math.pi * SMALLEST**3
    dt = contact_duration(stiffness, lightest) / part
    lmp = open_scene("in.sedimentation.granular", n=grains, lx=width, seed=seed, dt=dt, kn=stiffness)
    mass, radius = lmp.numpy.extract_atom("rmass")[:grains].copy(), lmp.numpy.extract_atom("radius")[:grains].copy()
    spring = Spring("gran", "hooke", stiffness, 0.0, None, float(mass.mean()), float(radius.mean()), 0.0)
    lmp.commands_list(["unfix walls", *spring.pair(friction), *spring.walls(box_walls(width), friction)])
    lmp.command("thermo_modify lost ignore")
    probe = Penetration(radius, box_walls(width))
    steps = round(times.settled / dt)
    chunk = -(-steps // LOOKS)
    seconds, worst, done = 0.0, 0.0, 0
    lmp.command("run 0 post no")
    while done < steps and worst < 1 and lmp.get_natoms() == grains:
        began = time.thread_time()
        lmp.command(f"run {chunk} pre no post no")
        seconds += time.thread_time() - began
        done += chunk
        depth, smaller = probe.overlaps(lmp.numpy.extract_atom("x")[:grains])
        worst = max(worst, float((depth / smaller).max(initial=0.0)))
    survived = done >= steps and worst < 1
    height = float(np.average(lmp.numpy.extract_atom("x")[:grains, 2], weights=mass)) if survived else None
    lmp.close()
    return {
        "part": "springs",
        **{"grains": grains, "friction": friction, "stiffness": stiffness, "part_of_contact": part, "seed": seed},
        **{"dt": dt, "steps": done, "cpu_seconds": seconds if survived else None, "height": height},
        "overlap_ratio": worst if survived else None,
    }


def last_correction(problem: nscd_lmp.ContactProblem, impulse: Array) -> float:
    """Return the rms over the contacts of what one more plain sweep does to W_cc p_c, over that of W_cc p_c."""
    after = nscd_lmp.solve(problem, "pdas", maxiter=1, warmstart=impulse, unconverged="ignore").impulse
    assert problem.spheres is not None
    w = problem.spheres.normal_response()[:, None] * np.array([1, *[1 + problem.spheres.spin_response] * 2])
    return float(np.linalg.norm(w * (after - impulse)) / np.linalg.norm(w * impulse))


def norms(case: Case, times: Times, record: Record) -> list[dict[str, Any]]:
    """Return natural map and LMGC90's norm of problems of a run, after more and more sweeps from the warm start."""
    kept: list[tuple[float, nscd_lmp.ContactProblem, Array]] = []
    wanted = [round(share * times.settled / case.dt) for share in (0.3, 0.5, 1.0)]
    taken = 0

    def solver(system: Any) -> Array:
        nonlocal taken
        taken += 1
        problem = system.problem()
        if taken in wanted:
            kept.append((taken * case.dt, problem, system.start.copy()))
        found = nscd_lmp.solve(problem, "apgs", tol=1e-3, maxiter=300, warmstart=system.start, unconverged="ignore")
        return found.impulse

    bed = Bed(case, solver=solver)
    bed.run(times.settled)
    bed.lmp.close()
    rows = []
    for when, problem, start in kept:
        for sweeps in SWEEPS:
            found = nscd_lmp.solve(
                problem, "apgs", tol=1e-9, maxiter=sweeps, warmstart=start, criterion="natural", unconverged="ignore"
            )
            row = {
                "part": "norms",
                **vars(case),
                **{"time": when, "contacts": len(problem.q), "sweeps": sweeps, "residual": found.residual},
                "last_correction": last_correction(problem, found.impulse),
            }
            record.add(**row)
            rows.append(row)
    return rows


def report_rigid(rows: Sequence[dict[str, Any]]) -> None:
    """Print mean and scatter over the seeds: a line an accuracy, coefficient and step."""
    shown = {
        "CPU s": ("cpu_seconds", 1.0),
        "without\nfriction": ("frictionless_cpu_seconds", 1.0),
        "sweeps\na step": ("sweeps_per_step", 1.0),
        "accepted": ("accepted_steps", 1.0),
        "given up": ("given_up_steps", 1.0),
        "height, mm": ("height", 1e3),
        "floor": ("floor_ratio", 1.0),
        "walls": ("walls_ratio", 1.0),
        "pushing": ("pushing_contacts", 1.0),
        "variation": ("force_variation", 1.0),
        "creep, um": ("creep", 1e6),
    }
    groups: dict[tuple[Any, ...], list[dict[str, Any]]] = {}
    for row in rows:
        groups.setdefault(tuple(row[key] for key in ("grains", "friction", "dt", "accuracy")), []).append(row)
    lines = []
    for key, mine in groups.items():
        cells = [mean_and_scatter([unit * row[name] for row in mine]) for name, unit in shown.values()]
        worst = 100 * max(max(row["overlap_ratio"], row["tilted_overlap_ratio"]) for row in mine)
        name = " ".join(f"{value:g}" if isinstance(value, float) else str(value) for value in key)
        lines.append([name, *cells, f"{worst:.3f}"])
    columns = ["grains, friction, dt, accuracy", *shown, "worst\noverlap, %"]
    print_table("Rigid contacts with friction: mean +- scatter over the seeds", columns, lines)


def mean_and_scatter(values: Sequence[float]) -> str:
    """Return the mean and the standard deviation of a sample, as text."""
    scatter = f" +- {np.std(values, ddof=1):.2g}" if len(values) > 1 else ""
    return f"{np.mean(values):.4g}{scatter}"


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parts = ["rigid", "springs", "norms"]
    parser.add_argument("--parts", nargs="+", choices=parts, default=parts)
    parser.add_argument("--grains", type=int, choices=list(WIDTHS), default=500, help="[%(default)s]")
    parser.add_argument("--accuracies", nargs="+", choices=ACCURACIES, default=ACCURACIES, help="[all]")
    parser.add_argument("--frictions", nargs="+", type=float, default=FRICTIONS, metavar="MU")
    parser.add_argument("--steps", nargs="+", type=float, default=STEPS, metavar="DT", help="of rigid contacts, s")
    parser.add_argument("--seeds", nargs="+", type=int, default=(1, 2, 3, 4))
    parser.add_argument("--stiffnesses", nargs="+", type=float, default=STIFFNESSES, metavar="N/M")
    parser.add_argument("--of-contact", nargs="+", type=int, default=PARTS_OF_CONTACT, metavar="PART", help="springs")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="a small scene, only to see that everything runs")
    given = parser.parse_args(words)
    times = Times()
    if given.quick:
        times = Times(0.02, 0.004)
        given.grains, given.frictions, given.steps, given.seeds = 60, [0.5], [2e-4], [1, 2]
        given.stiffnesses, given.of_contact = [1e3], [10]
    record = Record("friction_accuracy")
    record.print_origin()
    path = given.output / "friction_accuracy.csv"
    if "rigid" in given.parts:
        order = product([given.grains], given.accuracies, given.frictions, given.steps, given.seeds)
        report_rigid(run_rigid([Case(*values) for values in order], times, record))
    if "norms" in given.parts:
        for friction in given.frictions:
            found = norms(Case(given.grains, "normal", friction, given.steps[0], given.seeds[0]), times, record)
            report(found, "Two measures of one error", ["time", "contacts", "sweeps", "residual", "last_correction"])
    if "springs" in given.parts:
        order_of_springs = product(given.frictions, given.stiffnesses, given.of_contact, given.seeds[:1])
        found = []
        for friction, stiffness, part, seed in order_of_springs:
            found.append(springs(given.grains, friction, stiffness, part, seed, times))
            record.add(**found[-1])
        names = ["friction", "stiffness", "part_of_contact", "dt", "cpu_seconds", "overlap_ratio", "height"]
        report(found, "Springs with friction", names)
    record.write(path)


def report(rows: Sequence[dict[str, Any]], title: str, names: Sequence[str]) -> None:
    """Print these columns."""
    print_table(title, [name.replace("_", " ") for name in names], [[row[name] for name in names] for row in rows])


if __name__ == "__main__":
    main()
