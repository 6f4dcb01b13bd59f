# SPDX-License-Identifier: GPL-2.0-or-later
"""Random scenes on several ranks, for test_random_properties.py: ``mpiexec -n P python random_ranks.py ANSWERS``."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path

import numpy as np
import random_runs
import random_scenes
import ranks_scene
import watched_runs
from random_scenes import Push, Scene

# tight and without friction: so velocities are unique, and may be compared
SCENES = [
    Scene(n=30, seed=1, sizes=3.0, layout="touching", room="dense", speed=1.0, boundary="p p p", tight=True),
    Scene(n=40, seed=2, sizes=20.0, masses=1e3, layout="apart", room="dense", speed=1.0, boundary="f f f", tight=True),
    Scene(n=30, seed=3, layout="overlapping", room="dense", gravity=True, boundary="p p p", tilt=0.3, tight=True),
    Scene(n=20, seed=4, layout="touching", speed=1.0, law="moreau", e=0.5, boundary="f f f", obstacles=3, tight=True),
    Scene(n=20, seed=5, layout="apart", room="dense", speed=1.0, e=0.9, boundary="p f p", tight=True),
    Scene(n=16, seed=6, layout="columns", gravity=True, boundary="p p f", tight=True),
    Scene(n=16, seed=7, layout="columns", gravity=True, boundary="m m m", pushes=(Push(3, 1e3, (0, 0, -1)),)),
    Scene(n=30, seed=8, room="dense", speed=1.0, obstacles=3, move="rotate", mu=0.3, turns=True, boundary="s s s"),
]


def run(scene: Scene, door: str) -> dict[str, np.ndarray]:
    """Take the steps of a scene; every run is asked for its overlap."""
    placed = random_scenes.place(scene)
    lmp = random_scenes.build(scene, placed)
    random_runs.harden(lmp, scene, placed, door)
    lmp.commands_list(["run 1 post no"] * scene.steps)
    lmp.command("run 1 post no")
    return ranks_scene.answer(lmp)


if __name__ == "__main__":
    from mpi4py import MPI

    warnings.simplefilter("ignore", UserWarning)
    watched_runs.install()
    for number, scene in enumerate(SCENES):
        for door in ("python", "script"):
            left = run(scene, door)
            if MPI.COMM_WORLD.rank == 0:
                np.savez(Path(sys.argv[1]) / f"{number}.{door}.{MPI.COMM_WORLD.size}.npz", **left)
