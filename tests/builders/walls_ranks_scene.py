# SPDX-License-Identifier: GPL-2.0-or-later
"""A run for test_wall_scenes.py on several ranks: ``mpiexec -n P python walls_ranks_scene.py CASE FILE``."""

from __future__ import annotations

import sys

import numpy as np
from scenes import cloud
from walled import numbers, walled

CASES = {
    "drum": [
        "fix w all wall/nscd ycylinder 0.95 rotate 4 0 0 0 0 1 0 contacts",
        "fix ends all wall/nscd yplane -0.6 0.6",
    ],
    "box": [
        "variable x equal 0.05*sin(10*step*dt)",
        "region r block -0.6 0.6 -0.6 0.6 -1 3 move v_x NULL NULL",
        "fix w all wall/nscd region r contacts",
    ],
    "region": [
        *("region c cylinder y 0 0 0.95 -0.6 0.6", "region b block -0.05 0.05 -0.6 0.6 -0.95 -0.75 side out"),
        *("region r intersect 2 c b", "fix w all wall/nscd region r friction 0.6 contacts"),
    ],
}  # fmt: skip

case, file = sys.argv[1:]
balls = cloud(60, (0.06, 0.11), 1.0)
balls.x[:, :2] -= 0.5
balls.x[:, 2] -= 0.6
hard = "fix hard all nscd friction 0.3 criterion paper tol 1e-10 maxiter 100000"
lmp = walled(balls, hard, *CASES[case], "run 60", dt=2e-3)
told = numbers(lmp, 0, 15)
rows = np.array(lmp.numpy.extract_fix("w", 1, 2))[: lmp.extract_setting("nlocal"), 1:4].sum(axis=0)
rows = lmp.get_mpi_comm().allreduce(rows)
v = np.array(lmp.gather_atoms("v", 1, 3)).reshape(-1, 3)
if lmp.extract_setting("world_rank") == 0:
    np.savez(file, v=v, told=told, rows=rows)
lmp.close()
