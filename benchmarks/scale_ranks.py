# SPDX-License-Identifier: GPL-2.0-or-later
"""Two ranks against one, and what ranks send each other: slabs of scale.py, a fixed number of iterations.

speed    wall time of a step and of an iteration, the best of the repeats; ways to run take turns:
         one      all grains on one rank              half   half of them on one rank
         two      all grains on two ranks             apart  two processes with half of them each, that share nothing
         strong = one / two, weak = half / two. `apart` is what the machine can do: two cores share its memory.
traffic  what a rank sends in a step, on average over the ranks, as the code counts it; on more ranks than cores too.
         The part that grows with the iterations is from runs of 20 and of 60. What LAMMPS' own communication would
         move: velocities of its images, forward and reverse.

    python benchmarks/scale_ranks.py
    python benchmarks/scale_ranks.py --parts traffic
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
from record import Record, print_table
from scale import COPIES
from slab import settled_cell
from slab_job import DT, measure

Row = dict[str, Any]
FIXED = {"warmstart": False, "tol": 1e-30}
WAYS = (("apgs", 0.0), ("pdas", 0.0), ("apgs", 0.3))
GRIDS = {1: (1, 1), 2: (2, 1), 4: (2, 2), 8: (4, 2), 16: (4, 4)}
FEW, MANY = 20, 60  # iterations
DOUBLE = 8  # bytes


def speed_jobs(copies: tuple[int, int]) -> dict[str, tuple[Row, int]]:
    """Return the job and the number of ranks of every way to run."""
    half = (copies[0] // 2, copies[1])
    split = {"copies": copies, "processors": "2 1 1"}
    return {
        "one": ({"copies": copies}, 1),
        "two": (split, 2),
        "half": ({"copies": half}, 1),
        "apart": ({"copies": half, "apart": True}, 2),
    }


def speed_rows(cell: Path, copies: tuple[int, int], job: Row, rounds: int) -> list[Row]:
    """Return for every way the best times of a step and of an iteration, s, and what they say."""
    best: dict[tuple[int, str], Row] = {}
    for turn in range(rounds):
        jobs = list(speed_jobs(copies).items())
        for name, (how, ranks) in jobs if turn % 2 == 0 else reversed(jobs):
            for found in measure(job | how | {"what": "times", "cell": str(cell)}, ranks):
                row = best.setdefault((found["way"], name), {"iterations": found["iterations"]})
                steps = job["steps"]
                row |= {n: found[n] for n in ("grains", "contacts")}
                iteration = found["solver"] / (steps * found["iterations"])
                step, ours = found["wall"] / steps, found["ours"] / steps
                for what, seconds in (("step", step), ("iteration", iteration), ("outside", ours)):
                    row[what] = min(row.get(what, seconds), seconds)
    rows = []
    for k, (solver, friction) in enumerate(WAYS):
        ways = {name: best[k, name] for name in speed_jobs(copies)}
        row = {"solver": solver, "friction": friction, "grains": ways["two"]["grains"]}
        for what in ("step", "iteration", "outside"):
            seconds = {name: of[what] for name, of in ways.items()}
            row |= {f"{what}_s_{name}": s for name, s in seconds.items()}
            row[f"{what}_strong"] = seconds["one"] / seconds["two"]
            row[f"{what}_weak"] = seconds["half"] / seconds["two"]
            row[f"{what}_strong_apart"] = seconds["one"] / seconds["apart"]
            row[f"{what}_weak_apart"] = seconds["half"] / seconds["apart"]
        rows.append(row | {"contacts": ways["two"]["contacts"], "iterations": ways["two"]["iterations"]})
    return rows


def speed_part(cell: Path, sizes: Sequence[tuple[int, int]], repeats: int, rounds: int, record: Record) -> None:
    """Measure two ranks against one."""
    table = []
    for copies in sizes:
        grains = copies[0] * copies[1] * 1000
        job: Row = {"steps": max(2, min(10, 300_000 // grains)), "repeats": repeats}
        job["ways"] = [FIXED | {"solver": s, "friction": f, "maxiter": MANY} for s, f in WAYS]
        for row in speed_rows(cell, copies, job, rounds):
            record.add(part="speed", dt=DT, repeats=repeats, rounds=rounds, steps=job["steps"], **row)
            for what in ("step", "iteration", "outside"):
                ms = [1e3 * row[f"{what}_s_{name}"] for name in ("one", "two", "half", "apart")]
                ratios = [row[f"{what}_{name}"] for name in ("strong", "weak", "strong_apart", "weak_apart")]
                table.append([row["grains"], row["solver"], row["friction"], what, *ms, *ratios])
    titles = ["grains", "solver", "friction", "of", "one, ms", "two", "half", "apart"]
    print_table("Two ranks", [*titles, "strong", "weak", "strong,\napart", "weak,\napart"], table)


def traffic_row(cell: Path, ranks: int, wide: int, way: Row, steps: int) -> Row:
    """Return what a rank sends: in an iteration, and beside iterations in a step."""
    grid = GRIDS[ranks]
    job: Row = {"what": "traffic", "cell": str(cell), "steps": steps, "processors": f"{grid[0]} {grid[1]} 1"}
    job["copies"] = [n * wide for n in grid]
    job["ways"] = [FIXED | way | {"maxiter": n} for n in (FEW, MANY)]
    few, many = measure(job, ranks)
    row = {"ranks": ranks, "grains_per_rank": many["grains"] / ranks, "contacts": many["contacts"], "steps": steps}
    for name in ("exchanges", "messages", "bytes", "reductions"):
        grown = (many[name] - few[name]) / (many["iterations"] - few["iterations"])
        row |= {f"iteration_{name}": grown, f"step_{name}": many[name] - grown * many["iterations"]}
    numbers = 6 if way["friction"] else 3
    ghosts = many["ghosts"]
    row |= {"shared_per_rank": row["iteration_bytes"] / (2 * DOUBLE * numbers), "ghosts_per_rank": ghosts}
    row["lammps_bytes"] = 2 * DOUBLE * numbers * ghosts if ranks > 1 else 0.0
    # What a rank sends itself, across a periodic border, is no message.
    row["lammps_messages"] = 2 * 2 * sum(n > 1 for n in grid)
    return row


def traffic_part(cell: Path, ranks: Sequence[int], wides: Sequence[int], steps: int, record: Record) -> None:
    """Count messages with growing numbers of ranks, and on four with growing numbers of grains."""
    table = []
    for friction in (0.0, 0.3):
        way = {"solver": "apgs", "friction": friction}
        cases = [(p, wides[0]) for p in ranks] + [(4, wide) for wide in wides[1:]]
        for p, wide in cases:
            row = traffic_row(cell, p, wide, way, steps)
            record.add(part="traffic", **way, **row)
            shown = ["ranks", "grains_per_rank", "iteration_exchanges", "iteration_messages", "iteration_bytes"]
            shown += ["shared_per_rank", "iteration_reductions", "step_exchanges", "step_messages", "step_bytes"]
            shown += ["step_reductions", "ghosts_per_rank", "lammps_messages", "lammps_bytes"]
            table.append([friction, *(float(row[name]) for name in shown)])
    titles = ["friction", "ranks", "grains\na rank", "an iteration:\nexchanges", "messages", "bytes", "shared\ngrains"]
    titles += ["reductions", "beside them:\nexchanges", "messages", "bytes", "reductions"]
    print_table("What a rank sends", [*titles, "images", "LAMMPS:\nmessages", "bytes"], table)


def draw(rows: Sequence[Row], path: Path) -> None:
    """Draw speed-ups, and bytes an iteration."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4), layout="constrained")
    speed = [row for row in rows if row["part"] == "speed"]
    for k, (solver, friction) in enumerate(WAYS):
        of_way = [row for row in speed if (row["solver"], row["friction"]) == (solver, friction)]
        grains = [row["grains"] for row in of_way]
        name = f"{solver}, friction {friction:g}"
        left.semilogx(grains, [row["step_strong"] for row in of_way], f"C{k}o-", label=f"{name}: two ranks")
        left.semilogx(grains, [row["step_strong_apart"] for row in of_way], f"C{k}x:", label="two that share nothing")
    left.axhline(2, color="gray", lw=0.8)
    left.set(title="whole step: times faster than one rank", xlabel="grains", ylim=(0, 2.4))
    sent = [row for row in rows if row["part"] == "traffic" and row["friction"] == 0 and row["ranks"] > 1]
    least = min((row["grains_per_rank"] for row in sent), default=0)
    same = [row for row in sent if row["grains_per_rank"] == least]
    ranks = [row["ranks"] for row in same]
    right.semilogx(ranks, [row["iteration_bytes"] / 1e3 for row in same], "C0o-", label="nscd, an iteration", base=2)
    right.semilogx(ranks, [row["lammps_bytes"] / 1e3 for row in same], "C1s-", label="all images, both ways", base=2)
    right.set(title=f"kB that a rank sends, {least:g} grains a rank", xlabel="ranks", xticks=ranks)
    right.set_xticklabels([f"{n:g}" for n in ranks])
    for axis in (left, right):
        axis.grid(alpha=0.3)
        axis.legend(fontsize=7)
    right.set_ylim(bottom=0)
    figure.savefig(path, dpi=120)
    print(f"wrote {path}")


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=list(PARTS), help="what to run [all]")
    sizes = [10_000, 100_000, 300_000]
    parser.add_argument("--grains", nargs="+", type=int, choices=COPIES, default=sizes, help="of part speed")
    parser.add_argument("--repeats", type=int, default=2, help="in one process [%(default)s]")
    parser.add_argument("--rounds", type=int, default=4, help="processes for each way [%(default)s]")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="small slabs, only to see that everything runs")
    given = parser.parse_args(words)
    record = Record("scale_ranks")
    record.print_origin()
    cell = settled_cell(given.output, (4, 4) if given.quick else (10, 10), 4 if given.quick else 10)
    if "speed" in given.parts:
        copies = [(2, 1)] if given.quick else [(2, 5) if n == 10_000 else COPIES[n] for n in given.grains]
        speed_part(cell, copies, 1 if given.quick else given.repeats, 1 if given.quick else given.rounds, record)
    if "traffic" in given.parts:
        ranks = [1, 2, 4] if given.quick else list(GRIDS)
        traffic_part(cell, ranks, [1] if given.quick else [1, 2, 3], 2 if given.quick else 5, record)
    record.write(given.output / "scale_ranks.csv")
    if set(given.parts) == set(PARTS):
        draw(record.rows, given.output / "scale_ranks.png")


PARTS = ("speed", "traffic")

if __name__ == "__main__":
    main()
