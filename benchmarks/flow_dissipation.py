# SPDX-License-Identifier: GPL-2.0-or-later
"""Where a dense flow leaves the power of gravity, over the step: impacts, sticking and sliding.

The rough incline of rough_incline.py, all steps from one flow. The work of an impulse is that on the mean of the
velocities before and after the step, so all works together are the change of the kinetic energy. Columns are shares of
gravity's power, in the mean over the time: `normal` impulses of pairs that meet in the step (their free motion brings
them from a gap to an overlap) and of those that last, and tangential impulses of contacts that stick and that slide.
`impulse` is the share of the normal impulses that pairs have which meet.

    python benchmarks/flow_dissipation.py
    python benchmarks/flow_dissipation.py --steps 2e-4 5e-5 --accuracies normal tight --seconds 0.2
"""

from __future__ import annotations

import argparse
import warnings
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from record import Record, print_table
from rough_incline import (
    ANGLE,
    DENSITY,
    DIAMETER,
    FRICTION,
    GRAVITY,
    LAYERS,
    SIDE,
    SPEED,
    State,
    flow,
    now,
    rigid,
    start,
)

Array = NDArray[np.float64]
COLUMNS = ("law", "accuracy", "dt", "velocity", "meets", "lasts", "sticks", "slides", "impulse")
FIXED = SIDE * SIDE  # grains of the base


def turned(a: Array, normal: Array) -> Array:
    return np.cross(a, normal)


def works(before: State, after: State, contacts: dict[str, Array], radii: Array, dt: float) -> Counter[str]:
    """Return what the contacts between grains take from the kinetic energy in a step, J, by what they do."""
    held = (contacts["tag_j"] > 0) & (contacts["impulse"] > 0)
    i, j = (contacts[name][held].astype(int) - 1 for name in ("tag_i", "tag_j"))
    normal = np.stack([contacts[f"n{axis}"][held] for axis in "xyz"], axis=1)
    push = contacts["impulse"][held]
    rub = np.stack([contacts[f"impulse_t{axis}"][held] for axis in "xyz"], axis=1)
    (x, v0, w0), (_, v1, w1) = before, after
    v, w = 0.5 * (v0 + v1), 0.5 * (w0 + w1)
    mean = v[i] - v[j] - turned(radii[i, None] * w[i] + radii[j, None] * w[j], normal)
    apart, length = x[i] - x[j], SIDE * DIAMETER
    apart[:, :2] -= length * np.round(apart[:, :2] / length)
    reach = radii[i] + radii[j]
    gap = np.linalg.norm(apart, axis=1) - reach
    meets = (gap > 0) & (np.linalg.norm(apart + dt * (v0[i] - v0[j]), axis=1) < reach)
    sticks = np.linalg.norm(rub, axis=1) < 0.999 * FRICTION * push
    along, across = -push * (mean * normal).sum(axis=1), -(rub * mean).sum(axis=1)
    return Counter(
        meets=along[meets].sum(),
        lasts=along[~meets].sum(),
        sticks=across[sticks].sum(),
        slides=across[~sticks].sum(),
        push=push.sum(),
        push_meets=push[meets].sum(),
    )


def measure(state: State, diameters: Array, dt: float, law: str, accuracy: str, seconds: float) -> dict[str, Any]:
    """Run from a flow for a time and return a row."""
    lmp = rigid(state, diameters, dt, law, accuracy=accuracy)
    attached = lmp._nscd.attached
    masses = DENSITY * np.pi / 6 * diameters[FIXED:, None] ** 3
    pull = GRAVITY * np.array([np.sin(ANGLE), 0, -np.cos(ANGLE)])
    sums: Counter[str] = Counter()
    power, speed, steps = 0.0, 0.0, max(1, round(seconds / dt))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        lmp.command("run 0 post no")
        after = copied(now(lmp))
        for _ in range(steps):
            before = after
            lmp.command("run 1 pre no post no")
            after = copied(now(lmp))
            sums.update(works(before, after, attached.contacts, diameters / 2, dt))
            power += float((masses * pull * 0.5 * (before[1] + after[1])[FIXED:]).sum()) * dt
            speed += after[1][FIXED:, 0].mean() / SPEED / steps
    lmp.close()
    shares = {name: sums[name] / power for name in ("meets", "lasts", "sticks", "slides")}
    impulse = sums["push_meets"] / sums["push"]
    return {"law": law, "accuracy": accuracy, "dt": dt, "velocity": speed, **shares, "impulse": impulse}


def copied(state: State) -> State:
    x, v, w = (values.copy() for values in state)
    return x, v, w


def main(words: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", nargs="*", type=float, default=(1e-3, 5e-4, 2e-4, 1e-4, 5e-5), help="s")
    parser.add_argument("--laws", nargs="*", default=("gap",), choices=("gap", "moreau"))
    parser.add_argument("--accuracies", nargs="*", default=("tight",), choices=("loose", "normal", "tight"))
    parser.add_argument("--seed", type=int, default=32)
    parser.add_argument("--seconds", type=float, default=0.2, help="of every run")
    parser.add_argument("--settling", type=float, default=1.0, help="seconds before, of law gap at 2e-4 s")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="a few steps, to see that it runs")
    asked = parser.parse_args(words)
    if asked.quick:
        asked.steps, asked.seconds, asked.settling = (1e-3,), 5e-3, 0.05
    state, diameters = start(asked.seed)
    lmp = rigid(state, diameters, 2e-4, "gap")
    flow(lmp, 2e-4, asked.settling, diameters / 2)
    state = copied(now(lmp))
    lmp.close()
    record = Record("flow_dissipation")
    for law in asked.laws:
        for accuracy in asked.accuracies:
            for dt in asked.steps:
                record.add(grains=SIDE * SIDE * LAYERS, **measure(state, diameters, dt, law, accuracy, asked.seconds))
                record.write(asked.output / "flow_dissipation.csv")
    rows = [[row[name] for name in COLUMNS] for row in record.rows]
    print_table("shares of gravity's power that a flow on a rough incline leaves at", COLUMNS, rows)


if __name__ == "__main__":
    main()
