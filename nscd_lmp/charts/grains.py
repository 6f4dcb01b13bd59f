# SPDX-License-Identifier: GPL-2.0-or-later
"""Grains of a scene in a LAMMPS instance, set to the last bit."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nscd_lmp.charts.methods import FEW, Contacts
from nscd_lmp.door.create import create_grains
from nscd_lmp.door.scene import gravity_fix, open_box

Array = NDArray[np.float64]
Timing = dict[str, float]

LONG = 2.0  # s


def open_lammps(
    folder: Path,
    x: ArrayLike,
    radius: ArrayLike,
    mass: ArrayLike,
    v: ArrayLike = 0.0,
    omega: ArrayLike = 0.0,
    *,
    box: Sequence[tuple[float, float]],
    gravity: float = 0.0,
    boundary: str = "f f f",
) -> Any:
    """Return a LAMMPS instance with spheres, tags from 1 in the order given, under gravity along -z.

    Parameters
    ----------
    folder : Path
        For the log file.
    x : array_like, shape (n, 3)
        Centres, m.
    radius, mass : array_like, shape (n,) or scalar
        m, kg.
    v, omega : array_like, shape (n, 3) or what can be spread over it
        m/s, rad/s.
    box : sequence of three pairs
        Bounds of the box, m.
    gravity : float
        m/s^2.
    boundary : str
        As of LAMMPS' command.
    """
    centres = np.array(x, dtype=float).reshape(-1, 3)
    silent = ["-screen", "none", "-log", str(folder / "log.lammps"), "-nocite"]
    lmp = open_box(box, boundary, sort=len(centres) >= FEW, cmdargs=silent)
    create_grains(lmp, centres, radius, mass=mass, v=v, omega=omega)
    if gravity:
        lmp.command(gravity_fix(gravity))
    return lmp


def per_grain(lmp: Any, name: str) -> Array:
    """Return a copy of x, v, omega, radius, rmass, ... of all ranks' grains in the order of the tags."""
    here = lmp.extract_global("nlocal")
    tags, values = (np.array(lmp.numpy.extract_atom(one)[:here]) for one in ("id", name))
    if lmp.extract_setting("world_size") > 1:
        tags, values = map(np.concatenate, zip(*lmp.get_mpi_comm().allgather((tags, values)), strict=True))
    return values[np.argsort(tags)]


def fastest_run(begin: Callable[[], Contacts], steps: int, repeats: int) -> tuple[Timing, Contacts]:
    """Run a scene several times from its start.

    Parameters
    ----------
    begin : function
        Opens LAMMPS with the scene and returns its contacts.
    steps : int
    repeats : int
        At most: a run of more than LONG seconds is not repeated.

    Returns
    -------
    dict
        ``solve_seconds``, processor time of the ``run`` command by the run where it is least, and its
        ``wall_seconds``: the same where nobody else is at work.
    Contacts
        Of the last run, LAMMPS still open.
    """
    found = []
    for number in range(1, repeats + 1):
        contacts = begin()
        started_at = time.thread_time()
        wall = contacts.run(steps)
        found.append({"solve_seconds": time.thread_time() - started_at, "wall_seconds": wall})
        if number == repeats or found[-1]["solve_seconds"] > LONG:
            break
        contacts.lmp.close()
    return min(found, key=lambda seconds: seconds["solve_seconds"]), contacts
