"""Contact problems without LAMMPS: what they are, their files, and what solves them."""
