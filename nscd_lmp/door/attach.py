# SPDX-License-Identifier: GPL-2.0-or-later
"""The Python door: nonsmooth contact dynamics on a live LAMMPS object.

Needs LAMMPS' C interface alone, so it serves any build that has ``fix external`` (all do). A step is compiled
code from end to end; Python is entered only by a Python solver.
"""

from collections.abc import Callable, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from nscd_lmp._core import NscdError
from nscd_lmp.door.attached import Attached
from nscd_lmp.door.contact_system import ContactSystem
from nscd_lmp.door.door import Door
from nscd_lmp.door.scene import walls_of
from nscd_lmp.door.walls import Plane

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
    accuracy: Literal["loose", "normal", "tight"] | None = None,
    tol: float | None = None,
    criterion: Literal["paper", "natural"] | None = None,
    overlap: float | None = None,
    budget: int | None = None,
    maxiter: int = 1000,
    warmstart: bool | None = None,
    paper: bool = False,
    walls: Sequence[Plane] | None = None,
    rho: float | None = None,
    gamma: float | None = None,
    theta: float = 0.5,
    recovery: float = 0.2,
    inertia: Literal["sphere", "disc"] | None = None,
    unconverged: Literal["ignore", "warn", "error"] = "warn",
    threads: int = 1,
    door: Literal["external", "invoke"] = "external",
) -> Attached:
    """Make the grains of a group rigid: the following runs of `lmp` integrate them by contact dynamics.

    Call it when atoms, pair style (``pair_style zero CUTOFF`` will do) and neighbor settings are there. Fixes
    that exert forces may come before or after.

    Parameters
    ----------
    lmp : lammps.lammps
        With ``atom_style sphere``; on any number of MPI ranks, all of which make the same calls.
    group : str
        Atoms to move; the others are obstacles of infinite mass.
    solver : str or callable, optional
        None: ``"auto"``. A name of :data:`nscd_lmp.SOLVERS`, or a function that takes a :class:`ContactSystem` and
        returns the impulses (N s), a float64 array of shape (n,), with friction (n, 2) in a planar scene and (n, 3) in
        space.
    law : str, optional
        A name of :data:`nscd_lmp.LAWS`. None: ``"gap"``.
    restitution : float
        Newton's coefficient e, 0 to 1.
    friction : float or "stick"
        Coulomb's coefficient of pairs, and of walls without their own. 0: no spins, omega is left alone.
        ``"stick"``: no slip while in contact.
    e_t : float
        Tangential restitution, 0 to 1.
    accuracy : str, optional
        How good the answers are, where `tol`, `overlap` and `budget` are None, with the criterion ``"natural"``:
        ``"loose"`` is for grains that fall and flow, ``"tight"`` for beds that must stand still. None: ``"normal"``.
        What each buys: docs/friction_accuracy.md.
    tol : float, optional
        A step is solved when the criterion is below it. None: 1e-3 with ``"natural"`` (1e-2 loose, 1e-4 tight),
        1e-7 m/s with ``"paper"``.
    criterion : str, optional
        ``"natural"``: the natural map of all contacts over the norm of their velocities without impulses, as in
        :func:`nscd_lmp.solve`. ``"paper"``: (42) of Barboteu & Dumont (2017), in m/s, the mean over the contacts.
        None: ``"natural"``, also where `tol` is given; `paper` means ``"paper"``.
    overlap : float, optional
        Of ``law gap``: a step is solved only when no contact is driven deeper than this share of its own
        smaller radius.
        None: 5e-4 with the criterion ``"natural"`` (1e-3 loose, 1e-4 tight), no such condition with ``"paper"``.
    budget : int, optional
        Sweeps after which, or at `maxiter` if that is less, a step is accepted that is above `tol`, but below 30 `tol`
        and within `overlap`; the column ``accepted_steps`` counts them. 0: never. None: 30 with friction and the
        criterion ``"natural"`` (10 loose, 300 tight), and more where there are less than 2000 contacts, 2000 visits of
        contacts for each; 0 otherwise.
    maxiter : int
        Iterations after which a step is given up; see `unconverged`.
    warmstart : bool, optional
        Start from the impulses of the step before. None: True.
    paper : bool
        The settings of Barboteu & Dumont (2017) for what is None above: ``pdas``, ``moreau``, tol 1e-7 m/s, no warm
        start.
    walls : sequence of Plane, optional
        None: those that :func:`nscd_lmp.scene` was given, else none.
    rho, gamma : float, optional
        The solver's parameter as a multiple of 1/W_nn; None for its own default.
    theta : float
        Of ``law moreau``.
    recovery : float
        Of ``law gap``: share of an overlap given back per step, with friction of what is beyond 3e-5 of the smaller
        radius.
    inertia : str, optional
        Moment of inertia of a grain, ``"sphere"`` (2/5 m r^2) or ``"disc"`` (1/2 m r^2, in dimension 2). None: disc
        in dimension 2, sphere otherwise.
    unconverged : str
        What to do about steps that were given up: ``"ignore"``, ``"warn"`` at the end of a run, or
        ``"error"``.
    threads : int
        Threads that share the contacts of a rank, 1 to 64; see docs/ranks.md.
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
    keywords = _keywords(
        paper=paper or None, law=law, restitution=restitution, friction=friction, e_t=e_t or None, tol=tol,
        accuracy=accuracy, criterion=criterion, overlap=overlap, budget=budget, maxiter=maxiter, warmstart=warmstart,
        rho=rho, gamma=gamma, theta=theta, recovery=recovery, unconverged=unconverged, inertia=inertia, threads=threads,
    )  # fmt: skip
    custom = None
    if callable(solver):
        custom = _with_contact_system(solver)
    elif solver is not None:
        keywords += ["solver", solver]
    for wall in walls_of(lmp) if walls is None else walls:
        keywords += wall.keywords()
    return Door(lmp, group, keywords, custom, door).attached


def _keywords(**values: Any) -> list[str]:
    """Return the values as words of ``fix nscd``; None is left out."""
    words: list[str] = []
    for keyword, value in values.items():
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
