# SPDX-License-Identifier: GPL-2.0-or-later
"""Lists of cases: methods over time steps, tolerances and stiffnesses."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from typing import Any

from nscd_lmp.charts.penalty import contact_duration

Case = dict[str, Any]

# Time steps of penalty contacts as parts of pi sqrt(m / (2 k)); 1/10 is about what they bear.
FRACTIONS = (1 / 10, 1 / 20, 1 / 50)


def rigid_cases(methods: Iterable[str], dts: Sequence[float], tols: Sequence[float], **scene: Any) -> list[Case]:
    """Return a case for each method, time step (s) and tolerance (m/s); `scene` is in all of them."""
    product = itertools.product(methods, tols, dts)
    return [{"method": method, "tol": tol, "dt": dt, **scene} for method, tol, dt in product]


def overlap_cases(methods: Iterable[str], dts: Sequence[float], overlaps: Sequence[float], **scene: Any) -> list[Case]:
    """Return a case for each method, time step (s) and bound on what a step may drive a contact into another.

    The tolerance is the default one, unless `scene` has ``tol``.
    """
    product = itertools.product(methods, overlaps, dts)
    return [{"method": method, "overlap": overlap, "dt": dt, **scene} for method, overlap, dt in product]


def penalty_cases(
    methods: Iterable[str],
    stiffnesses: Sequence[float],
    mass: float,
    fractions: Sequence[float] = FRACTIONS,
    **scene: Any,
) -> list[Case]:
    """Return a case for each method, stiffness (N/m) and part of the contact duration of two grains of `mass` (kg).

    Give the mass of the lightest grain, whose contacts are shortest. The time step is rounded to three digits.
    """
    product = itertools.product(methods, stiffnesses, fractions)
    return [
        {
            "method": method,
            "stiffness": stiffness,
            "dt": float(f"{fraction * contact_duration(stiffness, mass):.2e}"),
            **scene,
        }
        for method, stiffness, fraction in product
    ]
