"""The Python door: nonsmooth contact dynamics on a live LAMMPS object.

Needs LAMMPS' C interface alone, so it serves any build that has ``fix external`` (all do). A step is compiled
code from end to end; Python is entered only by a Python solver.
"""

import contextlib
import ctypes
import re
import warnings
from collections.abc import Callable, Sequence
from dataclasses import astuple
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from nscd_lmp import _core, ghost_homes
from nscd_lmp.attached import Attached
from nscd_lmp.command_lines import split_commands
from nscd_lmp.contact_system import ContactSystem
from nscd_lmp.inspection import MOVERS, FixInfo, Inspection
from nscd_lmp.ranks import Ranks
from nscd_lmp.step_fix import FIX_ID, address, definition
from nscd_lmp.walls import Plane

PythonSolver = Callable[[ContactSystem], NDArray[np.float64]]

ADDRESSES = (
    "lammps_extract_atom",
    "lammps_extract_global",
    "lammps_extract_setting",
    "lammps_extract_box",
    "lammps_get_thermo",
    "lammps_get_natoms",
    "lammps_find_pair_neighlist",
    "lammps_neighlist_num_elements",
    "lammps_neighlist_element_neighbors",
    "lammps_force_timeout",
    "lammps_id_count",
    "lammps_id_name",
)
# Commands that run steps, the first directly, the others by what they contain; and those that change the list.
RUNNING = ("run", "include", "jump", "if", "next")
LIST_COMMANDS = ("pair_", "neigh", "comm_modify", "read_", "clear", "newton")
COMMAND_METHODS = ("command", "commands_list", "commands_string", "file")


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
    walls: Sequence[Plane] = (),
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
    walls : sequence of Plane
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
    for wall in walls:
        keywords += wall.keywords()
    return _Door(lmp, group, keywords, custom, door).attached


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
            raise _core.NscdError(
                f"the Python solver returned an array of shape {impulses.shape} for {len(system)} contacts:"
                f" it must be {system.start.shape}"
            )
        return impulses.reshape(-1)

    return custom


class _Door:
    """The step's fix on one LAMMPS instance, and the watch over the commands that run it."""

    def __init__(self, lmp: Any, group: str, keywords: list[str], solver: Any, door: str) -> None:
        self.define = definition(lmp, door)
        ranks = Ranks(lmp.get_mpi_comm()) if lmp.extract_setting("world_size") > 1 else None
        self.inspection = Inspection(lmp, ranks)
        self.lmp = lmp
        self.group = group
        self.remeasure = False
        self.holders_told_of: set[str] = set()
        if any(fix.id == FIX_ID for fix in self.inspection.fixes()):
            raise _core.NscdError(
                "another attach() is at work on this LAMMPS object: detach() it first, and attach to the union of"
                " the groups"
            )
        self.inspection.require_spheres()
        listed = self.inspection.listed_pairs()
        addresses = {name: ctypes.cast(getattr(lmp.lib, name), ctypes.c_void_p).value for name in ADDRESSES}
        addresses["handle"] = address(lmp.lmp)
        group_bit = self.inspection.group_bit(group)
        find_homes = ghost_homes.finder(lmp, ranks) if ranks else None
        self.fix = _core.ExternalFix(addresses, FIX_ID, group_bit, keywords, solver, ranks, find_homes)
        self.fix.set_listed_pairs(*astuple(listed))
        self.fix.set_image_cutoff(self.inspection.communication_cutoff())
        for doubt in [*filter(None, [self.fix.crowding]), *self.fix.doubts()]:
            warnings.warn(doubt, stacklevel=3)
        self.methods = {name: getattr(lmp, name) for name in COMMAND_METHODS}
        self.add_fix()
        for name in COMMAND_METHODS:
            setattr(lmp, name, self.watched(name))
        self.attached = Attached(self.fix, self.detach)
        lmp._nscd = self

    def add_fix(self) -> None:
        """Define the fix that calls the step."""
        # A dynamic group is refused by fix external; the step itself knows whom it moves.
        group = "all" if self.inspection.is_dynamic(self.group) else self.group
        self.define(self.lmp, self.methods["command"], group, self.fix)

    def watched(self, name: str) -> Callable[..., Any]:
        """Return the LAMMPS method, made to look before a run and to raise what stopped it."""
        one = self.watched_command
        watched: dict[str, Callable[[Any], Any]] = {
            "command": one,
            "commands_list": lambda commands: [one(command) for command in commands] and None,
            "commands_string": lambda text: [one(command) for command in split_commands(text)] and None,
            "file": self.watched_file,
        }
        return watched[name]

    def watched_command(self, command: str) -> Any:
        """Give LAMMPS one command."""
        word = (command.split() or [""])[0]
        self.refuse_rerun(command)
        if word in RUNNING:
            self.before_run(command)
        try:
            return self.methods["command"](command)
        finally:
            self.remeasure = self.remeasure or word.startswith(LIST_COMMANDS) or word in RUNNING[1:]
            self.after_run()

    def refuse_rerun(self, commands: str) -> None:
        """Raise for a ``rerun`` among the commands: every frame that it reads would be taken for a step, and moved."""
        named = re.search(r"^[^#]*\brerun\b", commands, re.MULTILINE)
        if named and any(fix.id == FIX_ID for fix in self.inspection.fixes()):
            raise _core.NscdError("rerun reads frames and takes no steps, so there are no contacts: detach() before it")

    def watched_file(self, path: str) -> Any:
        """Give LAMMPS a script, whose commands cannot be looked at; the step refuses a fix that comes after it."""
        with contextlib.suppress(OSError), open(path, encoding="utf-8", errors="replace") as file:
            self.refuse_rerun(file.read())
        self.before_run("file")
        try:
            return self.methods["file"](path)
        finally:
            self.remeasure = True
            self.after_run()

    def before_run(self, command: str) -> None:
        """Keep our fix the last one, so that it sees all forces; refuse integrators; look at the list again."""
        fixes = self.inspection.fixes()
        if not any(fix.id == FIX_ID for fix in fixes):
            return
        self.inspection.refuse_integrators(fixes, FIX_ID, self.group)
        self.inspection.refuse_bonding(fixes)
        self.tell_of_force_holders(fixes)
        movers = any(MOVERS.match(fix.style) for fix in fixes)
        self.fix.set_fixes(self.inspection.held_groups(fixes), movers)
        if fixes[-1].id != FIX_ID:
            if re.search(r"\bpre\s+(no|off|false)\b", command):
                raise _core.NscdError(
                    f"fix {fixes[-1].id} was defined since the last run: `run` needs its setup, leave out `pre no`"
                )
            self.methods["command"](f"unfix {FIX_ID}")
            self.add_fix()
        if self.remeasure:
            self.fix.set_listed_pairs(*astuple(self.inspection.listed_pairs()))
            self.fix.set_image_cutoff(self.inspection.communication_cutoff())
            self.remeasure = False

    def tell_of_force_holders(self, fixes: list[FixInfo]) -> None:
        """Warn, once each, of fixes that hold grains against forces alone."""
        for fix in self.inspection.force_holders(fixes, self.group):
            if fix.id in self.holders_told_of:
                continue
            self.holders_told_of.add(fix.id)
            warnings.warn(
                f"fix {fix.id} (style {fix.style}) sets forces, and impulses of contacts, which are none, move its"
                " grains all the same: to hold grains, leave them out of the group of attach(), or use fix freeze; to"
                " keep them in a plane, use dimension 2",
                stacklevel=4,
            )

    def after_run(self) -> None:
        """Raise what stopped the run; warn of what its steps may be taken for and are not."""
        remarks = self.fix.take_remarks()
        if self.fix.failed:
            self.methods["command"]("timer timeout off")
            self.fix.raise_failure()
        for remark in remarks:
            warnings.warn(remark, stacklevel=4)

    def detach(self) -> None:
        """Undo what attaching did."""
        for name in COMMAND_METHODS:
            self.lmp.__dict__.pop(name, None)
        if any(fix.id == FIX_ID for fix in self.inspection.fixes()):
            self.lmp.command(f"unfix {FIX_ID}")
        self.lmp.__dict__.pop("_nscd", None)
