# SPDX-License-Identifier: GPL-2.0-or-later
"""What :func:`nscd_lmp.attach` returns: the statistics and contacts of a running simulation."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from nscd_lmp import _core

STATS_DTYPE = np.dtype(
    [
        ("step", "i8"),
        *((name, "f8") for name in _core.REPORT_COLUMNS),
        ("seconds_contacts", "f8"),
        ("seconds_solver", "f8"),
    ]
)


class Attached:
    """Nonsmooth contact dynamics on a LAMMPS instance; made by :func:`nscd_lmp.attach`."""

    def __init__(self, fix: _core.ExternalFix, detach: Any) -> None:
        self._fix = fix
        self._detach = detach
        self._rows = np.empty(0, STATS_DTYPE)  # with room for more behind the rows so far
        self._count = 0

    @property
    def stats(self) -> NDArray[Any]:
        """Return a structured array with a row for every step taken so far.

        Columns: `step`, the columns of ``fix nscd``'s vector (``contacts``, ``iterations``, ``criterion`` (42) and its
        parts ``motion``, ``bipotential``, ``penetration`` in m/s, ``relative_residual``, ``largest_overlap`` in m,
        ``dissipated_energy`` in J since the run began, ``largest_overlap_ratio`` over the smaller radius,
        ``unconverged_steps`` and ``energy_limited_steps`` since the run began, ``worst_residual`` of a contact over
        what it has at stake, ``accepted_steps`` since the run began), ``seconds_contacts`` and ``seconds_solver``.

        It is read-only, and keeps its rows when more steps are taken. Reading it costs what the steps since the last
        reading cost, not all of them.
        """
        new = np.frombuffer(self._fix.take_stats(), dtype=STATS_DTYPE)
        count = self._count + len(new)
        if count > len(self._rows):
            rows = np.empty(2 * count, STATS_DTYPE)
            rows[: self._count] = self._rows[: self._count]
            self._rows = rows
        self._rows[self._count : count] = new
        self._count = count
        stats = self._rows[:count]
        stats.flags.writeable = False
        return stats

    @property
    def contacts(self) -> dict[str, NDArray[np.float64]]:
        """Return the contacts of the last step as arrays of length n.

        Keys: ``tag_i``, ``tag_j`` (a wall w is -1 - w), the contact point ``x``, ``y``, ``z`` (m), the unit normal
        ``nx``, ``ny``, ``nz`` from j to i, ``gap`` (m, at the end of the step) and ``impulse`` (N s); with friction
        also ``impulse_tx``, ``impulse_ty``, ``impulse_tz``, the tangential impulse on grain i.
        """
        rows = self._fix.contact_rows()
        return {name: rows[:, column].copy() for column, name in enumerate(_core.CONTACT_COLUMNS[: rows.shape[1]])}

    def wall_forces(self) -> NDArray[np.float64]:
        """Return what each wall carried in the last step, an array of shape (walls, 7).

        The mean force of the step on the wall (3 columns, in LAMMPS' unit of force), its torque (3) about the point of
        the wall's rotation, or about the origin where it does not rotate, and the number of contacts that push. Walls
        are in the order of `walls`, grains of all ranks count, and all ranks have to make the call.
        """
        return self._fix.wall_loads()

    @property
    def traffic(self) -> dict[str, float]:
        """Return what this rank has sent to others in the steps taken so far; zeros on one rank.

        Keys: ``exchanges``, rounds of messages between neighbours, ``messages`` and ``bytes`` in them, and
        ``reductions`` over all ranks. LAMMPS' own communication is not among them.
        """
        return self._fix.traffic()

    @property
    def description(self) -> str:
        """Return one line: what was chosen for the scene."""
        return self._fix.describe()

    def detach(self) -> None:
        """Remove the fix from LAMMPS and give its methods back; the statistics stay readable."""
        self._detach()
