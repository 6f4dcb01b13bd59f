# SPDX-License-Identifier: GPL-2.0-or-later
"""Newton's coefficient of what LAMMPS' springs and dashpots do to two grains that meet.

The overlap d of a contact moves as m d'' = -F(d) - c(d) d', with m the effective mass. F is k d (hooke) or
k sqrt(R d) d (hertz). c is, by LAMMPS' names (GRANULAR/gran_sub_mod_damping.cpp), with a number g:

======================  =============================================
velocity                g
mass_velocity           g m; this is gran/hooke and gran/hooke/history
viscoelastic            g m sqrt(R d); this is gran/hertz/history
coeff_restitution       a(g) sqrt(m F / d)
tsuji                   a'(g) sqrt(m F / d)
======================  =============================================

Where the motion is that of a damped oscillator of ratio z (1: critical) there is a closed form. LAMMPS ends a contact
when the overlap is zero, e = exp(-pi z / sqrt(1 - z^2)), and none of ratio 1 or more ends. With limit_damping it ends
in effect when the force is zero, and does so at any ratio: e = exp(-2 a cot a), cos a = z, 0.135 at z = 1. That holds
for hertz with a dashpot of d^(1/4), the last two, too: one motion in other units (Antypov & Elliott 2011). Others are
integrated, and depend on the speed of the impact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

HERTZ = 1.5  # exponent of its force
LONGEST = 200.0  # of an integration, in times of the spring alone: what takes longer creeps, and does not bounce
BY_RATIO = ("tsuji", "coeff_restitution")


@dataclass(frozen=True)
class Spring:
    """The normal part of a contact model.

    Attributes
    ----------
    normal : str
        ``hooke`` or ``hertz``.
    stiffness : float
        k, N/m or Pa.
    damping : str
        A name of the table above, or ``none``.
    number : float
        g of that table.
    limited : bool
        Whether the contact cannot attract (``limit_damping``).
    """

    normal: str
    stiffness: float
    damping: str
    number: float
    limited: bool

    @property
    def needs_mass(self) -> bool:
        """Whether restitution depends on the grains."""
        return self.damping not in (*BY_RATIO, "none") and self.number != 0

    @property
    def needs_speed(self) -> bool:
        """Whether restitution depends on the speed of the impact."""
        linear = self.normal == "hooke" and self.damping in ("velocity", "mass_velocity")
        return self.needs_mass and not linear


def restitution(spring: Spring, mass: float = 1.0, radius: float = 1.0, speed: float = 1.0) -> float:
    """Return Newton's coefficient of an impact.

    Parameters
    ----------
    spring : Spring
        The contact.
    mass, radius : float
        Effective ones (kg, m): half of a grain's for two alike, the grain's own at a wall.
    speed : float
        Of the approach, m/s.
    """
    if spring.damping == "none" or (spring.number == 0 and spring.damping not in BY_RATIO):
        return 1.0
    if spring.stiffness <= 0:
        return 0.0
    if spring.needs_speed:
        return _integrated(spring, mass, radius, speed)
    return of_ratio(_ratio(spring, mass), spring.limited)


def of_ratio(ratio: float, limited: bool) -> float:
    """Return the restitution of a damped oscillator of this ratio (1: critical)."""
    if ratio <= 0:
        return 1.0
    if not limited:
        return math.exp(-math.pi * ratio / math.sqrt(1 - ratio**2)) if ratio < 1 else 0.0
    if abs(ratio - 1) < 1e-8:
        return math.exp(-2)
    if ratio > 1:
        return math.exp(-2 * math.acosh(ratio) * ratio / math.sqrt(ratio**2 - 1))
    return math.exp(-2 * math.acos(ratio) * ratio / math.sqrt(1 - ratio**2))


def _ratio(spring: Spring, mass: float) -> float:
    number = spring.number
    if spring.damping in BY_RATIO:
        if spring.damping == "coeff_restitution":
            if number <= 0:
                return 1.0
            return max(0.0, -math.log(number)) / math.hypot(math.pi, math.log(number))
        powers = (1.2728, -4.2783, 11.087, -22.348, 27.467, -18.022, 4.8218)  # of LAMMPS, for hertz
        fit = sum(factor * number**k for k, factor in enumerate(powers))
        return fit / (2 if spring.normal == "hooke" else math.sqrt(5))
    per_mass = number if spring.damping == "mass_velocity" else number / mass
    return per_mass / 2 * math.sqrt(mass / spring.stiffness)


def _integrated(spring: Spring, mass: float, radius: float, speed: float) -> float:
    """Return the restitution by following the overlap, in units of the spring's own depth and time."""
    from scipy.integrate import solve_ivp  # here: SciPy takes long to import, and few need this

    power = 1.0 if spring.normal == "hooke" else HERTZ
    stiffness = spring.stiffness if spring.normal == "hooke" else spring.stiffness * math.sqrt(radius)
    depth = (mass * speed**2 / stiffness) ** (1 / (power + 1))
    time = depth / speed
    per_mass = spring.number / mass if spring.damping == "velocity" else spring.number
    viscous = spring.damping == "viscoelastic"
    factor = per_mass * time * (math.sqrt(radius * depth) if viscous else 1.0)

    def force(state: Any) -> float:
        d = max(state[0], 0.0)
        push = d**power + factor * (math.sqrt(d) if viscous else 1.0) * state[1]
        return max(push, 0.0) if spring.limited else push

    def parted(_: float, state: Any) -> float:
        return float(state[0])

    parted.terminal, parted.direction = True, -1  # type: ignore[attr-defined]
    motion = solve_ivp(
        lambda _, state: [state[1], -force(state)],
        (0.0, LONGEST), [0.0, 1.0], method="LSODA", events=parted, rtol=1e-8, atol=1e-11,
    )  # fmt: skip
    return max(0.0, -float(motion.y[1, -1])) if motion.status == 1 else 0.0
