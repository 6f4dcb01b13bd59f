# SPDX-License-Identifier: GPL-2.0-or-later
"""Loose clouds of grains that fall into boxes, and how charts time and watch them."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nscd_lmp.charts.grains import open_lammps, per_grain
from nscd_lmp.charts.methods import METHODS, RIGID, Contacts, start
from nscd_lmp.charts.overlap import Overlaps
from nscd_lmp.charts.penalty import contact_duration
from nscd_lmp.door.walls import Plane

Array = NDArray[np.float64]

DENSITY, GRAVITY, LOOSE = 2500.0, 9.81, 1.02  # kg/m^3, m/s^2, edge of a grain's cell over the largest diameter
MOST_LOOKS = 2000
MAXITER = 20_000
FIRST = (12.9898, 39.3461, 73.1561, 93.9893)  # of the hash in inputs/include/cloud.initial


@dataclass(frozen=True)
class Cloud:
    """Grains at rest without overlap: x (n, 3) and radius (n,) in m, the height of the cloud in m."""

    x: Array
    radius: Array
    height: float

    @property
    def mass(self) -> Array:
        """Masses, kg."""
        return DENSITY * 4 / 3 * np.pi * self.radius**3

    @property
    def speed(self) -> float:
        """Speed of a fall through the cloud, m/s."""
        return math.sqrt(2 * GRAVITY * self.height)


def loose_cloud(grains: int, width: float, smallest: float, largest: float, seed: int = 1) -> Cloud:
    """Return the cloud of ``inputs/include/cloud.initial`` over a square of `width` (m): a cell for each grain.

    Radii are uniform from `smallest` to `largest` (m).
    """
    across = math.floor(width / (2 * largest * LOOSE))
    layers = math.ceil(grains / across**2)
    edge = np.array([width / across, width / across, 2 * largest * LOOSE])
    cell = np.arange(grains)
    places = np.column_stack([cell % across, cell // across % across, cell // across**2])
    hashed = [
        np.abs(43758.5453 * np.sin(first * cell + 78.233 * seed + k)) % 1 for k, first in enumerate(FIRST, start=1)
    ]
    radius = smallest + hashed[0] * (largest - smallest)
    shift = (2 * np.column_stack(hashed[1:]) - 1) * (edge / 2 - radius[:, None])
    return Cloud((places + 0.5) * edge + shift, radius, layers * edge[2])


def box_width(grains: int) -> float:
    """Return the width of the box in m: 8 mm for the 500 grains of the paper, 20 mm for 10,000."""
    return 8e-3 * max(1.0, (grains / 500) ** 0.306)


def box_walls(width: float) -> list[Plane]:
    """Return the floor and the four sides of a box of `width` x `width` m above the corner 0 0 0."""
    sides = [((0, 0, 0), (1, 0, 0)), ((width, 0, 0), (-1, 0, 0)), ((0, 0, 0), (0, 1, 0)), ((0, width, 0), (0, -1, 0))]
    return [Plane((0, 0, 0), (0, 0, 1)), *(Plane(point, normal) for point, normal in sides)]


@dataclass
class Scene:
    """A scene that can be begun again and again: grains, walls and what they are given.

    `start_x`, `start_v` replace the places and velocities of the cloud, `options` are words for ``fix nscd``.
    """

    cloud: Cloud
    walls: list[Plane]
    box: list[tuple[float, float]]
    friction: float = 0.0
    boundary: str = "f f f"
    gravity: tuple[float, float, float] = (0.0, 0.0, -1.0)
    options: str = f"maxiter {MAXITER}"
    start_x: Array | None = None
    start_v: Array | None = None
    speed: float | None = None
    commands: list[str] = field(default_factory=list)

    def begin(self, folder: Path, case: dict[str, Any]) -> Contacts:
        """Open LAMMPS with the scene and its contacts."""
        cloud = self.cloud
        x = cloud.x if self.start_x is None else self.start_x
        v = 0.0 if self.start_v is None else self.start_v
        lmp = open_lammps(folder, x, cloud.radius, cloud.mass, v, box=self.box, boundary=self.boundary)
        lmp.command(f"fix gravity all gravity {GRAVITY} vector {' '.join(map(repr, self.gravity))}")
        lmp.commands_list(self.commands)
        speed = cloud.speed if self.speed is None else self.speed
        return start(lmp, case["method"], case, self.walls, 0.0, self.friction, speed=speed, options=self.options)


@dataclass(frozen=True)
class Timed:
    """Wall and processor seconds of ``run`` commands."""

    wall: float
    processor: float

    def __add__(self, other: Timed) -> Timed:
        """Return the sum."""
        return Timed(self.wall + other.wall, self.processor + other.processor)


def timed(contacts: Contacts, command: str) -> Timed:
    """Give LAMMPS a run command and return what it took."""
    wall, processor = time.perf_counter(), time.thread_time()
    contacts.lmp.command(command)
    return Timed(time.perf_counter() - wall, time.thread_time() - processor)


def fastest(begin: Callable[[], Contacts], steps: int, repeats: int) -> Timed:
    """Run a scene from its start `repeats` times; return the least of its seconds."""
    found = []
    for _ in range(repeats):
        contacts = begin()
        found.append(timed(contacts, f"run {steps} post no"))
        contacts.lmp.close()
    return min(found, key=lambda seconds: seconds.processor)


def follow(contacts: Contacts, steps: int, every: int, look: Callable[[int], object]) -> Timed:
    """Run `steps`, and call `look` with the steps taken after every so many and at the end."""
    taken, seconds = 0, Timed(0.0, 0.0)
    while taken < steps:
        more = min(every, steps - taken)
        seconds += timed(contacts, f"run {more} {'pre no ' if taken else ''}post no")
        taken += more
        look(taken)
    return seconds


def steps_between_looks(case: dict[str, Any], lightest: float, steps: int, most: int = MOST_LOOKS) -> int:
    """Return after how many steps to look: each step of rigid contacts, three times a contact of penalty ones.

    There are at most `most` looks.
    """
    often = 1
    if METHODS[case["method"]].family != RIGID:
        often = round(contact_duration(case["stiffness"], lightest) / 3 / case["dt"])
    return max(1, often, -(-steps // most))


class Watch:
    """Overlaps and heights of a run, look by look."""

    def __init__(self, contacts: Contacts, walls: list[Plane], dt: float) -> None:
        self.lmp, self.dt = contacts.lmp, dt
        self.probe = Overlaps(per_grain(self.lmp, "radius"), walls)
        self.times: list[float] = []
        self.heights: list[float] = []
        self.largest: list[float] = []
        self.shares: list[float] = []

    def look(self, taken: int) -> Array:
        """Note overlaps and mean height after so many steps; return the places."""
        x = per_grain(self.lmp, "x")
        depth, smaller = self.probe.look(x)
        ratios = depth / smaller
        self.times.append(taken * self.dt)
        self.heights.append(float(x[:, 2].mean()))
        self.largest.append(float(ratios.max(initial=0.0)))
        self.shares.append(float(ratios.sum()) / len(x))
        return x

    def overlaps(self) -> dict[str, float]:
        """Return overlap_max, the largest of all looks, and overlap_mean, the mean over time of the sum a grain."""
        return {"overlap_max": max(self.largest), "overlap_mean": float(np.mean(self.shares))}
