# SPDX-License-Identifier: GPL-2.0-or-later
"""The time step of hard grains: what docs/how_large_a_step.md allows, not what a spring does."""

from __future__ import annotations

import math
import re

from nscd_lmp._core import NscdError
from nscd_lmp.conversion.conversion import Conversion
from nscd_lmp.conversion.grains import Grains
from nscd_lmp.conversion.script import Command
from nscd_lmp.conversion.variables import Variables

MOST = 50  # times the step of springs
UNSURE = 20  # if nothing is known of the grains
FALL = 0.05  # dt sqrt(g/d): heights and fractions to 1 %, flows to 20 %
WAY = 0.1  # dt v/d
WORTH = 5  # times; less gains little
COUNTED = {"run": 1, "thermo": 1, "dump": 4, "restart": 1}  # commands with a number of steps, and its place
NOT_WORTH = "hard contacts may not be worth it here: "
EACH_STEP = re.compile(r"(?<![\w.])(?:step|elapsed|elaplong)(?![\w.(])")


def proposed(soft: float, grains: Grains) -> tuple[float, str]:
    """Return a step for hard grains and the reason.

    Parameters
    ----------
    soft : float
        The step of the springs, s.
    grains : Grains
        What is known of the grains.
    """
    bounds = [(MOST * soft, f"{MOST} times that")]
    try:
        diameter = grains.diameter
    except NscdError:
        return _rounded(
            UNSURE * soft
        ), f"{UNSURE} times that; the size of the grains is not in the script, see that dt v << r"
    if grains.gravity:
        bounds.append((FALL * math.sqrt(diameter / grains.gravity), f"dt sqrt(g/d) of {FALL:g}"))
    if grains.speed:
        bounds.append((WAY * diameter / grains.speed, f"dt v/d of {WAY:g}"))
    if len(bounds) == 1:
        return _rounded(UNSURE * soft), f"{UNSURE} times that; no gravity in the script, see that dt v << r"
    return min((_rounded(bound), reason) for bound, reason in bounds)


def change_step(
    command: Command,
    soft: float | None,
    variables: Variables,
    grains: Grains,
    conversion: Conversion,
    wanted: float | None,
) -> float:
    """Change a step where it is defined; return the new one over the old one, 1 if it stays.

    Parameters
    ----------
    command : Command
        ``timestep``.
    soft : float, optional
        Its value, as far as it is known, s.
    wanted : float, optional
        What the user asks for, s.
    """
    raw = command.words[1]
    if soft is None or soft <= 0:
        text = f"timestep {raw}: no number above 0 before the run; docs/how_large_a_step.md has what to take"
        conversion.leave_out(command, text)
        return 1.0
    new, reason = (wanted, "as asked for") if wanted else proposed(soft, grains)
    if new == soft:
        return 1.0
    if new < soft and not wanted:
        conversion.remark(command, f"timestep {soft:g} stays: {reason} would be {new:g}")
        conversion.remark(None, NOT_WORTH + "springs have as large a step")
        return 1.0
    if new < WORTH * soft and not wanted:
        conversion.remark(None, NOT_WORTH + f"the step may grow by {new / soft:.2g} times only ({reason})")
    name = re.fullmatch(r"\$\{(\w+)\}|\$(\w)", raw)
    defined = variables.definitions.get(name[1] or name[2], []) if name else []
    if len(defined) == 1 and not variables.is_given(defined[0].words[1]):
        place, kept = defined[0], defined[0].words[:3]
    else:
        place, kept = command, ["timestep"]
    old = " ".join(place.words[len(kept) :])
    value = "" if variables.number(old) == soft and "$" not in old else f" = {soft:g}"
    conversion.change(place, place.replaced([*kept, short(new)], f"was {old}{value}: {reason}"))
    return new / soft


def note_counted_steps(commands: list[Command], conversion: Conversion, times: dict[int, float]) -> None:
    """Say what the commands that count steps are with steps that are longer.

    Parameters
    ----------
    times : dict
        How many times as long they are from a line on; the first holds before it, too.
    """
    longer = next(iter(times.values()))
    for command in commands:
        longer = times.get(command.first, longer)
        if longer == 1:
            continue
        words = command.words
        at = COUNTED.get(words[0])
        if at is not None and len(words) > at:
            if words[at].isdigit() and int(words[at]) > 1:
                count = max(1, round(int(words[at]) / longer))
                conversion.remark(command, f"{words[0]} {words[at]} counts steps: as long in time are now {count}")
            elif "$" in words[at]:
                conversion.remark(command, f"{words[0]} counts steps by {words[at]}: see that it follows the new step")
        elif words[0] == "variable" and words[2:3] == ["equal"] and _turns_by_steps(command.text):
            conversion.remark(
                command, f"variable {words[1]} changes with each step, and now {longer:.3g} times as slowly in time"
            )


def short(value: float) -> str:
    """Return the shorter of 0.0002 and 2e-4."""
    plain = f"{value:g}"
    digits, _, power = f"{value:e}".partition("e")
    scientific = f"{float(digits):g}e{int(power)}"
    return min(plain, scientific, key=len)


def _turns_by_steps(text: str) -> bool:
    """Return whether a formula counts steps and not time."""
    formula = text.split("equal", 1)[1]
    return bool(EACH_STEP.search(formula)) and not re.search(r"(?<![\w.])(v_)?dt\b|\{dt\}", formula)


def _rounded(value: float) -> float:
    """Return the largest of 1, 2 and 5 times a power of ten that is not above."""
    power = 10.0 ** math.floor(math.log10(value))
    digit = max(one for one in (0.5, 1, 2, 5) if one * power <= value * (1 + 1e-9))
    return float(f"{digit * power:.3g}")
