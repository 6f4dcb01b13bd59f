"""The Python door: nonsmooth contact dynamics on a live LAMMPS object.

Needs LAMMPS' C interface alone, so it serves any build that has ``fix external`` (all do). A step is compiled
code from end to end; Python is entered only by a Python solver.
"""

import ctypes
import warnings
from collections.abc import Callable, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from nscd_lmp import _core
from nscd_lmp.attached import Attached
from nscd_lmp.contact_system import ContactSystem
from nscd_lmp.inspection import Inspection
from nscd_lmp.step_fix import FIX_ID, address, definition
from nscd_lmp.walls import Plane

PythonSolver = Callable[[ContactSystem], NDArray[np.float64]]

ADDRESSES = (
    "lammps_extract_atom",
    "lammps_extract_global",
    "lammps_extract_setting",
    "lammps_get_thermo",
    "lammps_get_natoms",
    "lammps_find_pair_neighlist",
    "lammps_neighlist_num_elements",
    "lammps_neighlist_element_neighbors",
    "lammps_force_timeout",
)
COMMAND_METHODS = ("command", "commands_list", "commands_string", "file")


def attach(
    lmp: Any,
    group: str = "all",
    *,
    solver: str | PythonSolver = "pdas",
    law: str = "gap",
    restitution: float = 0.0,
    tol: float = 1e-7,
    maxiter: int = 1000,
    warmstart: bool = True,
    walls: Sequence[Plane] = (),
    rho: float | None = None,
    gamma: float | None = None,
    theta: float = 0.5,
    recovery: float = 0.2,
    unconverged: Literal["ignore", "warn", "error"] = "warn",
    door: Literal["external", "invoke"] = "external",
) -> Attached:
    """Make the grains of a group rigid: the following runs of `lmp` integrate them by contact dynamics.

    Call it when atoms, pair style (``pair_style zero CUTOFF`` will do) and neighbor settings are there. Fixes
    that exert forces may come before or after.

    Parameters
    ----------
    lmp : lammps.lammps
        On one MPI rank, with ``atom_style sphere``.
    group : str
        Atoms to move; the others are obstacles of infinite mass.
    solver : str or callable
        A name of :data:`nscd_lmp.SOLVERS`, or a function that takes a :class:`ContactSystem` and returns one
        impulse (N s) per contact, a float64 array of shape (n,).
    law : str
        A name of :data:`nscd_lmp.LAWS`.
    restitution : float
        Newton's coefficient e, 0 to 1.
    tol : float
        A step is solved when the criterion (42) of Barboteu & Dumont (2017), in m/s, is below it.
    maxiter : int
        Iterations after which a step is given up; see `unconverged`.
    warmstart : bool
        Start from the impulses of the step before.
    walls : sequence of Plane
    rho, gamma : float, optional
        The solver's parameter as a multiple of 1/W_nn; None for its own default.
    theta : float
        Of ``law moreau``.
    recovery : float
        Of ``law gap``: share of an overlap given back per step.
    unconverged : str
        What to do about steps that did not reach `tol`: ``"ignore"``, ``"warn"`` at the end of a run, or
        ``"error"``.
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
        For a value out of range, an unknown name, no pair style, a second integrator, more than one rank, a
        door that the build lacks.
        From the commands that run steps: whatever stopped the run, exceptions of a Python solver included;
        the positions and velocities are then those at the end of the last good step.
    """
    keywords = _keywords(
        law=law, restitution=restitution, tol=tol, maxiter=maxiter, warmstart=warmstart, rho=rho, gamma=gamma,
        theta=theta, recovery=recovery, unconverged=unconverged,
    )  # fmt: skip
    custom = None
    if callable(solver):
        function = solver

        def custom(system: dict[str, Any]) -> NDArray[np.float64]:
            return np.ascontiguousarray(function(ContactSystem(**system)), dtype=np.float64)

    else:
        keywords += ["solver", solver]
    for wall in walls:
        keywords += wall.keywords()
    return _Door(lmp, group, keywords, custom, unconverged, door).attached


def _keywords(**values: Any) -> list[str]:
    """Return the values as words of ``fix nscd``; None is left out."""
    words: list[str] = []
    for keyword, value in values.items():
        if value is None:
            continue
        if isinstance(value, bool):
            value = "yes" if value else "no"
        words += [keyword, value if isinstance(value, str) else repr(value)]
    return words


class _Door:
    """The step's fix on one LAMMPS instance, and the watch over the commands that run it."""

    def __init__(
        self, lmp: Any, group: str, keywords: list[str], solver: Any, unconverged: str, door: str
    ) -> None:
        ranks = lmp.extract_setting("world_size")
        if ranks > 1:
            raise _core.NscdError(
                f"nscd runs on one MPI rank, this run has {ranks}: start LAMMPS on one rank"
            )
        self.define = definition(lmp, door)
        self.lmp = lmp
        self.group = group
        self.warn = unconverged == "warn"
        self.warned_steps = 0
        self.inspection = Inspection(lmp)
        pair_style = self.inspection.pair_style()
        cutoff = self.inspection.neighbor_cutoff()
        addresses = {name: ctypes.cast(getattr(lmp.lib, name), ctypes.c_void_p).value for name in ADDRESSES}
        addresses["handle"] = address(lmp.lmp)
        group_bit = self.inspection.group_bit(group)
        self.fix = _core.ExternalFix(addresses, pair_style, cutoff, group_bit, keywords, solver)
        self.methods = {name: getattr(lmp, name) for name in COMMAND_METHODS}
        self.add_fix()
        for name in COMMAND_METHODS:
            setattr(lmp, name, self.watched(name))
        self.attached = Attached(self.fix, self.detach)
        lmp._nscd = self

    def add_fix(self) -> None:
        """Define the fix that calls the step."""
        self.define(self.lmp, self.methods["command"], self.group, self.fix)

    def watched(self, name: str) -> Callable[..., Any]:
        """Return the LAMMPS method, made to raise what stopped a run inside it."""
        method = self.methods[name]

        def call(*args: Any, **kwargs: Any) -> Any:
            self.before_run(args)
            try:
                return method(*args, **kwargs)
            finally:
                self.after_run()

        return call

    def before_run(self, args: Sequence[Any]) -> None:
        """Keep our fix the last one, so that it sees all forces, and refuse other integrators."""
        if "run" not in str(args[0] if args else ""):
            return
        fixes = self.inspection.fixes()
        if not any(fix.id == FIX_ID for fix in fixes):
            return
        self.inspection.refuse_integrators(fixes, FIX_ID, self.group)
        if fixes[-1].id != FIX_ID:
            self.methods["command"](f"unfix {FIX_ID}")
            self.add_fix()

    def after_run(self) -> None:
        """Raise what stopped the run; warn about steps that did not converge."""
        if self.fix.failed:
            self.methods["command"]("timer timeout off")
            self.fix.raise_failure()
        if self.warn and self.fix.unconverged_steps != self.warned_steps:
            self.warned_steps = self.fix.unconverged_steps
            warnings.warn(
                f"{self.warned_steps} steps of the run ended above tol: raise maxiter or tol", stacklevel=3
            )

    def detach(self) -> None:
        """Undo what attaching did."""
        for name in COMMAND_METHODS:
            self.lmp.__dict__.pop(name, None)
        if any(fix.id == FIX_ID for fix in self.inspection.fixes()):
            self.lmp.command(f"unfix {FIX_ID}")
        self.lmp.__dict__.pop("_nscd", None)
