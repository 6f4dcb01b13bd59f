# SPDX-License-Identifier: GPL-2.0-or-later
"""Oblique impacts of all pairs of three types of grains, and on three walls, each in a place of its own.

``mpiexec -n P python materials_scene.py DOOR LAW ANSWER`` runs them, restarts them half-way, and leaves the velocities.
What each impact must give is a closed form of its own material (`expected`).
"""

from __future__ import annotations

import itertools
import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import nscd_lmp

Array = NDArray[np.float64]

RADIUS, MASS, SPIN = 0.1, 0.5, 2.5  # m, kg, m r^2 / I of a sphere
DT, STEPS = 1e-3, 8
NORMAL, SLIP = 1.0, 4.0  # m/s, of every impact
MEETS = 2.4 * DT  # s after the start: within a step
OTHERS: dict[str, Any] = {"friction": 0.25, "restitution": 0.2, "e_t": 0.1}  # of what has none of its own
MATERIALS = {
    (1, 1): nscd_lmp.Material(friction=0.1, restitution=0.9),
    (2, 2): nscd_lmp.Material(friction=0.3, restitution=0.5, e_t=0.0),
    (3, 3): nscd_lmp.Material(friction="stick", restitution=0.0, e_t=0.4),
    (1, 2): nscd_lmp.Material(restitution=0.7),
    (3, 1): nscd_lmp.Material(friction=0.0, restitution=1.0),
    (2, 3): nscd_lmp.Material(friction=0.6),
}
DOORS = ("python", "script", "script, pair_style", "python, pair_style")  # the last two: materials of pair_style nscd
HALF = 3.0  # of the box, m
WALLS = [
    nscd_lmp.Plane((0, -HALF, 0), (0, 1, 0), friction=0.05, restitution=0.6),
    nscd_lmp.Plane((0, HALF, 0), (0, -1, 0), friction="stick"),
    nscd_lmp.Plane((0, 0, -HALF), (0, 0, 1)),
]
PAIRS = list(itertools.combinations_with_replacement((1, 2, 3), 2))


def start() -> tuple[Array, Array, NDArray[np.int64]]:
    """Return places, velocities and types; a pair and its image under x -> -x meet on both sides of x = 0 or across it.

    Pairs meet along x, where the ranks' border lies, with slip along z. Their second half meets across the box' face.
    """
    x, v, types = [], [], []
    for k, pair in enumerate(PAIRS):
        middle = np.array([0.0 if k % 2 else HALF, -2 + 0.8 * k, 0.0])
        for sign, kind in zip((1, -1), pair, strict=True):
            rate = 0.5 * sign * np.array([-NORMAL, 0, SLIP])
            x.append(middle + sign * np.array([RADIUS, 0, 0]) - MEETS * rate)
            v.append(rate)
            types.append(kind)
    for wall, point in zip(WALLS, ([1.0, -HALF, 1.5], [-1.0, HALF, 1.5], [1.0, 0.5, -HALF]), strict=True):
        normal = np.array(wall.normal, float)
        rate = -NORMAL * normal + SLIP * np.roll(normal, 1)
        x.append(np.array(point) + RADIUS * normal - MEETS * rate)
        v.append(rate)
        types.append(1)
    places = np.array(x)
    places[:, 0] = (places[:, 0] + HALF) % (2 * HALF) - HALF
    return places, np.array(v), np.array(types)


def impact(material: Any, mass: float) -> tuple[float, float]:
    """Return normal and tangential impulse of an impact without spins, N s; `mass` is that of the two together."""
    mu, e, e_t = (OTHERS[part] if getattr(material, part) is None else getattr(material, part) for part in OTHERS)
    normal = mass * (1 + e) * NORMAL
    sticks = mass / (1 + SPIN) * (1 + e_t) * SLIP
    return normal, min(sticks, math.inf if mu == "stick" else mu * normal)


def expected() -> Array:
    """Return the velocities after the impacts, by Newton's and Coulomb's laws."""
    _, v, _ = start()
    for k, pair in enumerate(PAIRS):
        normal, slip = impact(MATERIALS.get(pair) or MATERIALS[pair[::-1]], MASS / 2)
        for grain, sign in ((2 * k, 1), (2 * k + 1, -1)):
            v[grain] += sign * np.array([normal, 0, -slip]) / MASS
    for grain, wall in enumerate(WALLS, 2 * len(PAIRS)):
        normal, slip = impact(wall, MASS)
        n = np.array(wall.normal, float)
        v[grain] += (normal * n - slip * np.roll(n, 1)) / MASS
    return v


def harden(lmp: Any, door: str, law: str) -> None:
    """Give the grains their materials by a door."""
    if door.startswith("python"):
        materials = MATERIALS if door == "python" else None
        nscd_lmp.attach(lmp, law=law, tol=1e-12, criterion="paper", materials=materials, walls=WALLS, **OTHERS)
        return
    words = [f"{part} {value}" for part, value in OTHERS.items()]
    if door == "script":
        words += [f"material {own}" for own in own_words()]
    words += [" ".join(wall.keywords()) for wall in WALLS]
    lmp.command(f"fix nscd all nscd law {law} criterion paper tol 1e-12 {' '.join(words)}")


def own_words() -> list[str]:
    """Return types and numbers of each material, as keyword ``material`` and ``pair_coeff`` take them."""
    words = []
    for (a, b), material in MATERIALS.items():
        own = [(part, getattr(material, part)) for part in OTHERS if getattr(material, part) is not None]
        words.append(f"{a} {b} " + " ".join(f"{part} {value}" for part, value in own))
    return words


def velocities(lmp: Any) -> Array | None:
    """Return those of all grains by tag, on the first rank."""
    n = lmp.extract_setting("nlocal")
    own = np.array(lmp.numpy.extract_atom("id")[:n]), np.array(lmp.numpy.extract_atom("v")[:n])
    pieces = lmp.get_mpi_comm().gather(own)
    if lmp.get_mpi_comm().rank != 0:
        return None
    return np.concatenate([v for _, v in pieces])[np.argsort(np.concatenate([tag for tag, _ in pieces]))]


def run(door: str, law: str, folder: Path) -> tuple[Array | None, Array | None]:
    """Return the velocities at the end, straight through and with a restart before the impacts."""
    places, v, types = start()
    box = np.array([[-HALF, HALF], [-HALF - 1, HALF + 1], [-HALF - 1, HALF + 1]])
    lmp = nscd_lmp.scene(
        places, RADIUS, dt=DT, mass=MASS, v=v, type=types, box=box, periodic="x", speed=10.0, setup=["processors * 1 1"]
    )
    if "pair_style" in door:
        lmp.commands_list(["pair_style nscd", *(f"pair_coeff {own}" for own in own_words())])
    harden(lmp, door, law)
    lmp.commands_list(["run 1", f"write_restart {folder}/half"])
    lmp.command(f"run {STEPS - 1}")
    straight = velocities(lmp)
    lmp.close()
    from lammps import lammps

    lmp = lammps(cmdargs=["-screen", "none", "-log", "none", "-nocite"])
    lmp.command(f"read_restart {folder}/half")  # brings pair_style nscd and its materials
    if "pair_style" not in door:
        lmp.commands_list(["pair_style zero 0.25", "pair_coeff * *", "neighbor 0.1 bin"])
    lmp.commands_list(["neigh_modify every 1 delay 0 check yes", f"timestep {DT}", "comm_modify vel yes"])
    harden(lmp, door, law)
    lmp.command(f"run {STEPS - 1}")
    again = velocities(lmp)
    lmp.close()
    return straight, again


if __name__ == "__main__":
    chosen_door, chosen_law, answer = sys.argv[1:]
    through, restarted = run(chosen_door, chosen_law, Path(answer).parent)
    if through is not None and restarted is not None:
        np.savez(answer, through=through, restarted=restarted)
