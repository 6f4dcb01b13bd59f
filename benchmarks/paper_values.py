# SPDX-License-Identifier: GPL-2.0-or-later
"""Numbers printed in the paper, to stand beside ours.

Source: M. Barboteu and S. Dumont, "A primal-dual active set method for solving multi-rigid-body dynamic
contact problems", Mathematics and Mechanics of Solids 23 (2017) 489-503, section 5. It names no processor
and no program.
"""

from typing import NamedTuple


class PaperRow(NamedTuple):
    """A method in a table: iterations per step (Table 1 alone), CPU seconds, those for the contact forces."""

    iterations: int | None
    cpu_seconds: float
    contact_seconds: float


# Table 1: one ball sliding on a plane, 2000 steps of 1e-4 s
TABLE_1 = {
    "sbp": PaperRow(18, 4.10, 0.129),
    "sal": PaperRow(17, 4.07, 0.111),
    "ebp": PaperRow(2, 4.00, 0.0840),
    "eal": PaperRow(2, 4.02, 0.095),
    "pdas": PaperRow(1, 3.91, 0.077),
}

# Table 2: sedimentation of 500 balls, 1000 steps of 5e-5 s, criterion (42) at 1e-7
TABLE_2 = {
    "sbp": PaperRow(None, 265.43, 235.4),
    "sal": PaperRow(None, 259.89, 232.79),
    "ebp": PaperRow(None, 143.68, 126.99),
    "eal": PaperRow(None, 148.49, 131.81),
    "pdas": PaperRow(None, 135.19, 120.42),
}

# Table 3: 500 balls falling on a plane inclined by 10 degrees, 10,000 steps of 1e-5 s, criterion (42) at 1e-7
TABLE_3 = {
    "sbp": PaperRow(None, 6790.0, 6724.0),
    "sal": PaperRow(None, 6704.0, 6660.0),
    "ebp": PaperRow(None, 3967.0, 3956.0),
    "eal": PaperRow(None, 3699.0, 3676.0),
    "pdas": PaperRow(None, 3058.0, 2977.0),
}
