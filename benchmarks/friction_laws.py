# SPDX-License-Identifier: GPL-2.0-or-later
"""The local laws with Coulomb friction: iterations, seconds and failures over the coefficient.

Two settled beds of 500 grains, balls (three unknowns a contact) and discs (two), `law gap`, a step of 1e-4 s,
criterion (42) at 1e-5 and 1e-7, at most 10,000 iterations. Every law and coefficient starts from the same state.
Balls were settled without friction, so they are at rest whatever the coefficient; discs with 0.3. cold: zero start
impulses in each step; warm: those of the step before. The first two steps are not counted.

Seconds are processor time in the solver per step, the best of several runs that take turns. The relative residual
is that of the natural map, the largest of the steps. A law fails where a step ends above tol; it is then run once.

    python benchmarks/friction_laws.py
    python benchmarks/friction_laws.py --frictions 0.3 stick --starts warm
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import matplotlib
import numpy as np
from analysis_scripts import STYLE, save_figure
from discs import open_discs
from matplotlib.figure import Figure
from numpy.typing import NDArray
from record import Record, print_table
from saved_state import SavedState
from settled_bed import open_balls, open_bed

import nscd_lmp

Friction = float | Literal["stick"]

DT = 1e-4  # s
TOLERANCES = (1e-5, 1e-7)  # m/s; gravity gives 1e-3 in a step
STEPS = 5
WARM_UP = 2
FRICTIONS: tuple[Friction, ...] = (0.0, 0.1, 0.3, 0.6, 1.0, "stick")
STARTS = ("cold", "warm")
SCENES = {"balls": (open_balls, "settled_bed", 0.0), "discs": (open_discs, "settled_discs", 0.3)}


@dataclass(frozen=True)
class Case:
    """One cell of the tables."""

    scene: str
    start: str
    tol: float
    friction: Friction
    solver: str


@dataclass
class Bed:
    """A settled bed in LAMMPS, and what to start it from."""

    lmp: Any
    walls: list[nscd_lmp.Plane]
    state: SavedState


def measure(bed: Bed, cases: Sequence[Case], maxiter: int, repeats: int) -> list[dict[str, Any]]:
    """Run the steps of each case, those that converge `repeats` times; they take turns."""
    results = [_result(case, *_run(bed, case, maxiter)) for case in cases]
    for _ in range(repeats - 1):
        for case, result in zip(cases, results, strict=True):
            if result["unconverged_steps"]:
                continue  # how long a failure takes is maxiter's choice
            again = _result(case, *_run(bed, case, maxiter))
            for name in ("seconds_per_step", "ns_per_contact_and_iteration"):
                result[name] = min(result[name], again[name])
    return results


def _result(case: Case, stats: NDArray[Any], share: float) -> dict[str, Any]:
    seconds = share * float(stats["seconds_solver"].mean())
    return {
        "contacts": int(stats["contacts"].mean()),
        "iterations_per_step": float(stats["iterations"].mean()),
        "seconds_per_step": seconds,
        "ns_per_contact_and_iteration": 1e9 * seconds / float((stats["contacts"] * stats["iterations"]).mean()),
        "unconverged_steps": int((stats["criterion"] >= case.tol).sum()),
        "criterion": float(stats["criterion"].max()),
        "relative_residual": float(stats["relative_residual"].max()),
    }


def _run(bed: Bed, case: Case, maxiter: int) -> tuple[NDArray[Any], float]:
    bed.state.put_back(bed.lmp)
    attached = nscd_lmp.attach(
        bed.lmp,
        solver=case.solver,
        law="gap",
        friction=case.friction,
        criterion="paper",
        tol=case.tol,
        maxiter=maxiter,
        warmstart=case.start == "warm",
        walls=bed.walls,
        unconverged="ignore",
    )
    bed.lmp.command(f"run {WARM_UP} post no")
    wall, cpu = time.perf_counter(), time.thread_time()
    bed.lmp.command(f"run {STEPS} post no")
    wall, cpu = time.perf_counter() - wall, time.thread_time() - cpu
    attached.detach()
    return attached.stats[WARM_UP:], cpu / wall


def report_laws(results: dict[Case, dict[str, Any]], scene: str, start: str, tol: float, maxiter: int) -> None:
    """Print the tables of a scene, start and tolerance: a row a coefficient, a column a law."""
    chosen = {
        case: result for case, result in results.items() if (case.scene, case.start, case.tol) == (scene, start, tol)
    }
    contacts = next(iter(chosen.values()))["contacts"]
    columns = ["friction", *(law.title for law in nscd_lmp.LOCAL_LAWS.values())]
    shown = {
        f"iterations a step; * steps ended above tol, after {maxiter}": _count,
        "solver, ms a step": lambda result: 1e3 * result["seconds_per_step"],
        "largest relative residual": lambda result: f"{result['relative_residual']:.0e}",
    }
    for what, cell in shown.items():
        rows = [
            [
                str(friction),
                *(cell(chosen[Case(scene, start, tol, friction, solver)]) for solver in nscd_lmp.LOCAL_LAWS),
            ]
            for friction in dict.fromkeys(case.friction for case in chosen)
        ]
        print_table(f"{scene}, {contacts} contacts, {start} start, tol {tol:g}: {what}", columns, rows)


def _count(result: dict[str, Any]) -> str:
    return f"{result['iterations_per_step']:.0f}{'*' if result['unconverged_steps'] else ''}"


# A law and the next one in the registry have nearly the same iterates: the next is drawn on it in pale dashes.
COLORS = ("#21618c", "#aed6f1", "#d35400", "#fad7a0", "#1e8449", "#a9dfbf")


def draw(results: dict[Case, dict[str, Any]], maxiter: int, path: Path) -> None:
    """Draw iterations against the coefficient: a row a tolerance, a column a scene and start, a line a law."""
    columns = list(dict.fromkeys((case.scene, case.start) for case in results))
    tolerances = list(dict.fromkeys(case.tol for case in results))
    width, height = 2.5 * len(columns) + 0.8, 2.7 * len(tolerances) + 0.5
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(width, height), layout="constrained")
        grid = figure.subplots(len(tolerances), len(columns), sharex=True, sharey=True, squeeze=False)
        for tol, row in zip(tolerances, grid, strict=True):
            for (scene, start), axes in zip(columns, row, strict=True):
                _draw_panel(
                    axes, {c: r for c, r in results.items() if (c.scene, c.start, c.tol) == (scene, start, tol)}
                )
                axes.axhline(maxiter, color="black", linewidth=0.8, linestyle=":")
                axes.set_title(f"{scene}, {start}, tol {_power(tol)} m/s", fontsize=9)
        for axes in grid[-1]:
            axes.set_xlabel("friction")
        for axes in grid[:, 0]:
            axes.set_ylabel("NLGS iterations a step")
        grid[-1, 0].legend(fontsize=8, loc="lower right", title="crosses: above tol", title_fontsize=8)
        save_figure(figure, path)
    print(f"wrote {path}")


def _power(tol: float) -> str:
    return np.format_float_scientific(tol, trim="-", exp_digits=1)


def _draw_panel(axes: Any, results: dict[Case, dict[str, Any]]) -> None:
    axes.set_yscale("log")
    for k, law in enumerate(nscd_lmp.LOCAL_LAWS.values()):
        mine = [(str(case.friction), result) for case, result in results.items() if case.solver == law.name]
        color, line = COLORS[k % len(COLORS)], (0, (4, 4)) if k % 2 else "-"
        names, counts = [name for name, _ in mine], [result["iterations_per_step"] for _, result in mine]
        axes.plot(names, counts, color=color, linestyle=line, label=law.title)
        failed = [(name, result["iterations_per_step"]) for name, result in mine if result["unconverged_steps"]]
        axes.plot([name for name, _ in failed], [count for _, count in failed], "x", color=color)


def parse_friction(word: str) -> Friction:
    """Return a coefficient from a word of the command line."""
    return "stick" if word == "stick" else float(word)


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", nargs="+", choices=list(SCENES), default=list(SCENES), help="what to run [all]")
    parser.add_argument("--starts", nargs="+", choices=STARTS, default=STARTS, help="[cold warm]")
    parser.add_argument(
        "--frictions", nargs="+", type=parse_friction, default=list(FRICTIONS), metavar="MU", help="numbers or stick"
    )
    parser.add_argument("--grains", type=int, default=500, help="[%(default)s]")
    parser.add_argument("--maxiter", type=int, default=10000, help="[%(default)s]")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--repeats", type=int, default=3, help="runs of each [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="small beds, only to see that everything runs")
    given = parser.parse_args(words)
    if given.quick:
        given.grains, given.maxiter, given.repeats, given.frictions = 60, 300, 1, [0.3, "stick"]
    record = Record("friction_laws")
    record.print_origin()
    results: dict[Case, dict[str, Any]] = {}
    for scene in given.scenes:
        opener, name, settled_with = SCENES[scene]
        bed = Bed(*open_bed(given.grains, given.output, DT, opener, name, settled_with))
        for start in given.starts:
            for tol in TOLERANCES:
                for friction in given.frictions:
                    cases = [Case(scene, start, tol, friction, solver) for solver in nscd_lmp.LOCAL_LAWS]
                    for case, result in zip(cases, measure(bed, cases, given.maxiter, given.repeats), strict=True):
                        results[case] = result
                        parameters = {"grains": given.grains, "dt": DT, "maxiter": given.maxiter}
                        record.add(**vars(case), law="gap", steps=STEPS, **parameters, **result)
                report_laws(results, scene, start, tol, given.maxiter)
        bed.lmp.close()
    record.write(given.output / "friction_laws.csv")
    draw(results, given.maxiter, given.output / "friction_laws.png")


if __name__ == "__main__":
    main()
