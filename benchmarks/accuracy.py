# SPDX-License-Identifier: GPL-2.0-or-later
"""Accuracy against speed: rigid contacts and LAMMPS' penalty contacts on the same scenes, one thread.

sedimentation   in.sedimentation (law gap at several steps, law moreau at the paper's) and its penalty twin
                at the largest stable steps; largest overlap / radius of all steps against processor seconds
balls           SimBenchmark's 666 balls, both laws, beside the published numbers of physics engines

All contacts start from the impulses of the step before (warm start).

    python benchmarks/accuracy.py
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from analysis_scripts import STYLE, new_figure, save_figure
from balls666 import ELASTIC, ENGINES, INELASTIC, published, run_balls
from box import box_walls
from matplotlib.ticker import FormatStrFormatter, LogLocator, NullLocator
from penetration import Penetration
from record import Record, print_table
from script import ScriptRun, open_scene, run_script

import nscd_lmp

RIGID = (  # law, dt in s
    ("moreau", 5e-5),
    ("gap", 5e-5),
    ("gap", 2e-4),
    ("gap", 5e-4),
    ("gap", 1e-3),
)
TOLERANCES = (1e-6, 1e-7)
PENALTY = ((1e3, 8e-6), (1e5, 8e-7))  # kn in N/m, its largest stable dt in s
ELASTIC_TOL = 1e-10  # what is left of the energy is then the law's doing, not the tolerance's


@dataclass(frozen=True)
class Case:
    """A way to run the sedimentation: its script and LAMMPS variables."""

    method: str
    script: str
    variables: dict[str, Any]


@dataclass(frozen=True)
class Result:
    """What a case gave; iterations and steps above tol are None for penalty contacts."""

    method: str
    parameters: dict[str, Any]
    steps: int
    seconds: float
    wall_seconds: float
    overlap_ratio: float
    iterations_per_step: float | None = None
    unconverged_steps: int | None = None


def cases(quick: bool) -> list[Case]:
    """Return all ways to run the sedimentation; the quick ones are few and small."""
    scene = {"n": 60, "lx": 4e-3, "time": 0.01} if quick else {}
    warm = {"warmstart": "yes", "unconverged": "ignore"}
    rigid = [
        Case(f"law {law}", "in.sedimentation", {"law": law, "dt": dt, "tol": tol, **warm, **scene})
        for law, dt in RIGID
        for tol in TOLERANCES
    ]
    penalty = [
        Case(f"penalty kn = {kn:g} N/m", "in.sedimentation.granular", {"kn": kn, "dt": dt, **scene})
        for kn, dt in (PENALTY[:1] if quick else PENALTY)
    ]
    return rigid + penalty


def fastest_runs(given: Sequence[Case], repeats: int) -> list[ScriptRun]:
    """Return the fastest run of each case; they take turns, so that a busy minute hits all of them."""
    rounds = [[run_script(case.script, **case.variables) for case in given] for _ in range(repeats)]
    return [min(runs, key=lambda run: run.cpu_seconds) for runs in zip(*rounds, strict=True)]


def evaluate(case: Case, run: ScriptRun) -> Result:
    """Return the result of a run. Penalty contacts are run once more, to look for overlaps after every step."""
    if run.totals:
        return Result(
            case.method,
            case.variables,
            int(run.totals["steps"]),
            run.cpu_seconds,
            run.wall_seconds,
            run.totals["worst_overlap_ratio"],  # of every step
            run.iterations_per_step,
            int(run.totals["unconverged_steps"]),
        )
    lmp = open_scene(case.script, **case.variables)
    steps = round(float(lmp.extract_variable("time")) / case.variables["dt"])
    worst = _worst_overlap(lmp, steps)
    lmp.close()
    return Result(case.method, case.variables, steps, run.cpu_seconds, run.wall_seconds, worst)


def _worst_overlap(lmp: Any, steps: int) -> float:
    n = lmp.extract_global("nlocal")
    probe = Penetration(lmp.numpy.extract_atom("radius")[:n].copy(), box_walls(float(lmp.extract_variable("lx"))))
    worst = 0.0
    lmp.command("run 0 post no")
    for _ in range(steps):
        lmp.command("run 1 pre no post no")
        depth, smaller = probe.overlaps(lmp.numpy.extract_atom("x")[:n])
        worst = max(worst, float((depth / smaller).max(initial=0.0)))
    return worst


def sedimentation(repeats: int, quick: bool, record: Record) -> list[Result]:
    """Run, print and record the sedimentation."""
    given = cases(quick)
    results = [evaluate(case, run) for case, run in zip(given, fastest_runs(given, repeats), strict=True)]
    rows = []
    for result in results:
        row = {
            **{name: result.parameters.get(name) for name in ("dt", "tol")},
            "steps": result.steps,
            "cpu_seconds": result.seconds,
            "worst_overlap_ratio": result.overlap_ratio,
            "iterations_per_step": result.iterations_per_step,
            "unconverged_steps": result.unconverged_steps,
        }
        rows.append([result.method, *row.values()])
        more = {name: result.parameters.get(name) for name in ("law", "kn")}
        record.add(part="sedimentation", method=result.method, **more, **row, wall_seconds=result.wall_seconds)
    print_table(
        "Sedimentation of 60 balls, 0.01 s" if quick else "Sedimentation of 500 balls, 0.05 s",
        "method|dt, s|tol|steps|CPU s|largest overlap\n/ radius|iterations\na step|unconverged".split("|"),
        rows,
        f"CPU s: the whole script, best of {repeats}; overlap: the largest after any step",
    )
    return results


def balls(repeats: int, quick: bool, record: Record) -> None:
    """Run, print and record the 666 balls."""
    duration = 0.2 if quick else 10.0
    cases = [(INELASTIC, 1e-2)] if quick else [(INELASTIC, 1e-3), (INELASTIC, 1e-2), (ELASTIC, 1e-3)]
    rows = []
    for law in nscd_lmp.LAWS:
        row: list[Any] = [f"law {law}"]
        for variant, dt in cases:
            tol = ELASTIC_TOL if variant is ELASTIC else 1e-7
            result = run_balls(variant, law, dt, tol, duration, repeats)
            row += [result["error"], result["cpu_seconds"]]
            parameters = {"method": f"law {law}", "law": law, "variant": variant.name, "dt": dt, "tol": tol}
            record.add(part="balls", **parameters, **result, error_is=variant.error)
        rows.append(row)
    for engine in ENGINES:
        rows.append([engine, *(value for variant, dt in cases for value in published(engine, variant, dt))])
    columns = ["engine"]
    for variant, dt in cases:
        columns += [f"{variant.name}, dt {dt:g} s\nerror", "\nseconds"]
    note = "; ".join(dict.fromkeys(f"error {variant.name}: {variant.error}" for variant, _ in cases))
    print_table(f"666 balls, {duration:g} s; engines as published in 2018", columns, rows, note)


def draw(results: Sequence[Result], path: Path) -> None:
    """Draw largest overlap against processor seconds, a line a method and tolerance."""
    series: dict[str, list[Result]] = {}
    for result in results:
        tol = result.parameters.get("tol")
        name = "penalty (gran/hooke)" if tol is None else f"{result.method}, tol {tol:g}"
        series.setdefault(name, []).append(result)
    with matplotlib.rc_context(STYLE):
        figure, axes = new_figure(6.8, 4.6)
        for name, mine in series.items():
            _draw_line(axes, name, mine)
        axes.margins(x=0.15, y=0.1)
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.xaxis.set_major_formatter(FormatStrFormatter("%g"))
        axes.xaxis.set_minor_locator(NullLocator())
        axes.set_xlabel("processor time, s")
        axes.set_ylabel("largest overlap / radius")
        axes.legend(loc="upper right", title="labels: time step, s")
        save_figure(figure, path)
    print(f"wrote {path}")


def _draw_line(axes: Any, name: str, results: Sequence[Result]) -> None:
    law, tol = (results[0].parameters.get(key) for key in ("law", "tol"))
    color = {"gap": "C0", "moreau": "C1", None: "C2"}[law]
    tight = tol == min(TOLERANCES)
    seconds, overlaps = [r.seconds for r in results], [r.overlap_ratio for r in results]
    line, marker = ("--", "s") if tight else ("-", "o")
    axes.loglog(seconds, overlaps, color=color, linestyle=line, marker=marker, label=name)
    for result, second, overlap in zip(results, seconds, overlaps, strict=True):
        offset, side = ((7, 5), "left") if tight else ((-6, -6), "right")
        axes.annotate(
            np.format_float_scientific(result.parameters["dt"], trim="-", exp_digits=1),
            (second, overlap),
            offset,
            textcoords="offset points",
            ha=side,
            va="center",
            fontsize=8,
            color=color,
        )


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--parts", nargs="+", choices=["sedimentation", "balls"], default=["sedimentation", "balls"])
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--repeats", type=int, default=5, help="runs of each [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="small scenes, only to see that everything runs")
    given = parser.parse_args(words)
    repeats = 1 if given.quick else given.repeats
    record = Record("accuracy")
    record.print_origin()
    if "sedimentation" in given.parts:
        draw(sedimentation(repeats, given.quick, record), given.output / "accuracy.png")
    if "balls" in given.parts:
        balls(repeats, given.quick, record)
    record.write(given.output / "accuracy.csv")


if __name__ == "__main__":
    main()
