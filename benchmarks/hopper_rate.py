# SPDX-License-Identifier: GPL-2.0-or-later
"""How fast discs leave a planar hopper, over its opening and over the height of its filling: Beverloo's law.

The scene is inputs/in.hopper2d: 1500 discs of 0.8 to 1.2 mm, friction 0.5, here with solver auto to 1e-3. The rate is
the slope of the number of discs below the slot over time, from 0.05 s after the opening until half of them are out, and
`later` is the slope from there until three quarters are. The fit is rate = C (slot / d - k)^p over all runs of so many
discs, in logarithms: with p = 3/2, then with p free. Errors of fits are standard deviations over fits of as many runs,
drawn with replacement from those of each slot.

    python benchmarks/hopper_rate.py
    python benchmarks/hopper_rate.py --slots 6e-3 12e-3 --discs 1000 --fillings --dt 5e-4 --seeds 1
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from record import Record, print_table
from scipy.optimize import least_squares
from script import run_scene

Array = NDArray[np.float64]

DIAMETER = 1e-3  # mean, m
SLOTS, FILLING = (6e-3, 8e-3, 10e-3, 12e-3), 1500
FILLINGS = (1000, 2000)  # at the slot AT
AT = 8e-3
RIGID = {"solver": "auto", "tol": 1e-3, "maxiter": 1000, "unconverged": "ignore"}
SETTLES, LONGEST, LOOK, END = 0.05, 1.5, 0.01, 0.75  # s, s, s, share of the discs
DRAWS = 200


def slope(t: Array, out: Array, first: float, last: float) -> float:
    """Return the slope from the first to the last time (s), NaN without two looks between them."""
    inside = (t > first - LOOK / 2) & (t < last + LOOK / 2)
    return float(np.polyfit(t[inside], out[inside], 1)[0]) if inside.sum() > 1 else float("nan")


def discharge(slot: float, discs: int, seed: int, dt: float, seconds: float = LONGEST) -> dict[str, Any]:
    """Run a hopper until three quarters of its discs are out, and return the row."""
    began = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        lmp = run_scene("in.hopper2d", slot=slot, n=discs, seed=seed, dt=dt, steps=0, every=1000, **RIGID)
        looks = [0.0]
        while len(looks) * LOOK <= seconds and looks[-1] < END * discs:
            lmp.command(f"run {round(LOOK / dt)} post no")
            looks.append(float(lmp.extract_variable("discharged")))
    given_up = float(lmp.numpy.extract_fix("nscd", 0, 1, 10))
    lmp.close()
    out = np.array(looks)
    t = LOOK * np.arange(len(out))
    half = float(t[np.argmax(out >= discs / 2)]) if out[-1] >= discs / 2 else float(t[-1])
    return {
        "slot": slot,
        "discs": discs,
        "seed": seed,
        "dt": dt,
        "rate": slope(t, out, SETTLES, half),
        "later": slope(t, out, half, float(t[-1])),
        "discharged": int(out[-1]),
        "seconds": float(t[-1]),
        "given_up": given_up,
        "cpu_seconds": time.process_time() - began,
    }


def fit(slots: Array, rates: Array, power: float | None = 1.5) -> tuple[float, float, float]:
    """Return C (discs/s per (opening / d)^p), k and p of rate = C (slot / d - k)^p; `power` None leaves p free."""

    def off(guess: Array) -> Array:
        return guess[0] + (guess[2] if power is None else power) * np.log(slots / DIAMETER - guess[1]) - np.log(rates)

    start = [4.0, 1.4] + ([1.5] if power is None else [])
    highest = slots.min() / DIAMETER - 0.1
    bounds = ([-10, -5, 0.1][: len(start)], [20, highest, 5][: len(start)])
    found = least_squares(off, start, bounds=bounds).x
    return float(np.exp(found[0])), float(found[1]), float(found[2] if power is None else power)


def fit_and_error(slots: Array, rates: Array, power: float | None) -> tuple[Array, Array]:
    """Return what `fit` finds, and its standard deviation over draws of the runs of each slot."""
    random, found = np.random.default_rng(0), []
    groups = [np.flatnonzero(slots == slot) for slot in np.unique(slots)]
    for _ in range(DRAWS):
        drawn = np.concatenate([random.choice(group, len(group)) for group in groups])
        found.append(fit(slots[drawn], rates[drawn], power))
    return np.array(fit(slots, rates, power)), np.std(found, axis=0)


def report(rows: Sequence[dict[str, Any]], filling: int) -> None:
    """Print mean rates and their standard deviations, and the fits."""
    groups: dict[tuple[float, int], list[dict[str, Any]]] = {}
    for row in rows:
        groups.setdefault((row["slot"] / DIAMETER, row["discs"]), []).append(row)
    lines = []
    for (slot, discs), of in groups.items():
        rates, ratios = [row["rate"] for row in of], [row["later"] / row["rate"] for row in of]
        spread = [float(np.std(values, ddof=1)) if len(of) > 1 else None for values in (rates, ratios)]
        lines.append([f"{slot:g}", discs, len(of), np.mean(rates), spread[0], np.mean(ratios), spread[1]])
    columns = ["slot / d", "discs", "seeds", "discs/s", "deviation", "later / rate", "deviation"]
    print_table("discs out of a planar hopper", columns, lines)
    usual = [row for row in rows if row["discs"] == filling]
    slots, rates = (np.array([row[name] for row in usual]) for name in ("slot", "rate"))
    for power in (1.5, None):
        if len(np.unique(slots)) < (2 if power else 3):
            continue
        (c, k, p), (dc, dk, dp) = fit_and_error(slots, rates, power)
        print(f"rate = C (slot/d - k)^p: C {c:.4g} +- {dc:.2g} discs/s, k {k:.3g} +- {dk:.2g}, p {p:.3g} +- {dp:.2g}")


def parsed(words: Sequence[str] | None = None) -> argparse.Namespace:
    """Return what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--slots", nargs="*", type=float, default=SLOTS, metavar="D", help="m")
    parser.add_argument("--discs", type=int, default=FILLING, metavar="N", help="at all slots")
    parser.add_argument("--fillings", nargs="*", type=int, default=FILLINGS, metavar="N", help=f"discs, slot {AT} m")
    parser.add_argument("--seeds", nargs="+", type=int, default=(1, 2, 3))
    parser.add_argument("--dt", type=float, default=2e-4, help="s")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="a few discs and steps, to see that it runs")
    return parser.parse_args(words)


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    asked = parsed(words)
    record = Record("hopper_rate")
    record.print_origin()
    cases = [(slot, asked.discs) for slot in asked.slots] + [(AT, discs) for discs in asked.fillings]
    if asked.quick:
        asked.seeds, cases = (1,), [(AT, 100)]
    for seed in asked.seeds:
        for slot, discs in cases:
            record.add(**discharge(slot, discs, seed, asked.dt, 0.1 if asked.quick else LONGEST))
            record.write(asked.output / "hopper_rate.csv")
    report(record.rows, asked.discs)


if __name__ == "__main__":
    main()
