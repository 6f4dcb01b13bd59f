# SPDX-License-Identifier: GPL-2.0-or-later
"""What there is to choose from, as the compiled core registers it."""

from dataclasses import dataclass

from nscd_lmp import _core


@dataclass(frozen=True)
class Solver:
    """A solver: keyword, legend title, and its parameter with default (multiple of 1/W_nn), or ``""`` for none.

    `kind` is ``"local law"`` (of nonlinear Gauss-Seidel) or ``"global"`` (all contacts at once); `friction` whether it
    takes contacts with friction.
    """

    name: str
    title: str
    kind: str
    parameter: str
    default: float
    friction: bool


@dataclass(frozen=True)
class Law:
    """A contact law of the time-stepping scheme: keyword and legend title."""

    name: str
    title: str


SOLVERS: dict[str, Solver] = {row["name"]: Solver(**row) for row in _core.solvers()}
LOCAL_LAWS: dict[str, Solver] = {name: solver for name, solver in SOLVERS.items() if solver.kind == "local law"}
FRICTIONAL_SOLVERS: dict[str, Solver] = {name: solver for name, solver in SOLVERS.items() if solver.friction}
LAWS: dict[str, Law] = {row["name"]: Law(**row) for row in _core.laws()}
