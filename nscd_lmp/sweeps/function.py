# SPDX-License-Identifier: GPL-2.0-or-later
"""A Python function as what the cases of a sweep run, and how a worker finds it again."""

from __future__ import annotations

import importlib
import inspect
import runpy
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from nscd_lmp._core import NscdError
from nscd_lmp.sweeps.cases import Case
from nscd_lmp.sweeps.code import code_of

Function = Callable[..., Any]
RUN_NAME = "__nscd_sweep__"  # not __main__: what a file does as a program is left out

_loading = False


class FunctionTask:
    """A function ``f(folder, **variables)`` at the top level of a module or file."""

    def __init__(self, function: Function | str) -> None:
        if isinstance(function, str):
            self.module, self.file, self.function = _split(function)
            before = list(sys.path)
            self.called = load_function(self.module, self.file, self.function)
            sys.path[:] = before
        else:
            self.module, self.file, self.function = _reference(function)
            self.called = function
        self.name = f"{self.module or Path(str(self.file)).name}:{self.function}"
        self.code = code_of(self.called, self.function)

    def check(self, cases: Sequence[Case], folder: Path) -> None:
        """Refuse variables that the function does not take."""
        for case in cases:
            try:
                inspect.signature(self.called).bind(folder, **case.variables)
            except TypeError as error:
                raise NscdError(
                    f"{self.name} cannot be called as {self.function}(folder, {', '.join(case.variables)}): {error}"
                ) from None

    def key(self, case: Case, folder: Path) -> dict[str, Any]:
        """Return what, besides the variables, the results of a case depend on."""
        return {"code": self.code}

    def spec(self, case: Case, folder: Path) -> dict[str, Any]:
        """Return what the worker has to know."""
        return {
            "function": self.function,
            "module": self.module,
            "file": self.file,
            "folder": str((folder / case.name).resolve()),
            "variables": case.variables,
        }


def load_function(module: str | None, file: str | None, name: str) -> Function:
    """Import a function of a module, or of a file if there is no such module; the file's folder joins ``sys.path``.

    Raises
    ------
    NscdError
        It is not there.
    """
    global _loading
    _loading = True
    try:
        if module:
            try:
                found = getattr(importlib.import_module(module), name, None)
                if found is not None:
                    return found
            except ModuleNotFoundError as error:
                if error.name is None or not f"{module}.".startswith(f"{error.name}."):
                    raise
        if file and Path(file).is_file():
            sys.path.insert(0, str(Path(file).resolve().parent))
            found = runpy.run_path(file, run_name=RUN_NAME).get(name)
            if found is not None:
                return found
    finally:
        _loading = False
    raise NscdError(
        f"there is no function '{name}' in '{module or file}': give a function at the top level of a module that can"
        " be imported, or of a file, as FILE.py:NAME"
    )


def refuse_while_loading() -> None:
    """Raise if a worker, or this process, is importing the file of a function."""
    if _loading:
        raise NscdError(
            "the file of the function calls nscd_lmp.sweep as it is imported, so every case would begin the sweep anew:"
            ' put the call under if __name__ == "__main__":'
        )


def is_reference(run: str) -> bool:
    """Return whether a string names a function, ``module:name`` or ``file.py:name``."""
    place, colon, name = run.rpartition(":")
    return bool(colon and place and name.isidentifier()) and not Path(run).is_file()


def _split(reference: str) -> tuple[str | None, str | None, str]:
    place, _, name = reference.rpartition(":")
    if place.endswith(".py") or Path(place).is_file():
        return None, place, name
    return place, None, name


def _reference(function: Function) -> tuple[str | None, str | None, str]:
    """Return module, file and name of a function object."""
    module = getattr(function, "__module__", None)
    name = getattr(function, "__qualname__", None)
    home = sys.modules.get(module or "")
    if name is None or home is None or getattr(home, name, None) is not function:
        raise NscdError(
            f"{function!r} is not at the top level of a module, where each case's own process could import it: define"
            " it there by def, and give what it needs as variables"
        )
    file = getattr(home, "__file__", None)
    if module == "__main__" and home.__spec__ is not None:  # python -m MODULE
        module = home.__spec__.name
    if module == "__main__":
        if file is None:
            raise NscdError(
                f"the function '{name}' was typed into a session, and cases run in processes of their own: write it"
                " into a file and import it from there"
            )
        module = None
    return module, str(Path(file).resolve()) if file else None, name
