# SPDX-License-Identifier: GPL-2.0-or-later
"""The solver-level door: any contact problem, any solver of the registry, without LAMMPS."""

import math
import operator
import warnings
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nscd_lmp import _core
from nscd_lmp._choices import SOLVERS
from nscd_lmp.problems import checks
from nscd_lmp.problems.checks import BlockRows, Floats
from nscd_lmp.problems.contact_problem import ContactProblem

COLUMNS = ("iterations", "criterion", "motion", "bipotential", "penetration", "relative_residual")
LARGEST_TOL = 0.1  # of criterion natural, as for fix nscd
HISTORY_DTYPE = np.dtype([(name, "i8" if name == "iterations" else "f8") for name in COLUMNS])


@dataclass(frozen=True)
class Solution:
    """What a solver found.

    Attributes
    ----------
    impulse : (n,) in dim 1, else (n, dim) float, N s
        Along N, T1[, T2].
    velocity : the same shape, m/s
        W p + q, `q` included.
    iterations : int
        Sweeps, or whatever the solver counts.
    status : str
        ``"solved"``: the residual is below the tolerance. ``"accepted"``: it is not, but below 30 times the tolerance
        after `budget` sweeps. ``"stalled"``: neither, and the best impulses met are returned. ``"diverged"``: impulses
        ran away; they are of no use.
    residual : float
        What `tol` was compared with: relative (criterion ``"natural"``) or in m/s (``"paper"``).
    history : structured array
        A row for every time that the solver measured: `iterations`, `criterion` (42) in m/s with its parts `motion`,
        `bipotential` and `penetration`, `relative_residual`. Sweeping solvers measure rarely while far off.
    seconds : float
        Wall time of the solver alone.
    """

    impulse: Floats
    velocity: Floats
    iterations: int
    status: Literal["solved", "accepted", "stalled", "diverged"]
    residual: float
    history: NDArray[Any] = field(repr=False)
    seconds: float

    @property
    def converged(self) -> bool:
        """Whether the residual is below the tolerance."""
        return self.status == "solved"


def solve(
    problem: ContactProblem,
    solver: str = "auto",
    *,
    tol: float = 1e-8,
    maxiter: int = 10000,
    budget: int = 0,
    warmstart: ArrayLike | Solution | None = None,
    criterion: Literal["natural", "paper"] = "natural",
    rho: float | None = None,
    gamma: float | None = None,
    unconverged: Literal["warn", "ignore", "error"] = "warn",
) -> Solution:
    """Return the impulses and velocities that solve a contact problem.

    Parameters
    ----------
    problem : ContactProblem
    solver : str
        A name of :data:`nscd_lmp.SOLVERS`; a local law (``kind``) means nonlinear Gauss-Seidel with it.
    tol : float
        The problem is solved when the criterion is below it; in m/s with ``"paper"``.
    maxiter : int
        Iterations after which it is given up; see `unconverged`. More never leave a larger residual than fewer
        (`auto`: until it hands over, which depends on how many are left).
    budget : int
        Sweeps after which the problem is accepted with a residual below 30 times `tol` (``"natural"`` only); 0: never.
    warmstart : array_like (n,) or (n, dim), or Solution, optional
        Impulses to start from, N s. None: 0.
    criterion : str
        What `tol` is compared with. ``"natural"``: the natural map over the norm of q, without a unit, after the FCLIB
        comparisons (Acary, Bremond & Huber 2018), but in velocities: the 2-norm over all contacts of
        W_nn (p_n - max(0, p_n - u_n / W_nn)) and W_tt (p_t - proj(p_t - u_t / W_tt)), where proj goes onto the disc of
        radius mu p_n. Where a contact's own block of W is not diag(W_nn, W_tt, W_tt), W_nn and W_tt stand for a
        diagonal that is larger than the block.
        ``"paper"``: criterion (42) of Barboteu & Dumont (2017) in m/s, the mean over the contacts of motion,
        bipotential and penetration.
    rho, gamma : float, optional
        The solver's parameter as a multiple of 1/W_nn; None for its own default.
    unconverged : str
        What to do where it is neither solved nor accepted: ``"warn"``, ``"ignore"`` or ``"error"``.

    Returns
    -------
    Solution

    Raises
    ------
    NscdError
        For an unknown name, a parameter that the solver does not have, a value out of range, a start of another shape
        or not finite; with ``unconverged="error"`` where it is neither solved nor accepted.

    Warns
    -----
    UserWarning
        With ``unconverged="warn"`` where it is neither solved nor accepted.
    """
    if not isinstance(problem, ContactProblem):
        raise _core.NscdError(f"the problem is a {type(problem).__name__} and must be a ContactProblem")
    parameter = _parameter(solver, rho, gamma)
    tol, maxiter = _check(tol, maxiter, criterion, unconverged)
    budget = _check_budget(budget, criterion)
    options = {
        "solver": solver,
        "tol": tol,
        "maxiter": maxiter,
        "budget": budget,
        "criterion": criterion,
        "parameter": parameter,
    }
    found = _run(problem, _start(problem, warmstart), options)
    if found.status in ("stalled", "diverged") and unconverged != "ignore":
        unit = " m/s" if criterion == "paper" else ""
        remedy = "raise maxiter or tol, or choose another solver"
        if found.iterations < maxiter:
            remedy = (
                "it gets no further, for tol lies below round-off, the problem has no solution, or the solver does not"
                " find it: raise tol or choose another solver"
            )
        message = (
            f"solver {solver} ended after {found.iterations} iterations with the {criterion} criterion at"
            f" {found.residual:.3g}{unit}, above tol = {tol:.3g}: {remedy}"
        )
        if unconverged == "error":
            raise _core.NscdError(message)
        warnings.warn(message, stacklevel=2)
    return found


def _parameter(solver: str, rho: float | None, gamma: float | None) -> float | None:
    """Return the one of the two that was given, checked against the solver's entry in the registry."""
    if solver not in SOLVERS:
        raise _core.NscdError(f"unknown solver {solver!r}: choose one of {', '.join(SOLVERS)}")
    takes = SOLVERS[solver].parameter
    value = None
    for name, given in (("rho", rho), ("gamma", gamma)):
        if given is None:
            continue
        if name != takes:
            has = f"which takes {takes}" if takes else "which has no parameter"
            raise _core.NscdError(f"{name} is not a parameter of solver {solver}, {has}")
        if not (given > 0 and math.isfinite(given)):
            raise _core.NscdError(f"{name} = {given} must be > 0: it is a multiple of 1/W_nn, and None is a good start")
        value = float(given)
    return value


def _check_budget(budget: int, criterion: str) -> int:
    """Return `budget` as a number; refuse one that means nothing."""
    try:
        budget = operator.index(budget)
    except TypeError:
        raise _core.NscdError(f"budget = {budget!r} must be a whole number") from None
    if not 0 <= budget < 2**31:
        raise _core.NscdError(f"budget = {budget} must be at least 0, for never, and below 2^31")
    if budget > 0 and criterion != "natural":
        raise _core.NscdError("budget goes with criterion natural: criterion paper does not say how good an answer is")
    return budget


def _check(tol: float, maxiter: int, criterion: str, unconverged: str) -> tuple[float, int]:
    """Return `tol` and `maxiter` as numbers; refuse settings out of range."""
    try:
        tol, maxiter = float(tol), operator.index(maxiter)
    except (TypeError, ValueError):
        raise _core.NscdError(f"tol = {tol!r} must be a number and maxiter = {maxiter!r} a whole number") from None
    if not (tol > 0 and math.isfinite(tol)):
        raise _core.NscdError(f"tol = {tol} must be > 0: it is the value of the criterion at which a problem is solved")
    if criterion == "natural" and tol > LARGEST_TOL:
        raise _core.NscdError(
            f"tol = {tol} must be <= {LARGEST_TOL} with criterion natural: it is a share of the norm of q, and more"
            " says nothing"
        )
    if not 1 <= maxiter < 2**31:
        raise _core.NscdError(f"maxiter = {maxiter} must be at least 1 and below 2^31")
    for name, value, choices in (
        ("criterion", criterion, ("natural", "paper")),
        ("unconverged", unconverged, ("warn", "ignore", "error")),
    ):
        if value not in choices:
            raise _core.NscdError(f"unknown {name} {value!r}: choose one of {', '.join(choices)}")
    return tol, maxiter


def _start(problem: ContactProblem, warmstart: ArrayLike | Solution | None) -> Floats:
    """Return the impulses to start from, (n, dim): zeros too where nothing moves, for they are the solution."""
    shape = (len(problem), problem.dim)
    if warmstart is None:
        return np.zeros(shape)
    start = checks.floats("warmstart", warmstart.impulse if isinstance(warmstart, Solution) else warmstart)
    if start.shape not in (shape, problem.q.shape):
        raise _core.NscdError(
            f"warmstart has the shape {start.shape} and must be {problem.q.shape}, one impulse for each contact"
        )
    return start.reshape(shape) if problem.q.any() else np.zeros(shape)


def _run(problem: ContactProblem, start: Floats, options: dict[str, Any]) -> Solution:
    """Return what the compiled core makes of it. Contacts that no impulse can move are not its business."""
    n, dim = start.shape
    q = problem.q.reshape(n, dim)
    mu = np.zeros(0) if problem.mu is None else problem.mu
    impulse, velocity = np.zeros((n, dim)), q.copy()
    if problem.spheres is None:
        w = problem.blocks
        assert w is not None
        own = w.diagonal_blocks()
        start[own[:, 0, 0] == 0] = 0
        found = _core.solve_matrix(w.row_start, w.column, _with_tangents(w, own), q, mu, start, **options)
        impulse, velocity = found["impulse"], found["velocity"]
    else:
        s = problem.spheres
        moves = np.flatnonzero(s.normal_response())
        found = _core.solve_spheres(
            s.inverse_mass, s.body_i[moves], s.body_j[moves], s.normal[moves], s.tangents[moves], q[moves],
            mu[moves] if len(mu) else mu, start[moves], s.spin_response, **options,
        )  # fmt: skip
        impulse[moves], velocity[moves] = found["impulse"], found["velocity"]
    return _solution(found, impulse.reshape(problem.q.shape), velocity.reshape(problem.q.shape))


def _with_tangents(w: BlockRows, own: Floats) -> Floats:
    """Return the blocks of W, with W_nn on the diagonal where a tangent does not move, which solvers divide by.

    Such a contact has no friction, so no tangential impulse ever meets these numbers.
    """
    if own.shape[1] == 1:
        return w.block
    still = np.einsum("kii->ki", own) == 0
    still[:, 0] = False
    still &= own[:, :1, 0] > 0
    if not still.any():
        return w.block
    block, on_diagonal = w.block.copy(), np.flatnonzero(w.rows() == w.column)
    k, i = np.nonzero(still)
    place = on_diagonal[np.searchsorted(w.column[on_diagonal], k)]
    block[place, i, i] = own[k, 0, 0]
    return block


def _solution(found: dict[str, Any], impulse: Floats, velocity: Floats) -> Solution:
    """Return the core's outcome with its history as a structured array."""
    rows = np.asarray(found["history"]).reshape(-1, len(COLUMNS))
    history = np.empty(len(rows), HISTORY_DTYPE)
    for column, name in enumerate(COLUMNS):
        history[name] = rows[:, column]
    return Solution(
        impulse, velocity, found["iterations"], found["status"], found["residual"], history, found["seconds"]
    )
