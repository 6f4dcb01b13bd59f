# SPDX-License-Identifier: GPL-2.0-or-later
"""How walls move. Times count from :func:`nscd_lmp.attach`, at which a wall is where its own numbers say."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from nscd_lmp._core import NscdError

Axis = Literal["x", "y", "z"]


class Motion(ABC):
    """One of the ways in which a wall moves; a wall may have one of each kind."""

    @abstractmethod
    def words(self) -> list[str]:
        """Return the words of ``fix wall/nscd`` for it."""

    @abstractmethod
    def fastest(self, x: NDArray[np.float64]) -> float:
        """Return the speed (m/s) of the wall's surface that places x (n, 3) meet at most."""


@dataclass(frozen=True)
class Wiggle(Motion):
    """The wall swings along an axis, by amplitude (1 - cos(2 pi t / period)): it is at rest at t = 0.

    Parameters
    ----------
    along : str
        ``"x"``, ``"y"`` or ``"z"``.
    amplitude : float, m
        Half of the way between the two turning points. Where it is above 0, the wall sets out towards larger
        coordinates.
    period : float, s
        Above 0.
    """

    along: Axis
    amplitude: float
    period: float

    def __post_init__(self) -> None:
        checked_period(self)
        number(self, "amplitude")

    def words(self) -> list[str]:
        """Return the words of ``fix wall/nscd``."""
        return ["wiggle", checked_axis(self), number(self, "amplitude"), number(self, "period")]

    def fastest(self, x: NDArray[np.float64]) -> float:
        """Return the speed (m/s) half-way."""
        return 2 * math.pi * abs(self.amplitude / self.period)


@dataclass(frozen=True)
class Shear(Motion):
    """The wall's surface runs along an axis as a belt does, and the wall stays where it is.

    Parameters
    ----------
    along : str
        ``"x"``, ``"y"`` or ``"z"``. What of it points into the wall has no effect.
    speed : float, m/s
        Below 0: towards smaller coordinates.
    """

    along: Axis
    speed: float

    def __post_init__(self) -> None:
        number(self, "speed")

    def words(self) -> list[str]:
        """Return the words of ``fix wall/nscd``."""
        return ["shear", checked_axis(self), number(self, "speed")]

    def fastest(self, x: NDArray[np.float64]) -> float:
        """Return the speed (m/s)."""
        return abs(self.speed)


@dataclass(frozen=True)
class Rotate(Motion):
    """The wall turns about an axis, by the right hand.

    Parameters
    ----------
    period : float, s
        Of one turn; above 0.
    point : three floats, m
        On the axis.
    axis : three floats
        Along it; any length but zero. The opposite vector turns the other way.
    """

    period: float
    point: Sequence[float]
    axis: Sequence[float]

    def __post_init__(self) -> None:
        for name in ("point", "axis"):
            three_numbers(self, name)
        checked_period(self)
        if not np.linalg.norm(np.array(self.axis, dtype=float)) > 0:
            raise NscdError(f"Rotate: axis = {self.axis!r} must be a vector other than (0, 0, 0)")

    def words(self) -> list[str]:
        """Return the words of ``fix wall/nscd``."""
        return ["rotate", number(self, "period"), *(repr(float(value)) for value in (*self.point, *self.axis))]

    def fastest(self, x: NDArray[np.float64]) -> float:
        """Return the speed (m/s) of what turns at the place farthest from the axis."""
        along = np.array(self.axis, dtype=float)
        arm = np.cross(x - np.array(self.point, dtype=float), along / np.linalg.norm(along))
        return 2 * math.pi / self.period * float(np.linalg.norm(arm, axis=1).max())


def checked_axis(of: Any, name: str = "along") -> str:
    """Return the axis that a wall or a motion names."""
    given = getattr(of, name)
    if given not in get_args(Axis):
        raise NscdError(f"{type(of).__name__}: {name} = {given!r} must be 'x', 'y' or 'z'")
    return str(given)


def number(of: Any, name: str) -> str:
    """Return a number that a wall or a motion has, as the core reads it."""
    given = getattr(of, name)
    try:
        return repr(float(given))
    except (TypeError, ValueError):
        raise NscdError(f"{type(of).__name__}: {name} = {given!r} must be a number") from None


def checked_period(of: Any) -> None:
    """Refuse a period that is none."""
    if not (math.isfinite(float(number(of, "period"))) and of.period > 0):
        raise NscdError(f"{type(of).__name__}: period = {of.period!r} s must be a finite number above 0")


def three_numbers(of: Any, name: str) -> None:
    """Refuse what is no vector."""
    given = getattr(of, name)
    try:
        fits = np.array(given, dtype=float).shape == (3,)
    except (TypeError, ValueError):
        fits = False
    if not fits:
        raise NscdError(f"{type(of).__name__}: {name} = {given!r} must be three numbers")
