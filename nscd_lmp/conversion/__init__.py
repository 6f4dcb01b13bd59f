# SPDX-License-Identifier: GPL-2.0-or-later
"""Scripts with LAMMPS' granular springs turned into scripts with hard contacts."""
