# SPDX-License-Identifier: GPL-2.0-or-later
"""Figure 4: how criterion (42) falls with the NLGS iterations of one step, law by law."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib
from analysis_scripts import STYLE, new_figure, save_figure
from box import box_walls
from saved_state import SavedState
from script import open_scene

import nscd_lmp

BELOW = 1e-10  # m/s, where a curve ends


class Point(NamedTuple):
    """Criterion (42), m/s, after a number of iterations from zero impulses."""

    solver: str
    contacts: int
    iterations: int
    criterion: float


def convergence_history(step: int, longest: int, **variables: Any) -> list[Point]:
    """Solve one step of in.sedimentation again and again, each time with more iterations.

    The state before the step is that of a run with PDAS, the same for all laws. `maxiter` ends the solver
    after k iterations from zero impulses, and the criterion is always taken after the last one: the history
    is what the solver does, nothing is computed a second time here.

    Parameters
    ----------
    step : int
        The step to solve, from 1.
    longest : int
        Largest number of iterations; a law stops where it is below 1e-10.
    variables
        LAMMPS variables of the scene, e.g. ``n``.
    """
    lmp = open_scene("in.sedimentation", step - 1, **variables)
    before = SavedState.of(lmp)
    width = float(lmp.extract_variable("lx"))
    points = []
    for solver in nscd_lmp.LOCAL_LAWS:
        for iterations in iteration_counts(longest):
            before.put_back(lmp)
            points.append(_solve_once(lmp, solver, iterations, width))
            if points[-1].criterion < BELOW:
                break
    lmp.close()
    return points


def _solve_once(lmp: Any, solver: str, iterations: int, width: float) -> Point:
    attached = nscd_lmp.attach(
        lmp,
        solver=solver,
        law="moreau",
        criterion="paper",
        tol=BELOW / 100,
        maxiter=iterations,
        warmstart=False,
        walls=box_walls(width),
        unconverged="ignore",
    )
    lmp.command("run 1 post no")
    attached.detach()
    (row,) = attached.stats
    return Point(solver, int(row["contacts"]), int(row["iterations"]), float(row["criterion"]))


def iteration_counts(longest: int) -> Iterator[int]:
    """Yield 1, 2, 3, ... and then numbers 12 % apart, up to `longest`."""
    count = 1
    while count < longest:
        yield count
        count = max(count + 1, round(1.12 * count))
    yield longest


def iterations_below(points: Sequence[Point], solver: str, criterion: float) -> int | None:
    """Return the first iteration count of the history at which the law is below a value, or None."""
    return next((p.iterations for p in points if p.solver == solver and p.criterion < criterion), None)


# A law and the next one in the registry often have the same iterates: the next is drawn on it in pale dashes.
COLORS = ("#21618c", "#aed6f1", "#d35400", "#fad7a0", "#1e8449", "#a9dfbf")


def draw(points: Sequence[Point], step: int, path: Path) -> None:
    """Draw criterion against iteration, a curve a law."""
    with matplotlib.rc_context(STYLE):
        figure, axes = new_figure(6.4, 4.2)
        for k, law in enumerate(nscd_lmp.LOCAL_LAWS.values()):
            mine = [p for p in points if p.solver == law.name]
            axes.semilogy(
                [p.iterations for p in mine],
                [p.criterion for p in mine],
                color=COLORS[k % len(COLORS)],
                linestyle=(0, (4, 4)) if k % 2 else "-",
                label=law.title,
            )
        axes.axhline(1e-7, color="black", linewidth=0.8, linestyle=":")
        axes.text(1.0, 1e-7, " tol", transform=axes.get_yaxis_transform(), va="center")
        axes.set_xlabel("NLGS iterations")
        axes.set_ylabel("criterion (42), m/s")
        axes.set_title(f"Step {step} of the sedimentation, {points[0].contacts} contacts, cold start")
        axes.legend()
        save_figure(figure, path)
    print(f"wrote {path}")
