# SPDX-License-Identifier: GPL-2.0-or-later
"""A LAMMPS script as commands that know their lines."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

WORD = re.compile(r'"""(.*?)"""|"([^"]*)"|\'([^\']*)\'|(\S+)', re.S)
QUOTED = re.compile(r'"""|"|\'')


@dataclass(frozen=True)
class Command:
    """A command of a script.

    Attributes
    ----------
    first, last : int
        Lines of the file, counted from 1, that it stands in.
    text : str
        The command without ``&`` and without comment.
    comment : str
        From ``#`` on, ``""`` if there is none.
    """

    first: int
    last: int
    text: str
    comment: str

    @property
    def words(self) -> list[str]:
        """Words as LAMMPS takes them, without the quotes."""
        return split_words(self.text)

    def replaced(self, words: list[str], remark: str = "") -> str:
        """Return a line of other words, set as this command is, with its comment and a remark."""
        head = re.match(r"\s*\S+\s+", self.text)
        start = head[0] if head and head[0].split() == words[:1] else words[0] + " "
        comments = [comment.lstrip("# ") for comment in (remark, self.comment) if comment]
        return (start + " ".join(words[1:]) + ("   # " + "; ".join(comments) if comments else "")).rstrip()


def split_words(text: str) -> list[str]:
    """Return the words of a text; what is in quotes is one."""
    found = WORD.finditer(text)
    return [next(part for part in one.groups() if part is not None) for one in found]


def read_lines(script: Path) -> list[str]:
    """Return the lines of a file."""
    return script.read_text(encoding="utf-8-sig", errors="replace").splitlines()


def commands_of(lines: list[str]) -> list[Command]:
    """Return the commands of the lines: ``&`` and triple quotes join several."""
    commands: list[Command] = []
    text, comment, first = "", "", 0
    for number, line in enumerate(lines, 1):
        first = first or number
        body, said = ("", line) if comment else _without_comment(line, text)
        text, comment = text + body, comment or said
        goes_on = line.rstrip().endswith("&")  # also of a comment, as LAMMPS reads it
        if text.count('"""') % 2:
            text += "\n"
        elif goes_on and number < len(lines):
            text = text.rstrip().removesuffix("&") + " "
            comment = comment.rstrip().removesuffix("&")
        else:
            if text.strip():
                commands.append(Command(first, number, text.rstrip(), comment))
            text, comment, first = "", "", 0
    return commands


def _without_comment(line: str, before: str) -> tuple[str, str]:
    """Return a line up to a ``#`` outside quotes, and from there; quotes may have been opened before."""
    quote = _open_quote(before)
    k = 0
    while k < len(line):
        found = QUOTED.match(line, k)
        if found and quote in ("", found[0]):
            quote = "" if quote else found[0]
            k = found.end()
            continue
        if line[k] == "#" and not quote:
            return line[:k].rstrip(), line[k:]
        k += 1
    return line, ""


def _open_quote(text: str) -> str:
    quote, k = "", 0
    while found := QUOTED.search(text, k):
        if quote in ("", found[0]):
            quote = "" if quote else found[0]
        k = found.end()
    return quote
