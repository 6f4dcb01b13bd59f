# SPDX-License-Identifier: GPL-2.0-or-later
"""What a conversion says: lines that change, what could not be converted, what else there is to know."""

from __future__ import annotations

from dataclasses import dataclass, field

from nscd_lmp.conversion.script import Command


@dataclass(frozen=True)
class Change:
    """Lines `first` to `last` of the script, which one line takes the place of."""

    first: int
    last: int
    new: str


@dataclass(frozen=True)
class Note:
    """What there is to say of a line."""

    line: int
    text: str


@dataclass
class Conversion:
    """The conversion of a script.

    Attributes
    ----------
    lines : list of str
        The script's.
    changes : list of Change
        In no order.
    left_out : list of Note
        What was not converted, with the reason.
    remarks : list of Note
        What else there is to know; of line 0 what is of the whole script.
    """

    lines: list[str]
    changes: list[Change] = field(default_factory=list)
    left_out: list[Note] = field(default_factory=list)
    remarks: list[Note] = field(default_factory=list)

    def change(self, command: Command, new: str) -> None:
        """Put a line in the place of a command."""
        self.changes.append(Change(command.first, command.last, new))

    def leave_out(self, command: Command, reason: str) -> None:
        """Say that something was not converted."""
        self.left_out.append(Note(command.first, reason))

    def remark(self, command: Command | None, text: str) -> None:
        """Say something of a command, or of the script; nothing is said twice."""
        note = Note(command.first if command else 0, text)
        if note not in self.remarks:
            self.remarks.append(note)

    @property
    def text(self) -> str:
        """The new script; what was not converted stands there as a comment."""
        changed = {change.first: change for change in self.changes}
        new, number = [], 1
        while number <= len(self.lines):
            new += [f"# not converted: {note.text}" for note in self.left_out if note.line == number]
            if number in changed:
                new.append(changed[number].new)
                number = changed[number].last
            else:
                new.append(self.lines[number - 1])
            number += 1
        return "\n".join(new) + "\n"

    @property
    def listing(self) -> str:
        """The changed lines with their numbers, old ones behind ``-``, new ones behind ``+``; then all notes."""
        parts = []
        for change in sorted(self.changes, key=lambda one: one.first):
            parts += [f"{k:5} - {self.lines[k - 1]}" for k in range(change.first, change.last + 1)]
            parts.append(f"{'':5} + {change.new}")
        for title, notes in (("Not converted:", self.left_out), ("To know:", self.remarks)):
            if notes:
                parts += ["", title]
                parts += [_place(note) + note.text for note in sorted(notes, key=lambda one: one.line)]
        return "\n".join(parts)


def _place(note: Note) -> str:
    return f"  line {note.line}: " if note.line else "  "
