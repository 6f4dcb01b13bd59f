# SPDX-License-Identifier: GPL-2.0-or-later
"""What can become of a run, and the rules that decide it: the one place for both."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field

# In the order of the legend, with their colours.
OUTCOMES = {
    "converged": "#3b8f5a",
    "slow": "#b9d36c",
    "stalled": "#f2c14e",
    "diverged": "#d1495b",
    "energy grew": "#e8833a",
    "penetrated": "#6a6fc0",
    "lost atoms": "#4a4a4a",
}
GOOD = ("converged", "slow")

SLOW = 1000  # iterations of a step, the default of maxiter
BUDGET = 20000  # iterations that maps of solvers give a step
WRONG = 0.1  # of the velocity that a step without contacts would add
NO_BETTER_THAN_NOTHING = 1.0  # relative residual of impulses 0, at most
OVERLAP = 0.01  # of the smaller radius
ENERGY = 0.01  # of the energy that the scene turns over
MEANING = {
    "converged": f"every step was solved, in {SLOW} iterations (the default of maxiter) or fewer",
    "slow": f"every step was solved, one of them in more than {SLOW} iterations",
    "stalled": f"a step was not solved in {BUDGET} iterations (or `maxiter`), was refused, or is called solved and off"
    f" by more than {WRONG:.0%} of g dt",
    "diverged": "the criterion is not a number, or impulses are no better than none at all",
    "energy grew": f"energy rose by more than {ENERGY:.0%} of what the scene turns over",
    "penetrated": f"grains overlap by more than {OVERLAP:.0%} of the smaller radius, or passed through each other",
    "lost atoms": "atoms left the box, or their positions are no numbers any more",
}

LOST = re.compile(r"lost atoms|left the box|non-numeric|not a finite number|out of range", re.I)
DIVERGED = re.compile(r"diverged", re.I)
REFUSED = re.compile(r"could be missed")
OVERLAPPED = re.compile(r"overlap by|inside wall", re.I)


@dataclass
class Seen:
    """What a run has shown, measured from outside, and what the software said of it.

    Attributes
    ----------
    iterations : int
        Of the step that took most.
    unconverged : int
        Steps that the package has counted as not solved.
    residual : float
        Relative residual of the worst step.
    velocity_error : float
        Distance to the known velocities over g dt; 0 where none are known.
    overlap : float
        Largest overlap over the smaller radius, from the positions.
    overlap_left : float
        The same at the end.
    energy_rise : float
        Largest rise of the energy over the energy that the scene turns over.
    lost : bool
        Atoms are missing, or not finite.
    passed : bool
        Grains have passed through each other.
    error : str
        What stopped the run.
    warnings : list of str
    """

    iterations: int = 0
    unconverged: int = 0
    residual: float = 0.0
    velocity_error: float = 0.0
    overlap: float = 0.0
    overlap_left: float = 0.0
    energy_rise: float = 0.0
    lost: bool = False
    passed: bool = False
    error: str = ""
    warnings: list[str] = field(default_factory=list)

    @property
    def told(self) -> str:
        """What the software said: its error, else its first warning; empty if it said nothing."""
        if self.error:
            return f"error: {self.error}"
        return f"warning: {self.warnings[0]}" if self.warnings else ""


def outcome(seen: Seen) -> str:
    """Return the outcome of a run, the worst that applies; its causes are asked before its consequences."""
    if seen.lost or LOST.search(seen.error):
        return "lost atoms"
    if DIVERGED.search(seen.error) or (seen.unconverged and not seen.residual <= NO_BETTER_THAN_NOTHING):
        return "diverged"
    if seen.energy_rise > ENERGY:
        return "energy grew"
    if OVERLAPPED.search(seen.error) or seen.passed:
        return "penetrated"
    if REFUSED.search(seen.error):
        return "stalled"
    if seen.error:
        raise ValueError(f"no outcome is known for a run that ended with: {seen.error}")
    if seen.overlap > OVERLAP:
        return "penetrated"
    if seen.unconverged or seen.velocity_error > WRONG or not math.isfinite(seen.velocity_error):
        return "stalled"
    return "slow" if seen.iterations > SLOW else "converged"


def is_silent(outcome: str, told: str) -> bool:
    """Return whether something failed and the software did not say so."""
    return outcome not in GOOD and not told
