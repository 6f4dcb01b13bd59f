# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact problems without LAMMPS: what they are, their files, and what solves them."""
