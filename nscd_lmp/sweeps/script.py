# SPDX-License-Identifier: GPL-2.0-or-later
"""A LAMMPS script as what the cases of a sweep run."""

from __future__ import annotations

import difflib
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from nscd_lmp._core import NscdError
from nscd_lmp.sweeps.cases import Case
from nscd_lmp.sweeps.script_text import ScriptText

FOLDER = "folder"  # the LAMMPS variable that names the folder of a case


class ScriptTask:
    """A script; a case sets its index variables, and `results` are formulas by the names of their columns."""

    def __init__(self, script: Path, results: Mapping[str, str]) -> None:
        if not script.is_file():
            raise NscdError(f"there is no script '{script}' in '{Path.cwd()}': give the path of an existing file")
        self.script = script
        self.results = dict(results)
        self.name = script.name

    def check(self, cases: Sequence[Case], folder: Path) -> None:
        """Refuse variables and folders that LAMMPS cannot take; warn of files that cases would share."""
        for case in cases:
            for name, value in case.variables.items():
                _word(name, value)
        text = ScriptText(self.script, _words(cases[0], folder))
        self._check_used(text, cases)
        if FOLDER in text.used() and any(letter.isspace() for letter in str(folder)):
            raise NscdError(f"'{folder}' has a blank, which LAMMPS cannot take in names of files: give another folder")
        self._check_written(text, cases, folder)

    def key(self, case: Case, folder: Path) -> dict[str, Any]:
        """Return what, besides the variables, the results of a case depend on; `folder` is the case's."""
        return {"code": ScriptText(self.script, _words(case, folder)).code(), "results": self.results}

    def spec(self, case: Case, folder: Path) -> dict[str, Any]:
        """Return what the worker has to know; a script that includes files from elsewhere gets a copy that finds them.

        The copy is in the case's folder.
        """
        words = _words(case, folder / case.name)
        script = ScriptText(self.script, words).placed(folder / case.name)
        return {"script": str(script), "words": words, "results": self.results}

    def _check_used(self, text: ScriptText, cases: Sequence[Case]) -> None:
        used = text.used()
        for name in dict.fromkeys(name for case in cases for name in case.variables):
            if name in used:
                continue
            near = difflib.get_close_matches(name, used, 3) or sorted(used)[:9]
            advice = f"it uses {', '.join(near)}" if near else "write ${" + name + "} where the value goes"
            told = f"the script '{self.script}' never uses the variable '{name}', so its values would change nothing"
            if not text.unread:
                raise NscdError(f"{told}: {advice}")
            unread = ", ".join(text.unread)
            warnings.warn(f"{told}, unless {unread} does, which was not found from '{Path.cwd()}'", stacklevel=4)

    def _check_written(self, text: ScriptText, cases: Sequence[Case], folder: Path) -> None:
        seen: dict[str, str] = {}
        for case in cases:
            for file in text.written(_words(case, folder / case.name)):
                if seen.setdefault(file, case.name) != case.name:
                    warnings.warn(
                        f"cases write the same file '{file}', and the last one wins: let the script write to"
                        " ${folder}/..., the folder of its case, or give a variable that names the file such a value",
                        stacklevel=4,
                    )
                    return


def _words(case: Case, folder: Path) -> dict[str, str]:
    """Return the values of all variables as LAMMPS reads them."""
    words = {name: _word(name, value) for name, value in case.variables.items()}
    # relative to the working directory where possible: shorter, and without the blanks of folders above
    return {name: word.replace("${folder}", str(folder)) for name, word in words.items()} | {FOLDER: str(folder)}


def _word(name: str, value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if value is None or isinstance(value, list | dict) or value == "":
        raise NscdError(
            f"variable '{name}' cannot be {value!r} in a LAMMPS script: give a number or word, True or False"
        )
    return repr(value) if isinstance(value, float) else str(value)
