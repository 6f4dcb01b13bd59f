# SPDX-License-Identifier: GPL-2.0-or-later
"""LAMMPS' penalty contacts: springs and dashpots for a wanted restitution, and the time step that they allow.

A linear spring k and dashpot on two grains of effective mass m move as a damped oscillator of frequency w = sqrt(k/m)
and damping ratio z. Contacts do not attract (``limit_damping``), so they end when the force is zero, after the time
2 a / (w sin a) with cos a = z, and the restitution is e = exp(-2 a cot a): 1 without damping, exp(-2) = 0.135 if
critical, which is the least one can have here. Less would take ever more damping, and ever smaller time steps.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, Literal

import numpy as np

from nscd_lmp._core import NscdError
from nscd_lmp.door.walls import Plane

Friction = float | Literal["stick"]

HISTORY_TANGENT = 2 / 7  # LAMMPS' default of kt/kn
STICK = 1e4  # coefficient of friction that no contact exceeds
NO_RESTITUTION = 1e-300  # LAMMPS takes the logarithm of it
HERTZ = 1.5  # exponent of its force


def contact_duration(stiffness: float, mass: float) -> float:
    """Return pi sqrt(m / (2 k)) (s), how long two grains of a mass (kg) touch on a spring k (N/m) without damping."""
    return math.pi * math.sqrt(mass / (2 * stiffness))


def hertz_stiffness(stiffness: float, mass: float, radius: float, speed: float) -> float:
    """Return kn (Pa) of ``hertz`` that an impact compresses as far as a linear spring.

    Parameters
    ----------
    stiffness : float
        Of the linear spring, N/m.
    mass, radius : float
        Of the two grains, kg and m.
    speed : float
        Of the impact, m/s.

    Returns
    -------
    float
        kn of F = kn sqrt(R) d^(3/2), R = radius / 2: 2/5 kn sqrt(R) d^(5/2) = 1/2 k d^2 with d = speed sqrt(m / (2 k)).
    """
    deepest = speed * math.sqrt(mass / (2 * stiffness))
    return 1.25 * stiffness / math.sqrt(radius / 2 * deepest)


@cache
def angle_of(restitution: float) -> float:
    """Return the angle a whose cosine is the damping ratio of a linear contact: e = exp(-2 a cot a), a in (0, pi/2]."""
    if restitution >= 1:
        return math.pi / 2
    if restitution <= math.exp(-2):
        return 0.0

    low, high = 1e-6, math.pi / 2
    for _ in range(60):
        a = (low + high) / 2
        low, high = (low, a) if math.exp(-2 * a / math.tan(a)) > restitution else (a, high)
    return (low + high) / 2


def damping_ratio(restitution: float) -> float:
    """Return the damping ratio (1: critical) of a linear contact without attraction that has this restitution."""
    return math.cos(angle_of(restitution))


def attractive_restitution(restitution: float) -> float:
    """Return what ``damping coeff_restitution`` has to be told for a restitution of contacts without attraction.

    LAMMPS' formula holds for contacts that may attract, e' = exp(-pi cot a). It is the same for hertz, whose dashpot
    goes with d^(1/4): the impacts of both are one motion (Antypov & Elliott 2011).
    """
    if restitution >= 1:
        return 1.0
    a = angle_of(restitution)
    return max(math.exp(-math.pi / math.tan(a)), NO_RESTITUTION) if a else NO_RESTITUTION


@cache
def tangent_ratio(restitution: float, e_t: float, model: str) -> float:
    """Return the tangential over the normal stiffness of contacts that reverse e_t of the slip if they stick.

    An impact is half a period or less of the tangential spring, whose mass is 2/7 of the grain's: it has to last
    arccos(-e_t) / w_t.
    """
    if model == "hooke":
        a = angle_of(restitution)
        lasts = 2 * a / math.sin(a) if a else 2.0  # in units of 1/w
        return HISTORY_TANGENT * (math.acos(-e_t) / lasts) ** 2
    from scipy.optimize import brentq, minimize_scalar  # here: SciPy takes long to import, and few need this

    b = damping_ratio(restitution)
    # the slip falls to its least, about -1 without damping, and rises again
    least = minimize_scalar(lambda ratio: _hertz_impact(b, ratio)[1], bounds=(0.0, 0.6), method="bounded")
    if least.fun + e_t >= 0:
        return float(least.x)
    return float(brentq(lambda ratio: _hertz_impact(b, ratio)[1] + e_t, 0.0, least.x, xtol=1e-8))


def _hertz_impact(b: float, ratio: float) -> tuple[float, float]:
    """Return restitution and slip after / before a Hertzian contact that ends when its force does.

    d'' = -d^(3/2) - sqrt(5) b d^(1/4) d' along the normal, and along the wall a force that changes by -kt d^(1/2) s for
    a slip s, as mindlin/force has it.
    """

    from scipy.integrate import solve_ivp

    def motion(_: float, state: Any) -> list[float]:
        depth, speed, force, slip = state
        depth = max(depth, 0.0)
        push = depth**HERTZ + math.sqrt(5) * b * depth**0.25 * speed
        return [speed, -push, -HERTZ * ratio / HISTORY_TANGENT * math.sqrt(depth) * slip, force]

    def force_ends(_: float, state: Any) -> float:
        # over depth^(1/4): this ends at depth 0 too, and is not zero at the start
        return max(state[0], 0.0) ** 1.25 + math.sqrt(5) * b * state[1]

    def parted(_: float, state: Any) -> float:
        return float(state[0])

    for event in (force_ends, parted):
        event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
    found = solve_ivp(motion, (0, 20), [1e-12, 1.0, 0.0, 1.0], events=(force_ends, parted), rtol=1e-9, atol=1e-12)
    return float(-found.y[1, -1]), float(found.y[3, -1])


@dataclass(frozen=True)
class Spring:
    """The commands for penalty contacts of a model.

    `style` is granular or gran (gran/hooke/history), `model` hooke or hertz; `stiffness` in N/m; `mass` (kg) and
    `radius` (m) are the means of the grains, `speed` (m/s) that of the impact by which hertz compares with hooke.
    """

    style: str
    model: str
    stiffness: float
    restitution: float
    e_t: float | None
    mass: float
    radius: float
    speed: float

    def pair(self, friction: Friction) -> list[str]:
        """Return the commands of the pair style."""
        if self.style == "granular":
            return ["pair_style granular", f"pair_coeff * * {self._granular(friction)}"]
        return [f"pair_style gran/hooke/history {self._gran(friction)}", "pair_coeff * *"]

    def walls(self, walls: Sequence[Plane], friction: Friction) -> list[str]:
        """Return the commands of the walls, as few fixes as LAMMPS can do them with."""
        commands: list[str] = []
        by_material: dict[tuple[Friction, Spring], list[Plane]] = {}
        for wall in walls:
            own = {name: getattr(wall, name) for name in ("restitution", "e_t") if getattr(wall, name) is not None}
            mu = friction if wall.friction is None else wall.friction
            by_material.setdefault((mu, replace(self, **own)), []).append(wall)
        for number, ((mu, spring), planes) in enumerate(by_material.items()):
            # also for gran/hooke/history: the friction of fix wall/gran hooke/history is wrong in LAMMPS of July 2025,
            # with little damping there is next to none (corrected by its pull request 5007)
            words = f"granular {spring._granular(mu)}"
            commands += _wall_fixes(f"wall{number}", words, planes)
        return commands

    def _granular(self, friction: Friction) -> str:
        """Return the words of pair_coeff, which are also those of fix wall/gran."""
        normal = self.stiffness
        if self.model == "hertz":
            normal = hertz_stiffness(self.stiffness, self.mass, self.radius, self.speed)
        told = attractive_restitution(self.restitution)
        # not mindlin, whose friction can push forwards where damping is strong
        style = "mindlin/force" if self.model == "hertz" else "linear_history"
        tangent = normal * self._tangent() * (HERTZ if self.model == "hertz" else 1.0)
        damping = 1 if self.e_t is None else 0
        tangential = f"{style} {tangent!r} {damping} {_number(friction)!r}" if friction else "linear_nohistory 0 0"
        return f"{self.model} {normal!r} {told!r} tangential {tangential} damping coeff_restitution limit_damping"

    def _gran(self, friction: Friction) -> str:
        """Return the words of gran/hooke/history, for two grains of mean mass."""
        damping = 2 * damping_ratio(self.restitution) * math.sqrt(2 * self.stiffness / self.mass)
        tangential = "NULL" if self.e_t is None else "0"
        mu = _number(friction)
        words = f"{self.stiffness!r} {self.stiffness * self._tangent()!r} {damping!r} {tangential}"
        return f"{words} {mu!r} {1 if mu else 0} limit_damping"

    def _tangent(self) -> float:
        """Return the tangential over the normal stiffness."""
        return HISTORY_TANGENT if self.e_t is None else tangent_ratio(self.restitution, self.e_t, self.model)


def _number(friction: Friction) -> float:
    return STICK if isinstance(friction, str) else float(friction)


def _wall_fixes(name: str, words: str, planes: Sequence[Plane]) -> list[str]:
    """Return one fix for one plane or for the sides of a block, a fix each for others."""
    sides = [_side(plane) for plane in planes]
    axes = {side[0] for side in sides if side}
    if any(side is None for side in sides) or len({side[:2] for side in sides if side}) < len(sides):
        commands = []
        for number, plane in enumerate(planes):
            place = " ".join(repr(float(value)) for value in (*plane.point, *plane.normal))
            commands += [
                f"region {name}_{number} plane {place} units box",
                f"fix {name}_{number} all wall/gran/region {words} region {name}_{number}",
            ]
        return commands
    at = {side[:2]: side[2] for side in sides if side}
    if len(axes) == 1:
        axis = axes.pop()
        low, high = (repr(at[axis, end]) if (axis, end) in at else "NULL" for end in (0, 1))
        return [f"fix {name} all wall/gran {words} {'xyz'[axis]}plane {low} {high}"]
    # a block whose other faces are open: the same forces as one fix an axis, in less time
    bounds = " ".join(repr(at[axis, end]) if (axis, end) in at else "INF" for axis in range(3) for end in (0, 1))
    still_open = " ".join(f"open {2 * axis + end + 1}" for axis in range(3) for end in (0, 1) if (axis, end) not in at)
    return [
        f"region {name} block {bounds} {still_open} units box",
        f"fix {name} all wall/gran/region {words} region {name}",
    ]


def _side(plane: Plane) -> tuple[int, int, float] | None:
    """Return axis, end (0 low, 1 high) and place of a plane across an axis; None for another."""
    normal = np.array(plane.normal, dtype=float)
    if not normal.any():
        raise NscdError(f"a wall's normal {plane.normal!r} must not be 0")
    along = np.flatnonzero(normal)
    if len(along) > 1:
        return None
    axis = int(along[0])
    return axis, int(normal[axis] < 0), float(plane.point[axis])
