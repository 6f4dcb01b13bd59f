# SPDX-License-Identifier: GPL-2.0-or-later
"""What two surfaces do to each other where they touch."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from nscd_lmp import _core
from nscd_lmp._core import NscdError

Friction = float | Literal["stick"]


@dataclass(frozen=True, kw_only=True)
class Material:
    """What contacts of two types of atoms have of their own.

    Parameters
    ----------
    friction : float or "stick", optional
        Coulomb's coefficient. ``"stick"``: no slip while in contact.
    restitution : float, optional
        Newton's coefficient e, 0 to 1.
    e_t : float, optional
        Tangential restitution, 0 to 1; with friction only.

    None is what all contacts without their own have: `friction`, `restitution`, `e_t` of :func:`nscd_lmp.attach`. Where
    several name a pair, the last one that gives a number holds, number by number.
    """

    friction: Friction | None = None
    restitution: float | None = None
    e_t: float | None = None


def own_words(of: Any) -> list[str]:
    """Return the words of ``fix nscd`` for what a :class:`Material`, or a wall, has of its own."""
    words: list[str] = []
    for part in _core.MATERIAL_PARTS:
        value = getattr(of, part)
        if value is not None:
            words += [part, _word(part, value)]
    return words


def _word(part: str, value: Any) -> str:
    """Return a number as ``fix nscd`` reads it; words, as ``"stick"``, are the core's to judge."""
    try:
        return value if isinstance(value, str) else repr(float(value))
    except TypeError:
        raise NscdError(f"{part} = {value!r} must be a number") from None


def material_words(materials: Mapping[tuple[int, int], Material]) -> list[str]:
    """Return the words of ``fix nscd`` for materials by pair of atom types."""
    words: list[str] = []
    if not isinstance(materials, Mapping):
        raise NscdError(f"materials = {materials!r} must be a dict, {{(i, j): nscd_lmp.Material(...)}}")
    for pair, material in materials.items():
        if not (isinstance(pair, tuple) and len(pair) == 2 and isinstance(material, Material)):
            raise NscdError(
                f"materials: {pair!r}: {material!r} must be (i, j): nscd_lmp.Material(...), i and j types of atoms"
            )
        words += ["material", str(pair[0]), str(pair[1]), *own_words(material)]
    return words
