# SPDX-License-Identifier: GPL-2.0-or-later
"""What a map is."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from nscd_lmp.atlas.grid import Axis, Cell


class Map(Protocol):
    """What a module of :mod:`nscd_lmp.atlas.maps` defines.

    Attributes
    ----------
    ORDER : int
        Place in lists.
    TITLE : str
        One line.
    X, Y : Axis
    PANELS : dict of str
        Title of each panel by its name.
    SHOWN : str
        What the numbers in the cells are.
    MECHANISM : str
        Why it fails, in a sentence or two.
    REMEDY : str
        What to do.
    UNSEEN : dict of str
        By outcome, why no software could know that it is one; empty if all is told.
    """

    ORDER: int
    TITLE: str
    X: Axis
    Y: Axis
    PANELS: Mapping[str, str]
    SHOWN: str
    MECHANISM: str
    REMEDY: str
    UNSEEN: Mapping[str, str]

    def run(self, panel: str, cell: Cell) -> dict[str, Any] | None:
        """Run a cell and return its columns, ``outcome``, ``shown`` and ``told`` among them; None: no such cell."""
