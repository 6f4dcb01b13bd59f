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


@dataclass(frozen=True)
class Keyword:
    """A keyword of ``fix nscd``: what it takes and what is said of it, as the docs have it.

    `choices` are the words that it takes, if it takes words; `value` is the default as a script gives it, or ``""``
    where that depends on others; `repeats` whether it may be given several times.
    """

    name: str
    kind: str
    choices: list[str]
    range: str
    default: str
    value: str
    repeats: bool
    doc: str


SOLVERS: dict[str, Solver] = {row["name"]: Solver(**row) for row in _core.solvers()}
LOCAL_LAWS: dict[str, Solver] = {name: solver for name, solver in SOLVERS.items() if solver.kind == "local law"}
FRICTIONAL_SOLVERS: dict[str, Solver] = {name: solver for name, solver in SOLVERS.items() if solver.friction}
KEYWORDS: dict[str, Keyword] = {row["name"]: Keyword(**row) for row in _core.keywords()}
LAWS: dict[str, Law] = {row["name"]: Law(**row) for row in _core.laws()}
