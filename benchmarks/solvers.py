# SPDX-License-Identifier: GPL-2.0-or-later
"""Solvers against each other: one contact problem to many tolerances, and whole runs.

problems  work against precision: milliseconds of the solver, best of the repeats, against the largest error of the
          contact velocities, from loose to tight `tol`; a table and a chart
paper     milliseconds to criterion (42) below 1e-7 and 1e-10 m/s, and how many times faster than NLGS-PDAS
runs      sedimentation to rest, law gap, dt 5e-4 s, tol 1e-6: seconds of the solver and of all, against NLGS-PDAS

    python benchmarks/solvers.py
    python benchmarks/solvers.py --grains 500 --parts problems paper
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from itertools import cycle
from pathlib import Path
from typing import Any

import matplotlib
from analysis_scripts import STYLE, save_figure
from contact_problems import DT, Case, bed, columns, velocity_error
from cycler import cycler
from matplotlib.figure import Figure
from record import Record, print_table
from settled_bed import open_balls

import nscd_lmp

TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)
PAPER_TOLERANCES = (1e-7, 1e-10)  # m/s
ENOUGH = 2.0  # seconds after which a solver is given no tighter tolerance
MAXITER = {"active_set": 300, "interior_point": 150}
FACTORISABLE = 5000  # contacts, beyond which a factorisation takes seconds
BASE = "pdas"  # what others are measured against: NLGS
PARTS = ("problems", "paper", "runs")
LOOKS = cycler(color=["#7f8c8d", "#d35400", "#21618c", "#1e8449", "#8e44ad", "#b7950b"])
Curves = dict[str, dict[str, list[tuple[float, float]]]]


def ways(case: Case) -> list[tuple[str, str, dict[str, Any]]]:
    """Return label, solver and parameters of what is worth a try; SOR is SBP with rho beyond 1."""
    friction = case.problem.mu is not None
    slow = {"interior_point"} if len(case.problem) > FACTORISABLE else set()
    names = ["pdas", *[name for name, solver in nscd_lmp.SOLVERS.items() if solver.kind == "global"]]
    some = [(n, n, {}) for n in names if n not in slow and (nscd_lmp.SOLVERS[n].friction or not friction)]
    return some if friction else [*some[:1], ("SOR 1.8", "sbp", {"rho": 1.8}), *some[1:]]


def solve(case: Case, solver: str, repeats: int, **options: Any) -> tuple[nscd_lmp.Solution, float]:
    """Return the solution and the best time of the repeats, ms."""
    options.setdefault("maxiter", MAXITER.get(solver, 100000))
    found = [
        nscd_lmp.solve(case.problem, solver, warmstart=case.start, unconverged="ignore", **options)
        for _ in range(repeats)
    ]
    return found[0], 1e3 * min(solution.seconds for solution in found)


def find_reference(case: Case) -> nscd_lmp.Solution:
    """Return the best solution that any solver finds."""
    names = ["auto"] if len(case.problem) > FACTORISABLE or case.problem.mu is not None else ["auto", "active_set"]
    found = [solve(case, name, 1, tol=1e-14, maxiter=20000)[0] for name in names]
    return min(found, key=lambda solution: solution.residual)


def compare(case: Case, record: Record, repeats: int) -> dict[str, list[tuple[float, float]]]:
    """Return points (error in m/s, milliseconds) of each solver."""
    reference = find_reference(case)
    curves: dict[str, list[tuple[float, float]]] = {}
    for label, solver, parameters in ways(case):
        points = curves.setdefault(label, [])
        for tol in TOLERANCES:
            solution, milliseconds = solve(case, solver, repeats, tol=tol, **parameters)
            error = velocity_error(solution, reference)
            record.add(
                part="problems", case=case.name, contacts=len(case.problem), solver=label, tol=tol,
                iterations=solution.iterations, converged=solution.converged, residual=solution.residual,
                milliseconds=milliseconds, error=error, reference_residual=reference.residual,
            )  # fmt: skip
            if not solution.converged:
                break
            points.append((error, milliseconds))
            if milliseconds > 1e3 * ENOUGH:
                break
    return curves


def precision_rows(case: Case, record: Record) -> list[list[Any]]:
    """Return a row a solver: what a velocity error of 1e-8 m/s takes, which the tightest loose tolerance gives."""
    rows = []
    labels = list(dict.fromkeys(row["solver"] for row in record.rows if row.get("case") == case.name))
    for label in labels:
        mine = [r for r in record.rows if r.get("case") == case.name and r["solver"] == label]
        good = [row for row in mine if row["error"] <= 1e-8 and row["converged"]]
        first = min(good, key=lambda row: row["milliseconds"]) if good else None
        rows.append(
            [case.name, len(case.problem), label]
            + ([first["tol"], first["iterations"], first["milliseconds"]] if first else [None, None, None])
            + [min(row["error"] for row in mine)]
        )
    return rows


def paper_rows(case: Case, record: Record, repeats: int) -> list[list[Any]]:
    """Return a row a solver: milliseconds to the two values of criterion (42), and the ratio to NLGS."""
    taken: dict[str, list[float | None]] = {}
    for label, solver, parameters in ways(case):
        if solver == "active_set" and len(case.problem) > FACTORISABLE:
            continue
        taken[label] = []
        for tol in PAPER_TOLERANCES:
            solution, milliseconds = solve(
                case, solver, repeats, tol=tol, criterion="paper", maxiter=MAXITER.get(solver, 40000), **parameters
            )
            record.add(
                part="paper", case=case.name, contacts=len(case.problem), solver=label, tol=tol,
                iterations=solution.iterations, converged=solution.converged, residual=solution.residual,
                milliseconds=milliseconds,
            )  # fmt: skip
            taken[label].append(milliseconds if solution.converged else None)
    rows = []
    for label, times in taken.items():
        ratios = [base / mine if base and mine else None for base, mine in zip(taken[BASE], times, strict=True)]
        rows.append([case.name, len(case.problem), label, *times, *ratios])
    return rows


def run_rows(grains: int, steps: int, record: Record) -> list[list[Any]]:
    """Return a row a solver: sedimentation from the loose start to rest."""
    rows: list[list[Any]] = []
    base: dict[str, float] = {}
    for solver in (BASE, "apgs", "auto"):
        lmp, walls = open_balls(grains, DT)
        attached = nscd_lmp.attach(
            lmp,
            law="gap",
            solver=solver,
            criterion="paper",
            tol=1e-6,
            maxiter=20000,
            walls=walls,
            unconverged="ignore",
        )
        wall, cpu = time.perf_counter(), time.thread_time()
        lmp.command(f"run {steps} post no")
        wall, cpu = time.perf_counter() - wall, time.thread_time() - cpu
        stats = attached.stats
        lmp.close()
        result = {
            "iterations": float(stats["iterations"].mean()),
            "unconverged": int(stats["unconverged_steps"][-1]),
            "solver_s": float(stats["seconds_solver"].sum()) * cpu / wall,
            "all_s": cpu,
            "overlap": float(stats["largest_overlap_ratio"].max()),
        }
        base = base or result
        ratios = [base["solver_s"] / result["solver_s"], base["all_s"] / result["all_s"]]
        record.add(part="runs", grains=grains, dt=DT, steps=steps, solver=solver, **result)
        rows.append([grains, steps, solver, *result.values(), *ratios])
    return rows


def draw(curves: Curves, path: Path) -> None:
    """Draw a panel a case: milliseconds against the error of the velocities."""
    labels = list(dict.fromkeys(label for solvers in curves.values() for label in solvers))
    wide = min(4, len(curves))
    high = -(-len(curves) // wide)
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(3.6 * wide, 3.2 * high), layout="constrained")
        axes = figure.subplots(high, wide, squeeze=False).ravel()
        looks = dict(zip(labels, cycle(LOOKS), strict=False))
        for ax, (name, solvers) in zip(axes, curves.items(), strict=False):
            for label, points in solvers.items():
                if points:
                    errors, milliseconds = zip(*points, strict=True)
                    floor = [max(error, 1e-15) for error in errors]
                    dash = "--" if label == "auto" else "-"  # it lies on the line of what it chose
                    ax.loglog(floor, milliseconds, dash, marker="o", markersize=3, label=label, **looks[label])
            ax.set_title(name)
            widen(ax)
            ax.invert_xaxis()
        for ax in axes[len(curves) :]:
            ax.set_axis_off()
        figure.supxlabel("largest error of a contact velocity, m/s")
        figure.supylabel("solver, ms")
        lines = {line.get_label(): line for ax in axes for line in ax.get_lines()}
        figure.legend(lines.values(), lines.keys(), loc="outside upper center", ncols=len(lines))
        save_figure(figure, path)
    print(f"wrote {path}")


def widen(ax: Any) -> None:
    """Let both axes span two decades at least, so that their labels have room."""
    for low_high, limit in ((ax.get_xlim(), ax.set_xlim), (ax.get_ylim(), ax.set_ylim)):
        low, high = low_high
        if high < 100 * low:
            middle = (low * high) ** 0.5
            limit(middle / 10, middle * 10)


def collect(given: argparse.Namespace) -> list[Case]:
    """Return the cases of the command line."""
    if given.quick:
        return [*columns()[1:], *bed(60, given.output)]
    cases = columns()
    for grains in given.grains:
        cases += bed(grains, given.output)
    return cases + bed(500, given.output, friction=0.1) + bed(500, given.output, friction=0.3)


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--grains", nargs="+", type=int, default=[500, 10000], help="[%(default)s]")
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=list(PARTS), help="[all]")
    parser.add_argument("--steps", type=int, default=200, help="of the runs [%(default)s]")
    parser.add_argument("--repeats", type=int, default=3, help="of each solve [%(default)s]")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="small problems, only to see that everything runs")
    given = parser.parse_args(words)
    record = Record("solvers")
    record.print_origin()
    repeats = 1 if given.quick else given.repeats
    cases = collect(given) if {"problems", "paper"} & set(given.parts) else []
    scene = ["case", "contacts", "solver"]
    if "problems" in given.parts:
        curves = {case.name: compare(case, record, repeats) for case in cases}
        rows = [row for case in cases for row in precision_rows(case, record)]
        print_table("To a velocity error of 1e-8 m/s", [*scene, "tol", "iterations", "ms", "best error"], rows)
        draw(curves, given.output / "solvers.png")
    if "paper" in given.parts:
        rows = [row for case in cases if "bed" in case.name for row in paper_rows(case, record, repeats)]
        print_table("Milliseconds to criterion (42)", [*scene, "1e-7", "1e-10", "times\nfaster", "times\nfaster"], rows)
    if "runs" in given.parts:
        rows = []
        for grains in [60] if given.quick else given.grains:
            rows += run_rows(grains, 20 if given.quick else given.steps, record)
        heads = ["grains", "steps", "solver", "iterations", "above\ntol", "solver s", "all s", "overlap/r"]
        print_table("Sedimentation, law gap, dt 5e-4 s, tol 1e-6", [*heads, "solver\nfaster", "all\nfaster"], rows)
    record.write(given.output / "solvers.csv")


if __name__ == "__main__":
    main()
