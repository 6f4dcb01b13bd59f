"""Hard grains in LAMMPS by nonsmooth contact dynamics."""
from mpi4py import MPI as _MPI  # noqa: F401
