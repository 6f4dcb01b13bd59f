# SPDX-License-Identifier: GPL-2.0-or-later
"""The Python door: nonsmooth contact dynamics on a live LAMMPS object.

Needs LAMMPS' C interface alone, so it serves any build that has ``fix external`` (all do). A step is compiled
code from end to end; Python is entered only by a Python solver.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from nscd_lmp._choices import KEYWORDS
from nscd_lmp._core import NscdError
from nscd_lmp.door.attached import Attached
from nscd_lmp.door.contact_system import ContactSystem
from nscd_lmp.door.door import Door
from nscd_lmp.door.materials import Material, material_words
from nscd_lmp.door.scene import walls_of
from nscd_lmp.door.walls import Wall, check_walls

PythonSolver = Callable[[ContactSystem], NDArray[np.float64]]


def attach(
    lmp: Any,
    group: str = "all",
    *,
    solver: str | PythonSolver | None = None,
    law: str | None = None,
    restitution: float = 0.0,
    friction: float | Literal["stick"] = 0.0,
    e_t: float = 0.0,
    min_bounce: float = 0.0,
    materials: Mapping[tuple[int, int], Material] | None = None,
    walls: Sequence[Wall] | None = None,
    inertia: Literal["sphere", "disc"] | None = None,
    accuracy: Literal["loose", "normal", "tight"] | None = None,
    tol: float | None = None,
    criterion: Literal["paper", "natural"] | None = None,
    overlap: float | None = None,
    budget: int | None = None,
    maxiter: int = 1000,
    warmstart: bool | None = None,
    paper: bool = False,
    rho: float | None = None,
    gamma: float | None = None,
    theta: float = 0.5,
    recovery: float = 0.2,
    unconverged: Literal["ignore", "warn", "error"] = "warn",
    threads: int = 1,
    door: Literal["external", "invoke"] = "external",
) -> Attached:
    """Make the grains of a group rigid: the following runs of `lmp` integrate them by contact dynamics.

    Call it when atoms, pair style and neighbor settings are there. ``pair_style nscd`` has list and materials, and
    its ``pair_coeff`` may change between runs; ``pair_style zero CUTOFF`` serves in builds of LAMMPS without it. Fixes
    that exert forces may come before or after.

    Parameters
    ----------
    lmp : lammps.lammps
        With ``atom_style sphere``; on any number of MPI ranks, all of which make the same calls.
    group : str
        Atoms to move; the others are obstacles of infinite mass.
    solver : str or callable, optional
        A name of :data:`nscd_lmp.SOLVERS`, or a function that takes a :class:`ContactSystem` and returns the impulses
        (N s), a float64 array of shape (n,), with friction (n, 2) in a planar scene and (n, 3) in space. None:
        ``"auto"``.
    law : str, optional
        A name of :data:`nscd_lmp.LAWS`, the contact law. None: ``"gap"``.
    restitution : float
        Newton's coefficient e of contacts without their own; 0 to 1.
    friction : float or "stick"
        Coulomb's coefficient mu of contacts without their own, or ``"stick"``: no slip while in contact; where no
        contact has any, grains have no spins; >= 0.
    e_t : float
        Tangential restitution of contacts without their own; with friction only; 0 to 1.
    min_bounce : float
        Of law ``"gap"`` with restitution: pairs that meet slower than this velocity do not bounce. Dense beds, where
        grains meet slowly without end, are solved faster with it. A grain that drops from a height h meets with sqrt(2
        g h); >= 0.
    materials : dict, optional
        What contacts of two types of atoms have of their own: ``{(1, 2): nscd_lmp.Material(friction=0.3)}``. Of several
        that name a pair the later ones hold. With ``pair_style nscd`` give them to its ``pair_coeff``.
    walls : sequence of Wall, optional
        :class:`nscd_lmp.Plane`, :class:`nscd_lmp.Planes`, :class:`nscd_lmp.Cylinder`, and how they move from here on.
        None: those that :func:`nscd_lmp.scene` was given, else none.
    inertia : str, optional
        ``"sphere"`` (2/5 m r^2), or ``"disc"`` (1/2 m r^2) in `dimension 2`; with friction only. None: ``"sphere"``, in
        dimension 2 ``"disc"``.
    accuracy : str, optional
        ``"loose"``, ``"normal"`` or ``"tight"``: how good steps are where `tol`, `overlap` and `budget` are not given,
        with ``criterion="natural"``: 1e-2, 1e-3 and 10; 1e-3, 5e-4 and 30; 1e-4, 1e-4 and 300. ``"loose"`` is for
        grains that fall and flow, ``"tight"`` for beds that must stand still (docs/friction_accuracy.md). None:
        ``"normal"``.
    tol : float, optional
        Value of the criterion below which a step is solved: of the scene's own velocities with ``criterion="natural"``,
        in velocity units with ``criterion="paper"``; > 0. None: 1e-3; with ``criterion="paper"`` 1e-7.
    criterion : str, optional
        What `tol` is compared with. ``criterion="paper"``: (42) of Barboteu & Dumont (2017), the mean over the
        contacts, the column ``criterion``; ``criterion="natural"``: the natural map of all contacts over the norm of
        their velocities without impulses, the column ``relative_residual``. None: ``"natural"``.
    overlap : float, optional
        Of law ``"gap"``: a step is solved only when no contact is driven deeper than this share of its own smaller
        radius; 0 to 1, not 0. None: 5e-4 with ``criterion="natural"``, no such condition with ``criterion="paper"``.
    budget : int, optional
        Sweeps after which, or at `maxiter` if that is less, a step above `tol` is accepted if it is below 30 `tol` and
        within `overlap`, the column ``accepted_steps``; 0: never; >= 0. None: 30 with friction and
        ``criterion="natural"`` (below 2000 contacts more: 60,000 visits of contacts), else 0.
    maxiter : int
        Iterations of a solve after which it is given up; >= 1.
    warmstart : bool, optional
        True or False: start from the impulses of the last step. None: True.
    paper : bool
        The settings of Barboteu & Dumont (2017) for what is None here: ``pdas``, ``moreau``, ``criterion="paper"``, tol
        1e-7 m/s, no warm start.
    rho : float, optional
        Parameter of ``"sbp"``, ``"sal"``, ``"ebp"``, ``"eal"``, a multiple of 1/W_nn; > 0. None: 4/9 (``"sbp"``,
        ``"sal"``), 1 (``"ebp"``, ``"eal"``).
    gamma : float, optional
        Parameter of ``"pdas"``, a multiple of 1/W_nn and, with friction, of 1/W_tt; > 0. None: 1.
    theta : float
        Of law ``"moreau"``: contacts are sought at q + (1 - theta) dt v; 0 to 1.
    recovery : float
        Of law ``"gap"``: share of an overlap given back per step (with friction of what is beyond 3e-5 of the smaller
        radius); 0 to 1.
    unconverged : str
        ``"ignore"``, ``"warn"`` or ``"error"``: what to do about steps that are given up, say nothing, warn at the end
        of a run, or stop it.
    threads : int
        Threads of each rank that share its contacts: docs/ranks.md; 1 to 64.
    door : str
        What calls the step: ``"external"`` (LAMMPS' ``fix external``, in every build) or ``"invoke"`` (its
        ``fix python/invoke``, in builds with package PYTHON). The trajectories are equal to the last bit.

    Returns
    -------
    Attached
        Keeps the statistics; also kept alive by `lmp` itself.

    Raises
    ------
    NscdError
        For a value out of range, an unknown name, no pair style, a second integrator, a
        door that the build lacks.
        From the commands that run steps: whatever stopped the run, exceptions of a Python solver included;
        the positions and velocities are then those at the end of the last good step.
    """
    given = {name: value for name, value in locals().items() if name in KEYWORDS and not callable(value)}
    keywords = _words(given)
    custom = None
    if callable(solver):
        custom = _with_contact_system(solver)
    keywords += material_words({} if materials is None else materials)
    walls = walls_of(lmp) if walls is None else walls
    check_walls(walls)
    for wall in walls:
        keywords += wall.keywords()
    return Door(lmp, group, keywords, custom, door).attached


def _words(given: dict[str, Any]) -> list[str]:
    """Return the keywords of ``fix nscd`` with their values; None is left out, and `paper` comes first."""
    words: list[str] = []
    for keyword in sorted(given, key=lambda name: name != "paper"):
        value = given[keyword]
        if value is None:
            continue
        if isinstance(value, np.generic):
            value = value.item()
        if isinstance(value, bool):
            value = "yes" if value else "no"
        words += [keyword, value if isinstance(value, str) else repr(value)]
    return words


def _with_contact_system(solver: PythonSolver) -> Callable[[dict[str, Any]], NDArray[np.float64]]:
    """Return the solver as the core calls it: arrays in a dictionary in, impulses one after another out."""

    def custom(arrays: dict[str, Any]) -> NDArray[np.float64]:
        system = ContactSystem.of_core(arrays)
        impulses = np.ascontiguousarray(solver(system), dtype=np.float64)
        if impulses.shape != system.start.shape and (impulses.ndim, system.start.ndim) != (1, 1):
            raise NscdError(
                f"the Python solver returned an array of shape {impulses.shape} for {len(system)} contacts:"
                f" it must be {system.start.shape}"
            )
        return impulses.reshape(-1)

    return custom
