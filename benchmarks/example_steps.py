# SPDX-License-Identifier: GPL-2.0-or-later
"""LAMMPS' own granular examples, by its springs and by rigid grains with the defaults of fix nscd.

springs   the contacts and the step of the example
rigid     fix nscd with the friction of the example, at its other defaults, at 20 and 50 times that step
tight     the same at a tenth of tol and overlap, with a budget of 300 sweeps; speed and height are held against it

Scenes: lammps_scenes.py. Seconds are processor time of the `run` commands. Speed (mean over the grains, along the
slope), height (of the centre of mass) and kinetic energy are means over the last fifth of the run. Units are those of
the scenes (lj).

    python benchmarks/example_steps.py
    python benchmarks/example_steps.py --scenes chute.2d --seeds 1 2 3 4 --kinds rigid tight --factors 50
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from analysis_scripts import find_grain_contacts
from lammps import LMP_STYLE_GLOBAL, LMP_TYPE_ARRAY, lammps
from lammps_scenes import SCENES, Phase, Scene
from numpy.typing import NDArray
from record import Record, print_table

from nscd_lmp import _core  # loads MPI too, which the LAMMPS library needs

Array = NDArray[np.float64]

KINDS = {"springs": "", "rigid": "", "tight": "tol 1e-4 overlap 5e-5 budget 300"}
FACTORS = (20, 50)  # steps of rigid grains over those of the example
SAMPLED = 0.2  # share of a run at its end
SHOWN = ("cpu_seconds", "ratio", "overlap_ratio", "sweeps_per_step", "accepted_steps", "given_up_steps", "steps")
COMPARED = ("speed", "height", "kinetic_energy")


class Run:
    """A scene in LAMMPS, and what it has cost so far."""

    def __init__(self, scene: Scene, kind: str, dt: float, more: str = "") -> None:
        self.scene, self.dt = scene, dt
        self.soft = kind == "springs"
        self.words = f"{scene.keywords} {KINDS[kind]} {more}"
        self.lmp = lammps(cmdargs=["-log", "none", "-screen", "none", "-nocite"])
        self.lmp.commands_string(f"units lj\n{scene.common}\ntimestep {dt!r}\nneighbor {scene.skin} bin")
        self.lmp.commands_string("neigh_modify every 1 delay 0 check yes\nthermo_modify lost warn")
        self.seconds = self.overlap = 0.0
        self.steps = 0
        self.totals = dict.fromkeys(_core.TOTALS_COLUMNS, 0.0)
        self.samples: list[tuple[float, float, float]] = []
        if self.soft:
            self.lmp.commands_string(scene.springs)
        else:
            self.lmp.commands_string(f"pair_style zero {scene.largest + scene.fastest * dt!r}\npair_coeff * *")

    def take(self, phase: Phase) -> None:
        """Run a phase to its end, in pieces of which each is looked at."""
        self.lmp.commands_string(phase.both)
        self.lmp.commands_string(phase.springs if self.soft else phase.rigid)
        if not self.soft:
            mobile = "flow" if self.lmp.has_id("group", "flow") else "all"
            if self.lmp.has_id("fix", "hard"):
                self.lmp.command("unfix hard")
            self.lmp.command(f"fix hard {mobile} nscd {self.words} {self.scene.walls} unconverged ignore")
        steps = round(phase.time / self.dt)
        piece = max(1, steps // self.scene.every)
        for done in range(0, steps, piece):
            self.run(min(piece, steps - done), done == 0)
            self.look()
        self.steps += steps
        if not self.soft:
            self.add_totals()

    def run(self, steps: int, first: bool) -> None:
        """Take some steps."""
        began = time.thread_time()
        self.lmp.command(f"run {steps} pre {'yes' if first else 'no'} post no")
        self.seconds += time.thread_time() - began

    def of_atoms(self, name: str) -> Array:
        """Return an array of the atoms that are there now."""
        return np.array(self.lmp.numpy.extract_atom(name)[: self.lmp.extract_global("nlocal")], dtype=float)

    def look(self) -> None:
        """Keep speed, height and energy; of springs the overlap too."""
        x, v, mass = self.of_atoms("x"), self.of_atoms("v"), self.of_atoms("rmass")
        if not len(x):
            return
        height = float(np.average(x[:, self.scene.upward], weights=mass))
        energy = float(0.5 * mass @ (v**2).sum(axis=1))
        self.samples.append((float(np.average(v[:, 0], weights=mass)), height, energy))
        if self.soft:
            self.overlap = max(self.overlap, self.deepest(x, self.of_atoms("radius")))

    def deepest(self, x: Array, radius: Array) -> float:
        """Return the largest overlap over the smaller radius, of pairs and of planes."""
        low, high, _, _, _, periodic, _ = self.lmp.extract_box()
        bounds = np.array([low, high]).T
        pairs = find_grain_contacts(x, radius, bounds, np.array(periodic, dtype=bool))
        apart = x[pairs.i] - x[pairs.j]
        lengths = np.where(periodic, bounds[:, 1] - bounds[:, 0], np.inf)
        apart -= np.where(np.isfinite(lengths), lengths, 0.0) * np.round(apart / lengths)
        depth = radius[pairs.i] + radius[pairs.j] - np.linalg.norm(apart, axis=1)
        worst = float((depth / np.minimum(radius[pairs.i], radius[pairs.j])).max(initial=0.0))
        for axis, place in self.scene.soft_walls:
            gap = x[:, axis] - place if place >= 0 else -place - x[:, axis]
            worst = max(worst, float((1 - gap / radius).max()))
        return worst

    def add_totals(self) -> None:
        """Add what the fix has counted in this phase; of overlaps the largest counts."""
        for column, name in enumerate(_core.TOTALS_COLUMNS):
            value = self.lmp.extract_fix("hard", LMP_STYLE_GLOBAL, LMP_TYPE_ARRAY, 0, column)
            worst = "overlap" in name
            self.totals[name] = max(self.totals[name], value) if worst else self.totals[name] + value

    def results(self) -> dict[str, Any]:
        """Return all of it."""
        last = np.array(self.samples[-max(1, round(SAMPLED * len(self.samples))) :])
        found: dict[str, Any] = {"grains": self.lmp.get_natoms(), "steps": self.steps, "cpu_seconds": self.seconds}
        found |= dict(zip(COMPARED, (float(value) for value in last.mean(axis=0)), strict=True))
        if self.soft:
            return found | {"overlap_ratio": self.overlap}
        return found | {
            "overlap_ratio": self.totals["worst_overlap_ratio"],
            "sweeps_per_step": self.totals["iterations"] / self.steps,
            "accepted_steps": int(self.totals["accepted_steps"]),
            "given_up_steps": int(self.totals["unconverged_steps"]),
            "solver_seconds": self.totals["seconds_solver"],
            "contacts_seconds": self.totals["seconds_contacts"],
        }


def measure(scene: Scene, kind: str, factor: float, shorter: float = 1.0, more: str = "") -> dict[str, Any]:
    """Return what a run of a scene took and left, at `factor` times the step of the example."""
    run = Run(scene, kind, scene.dt * factor, more)
    for phase in scene.phases:
        run.take(Phase(phase.time * shorter, phase.both, phase.springs, phase.rigid))
    found = run.results()
    run.lmp.close()
    return found


def compare(rows: Sequence[dict[str, Any]]) -> None:
    """Set `ratio`, seconds over those of springs, and what differs from tight in speed and height."""
    for row in rows:
        for other in rows:
            if (other["scene"], other["seed"]) != (row["scene"], row["seed"]):
                continue
            if other["kind"] == "springs":
                row["ratio"] = row["cpu_seconds"] / other["cpu_seconds"]
            if other["kind"] == "tight" and other["factor"] == row["factor"]:
                row |= {f"{name}_off": row[name] / other[name] - 1 for name in COMPARED}


def cases(given: argparse.Namespace) -> list[tuple[str, int, str, float]]:
    """Return scene, seed, kind and factor of the runs; springs have the step of the example."""
    found = []
    for name, seed, kind in product(given.scenes, given.seeds, given.kinds):
        for factor in [1] if kind == "springs" else given.factors:
            found.append((name, seed, kind, factor))
    return found


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", nargs="+", choices=list(SCENES), default=list(SCENES))
    parser.add_argument("--kinds", nargs="+", choices=list(KINDS), default=list(KINDS))
    parser.add_argument("--factors", nargs="+", type=float, default=FACTORS, help="steps over the example's")
    parser.add_argument("--seeds", nargs="+", type=int, default=[1])
    parser.add_argument("--keywords", default="", help="more of fix nscd, for trials")
    parser.add_argument("--shorter", type=float, default=1.0, help="share of the time of each phase [%(default)s]")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="the start of one scene, only to see that everything runs")
    given = parser.parse_args(words)
    if given.quick:
        given.scenes, given.shorter, given.factors = ["chute.2d"], 0.02, [50]
    record = Record("example_steps")
    record.print_origin()
    for name, seed, kind, factor in cases(given):
        row = measure(SCENES[name](seed), kind, factor, given.shorter, given.keywords)
        record.add(scene=name, seed=seed, kind=kind, factor=factor, **row)
        shown = (f"{key} {value:.5g}" for key, value in row.items())
        print(f"{name}, seed {seed}, {kind}, {factor:g} dt:", ", ".join(shown), flush=True)
    compare(record.rows)
    record.write(given.output / "example_steps.csv")
    columns = ["scene", "kind", "factor", "seed", *SHOWN, *COMPARED, "speed_off", "height_off"]
    print_table("LAMMPS' examples", columns, [[row.get(name) for name in columns] for row in record.rows])


if __name__ == "__main__":
    main()
