"""A settled bed of the grains of in.sedimentation, kept in a file from one benchmark to the next."""

from __future__ import annotations

import math
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


def box_width(grains: int) -> float:
    """Return the width of the box in m: 8 mm for the 500 grains of the paper, 20 mm for 10,000."""
    return 8e-3 * max(1.0, (grains / 500) ** 0.306)


def open_bed(grains: int, folder: Path, dt: float) -> tuple[Any, list[nscd_lmp.Plane], SavedState]:
    """Return LAMMPS with a settled bed and a step of `dt`, its walls and its state.

    The bed is settled by ``law gap`` with warm start until the mean speed is below 5 mm/s, once: the state is
    kept in the folder.
    """
    width = box_width(grains)
    path = folder / f"settled_bed_{grains}.npz"
    if not path.is_file():
        settle(grains, width).save(path)
    state = SavedState.load(path)
    lmp = open_scene("in.sedimentation", n=grains, lx=width, dt=dt)
    state.put_back(lmp)
    return lmp, box_walls(width), state


def settle(grains: int, width: float) -> SavedState:
    """Let the grains fall and come to rest; returns the state."""
    lmp = open_scene("in.sedimentation", n=grains, lx=width, dt=DT)
    attached = nscd_lmp.attach(lmp, law="gap", tol=1e-6, maxiter=3000, walls=box_walls(width), unconverged="ignore")
    speed = math.inf
    while speed > AT_REST and len(attached.stats) < MOST_STEPS:
        lmp.command("run 20 post no")
        state = SavedState.of(lmp)
        speed = float(np.sqrt((state.v**2).sum(axis=1).mean()))
    print(f"settled {grains} grains in {len(attached.stats)} steps of {DT} s, mean speed {speed:.1e} m/s")
    lmp.close()
    return state
