# SPDX-License-Identifier: GPL-2.0-or-later
"""Settled beds, kept in files from one benchmark to the next."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from box import box_walls
from saved_state import SavedState
from script import open_scene

import nscd_lmp

DT = 5e-4  # s
AT_REST = 5e-3  # m/s, root mean square: what gravity gives in a step. Beds without friction creep on for long.
MOST_STEPS = 1000

Scene = Callable[[int, float], tuple[Any, list[nscd_lmp.Plane]]]  # of grains and dt: LAMMPS and the walls


def box_width(grains: int) -> float:
    """Return the width of the box in m: 8 mm for the 500 grains of the paper, 20 mm for 10,000."""
    return 8e-3 * max(1.0, (grains / 500) ** 0.306)


def open_balls(grains: int, dt: float) -> tuple[Any, list[nscd_lmp.Plane]]:
    """Return LAMMPS with the loose grains of in.sedimentation and a step of `dt`, and the walls."""
    width = box_width(grains)
    return open_scene("in.sedimentation", n=grains, lx=width, dt=dt), box_walls(width)


def open_bed(
    grains: int,
    folder: Path,
    dt: float,
    scene: Scene = open_balls,
    name: str = "settled_bed",
    friction: float = 0.0,
) -> tuple[Any, list[nscd_lmp.Plane], SavedState]:
    """Return LAMMPS with a settled bed and a step of `dt`, its walls and its state.

    The bed is settled by ``law gap`` with warm start until the mean speed is below 5 mm/s, once: the state is
    kept in the folder, in a file of this name.
    """
    path = folder / f"{name}_{grains}.npz"
    if not path.is_file():
        settle(*scene(grains, DT), friction).save(path)
    state = SavedState.load(path)
    lmp, walls = scene(grains, dt)
    state.put_back(lmp)
    return lmp, walls, state


def settle(lmp: Any, walls: list[nscd_lmp.Plane], friction: float) -> SavedState:
    """Let the grains fall and come to rest, and close LAMMPS; returns the state."""
    attached = nscd_lmp.attach(
        lmp, law="gap", criterion="paper", tol=1e-6, maxiter=3000, walls=walls, friction=friction, unconverged="ignore"
    )
    speed = math.inf
    while speed > AT_REST and len(attached.stats) < MOST_STEPS:
        lmp.command("run 20 post no")
        state = SavedState.of(lmp)
        speed = float(np.sqrt((state.v**2).sum(axis=1).mean()))
    steps = len(attached.stats)
    print(f"settled {len(state.x)} grains in {steps} steps of {DT} s, mean speed {speed:.1e} m/s")
    lmp.close()
    return state
