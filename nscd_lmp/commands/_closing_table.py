# SPDX-License-Identifier: GPL-2.0-or-later
"""The table at the end of a script."""

from rich.table import Table

from nscd_lmp.commands._progress import Counts, format_speed


def closing_table(counts: Counts, seconds: float) -> Table:
    """Return the table of what the steps of a script cost and how well they were solved.

    Parameters
    ----------
    counts : Counts
        Sums over all steps.
    seconds : float
        Wall time of the whole script.
    """
    table = Table(show_header=False)
    table.add_column(no_wrap=True)
    table.add_column(justify="right", no_wrap=True)
    if counts.steps == 0:
        table.add_row("wall time", f"{seconds:.2f} s")
        table.add_row("steps by fix nscd", "none")
        return table
    steps = counts.steps
    table.add_row("steps", f"{steps:.0f}")
    table.add_row("wall time", f"{seconds:.2f} s")
    table.add_row("speed", format_speed(steps / seconds), end_section=True)
    contacts, solver = counts.seconds_contacts, counts.seconds_solver
    for name, part in (
        ("LAMMPS", seconds - contacts - solver),
        ("contacts", contacts),
        ("solver", solver),
    ):
        table.add_row(f"time in {name}", f"{part:.2f} s  {part / seconds:5.1%}")
    table.rows[-1].end_section = True
    table.add_row("contacts in the last step", f"{counts.step_contacts:.0f}")
    table.add_row("mean iterations per step", f"{counts.iterations / steps:.1f}")
    unconverged = counts.unconverged_steps
    table.add_row("steps given up", f"{unconverged:.0f}  {unconverged / steps:5.1%}")
    if counts.accepted_steps:
        table.add_row("steps accepted at budget", f"{counts.accepted_steps:.0f}  {counts.accepted_steps / steps:5.1%}")
    table.add_row("worst overlap", f"{counts.worst_overlap:.3g} m")
    table.add_row("worst overlap / radius", f"{counts.worst_overlap_ratio:.3g}")
    table.add_row("energy dissipated by contacts", f"{counts.dissipated_energy:.4g} J")
    return table
