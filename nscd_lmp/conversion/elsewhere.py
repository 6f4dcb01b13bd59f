# SPDX-License-Identifier: GPL-2.0-or-later
"""Other commands of granular scripts: what stays, what has no counterpart, what to look at."""

from __future__ import annotations

import re

from nscd_lmp.conversion.conversion import Conversion
from nscd_lmp.conversion.script import Command

PRESSURE = re.compile(r"\b(press|p[xyz][xyz])\b")
INSIDE = re.compile(r"pair_style\s+gran|nve/sphere|wall/gran|\bpair_coeff\s|\btimestep\s")
NO_COUNTERPART = {
    "nve": "grains without spins; fix nscd integrates all that its contacts move",
    "nve/limit": "a limit of how far grains move; hard grains do not fly off overlaps",
    "nvt/sphere": "a thermostat; fix nscd is the only integrator of its grains",
    "npt/sphere": "a thermostat and barostat; fix nscd is the only integrator of its grains",
    "nph/sphere": "a barostat; fix nscd is the only integrator of its grains, fix press/berendsen may change the box",
    "nve/asphere": "grains that are no spheres",
    "heat/flow": "heat that flows through contacts",
    "damping/cundall": "damping by the forces on a grain, of which those of contacts are none here",
}
COMPUTES = {
    "pair/local": "the rows f_ID[1] to f_ID[10] of fix nscd",
    "fabric": "the rows f_ID[1] to f_ID[10] of fix nscd",
    "stress/atom": "the rows f_ID[1] to f_ID[10] of fix nscd",
    "pressure": "it lacks the impulses of hard contacts",
    "heat/flux": "no heat flows through contacts",
}


def note_other_commands(command: Command, conversion: Conversion) -> None:
    """Note what there is to say of a command that is not of the lines that change."""
    words = command.words
    if words[0] == "include":
        conversion.remark(command, f"{words[1]} is not read: convert it too if it has contacts, walls or integrators")
    elif words[0] == "neighbor":
        conversion.remark(command, "the line may go: pair_style nscd finds a skin for the new step")
    elif words[0] == "fix" and len(words) > 3:
        _note_fix(words, command, conversion)
    elif words[0] == "compute" and len(words) > 3 and words[3] in COMPUTES:
        text = f"compute {words[3]} takes forces of the pair style, and pair_style nscd has none: {COMPUTES[words[3]]}"
        conversion.leave_out(command, text)
    elif words[0] == "compute" and words[3:4] == ["contact/atom"]:
        conversion.remark(
            command,
            "compute contact/atom counts overlaps, which hard grains hardly have; f_ID[1] of fix nscd counts contacts",
        )
    elif words[0] == "thermo_style" and PRESSURE.search(command.text):
        conversion.leave_out(command, "the pressure, which lacks the impulses of hard contacts")
    elif words[0] == "region" and {"move", "rotate"} & set(words):
        conversion.remark(command, f"region {words[1]} moves: see that fix wall/nscd follows it")
    elif words[0] in ("if", "run") and INSIDE.search(command.text):
        conversion.leave_out(command, f"what stands inside of '{words[0]} ...': convert it by hand")


def _note_fix(words: list[str], command: Command, conversion: Conversion) -> None:
    style = words[3]
    reason = NO_COUNTERPART.get(style)
    if style.startswith("rigid"):
        reason = "grains of several spheres"
    if reason:
        conversion.leave_out(command, f"fix {style}: {reason}")
    elif style == "pour" and "mol" in words:
        conversion.leave_out(command, "fix pour mol: grains of several spheres")
