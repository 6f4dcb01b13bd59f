# SPDX-License-Identifier: GPL-2.0-or-later
"""The methods that charts compare: every solver under every contact law, and LAMMPS' penalty models.

A scene makes grains in a LAMMPS instance and calls :func:`start`, which gives them contacts of one kind or the other;
the returned :class:`Contacts` runs steps and says how long the ``run`` command took, in the same way for all.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from nscd_lmp import _core
from nscd_lmp._choices import LAWS, SOLVERS
from nscd_lmp._core import NscdError
from nscd_lmp.charts import penalty
from nscd_lmp.door.walls import Plane

RIGID, PENALTY = "rigid", "penalty"
FIX = "nscd"
NEVER = 10**9  # steps
FEW = 300  # grains; below, bins for neighbors cost more than looking at all pairs

Friction = float | Literal["stick"]
Case = Mapping[str, Any]


@dataclass(frozen=True)
class Method:
    """A way to treat contacts.

    `name` is the key of :data:`METHODS`, `family` rigid or penalty, `title` for legends, `friction` whether it takes
    contacts with friction; `law` and `solver` of a rigid one, `style` (granular or gran) and `model` (hooke or hertz)
    of a penalty one.
    """

    name: str
    family: str
    title: str
    friction: bool
    law: str = ""
    solver: str = ""
    style: str = ""
    model: str = ""


def _rigid_methods() -> dict[str, Method]:
    made = {}
    for law in LAWS.values():
        for solver in SOLVERS.values():
            name = f"{law.name}/{solver.name}"
            made[name] = Method(name, RIGID, f"{law.title}, {solver.title}", solver.friction, law.name, solver.name)
    return made


METHODS: dict[str, Method] = _rigid_methods() | {
    name: Method(name, PENALTY, title, True, style=style, model=model)
    for name, title, style, model in (
        ("granular/hooke", "pair granular, hooke", "granular", "hooke"),
        ("granular/hertz", "pair granular, hertz", "granular", "hertz"),
        ("gran/hooke/history", "pair gran/hooke/history", "gran", "hooke"),
    )
}


def rigid_methods(*, friction: bool = False, laws: Sequence[str] | None = None) -> list[str]:
    """Return the names of the rigid methods: of all laws or those given, and with friction only who can take it."""
    return [
        method.name
        for method in METHODS.values()
        if method.family == RIGID and (method.friction or not friction) and (laws is None or method.law in laws)
    ]


def penalty_methods() -> list[str]:
    """Return the names of the penalty methods."""
    return [method.name for method in METHODS.values() if method.family == PENALTY]


class Contacts:
    """The contacts of a scene at work."""

    def __init__(self, lmp: Any, method: Method) -> None:
        self.lmp = lmp
        self.method = method

    def run(self, steps: int) -> float:
        """Run steps; return the wall seconds of the command ``run N post no``, the only one that charts time."""
        command = f"run {steps} post no"
        started_at = time.perf_counter()
        self.lmp.command(command)
        return time.perf_counter() - started_at

    def totals(self) -> dict[str, float | None]:
        """Return totals since the start.

        Of rigid contacts ``iterations``, ``unconverged_steps``, ``worst_overlap`` (m), ``worst_overlap_ratio`` (over
        the smaller radius, of every step), ``seconds_contacts``, ``seconds_solver``, ...; None for all of these of
        penalty contacts, which LAMMPS does not count: look at positions (:class:`nscd_lmp.charts.overlap.Overlaps`).
        """
        names = [name for name in _core.TOTALS_COLUMNS if name != "steps"]
        if self.method.family == PENALTY:
            return dict.fromkeys(names)
        style, array = 0, 2
        return {
            name: self.lmp.extract_fix(FIX, style, array, 0, column)
            for column, name in enumerate(_core.TOTALS_COLUMNS)
            if name != "steps"
        }


def start(
    lmp: Any,
    method: Method | str,
    case: Case,
    walls: Sequence[Plane] = (),
    restitution: float = 0.0,
    friction: Friction = 0.0,
    *,
    e_t: float | None = None,
    speed: float = 1.0,
    skin: float | None = None,
    options: str = "",
) -> Contacts:
    """Give the grains of a scene contacts, and LAMMPS the time step ``case["dt"]``.

    Defines the pair style, the neighbor list, the integrator and the walls; gravity is the scene's. Call it when the
    grains are there, once. Rigid contacts come by ``fix nscd``: the Python door looks at the fixes before each run,
    which takes milliseconds, more than a whole run of one ball.

    Parameters
    ----------
    lmp : lammps.lammps
        With ``atom_style sphere``.
    method : Method or str
        Or its name in :data:`METHODS`.
    case : mapping
        ``dt`` (s); ``tol`` (m/s, of criterion (42)), ``overlap`` or both of a rigid method; ``stiffness`` (N/m)
        of a penalty method, for hertz that of the spring which an impact of two mean grains at `speed` compresses as
        far (:func:`penalty.hertz_stiffness`).
    walls : sequence of Plane
    restitution : float
        Newton's e, 0 to 1. Penalty contacts are damped for it, without attraction; they cannot have less than 0.13.
    friction : float or "stick"
    e_t : float, optional
        Tangential restitution of impacts that stick. None: 0 for rigid contacts, for penalty contacts the tangential
        spring and dashpot that LAMMPS takes by default.
    speed : float
        The fastest that grains get, m/s: for the neighbor cutoff of rigid contacts, and the modulus of hertz.
    skin : float, optional
        Of the neighbor list, m; None for 0.4 of the largest radius.
    options : str
        More words for ``fix nscd``, such as ``"maxiter 10000"``; penalty methods leave them.

    Returns
    -------
    Contacts
    """
    chosen = METHODS[method] if isinstance(method, str) else method
    if friction and not chosen.friction:
        raise NscdError(f"method {chosen.name} cannot take friction {friction}: leave it out of this scene")
    largest, mean_radius, mean_mass = _sizes(lmp)
    if chosen.family == RIGID:
        commands = _rigid_commands(chosen, case, walls, restitution, friction, e_t, options)
        lmp.command(f"pair_style zero {2 * largest + 2 * case['dt'] * speed!r}")
        lmp.command("pair_coeff * *")
    else:
        spring = penalty.Spring(
            chosen.style,
            chosen.model,
            case["stiffness"],
            restitution,
            e_t,
            mean_mass,
            mean_radius,
            speed,
        )
        commands = [*spring.pair(friction), "fix move all nve/sphere", *spring.walls(walls, friction)]
    lmp.command(f"neighbor {0.4 * largest if skin is None else skin!r} {'nsq' if lmp.get_natoms() < FEW else 'bin'}")
    # rigid contacts ask for a list themselves; LAMMPS, which cannot know what they need, would build it more often
    lmp.command(f"neigh_modify every 1 delay {NEVER if chosen.family == RIGID else 0} check yes")
    lmp.commands_list([*commands, f"timestep {case['dt']!r}"])
    return Contacts(lmp, chosen)


def _rigid_commands(
    method: Method,
    case: Case,
    walls: Sequence[Plane],
    restitution: float,
    friction: Friction,
    e_t: float | None,
    options: str,
) -> list[str]:
    solved = "criterion paper " * ("tol" in case)
    solved += " ".join(f"{name} {case[name]!r}" for name in ("tol", "overlap") if name in case)
    words = [f"law {method.law} solver {method.solver} restitution {restitution!r} {solved}"]
    if friction:
        words.append(f"friction {friction}")
    if e_t:
        words.append(f"e_t {e_t!r}")
    # walls come last: a `friction` right behind a wall is the wall's own
    words += ["unconverged ignore", options, *(" ".join(wall.keywords()) for wall in walls)]
    return [f"fix {FIX} all nscd {' '.join(words)}"]


def _sizes(lmp: Any) -> tuple[float, float, float]:
    """Return the largest radius, the mean radius (m) and the mean mass (kg), over all ranks."""
    here = lmp.extract_global("nlocal")
    radius, mass = (np.array(lmp.numpy.extract_atom(name)[:here], dtype=float) for name in ("radius", "rmass"))
    own = (radius.max(initial=0.0), radius.sum(), mass.sum())
    ranks = lmp.get_mpi_comm().allgather(own) if lmp.extract_setting("world_size") > 1 else [own]
    largest, radii, masses = zip(*ranks, strict=True)
    return float(max(largest)), float(sum(radii)) / lmp.get_natoms(), float(sum(masses)) / lmp.get_natoms()
