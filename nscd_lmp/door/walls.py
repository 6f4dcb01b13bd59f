# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls that grains can touch."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class Plane:
    """A rigid half-space: the plane through `point`, with `normal` into the free side.

    Parameters
    ----------
    point : three floats
        Any point of the plane, in LAMMPS' length unit.
    normal : three floats
        Towards the grains; any length but zero.
    friction : float or "stick", optional
        Coulomb's coefficient of this wall; None for that of the pairs. ``"stick"``: no slip while in contact.
    """

    point: Sequence[float]
    normal: Sequence[float]
    friction: float | Literal["stick"] | None = None

    def __post_init__(self) -> None:
        for name in ("point", "normal"):
            if len(getattr(self, name)) != 3:
                raise ValueError(f"Plane: {name} = {getattr(self, name)!r} must be three numbers")

    def keywords(self) -> list[str]:
        """Return the words of ``fix nscd`` for this wall."""
        words = ["wall", "plane", *(repr(float(value)) for value in (*self.point, *self.normal))]
        if self.friction is not None:
            words += ["friction", self.friction if isinstance(self.friction, str) else repr(float(self.friction))]
        return words
