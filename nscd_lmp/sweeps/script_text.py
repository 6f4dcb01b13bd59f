# SPDX-License-Identifier: GPL-2.0-or-later
"""What the text of a LAMMPS script tells before it runs: variables that it uses, files that runs would share."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from nscd_lmp.door.command_lines import split_commands

INDEX = re.compile(r"\bvariable\s+(\w+)\s+index\s+([^\s\"]+)")
INCLUDE = re.compile(r"(?:^|[\s\"])(?:include|jump)\s+([^\s\"]+)")
REFERENCE = re.compile(r"\$\{(\w+)\}|\$(\w)")
USES = (
    re.compile(r"\$\{(\w+)\}"),
    re.compile(r"\$(\w)"),
    re.compile(r"(?<!\w)v_(\w+)"),
    re.compile(r"is_defined\(\s*variable\s*,\s*(\w+)"),
    re.compile(r"(?:^|[\s\"])variable\s+(\w+)\s+delete"),
)
COMMENT = re.compile(r"(\"[^\"]*\"|'[^']*')|#.*")
NEXT = re.compile(r"(?:^|[\s\"])next\s+([\w\s]+)")
# Commands whose argument is a file to write.
WRITES = (
    re.compile(r"^\s*dump\s+\S+\s+\S+\s+\S+\s+\S+\s+(\S+)"),
    re.compile(r"^\s*write_dump\s+\S+\s+\S+\s+(\S+)"),
    re.compile(r"^\s*(?:write_data|write_restart|log)\s+(\S+)"),
    re.compile(r"^\s*restart\s+[1-9]\S*\s+(\S+)"),
    re.compile(r"^\s*fix\s.*\s(?:file|append)\s+(\S+)"),
    re.compile(r"^\s*(?:print\s.*\s)?(?:file|append)\s+(\S+)"),
)
NOWHERE = ("none", "NULL", "/dev/null")


class ScriptText:
    """The commands of a script and of the files that it includes.

    Parameters
    ----------
    script : Path
        The script.
    variables : mapping
        Names and values of index variables that are set from outside, for names of files.

    Attributes
    ----------
    commands : list of str
        Of all files, without comments.
    files : dict
        The commands of each file, by the path by which it was found.
    unread : list of str
        Files to include that were not found: their names depend on what happens in the run.
    """

    def __init__(self, script: Path, variables: Mapping[str, Any]) -> None:
        self.commands: list[str] = []
        self.files: dict[Path, list[str]] = {}
        self.unread: list[str] = []
        self._values: dict[str, list[str]] = {}
        self._given = {name: str(value) for name, value in variables.items()}
        self._read: set[Path] = set()
        self._script = script
        self._elsewhere: dict[str, Path] = {}  # what is not in the working directory: name in the script -> its folder
        self._add(script)

    def used(self) -> set[str]:
        """Return the names of all variables that a command refers to."""
        text = "\n".join(self.commands)
        names = {found for use in USES for found in use.findall(text)}
        return names | {name for names in NEXT.findall(text) for name in names.split()}

    def written(self, variables: Mapping[str, Any]) -> set[str]:
        """Return the files that commands write, as far as the values of variables are known.

        Parameters
        ----------
        variables : mapping
            Those of a case; defaults of the script's own index variables stand for others.
        """
        given = {name: str(value) for name, value in variables.items()}
        files = set()
        for command in "\n".join(self.commands).replace('"', "\n").splitlines():
            for write in WRITES:
                found = write.match(command)
                if found:
                    files |= {name for name in self._resolve(found[1], given) if not REFERENCE.search(name)}
        return files - set(NOWHERE)

    def code(self) -> dict[str, str]:
        """Return hashes of the commands, by the names of the files; comments and layout do not count."""
        texts: dict[str, str] = {}
        for file, commands in self.files.items():
            texts[file.name] = texts.get(file.name, "") + "\n".join(" ".join(one.split()) for one in commands)
        return {name: hashlib.sha256(text.encode()).hexdigest()[:16] for name, text in texts.items()}

    def placed(self, folder: Path) -> Path:
        """Return a script to run from the working directory.

        LAMMPS looks for files to include there. Where they were found beside the script or above it instead, `folder`
        gets copies that name their places.
        """
        if not self._elsewhere:
            return self._script
        copies = {file.resolve(): folder / f"in.{k}.{file.name}" for k, file in enumerate(self.files)}
        for file in self.files:
            text = file.read_text(encoding="utf-8-sig", errors="replace")
            text = INCLUDE.sub(lambda found: self._found_again(found, copies), text)
            copies[file.resolve()].write_text(text, encoding="utf-8")
        return copies[self._script.resolve()]

    def _found_again(self, found: re.Match[str], copies: Mapping[Path, Path]) -> str:
        """Return a command to include a file with the place of its copy, or if several may be meant of the file."""
        name = found[1]
        place = self._elsewhere.get(name, Path())
        files = [place / one for one in self._resolve(name, self._given)]
        known = [copies[file.resolve()] for file in files if file.resolve() in copies]
        to = known[0] if len(known) == 1 else place / name
        return found[0][: found.start(1) - found.start()] + str(to)

    def _add(self, file: Path) -> None:
        self._read.add(file.resolve())
        lines = file.read_text(encoding="utf-8-sig", errors="replace").splitlines()
        commands = split_commands("\n".join(COMMENT.sub(r"\1", line).rstrip() for line in lines))
        self.commands += commands
        self.files[file] = commands
        for command in commands:
            for name, value in INDEX.findall(command):
                self._values.setdefault(name, []).append(value)
        for command in commands:
            for name in INCLUDE.findall(command):
                self._include(name)

    def _include(self, name: str) -> None:
        if name == "SELF":
            return
        names = self._resolve(name, self._given)
        for place in (Path(), *self._script.resolve().parents):
            found = [place / one for one in names if (place / one).is_file()]
            if found:
                break
        if not found:
            self.unread.append(name)
        elif place != Path():
            self._elsewhere[name] = place
        for file in found:
            if file.resolve() not in self._read:
                self._add(file)

    def _resolve(self, text: str, given: Mapping[str, str], depth: int = 0) -> set[str]:
        """Return the text with values in place of variables, in every way that the script offers."""
        found = REFERENCE.search(text)
        if not found or depth > 9:
            return {text}
        name = found[1] or found[2]
        values = [given[name]] if name in given else self._values.get(name, [])
        parts = [text[: found.start()] + value + text[found.end() :] for value in values]
        return {one for part in parts for one in self._resolve(part, given, depth + 1)} or {text}
