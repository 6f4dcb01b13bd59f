# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls that grains can touch."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from nscd_lmp._core import NscdError
from nscd_lmp.door.materials import Friction, own_words


@dataclass(frozen=True)
class Plane:
    """A rigid half-space: the plane through `point`, with `normal` into the free side.

    Parameters
    ----------
    point : three floats
        Any point of the plane, in LAMMPS' length unit.
    normal : three floats
        Towards the grains; any length but zero.
    friction, restitution, e_t : optional
        What its contacts have of their own, as in :class:`nscd_lmp.Material`.
    """

    point: Sequence[float]
    normal: Sequence[float]
    friction: Friction | None = None
    restitution: float | None = None
    e_t: float | None = None

    def __post_init__(self) -> None:
        for name in ("point", "normal"):
            given = getattr(self, name)
            try:
                fits = np.array(given, dtype=float).shape == (3,)
            except (TypeError, ValueError):
                fits = False
            if not fits:
                raise NscdError(f"Plane: {name} = {given!r} must be three numbers")

    def keywords(self) -> list[str]:
        """Return the words of ``fix nscd`` for this wall."""
        words = ["wall", "plane", *(repr(float(value)) for value in (*self.point, *self.normal))]
        return words + own_words(self)


def check_walls(walls: Any) -> None:
    """Refuse what is no sequence of walls; a wall is what has ``keywords()``, as :class:`Plane` does."""
    if not isinstance(walls, Sequence) or not all(callable(getattr(wall, "keywords", None)) for wall in walls):
        raise NscdError(f"walls = {walls!r} must be a list of walls, such as [nscd_lmp.Plane((0, 0, 0), (0, 0, 1))]")
