# SPDX-License-Identifier: GPL-2.0-or-later
"""Parameters of a test that all meet by twos: a third axis takes turns where a product of three tells no more."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest


def every_two_meet(axes: dict[str, Sequence[Any]]) -> pytest.MarkDecorator:
    """Return parameters of three axes, in which every value of one meets every value of each of the others.

    An axis of several names, as "law, kind", has tuples of values: what has to meet by threes is one axis of two names.
    The two longest axes are crossed, and the values of the third take turns along both. Along each there are at least
    as many turns as values.
    """
    (names, one), (others, two), (turning, turns) = sorted(axes.items(), key=lambda axis: -len(axis[1]))
    rows = [
        (*values(names, a), *values(others, b), *values(turning, turns[(i + k) % len(turns)]))
        for i, a in enumerate(one)
        for k, b in enumerate(two)
    ]
    return pytest.mark.parametrize(f"{names}, {others}, {turning}", rows, ids=name)


def values(names: str, given: Any) -> tuple[Any, ...]:
    """Return the values of an axis of one or several names."""
    return tuple(given) if "," in names else (given,)


def name(value: Any) -> str | None:
    """Return what a value is called in the name of a test; None is for what pytest calls it."""
    called = getattr(value, "name", None)
    return called.replace(" ", "-") if isinstance(called, str) else None
