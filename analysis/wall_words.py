# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls in the words of fix wall/nscd, and of LAMMPS' regions."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from stl_file import read_stl
from wall_mesh import Mesh
from wall_outlines import Wall
from wall_shapes import Block, Plane, Sphere, Tube

Array = NDArray[np.floating[Any]]
AXES = "xyz"
_AROUND = {0: (1, 2), 1: (0, 2), 2: (0, 1)}  # what c1 and c2 of a region are


class Words:
    """The words of one wall, read from the left."""

    def __init__(self, words: Sequence[str]) -> None:
        self.kind, self.rest = words[0], list(words[1:])

    def wrong(self, what: str) -> ValueError:
        """Error that shows the form of this kind."""
        return ValueError(f"wall {self.kind}: {what}; its form is: {self.kind} {KINDS[self.kind][0]}")

    def word(self) -> str:
        """Take the next word."""
        if not self.rest:
            raise self.wrong("too few words")
        return self.rest.pop(0)

    def number(self, endless: float | None = None, none: str = "INF") -> float:
        """Take a number, or, where `endless` is one, the word for none."""
        word = self.word()
        if endless is not None and word in (none, "EDGE"):
            return endless
        try:
            value = float(word)
        except ValueError:
            value = np.nan
        if not np.isfinite(value):
            raise self.wrong(f"'{word}' is not a finite number")
        return value

    def vector(self) -> Array:
        """Take three numbers."""
        return np.array([self.number(), self.number(), self.number()])

    def direction(self) -> Array:
        """Take a vector and make it of length 1."""
        vector = self.vector()
        size = float(np.linalg.norm(vector))
        if size == 0.0:
            raise self.wrong("the direction 0 0 0 is none")
        return vector / size

    def radius(self, least: str = "positive") -> float:
        """Take a radius."""
        value = self.number()
        if value < 0.0 or (value == 0.0 and least == "positive"):
            raise self.wrong(f"the radius {value:g} must be {'> 0' if least == 'positive' else '>= 0'}")
        return value

    def span(self, none: str = "INF") -> tuple[float, float]:
        """Take a lower and a higher end."""
        low, high = self.number(-np.inf, none), self.number(np.inf, none)
        if not low < high:
            raise self.wrong(f"lo = {low:g} must be below hi = {high:g}")
        return low, high


def _read_plane(words: Words) -> list[Wall]:
    return [Plane(words.vector(), words.direction())]


def _read_slab(words: Words) -> list[Wall]:
    axis = np.eye(3)[AXES.index(words.kind[0])]
    ends = words.span("NULL")
    if not np.isfinite(ends).any():
        raise words.wrong("both sides are NULL")
    sides = zip(ends, (axis, -axis), strict=True)
    return [Plane(axis * at, normal) for at, normal in sides if np.isfinite(at)]


def _read_axis(words: Words) -> tuple[Array, Array]:
    """Take DIM c1 c2 as regions have them: a point of the axis at 0 along it, and its direction."""
    letter = words.word()
    if letter not in tuple(AXES):
        raise words.wrong(f"the axis '{letter}' must be x, y or z")
    along = AXES.index(letter)
    point = np.zeros(3)
    for c in _AROUND[along]:
        point[c] = words.number()
    return point, np.eye(3)[along]


def _read_cylinder(words: Words) -> list[Wall]:
    if words.kind != "cylinder":
        return [Tube(np.zeros(3), np.eye(3)[AXES.index(words.kind[0])], words.radius())]
    if words.rest and words.rest[0] in tuple(AXES):
        point, axis = _read_axis(words)
        radius = words.radius()
        low, high = words.span()
        return [Tube(point, axis, radius, 0.0, low, high)]
    return [Tube(words.vector(), words.direction(), words.radius())]


def _read_cone(words: Words) -> list[Wall]:
    point, axis = _read_axis(words)
    radii = words.radius("none"), words.radius("none")
    low, high = words.number(), words.number()
    if not low < high:
        raise words.wrong(f"lo = {low:g} must be below hi = {high:g}")
    if max(radii) == 0.0:
        raise words.wrong("both radii are 0")
    slope = (radii[1] - radii[0]) / (high - low)
    return [Tube(point + low * axis, axis, radii[0], slope, 0.0, high - low)]


def _read_sphere(words: Words) -> list[Wall]:
    return [Sphere(words.vector(), words.radius())]


def _read_block(words: Words) -> list[Wall]:
    return [Block(np.array([words.span() for _ in AXES]))]


def _read_mesh(words: Words) -> list[Wall]:
    return [Mesh(read_stl(words.word()))]


KINDS: dict[str, tuple[str, Callable[[Words], list[Wall]]]] = {
    "plane": ("x y z nx ny nz", _read_plane),
    **{f"{letter}plane": ("lo hi", _read_slab) for letter in AXES},
    "cylinder": ("x y z ax ay az R, or DIM c1 c2 R lo hi", _read_cylinder),
    **{f"{letter}cylinder": ("R", _read_cylinder) for letter in AXES},
    "cone": ("DIM c1 c2 radlo radhi lo hi", _read_cone),
    "sphere": ("x y z R", _read_sphere),
    "block": ("xlo xhi ylo yhi zlo zhi", _read_block),
    "mesh": ("FILE.stl", _read_mesh),
}


def read_walls(walls: Sequence[Sequence[str]]) -> list[Wall]:
    """Read walls from their words.

    Parameters
    ----------
    walls : sequence of sequence of str
        Of each wall its kind and what belongs to it, in the units of the dump.

    Raises
    ------
    ValueError
        A kind is unknown, words are missing or too many, or a number is out of its range.
    FileNotFoundError
        There is no such mesh.
    """
    found: list[Wall] = []
    for given in walls:
        if given[0] not in KINDS:
            raise ValueError(f"unknown wall '{given[0]}': choose one of {', '.join(KINDS)}")
        words = Words(given)
        found += KINDS[given[0]][1](words)
        if words.rest:
            raise words.wrong(f"'{' '.join(words.rest)}' is too much")
    return found


def add_wall_option(parser: argparse.ArgumentParser) -> None:
    """Add the repeatable ``--wall``."""
    forms = "; ".join(f"{kind} {form}" for kind, (form, _) in KINDS.items())
    parser.add_argument(
        "--wall",
        nargs="+",
        action="append",
        dest="walls",
        default=[],
        metavar="WORD",
        help=f"outline a wall, in words of fix wall/nscd or of regions, in units of the dump; repeatable: {forms}",
    )
