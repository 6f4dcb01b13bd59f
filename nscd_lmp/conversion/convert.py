# SPDX-License-Identifier: GPL-2.0-or-later
"""The conversion of a script: pair styles, integrators, walls and the time step."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from nscd_lmp._core import NscdError
from nscd_lmp.conversion.contact_model import CLASSIC, ContactModel, classic_model, granular_model
from nscd_lmp.conversion.conversion import Conversion
from nscd_lmp.conversion.elsewhere import note_other_commands
from nscd_lmp.conversion.grains import Grains
from nscd_lmp.conversion.materials import Materials
from nscd_lmp.conversion.script import Command, commands_of, read_lines
from nscd_lmp.conversion.steps import NOT_WORTH, change_step, note_counted_steps
from nscd_lmp.conversion.variables import Variables, Word

SUFFIX = re.compile(r"/(omp|kk|kk/device|kk/host|gpu|intel|opt)$")
WALL_STYLES = {"xplane": 2, "yplane": 2, "zplane": 2, "zcylinder": 1, "region": 1}
WALL_KEYWORDS = {"wiggle": 3, "shear": 2, "contacts": 0}
ELASTIC = 0.9  # restitution of a gas


@dataclass(frozen=True)
class Known:
    """What the user says beside the script; None where the script is asked."""

    diameter: float | None = None
    density: float | None = None
    mass: float | None = None
    speed: float | None = None
    timestep: float | None = None


def convert(script: Path, variables: Mapping[str, str], known: Known) -> Conversion:
    """Return the conversion of a script.

    Parameters
    ----------
    script : Path
        A LAMMPS script with granular springs; files that it includes are not read.
    variables : mapping
        Values of variables that the script does not say, or that shall not be what it says.
    known : Known
        What else is known of the grains.

    Raises
    ------
    NscdError
        There is nothing to convert, a line cannot be understood, or a number is missing.
    OSError
        There is no such file.
    """
    lines = read_lines(script)
    values = Variables(variables)
    try:
        return _Converter(lines, values, known).conversion
    finally:
        values.close()


class _Converter:
    def __init__(self, lines: list[str], variables: Variables, known: Known) -> None:
        self.conversion = Conversion(lines)
        self.variables = variables
        self.grains = Grains(speed=known.speed)
        self.materials = Materials(self.grains, self.conversion)
        self.planar = False
        self.style = ""  # of pairs: of CLASSIC, granular, or none of ours
        self.hybrid = False
        self.pair_styles = 0
        self.model: ContactModel | None = None  # of a pair style that has one for all pairs
        self.contacts: list[tuple[Command, list[Word], ContactModel, bool]] = []
        self.integrators: list[Command] = []
        self.steps: list[tuple[Command, float | None]] = []
        commands = commands_of(lines)
        for command in commands:
            try:
                self._read(command)
            except NscdError as error:
                text = str(error)
                raise NscdError(text if text.startswith("line ") else f"line {command.first}: {text}") from None
            except (IndexError, ValueError):
                raise NscdError(f"line {command.first}: '{command.text}' lacks words, or has wrong ones") from None
        if not self.pair_styles:
            raise NscdError(
                "nothing to convert: the script has no pair_style gran/hooke, gran/hooke/history, gran/hertz/history or"
                " granular; if an included file has it, convert that one"
            )
        self._take(known)
        self._write(commands, known)

    def _read(self, command: Command) -> None:
        words = command.words
        if words[0] == "variable":
            self.variables.read(command)
            return
        self.grains.read(command, self.variables)
        if words[0] == "units":
            self.materials.units = words[1]
        elif words[0] == "dimension":
            self.planar = self.variables.expanded(words[1], command) == "2"
        elif words[0] == "pair_style":
            self._read_pair_style(command)
        elif words[0] == "pair_coeff" and self.style:
            self._read_pair_coeff(command)
        elif words[0] == "pair_coeff" and self.hybrid:
            self.conversion.leave_out(command, "a pair_coeff of pair_style hybrid")
        elif words[0] == "timestep":
            self.steps.append((command, self.variables.number(words[1])))
        elif words[0] == "fix" and len(words) > 3 and words[3].startswith("wall/gran"):
            self._read_wall(command)
        elif words[0] == "fix" and len(words) > 3 and SUFFIX.sub("", words[3]) == "nve/sphere":
            self.integrators.append(command)
        else:
            note_other_commands(command, self.conversion)

    def _read_pair_style(self, command: Command) -> None:
        words = self.variables.words(command)
        name = SUFFIX.sub("", words[1].value) if len(words) > 1 else ""
        self.style, self.model = "", None
        self.hybrid = name.startswith("hybrid") and any(word.value.startswith("gran") for word in words)
        if self.hybrid:
            self.pair_styles += 1
            reason = f"pair_style {name}: write hybrid/overlay nscd ..., and pair_coeff I J nscd friction ..., by hand"
            self.conversion.leave_out(command, reason)
            return
        if name == "granular":
            self.style = name
        elif name.removeprefix("gran/") in CLASSIC:
            self.style = name.removeprefix("gran/")
            self.model = classic_model(self.style, words[2:])
        elif name.startswith("gran/"):
            raise NscdError(
                f"pair_style {name} is not known: gran/hooke, gran/hooke/history, gran/hertz/history, granular"
            )
        else:
            return
        self.pair_styles += 1
        self.conversion.change(command, command.replaced(["pair_style", "nscd"]))

    def _read_pair_coeff(self, command: Command) -> None:
        words = self.variables.words(command)
        if len(words) < 3:
            raise NscdError("pair_coeff has two types of atoms behind it")
        self.contacts.append((command, words[:3], self.model or granular_model(words[3:]), False))

    def _read_wall(self, command: Command) -> None:
        words = self.variables.words(command)
        style = words[4].value if len(words) > 4 else ""
        if style == "granular":
            model = granular_model(words[5:])
        elif style in CLASSIC:
            model = classic_model(style, words[5:])
        else:
            raise NscdError(f"fix {words[3].value} has no model '{style}': {', '.join(CLASSIC)}, granular")
        self.contacts.append((command, words, model, True))

    def _take(self, known: Known) -> None:
        """Let what the user says of the grains hold in place of what the script says."""
        if known.diameter is not None:
            self.grains.diameters, self.grains.masses = [known.diameter], []
        if known.density is not None:
            self.grains.densities, self.grains.masses = [known.density], []
        if known.mass is not None:
            self.grains.masses = [known.mass]

    def _write(self, commands: list[Command], known: Known) -> None:
        for command, words, model, wall in self.contacts:
            try:
                material = self.materials.words(command, model, wall)
            except NscdError as error:
                raise NscdError(f"line {command.first}: {error}") from None
            new = self._wall(command, words[5 + model.used :]) if wall else [[word.raw for word in words], []]
            self.conversion.change(command, command.replaced([*new[0], *material, *new[1]]))
        for command in self.integrators:
            self._write_integrator(command)
        if len(self.integrators) > 1:
            text = "two fixes nscd: the grains of one are infinitely heavy to those of the other; take one for all"
            self.conversion.remark(self.integrators[1], text)
        if not self.integrators:
            self.conversion.remark(None, "no fix nve/sphere in the script: fix ID GROUP nscd has to take its place")
        if not self.contacts and not self.hybrid:
            self.conversion.remark(
                None, "no pair_coeff in the script: pair_style nscd needs pair_coeff I J friction MU restitution E"
            )
        self._write_step(commands, known)
        if not self.grains.gravity and self.materials.found and min(self.materials.found) >= ELASTIC:
            text = "few contacts that last (no gravity, nearly elastic): springs do that well, see docs/hard_or_soft.md"
            self.conversion.remark(None, NOT_WORTH + text)

    def _wall(self, command: Command, words: list[Word]) -> list[list[str]]:
        """Return what stands before the material of a wall and what stands behind it."""
        style = words[0].value if words else ""
        if style not in WALL_STYLES or len(words) <= WALL_STYLES[style]:
            raise NscdError(
                f"line {command.first}: '{style}' is no wall with all its numbers: {', '.join(WALL_STYLES)}"
            )
        count = 1 + WALL_STYLES[style]
        before = [*command.words[:3], "wall/nscd", *(word.raw for word in words[:count])]
        behind: list[str] = []
        rest = words[count:]
        while rest:
            key = rest[0].value
            if key == "temperature":
                self.conversion.leave_out(command, "the temperature of the wall: no heat flows through contacts")
                rest = rest[2:]
                continue
            if key not in WALL_KEYWORDS:
                raise NscdError(
                    f"line {command.first}: '{key}' is no keyword of fix wall/gran: {', '.join(WALL_KEYWORDS)}"
                )
            behind += [word.raw for word in rest[: 1 + WALL_KEYWORDS[key]]]
            rest = rest[1 + WALL_KEYWORDS[key] :]
        return [before, behind]

    def _write_integrator(self, command: Command) -> None:
        words = command.words
        new = [*words[:3], "nscd"]
        if self.planar and self.materials.friction:
            new += ["inertia", "disc" if "disc" in words[4:] else "sphere"]
        if "update" in words[4:]:
            self.conversion.leave_out(command, f"{' '.join(words[words.index('update') :])}: fix nscd turns no dipoles")
        self.conversion.change(command, command.replaced(new))

    def _write_step(self, commands: list[Command], known: Known) -> None:
        if not self.steps:
            self.conversion.remark(None, "no timestep in the script: see docs/how_large_a_step.md for one")
            return
        times = {
            command.first: change_step(command, soft, self.variables, self.grains, self.conversion, known.timestep)
            for command, soft in self.steps
        }
        note_counted_steps(commands, self.conversion, times)
