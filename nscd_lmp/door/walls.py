# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls that grains can touch: a class for each kind that the core has (core/obstacle/)."""

import os
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nscd_lmp._core import NscdError
from nscd_lmp.door.materials import Friction, own_words
from nscd_lmp.door.motion import Axis, Motion, checked_axis, number, three_numbers

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Wall(ABC):
    """What walls of all kinds have, beside their numbers.

    Parameters
    ----------
    friction, restitution, e_t : optional
        What its contacts have of their own, as in :class:`nscd_lmp.Material`.
    motion : Motion, or a sequence of them
        :class:`nscd_lmp.Wiggle`, :class:`nscd_lmp.Shear`, :class:`nscd_lmp.Rotate`, each once at most; together they
        are shift and turn of one rigid body. Times count from :func:`nscd_lmp.attach`. None: it stands.
    """

    friction: Friction | None = None
    restitution: float | None = None
    e_t: float | None = None
    motion: Motion | Sequence[Motion] = ()

    @abstractmethod
    def shape_words(self) -> list[str]:
        """Return its kind and its numbers, in the words of ``fix nscd``."""

    def half_spaces(self, up: Array) -> list[tuple[Array, Array]]:
        """Return planes that stop what falls against the unit vector `up`: of each a point (m) and a normal.

        They bound how far grains can fall; a kind that knows of none leaves that to the box.
        """
        return []

    def motions(self) -> list[Motion]:
        """Return its motions, none if it stands."""
        given = [self.motion] if isinstance(self.motion, Motion) else self.motion
        if not isinstance(given, Sequence) or not all(isinstance(one, Motion) for one in given):
            raise NscdError(
                f"{type(self).__name__}: motion = {self.motion!r} must be nscd_lmp.Wiggle, Shear or Rotate, or a list"
                " of them"
            )
        return list(given)

    def keywords(self) -> list[str]:
        """Return the words of ``fix nscd`` for this wall."""
        moves = [word for motion in self.motions() for word in motion.words()]
        return ["wall", *self.shape_words(), *own_words(self), *moves]


@dataclass(frozen=True)
class Plane(Wall):
    """A rigid half-space: the plane through `point`, with `normal` into the free side.

    Parameters
    ----------
    point : three floats
        Any point of the plane, in LAMMPS' length unit.
    normal : three floats
        Towards the grains; any length but zero.
    friction, restitution, e_t : optional
        What its contacts have of their own, as in :class:`nscd_lmp.Material`.
    motion : optional
        :class:`nscd_lmp.Wiggle`, :class:`nscd_lmp.Shear`, :class:`nscd_lmp.Rotate`, or a list of them.
    """

    point: Sequence[float]
    normal: Sequence[float]

    def __post_init__(self) -> None:
        for name in ("point", "normal"):
            three_numbers(self, name)

    def shape_words(self) -> list[str]:
        """Return ``plane`` and its six numbers."""
        return ["plane", *(repr(float(value)) for value in (*self.point, *self.normal))]

    def half_spaces(self, up: Array) -> list[tuple[Array, Array]]:
        """Return itself."""
        return [(np.array(self.point, dtype=float), np.array(self.normal, dtype=float))]


@dataclass(frozen=True)
class Planes(Wall):
    """One or two planes across an axis, with the grains between them: ``Planes("z", 0, 0.1)`` is floor and lid.

    Parameters
    ----------
    across : str
        ``"x"``, ``"y"`` or ``"z"``: the axis that the planes are normal to.
    lo, hi : float, optional
        Where on it the lower and the upper plane are, in LAMMPS' length unit; lo < hi. None: there is no such plane.
    friction, restitution, e_t : optional
        What its contacts have of their own, as in :class:`nscd_lmp.Material`.
    motion : optional
        :class:`nscd_lmp.Wiggle`, :class:`nscd_lmp.Shear`, :class:`nscd_lmp.Rotate`, or a list of them; of both planes.
    """

    across: Axis
    lo: float | None = None
    hi: float | None = None

    def __post_init__(self) -> None:
        checked_axis(self, "across")
        self.shape_words()

    def shape_words(self) -> list[str]:
        """Return ``zplane`` or its kin, and the two places."""
        sides = ["NULL" if getattr(self, side) is None else number(self, side) for side in ("lo", "hi")]
        return [f"{self.across}plane", *sides]

    def half_spaces(self, up: Array) -> list[tuple[Array, Array]]:
        """Return those that are there."""
        axis = np.eye(3)["xyz".index(self.across)]
        given = [(self.lo, 1.0), (self.hi, -1.0)]
        return [(axis * float(place), axis * sign) for place, sign in given if place is not None]


@dataclass(frozen=True)
class Cylinder(Wall):
    """The inside of a cylinder without ends: grains are within `radius` of the axis.

    Parameters
    ----------
    point : three floats
        Any point of the axis, in LAMMPS' length unit.
    axis : three floats
        Along it; any length but zero.
    radius : float
        In LAMMPS' length unit; above 0.
    friction, restitution, e_t : optional
        What its contacts have of their own, as in :class:`nscd_lmp.Material`.
    motion : optional
        :class:`nscd_lmp.Wiggle`, :class:`nscd_lmp.Shear`, :class:`nscd_lmp.Rotate`, or a list of them.
    """

    point: Sequence[float]
    axis: Sequence[float]
    radius: float

    def __post_init__(self) -> None:
        for name in ("point", "axis"):
            three_numbers(self, name)
        number(self, "radius")

    def shape_words(self) -> list[str]:
        """Return ``cylinder`` and its seven numbers."""
        return ["cylinder", *(repr(float(value)) for value in (*self.point, *self.axis)), number(self, "radius")]

    def half_spaces(self, up: Array) -> list[tuple[Array, Array]]:
        """Return the one below its lowest line; none where its axis is upright."""
        along = np.array(self.axis, dtype=float)
        size = float(along @ along)
        across = up - along * (along @ up / size) if size > 0 else np.zeros(3)
        length = float(np.linalg.norm(across))
        if length < 1e-6:
            return []
        normal = across / length
        return [(np.array(self.point, dtype=float) - float(self.radius) * normal, normal)]


@dataclass(frozen=True)
class Mesh(Wall):
    """The triangles of an STL file, binary or ASCII; both of their sides are walls.

    Parameters
    ----------
    path : str or path
        The file, in LAMMPS' length unit.
    friction, restitution, e_t : optional
        What its contacts have of their own, as in :class:`nscd_lmp.Material`.
    motion : optional
        :class:`nscd_lmp.Wiggle`, :class:`nscd_lmp.Shear`, :class:`nscd_lmp.Rotate`, or a list of them.
    """

    path: str | os.PathLike[str]

    def shape_words(self) -> list[str]:
        """Return ``mesh`` and the file."""
        try:
            return ["mesh", os.fspath(self.path)]
        except TypeError:
            raise NscdError(f"Mesh: path = {self.path!r} must be the name of an STL file") from None


def check_walls(walls: Any) -> None:
    """Refuse what is no sequence of walls; a wall is what has ``keywords()``, as :class:`Plane` does."""
    if not isinstance(walls, Sequence) or not all(callable(getattr(wall, "keywords", None)) for wall in walls):
        raise NscdError(f"walls = {walls!r} must be a list of walls, such as [nscd_lmp.Plane((0, 0, 0), (0, 0, 1))]")
