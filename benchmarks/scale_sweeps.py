# SPDX-License-Identifier: GPL-2.0-or-later
"""Iterations to a tolerance against the size of a bed: its height, its width, and the number of ranks.

Beds of grains periodic in x and y, frictionless, settled under law gap; one step of 5e-4 s to criterion (42) below 1e-7
and 1e-10 m/s, cold (zero start impulses) and warm (from those of the step before).

height   8 x 8 grains a layer, more and more layers
width    8 layers, wider and wider; each bed has settled on its own
copies   8 layers, the narrowest bed of them and copies beside it
ranks    4 copies of scale.py's slab on 1 to 8 ranks, divided in x and y

    python benchmarks/scale_sweeps.py
    python benchmarks/scale_sweeps.py --parts ranks
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from record import Record, print_table
from slab import settled_cell
from slab_job import measure

Row = dict[str, Any]
DT = 5e-4  # s
TOLS = (1e-7, 1e-10)  # m/s
MAXITER = 50_000
LAYERS = (8, 16, 32, 64)
WIDTHS = (8, 16, 32)
COPIES = ((1, 1), (2, 2), (4, 4))
GRIDS = {1: "1 1 1", 2: "2 1 1", 4: "2 2 1", 8: "4 2 1"}
FACTORISED = 13_000  # contacts: more of them are not given to active_set here


def beds(part: str, folder: Path, quick: bool) -> list[Row]:
    """Return the jobs of a part, with the number that grows from one to the next."""
    edge, layers, shrink = (4, 4, 2) if quick else (8, 8, None)
    jobs: list[Row] = []
    if part == "height":
        heights = (2, 4) if quick else LAYERS
        jobs += [{"cell": settled_cell(folder, (edge, edge), height), "size": height} for height in heights]
    elif part == "width":
        widths = (4, 5) if quick else WIDTHS
        jobs += [{"cell": settled_cell(folder, (wide, wide), layers), "size": wide} for wide in widths]
    elif part == "copies":
        cell = settled_cell(folder, (edge, edge), layers)
        jobs += [{"cell": cell, "copies": n, "size": n[0]} for n in COPIES[:shrink]]
    else:
        cell = settled_cell(folder, (4, 4) if quick else (10, 10), 4 if quick else 10)
        grids = list(GRIDS.items())[:shrink]
        jobs += [{"cell": cell, "copies": (2, 2), "processors": grid, "size": ranks} for ranks, grid in grids]
    return [job | {"cell": str(job["cell"]), "what": "sweeps", "dt": DT} for job in jobs]


def ways(part: str, contacts: float) -> list[Row]:
    """Return how the beds are solved; on several ranks, which are slow, NLGS only to the looser tolerance."""
    pairs = [("apgs", tol) for tol in TOLS] + [("pdas", tol) for tol in (TOLS[:1] if part == "ranks" else TOLS)]
    if part != "ranks" and contacts <= FACTORISED:
        pairs += [("active_set", tol) for tol in TOLS]
    return [{"solver": solver, "tol": tol, "maxiter": MAXITER} for solver, tol in pairs]


def measure_part(part: str, folder: Path, quick: bool, record: Record) -> list[Row]:
    """Return a row for every bed, solver and tolerance."""
    rows = []
    for job in beds(part, folder, quick):
        with np.load(job["cell"]) as cell:
            contacts = 3 * len(cell["radius"]) * int(np.prod(job.get("copies", 1)))
        asked = ways(part, contacts)
        found = measure(job | {"ways": asked}, job["size"] if part == "ranks" else 1)
        for way, row in zip(asked, found, strict=True):
            rows.append({"part": part, "size": job["size"], "dt": DT} | way | row)
            record.add(**rows[-1])
    return rows


def exponent(rows: Sequence[Row], start: str) -> float | None:
    """Return the slope of log iterations over log size; None where it cannot be told."""
    points = [(row["size"], row[start]) for row in rows if row[start]]
    if len(points) < 2:
        return None
    sizes, iterations = np.log(np.array(points)).T
    return float(np.polyfit(sizes, iterations, 1)[0])


def show(rows: Sequence[Row], record: Record) -> None:
    """Print iterations, and the exponents of their growth."""
    columns = ("part", "solver", "tol", "size", "grains", "contacts", "cold", "warm")
    titles = ["part", "solver", "tol", "layers, width,\ncopies or ranks", *columns[4:]]
    print_table("Iterations of a step", titles, [[row[name] for name in columns] for row in rows])
    table = []
    for part, solver, tol in dict.fromkeys((row["part"], row["solver"], row["tol"]) for row in rows):
        same = [row for row in rows if (row["part"], row["solver"], row["tol"]) == (part, solver, tol)]
        powers = {f"exponent_{start}": exponent(same, start) for start in ("cold", "warm")}
        record.add(part=f"{part}_exponent", solver=solver, tol=tol, **powers)
        table.append([part, solver, tol, *powers.values()])
    print_table("Iterations grow with this power", ["part", "solver", "tol", "cold", "warm"], table)


def draw(rows: Sequence[Row], path: Path) -> None:
    """Draw cold iterations against height, width and ranks."""
    figure, axes = plt.subplots(1, 3, figsize=(13, 4), layout="constrained", sharey=True)
    drawn = (("height", "layers"), ("width", "grains along an edge, 8 layers"), ("ranks", "ranks, 4000 grains"))
    for axis, (part, label) in zip(axes, drawn, strict=True):
        of_part = [row for row in rows if row["part"] == part]
        for k, solver in enumerate(("pdas", "apgs", "active_set")):
            for tol, line in zip(TOLS, (":", "-"), strict=True):
                same = [r for r in of_part if (r["solver"], r["tol"]) == (solver, tol) and r["cold"]]
                if same:
                    places, counts = [r["size"] for r in same], [r["cold"] for r in same]
                    axis.loglog(places, counts, f"C{k}o{line}", label=f"{solver}, {tol:g} m/s")
        sizes = sorted({row["size"] for row in of_part})
        axis.set(xlabel=label, title=part)
        axis.set_xticks(sizes, [str(size) for size in sizes])
        axis.minorticks_off()
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("iterations of a step, cold")
    axes[0].legend(fontsize=7, loc="center right", bbox_to_anchor=(1, 0.3))
    figure.savefig(path, dpi=120)
    print(f"wrote {path}")


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=list(PARTS), help="what to run [all]")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="small beds, only to see that everything runs")
    given = parser.parse_args(words)
    record = Record("scale_sweeps")
    record.print_origin()
    rows: list[Row] = []
    for part in given.parts:
        rows += measure_part(part, given.output, given.quick, record)
        record.write(given.output / "scale_sweeps.csv")
    show(rows, record)
    record.write(given.output / "scale_sweeps.csv")
    if set(given.parts) == set(PARTS):
        draw(rows, given.output / "scale_sweeps.png")


PARTS = ("height", "width", "copies", "ranks")

if __name__ == "__main__":
    main()
