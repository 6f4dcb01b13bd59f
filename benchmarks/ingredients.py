# SPDX-License-Identifier: GPL-2.0-or-later
"""What each ingredient of the model costs: where a scene does not need it, and where it does.

A settled bed is run again from the same state with one thing added at a time, beside the bed as it is; the two take
turns. Iterations are fixed (apgs, 30 a step, zero start impulses), so what differs is the price of the ingredient.

Not needed is, for instance, a wall that nothing touches, or restitution where nothing impacts: that should cost
nothing. Needed is what changes the result: friction, the contact law, warm start.

    python benchmarks/ingredients.py
    python benchmarks/ingredients.py --grains 500
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from discs import open_discs
from record import Record, print_table
from saved_state import SavedState
from settled_bed import Scene, open_balls, open_bed

import nscd_lmp

DT = 1e-4  # s
STEPS, WARM_UP = 20, 2
ITERATIONS = 30
FAR = [nscd_lmp.Plane((0, 0, -10 - k), (0, 0, 1)) for k in range(10)]
Floor = list[nscd_lmp.Plane]


@dataclass(frozen=True)
class Ingredient:
    """One thing more than the bed has: settings of attach, walls to add; and what it is added to."""

    name: str
    needed: bool
    settings: dict[str, Any] = field(default_factory=dict)
    base: dict[str, Any] = field(default_factory=dict)
    walls: tuple[nscd_lmp.Plane, ...] = ()
    own_friction: bool = False  # of the walls, as the pairs'
    base_scene: Scene = open_balls


INGREDIENTS = (
    Ingredient("friction 0, said so", False, {"friction": 0.0}),
    Ingredient("10 walls that nothing touches", False, walls=tuple(FAR)),
    Ingredient("restitution 0.5 in a bed at rest", False, {"restitution": 0.5}),
    Ingredient("gamma 1, said so", False, {"solver": "pdas", "gamma": 1.0}, {"solver": "pdas"}),
    Ingredient("threads 2, contacts for one", False, {"threads": 2}),
    Ingredient("e_t 0.5, with friction 0.3", False, {"e_t": 0.5}, {"friction": 0.3}),
    Ingredient("walls with a friction of their own", False, base={"friction": 0.3}, own_friction=True),
    Ingredient("warm start", True, {"warmstart": True}),
    Ingredient("criterion natural", True, {"criterion": "natural"}),
    Ingredient("friction 0.3 in space, 3 unknowns", True, {"friction": 0.3}),
    Ingredient("law gap, for law moreau", True, {"law": "gap"}, {"law": "moreau"}),
    Ingredient("friction 0.3 in the plane, 2 unknowns", True, {"friction": 0.3}, base_scene=open_discs),
)


@dataclass
class Bed:
    """A settled bed in LAMMPS."""

    lmp: Any
    walls: Floor
    state: SavedState


def microseconds(bed: Bed, settings: dict[str, Any], more_walls: Sequence[nscd_lmp.Plane] = ()) -> tuple[float, float]:
    """Return what a step of the bed costs, the best of some: solver, and all of ours beside it."""
    bed.state.put_back(bed.lmp)
    chosen: dict[str, Any] = {
        "solver": "apgs",
        "law": "gap",
        "warmstart": False,
        "criterion": "paper",
        "tol": 1e-14,
        "maxiter": ITERATIONS,
    } | settings
    attached = nscd_lmp.attach(bed.lmp, walls=[*bed.walls, *more_walls], unconverged="ignore", **chosen)
    bed.lmp.command(f"run {WARM_UP + STEPS} post no")
    stats = attached.stats[WARM_UP:]
    attached.detach()
    per_iteration = stats["seconds_solver"] / np.maximum(stats["contacts"] * stats["iterations"], 1)
    return 1e9 * float(per_iteration.min()), 1e6 * float(stats["seconds_contacts"].min())


def own_friction(bed: Bed, coefficient: float) -> Floor:
    """Return the bed's walls with a coefficient of their own."""
    return [nscd_lmp.Plane(wall.point, wall.normal, friction=coefficient) for wall in bed.walls]


def measure(bed: Bed, one: Ingredient, repeats: int) -> dict[str, float]:
    """Return the costs without and with the ingredient."""
    with_it = Bed(bed.lmp, own_friction(bed, 0.3), bed.state) if one.own_friction else bed
    without, having = [], []
    for _ in range(repeats):
        without.append(microseconds(bed, one.base))
        having.append(microseconds(with_it, one.base | one.settings, one.walls))
    sweep, step = np.min(without, axis=0)
    sweep_with, step_with = np.min(having, axis=0)
    return {
        "sweep_ns": sweep,
        "sweep_ns_with": sweep_with,
        "sweep_ratio": sweep_with / sweep,
        "step_us": step,
        "step_us_with": step_with,
        "step_ratio": step_with / step,
    }


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--grains", type=int, default=1000, help="[%(default)s]")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--repeats", type=int, default=7, help="runs of each [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="a small bed, only to see that everything runs")
    given = parser.parse_args(words)
    grains, repeats = (60, 1) if given.quick else (given.grains, given.repeats)
    record = Record("ingredients")
    record.print_origin()
    beds: dict[Scene, Bed] = {
        open_balls: Bed(*open_bed(grains, given.output, DT)),
        open_discs: Bed(*open_bed(grains, given.output, DT, open_discs, "settled_discs", 0.3)),
    }
    rows = []
    for one in sorted(INGREDIENTS, key=lambda one: one.needed):
        found = measure(beds[one.base_scene], one, repeats)
        record.add(ingredient=one.name, needed=one.needed, grains=grains, dt=DT, iterations=ITERATIONS, **found)
        rows.append([one.name, "yes" if one.needed else "no", *found.values()])
    columns = ["ns a contact\nand sweep", "with it", "ratio", "us a step\nbeside", "with it", "ratio"]
    print_table("What an ingredient costs", ["ingredient", "needed", *columns], rows)
    record.write(given.output / "ingredients.csv")


if __name__ == "__main__":
    main()
