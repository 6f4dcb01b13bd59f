# SPDX-License-Identifier: GPL-2.0-or-later
"""The two parameters of a map, and the cells that they make."""

from __future__ import annotations

import enum
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

Cell = dict[str, Any]
Value = float | str


class Size(enum.Enum):
    """How much of a map is made: a handful of its cells in seconds, or all of them."""

    QUICK = "quick"
    FULL = "full"


@dataclass(frozen=True)
class Axis:
    """A parameter of a map.

    Parameters
    ----------
    name : str
        Its column of the table.
    label : str
        With unit, for the picture.
    values : sequence of float or str
        In the order of the picture, from the left or from below.
    quick : sequence of float or str
        Some of them, for :attr:`Size.QUICK`.
    """

    name: str
    label: str
    values: Sequence[Value]
    quick: Sequence[Value]

    def of(self, size: Size) -> list[Value]:
        """Return the values of this size."""
        return list(self.values if size is Size.FULL else self.quick)


def cells_of(x: Axis, y: Axis, size: Size) -> list[Cell]:
    """Return the cells of a panel, row by row from below."""
    return [{x.name: a, y.name: b} for b in y.of(size) for a in x.of(size)]
