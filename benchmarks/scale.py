# SPDX-License-Identifier: GPL-2.0-or-later
"""What a grain costs on one rank, from 1000 to 1,000,000: time, memory, and the order of grains in memory.

A slab of 1000 grains, periodic in x and y, settles once; LAMMPS' ``replicate`` makes it wide. Depth, contacts a grain
and iterations are so the same at every size. Steps are of 1e-4 s, law gap, zero start impulses, 50 iterations (tol is
out of reach; six checks of the criterion are among them).

grains   nanoseconds per contact and iteration, and per grain and step outside the solver, in processor time: the best
         of the repeats. Beside them the time to read and write back what a sweep streams through: the contacts.
order    the same at one size, with grains in other orders in memory (``atom_modify sort``)
memory   bytes a grain: peak of the process over one with an empty LAMMPS, without and with fix nscd (APGS); and what
         the fix gives back when it is deleted

    python benchmarks/scale.py
    python benchmarks/scale.py --parts grains --grains 1000 10000
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from machine_bounds import seconds_per_byte_updated
from record import Record, print_table
from slab import settled_cell
from slab_job import DT, measure

ITERATIONS = 50
COPIES = {
    1_000: (1, 1),
    3_000: (3, 1),
    10_000: (5, 2),
    30_000: (6, 5),
    100_000: (10, 10),
    300_000: (20, 15),
    1_000_000: (40, 25),
}
FIXED = {"maxiter": ITERATIONS, "warmstart": False, "tol": 1e-30}
# Solver, friction, and bytes of a contact that a sweep reads and writes back; bodies are thought to stay in the cache.
WAYS = (("apgs", 0.0, 72), ("pdas", 0.0, 64), ("apgs", 0.3, 160), ("pdas", 0.3, 128))
SORTS = {
    "by places, bins of half a cutoff (LAMMPS' default)": "1000 0.0",
    "by places, bins of 2 mm": "1000 2e-3",
    "copy by copy": "0 0.0",
}


def _jobs() -> list[dict[str, Any]]:
    return [FIXED | {"solver": solver, "friction": friction} for solver, friction, _ in WAYS]


def _costs(row: dict[str, Any], steps: int) -> dict[str, float]:
    share, grain_steps = row["cpu_share"], row["grains"] * steps
    return {
        "sweep_ns": 1e9 * share * row["solver"] / row["visits"],
        "outside_ns": 1e9 * share * row["ours"] / grain_steps,
        "lammps_ns": 1e9 * share * (row["wall"] - row["ours"] - row["solver"]) / grain_steps,
    }


def time_rows(cell: Path, copies: tuple[int, int], steps: int, repeats: int, sort: str) -> list[dict[str, Any]]:
    """Return a row for each way: the best of the repeats."""
    job = {"what": "times", "cell": str(cell), "copies": copies, "sort": sort, "ways": _jobs()}
    rows = measure(job | {"steps": steps, "repeats": repeats})
    found = []
    for k, (solver, friction, size) in enumerate(WAYS):
        of_way = [row for row in rows if row["way"] == k]
        costs = [_costs(row, steps) for row in of_way]
        row = {"grains": of_way[0]["grains"], "solver": solver, "friction": friction}
        row |= {name: float(np.mean([r[name] for r in of_way])) for name in ("contacts", "iterations")}
        row |= {name: min(cost[name] for cost in costs) for name in costs[0]}
        row["memory_bound_ns"] = 1e9 * size * seconds_per_byte_updated(int(size * row["contacts"]))
        found.append(row | {"steps": steps, "repeats": repeats, "dt": DT})
    return found


def best_of(rounds: Sequence[list[dict[str, Any]]]) -> list[dict[str, Any]]:
    """Return rows with the lowest times of those that stand in the same place."""
    best = []
    for rows in zip(*rounds, strict=True):
        lowest = {name: min(row[name] for row in rows) for name in rows[0] if name.endswith("_ns")}
        best.append(rows[0] | lowest)
    return best


def grains_part(cell: Path, copies: dict[int, tuple[int, int]], repeats: int, rounds: int, record: Record) -> None:
    """Measure all sizes, in turns."""
    seen: dict[int, list[list[dict[str, Any]]]] = {}
    for _ in range(rounds):
        for grains, of_size in copies.items():
            steps = max(2, min(20, 100_000 // grains))
            seen.setdefault(grains, []).append(time_rows(cell, of_size, steps, repeats, SORTS_DEFAULT))
    columns = ["contacts", "iterations", "sweep_ns", "memory_bound_ns", "outside_ns", "lammps_ns"]
    table = []
    for rows in map(best_of, seen.values()):
        for row in rows:
            record.add(part="grains", sort=SORTS_DEFAULT, rounds=rounds, **row)
            table.append([row[name] for name in ("grains", "solver", "friction", *columns)])
    titles = ["contacts", "iterations", "ns a contact\nand iteration", "memory\nbound"]
    titles += ["ns a grain and\nstep, nscd", "LAMMPS"]
    print_table("Time on one rank", ["grains", "solver", "friction", *titles], table)


SORTS_DEFAULT = next(iter(SORTS.values()))


def order_part(cell: Path, copies: tuple[int, int], repeats: int, rounds: int, record: Record) -> None:
    """Measure one size with grains in other orders, in turns."""
    seen: dict[str, list[list[dict[str, Any]]]] = {}
    for _ in range(rounds):
        for name, sort in SORTS.items():
            seen.setdefault(name, []).append(time_rows(cell, copies, 2, repeats, sort))
    table = []
    for name, several in seen.items():
        for row in best_of(several):
            record.add(part="order", order=name, sort=SORTS[name], rounds=rounds, **row)
            table.append([name, row["grains"], row["solver"], row["friction"], row["sweep_ns"], row["outside_ns"]])
    print_table(
        "Order of the grains", ["", "grains", "solver", "friction", "ns a contact\nand iteration", "outside"], table
    )


def memory_part(cell: Path, copies: dict[int, tuple[int, int]], record: Record) -> None:
    """Measure the memory of all sizes, each in a process of its own."""
    table = []
    for of_size in copies.values():
        for friction in (0.0, 0.3):
            way = {"solver": "apgs", "law": "gap", "friction": friction, "maxiter": 5}
            found = measure({"what": "memory", "cell": str(cell), "copies": of_size, "ways": [way]})
            grains, contacts, held = found["grains"], found["contacts"], found["held"]
            row = {
                "contacts": contacts,
                "peak_bytes_per_grain": (found["all"] - found["empty"]) / grains,
                "lammps_peak_bytes_per_grain": (found["lammps"] - found["empty"]) / grains,
                "held_bytes_per_grain": held / grains if held else None,
                "held_bytes_per_contact": held / contacts if held else None,
            }
            record.add(part="memory", grains=grains, friction=friction, solver="apgs", **row)
            table.append([grains, friction, *row.values()])
    titles = ["contacts", "peak, bytes\na grain", "of LAMMPS\nalone", "held by the fix,\nbytes a grain", "a contact"]
    print_table("Memory on one rank", ["grains", "friction", *titles], table)


def draw(rows: Sequence[dict[str, Any]], path: Path) -> None:
    """Draw times and memory against the number of grains."""
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(13, 4.5), layout="constrained")
    timed = [row for row in rows if row["part"] == "grains"]
    for k, (solver, friction, _) in enumerate(WAYS):
        of_way = [row for row in timed if (row["solver"], row["friction"]) == (solver, friction)]
        grains = [row["grains"] for row in of_way]
        label = f"{solver}, friction {friction:g}"
        left.loglog(grains, [row["sweep_ns"] for row in of_way], f"C{k}o-", label=label)
        left.loglog(grains, [row["memory_bound_ns"] for row in of_way], f"C{k}:")
        middle.loglog(grains, [row["outside_ns"] for row in of_way], f"C{k}o-", label=label)
    left.set(title="a contact and iteration; dotted: to stream contacts", ylabel="ns")
    middle.set(title="a grain and step outside the solver", ylabel="ns")
    for friction, line in ((0.0, "-"), (0.3, "--")):
        weighed = [row for row in rows if row["part"] == "memory" and row["friction"] == friction]
        grains = [row["grains"] for row in weighed]
        for k, (name, label) in enumerate(
            (("peak", "peak"), ("lammps_peak", "peak of LAMMPS alone"), ("held", "held by fix nscd"))
        ):
            values = [row[f"{name}_bytes_per_grain"] for row in weighed]
            right.loglog(grains, values, f"C{k}s{line}", label=f"{label}, {friction:g}")
    right.set(title="memory of a grain; friction 0 and 0.3", ylabel="bytes")
    for axis in (left, middle, right):
        axis.set_xlabel("grains")
        axis.grid(alpha=0.3, which="both")
        axis.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.15), ncol=2)
    left.set_ylim(bottom=1)
    figure.savefig(path, dpi=120)
    print(f"wrote {path}")


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=list(PARTS), help="what to run [all]")
    parser.add_argument("--grains", nargs="+", type=int, choices=COPIES, default=list(COPIES), help="sizes [all]")
    parser.add_argument("--order-grains", type=int, choices=COPIES, default=300_000, help="of part order [%(default)s]")
    parser.add_argument("--repeats", type=int, default=2, help="in one process [%(default)s]")
    parser.add_argument("--rounds", type=int, default=3, help="processes for each size [%(default)s]")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="small slabs, only to see that everything runs")
    given = parser.parse_args(words)
    record = Record("scale")
    record.print_origin()
    repeats, rounds, wide, layers = (1, 1, (4, 4), 4) if given.quick else (given.repeats, given.rounds, (10, 10), 10)
    copies = {64: (1, 1), 128: (2, 1)} if given.quick else {grains: COPIES[grains] for grains in given.grains}
    cell = settled_cell(given.output, wide, layers)
    if "grains" in given.parts:
        grains_part(cell, copies, repeats, rounds, record)
    if "order" in given.parts:
        order_part(cell, (2, 1) if given.quick else COPIES[given.order_grains], repeats, rounds, record)
    if "memory" in given.parts:
        memory_part(cell, copies, record)
    record.write(given.output / "scale.csv")
    if {"grains", "memory"} <= set(given.parts):
        draw(record.rows, given.output / "scale.png")


PARTS = ("grains", "order", "memory")

if __name__ == "__main__":
    main()
