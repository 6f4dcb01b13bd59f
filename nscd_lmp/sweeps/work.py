# SPDX-License-Identifier: GPL-2.0-or-later
"""What a worker does: one case, measured, and its result in a file."""

from __future__ import annotations

import numbers
import sys
import time
import traceback
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from mpi4py import MPI

from nscd_lmp.sweeps.function import load_function
from nscd_lmp.sweeps.record import FAILED, OK, RESULT, write_json
from nscd_lmp.sweeps.script_run import run_script

Spec = dict[str, Any]


def work(folder: str, spec: Spec) -> None:
    """Run a case and write ``result.json``; several ranks end together, also when one of them fails."""
    comm = MPI.COMM_WORLD
    started_at = time.perf_counter()
    told: list[str] = []
    result: dict[str, Any] = {"key": spec["key"], "status": OK, "message": "", "results": {}, "warnings": told}
    try:
        with _heard(told):
            result |= _script(folder, spec) if "script" in spec else _function(spec, told)
    except BaseException as error:
        traceback.print_exc()
        result |= {"status": FAILED, "message": _told(error), "seconds": time.perf_counter() - started_at}
        if comm.size > 1:  # others may wait for this rank forever
            write_json(Path(folder) / RESULT, result)
            sys.stderr.flush()
            comm.Abort(1)
    sys.stdout.flush()
    comm.Barrier()  # no rank is ok before all are
    if comm.rank == 0:
        write_json(Path(folder) / RESULT, result)


def _script(folder: str, spec: Spec) -> dict[str, Any]:
    results, seconds, message = run_script(spec["script"], spec["words"], spec["results"], Path(folder))
    if message:
        print(message, file=sys.stderr)
    return {"status": FAILED if message else OK, "message": message, "results": results, "seconds": seconds}


@contextmanager
def _heard(told: list[str]) -> Iterator[None]:
    """Note Python's warnings, each once; they are shown as ever."""
    show = warnings.showwarning

    def hear(message: Any, *where: Any, **more: Any) -> None:
        text = " ".join(str(message).split())
        if text not in told:
            told.append(text)
        show(message, *where, **more)

    warnings.showwarning = hear
    try:
        yield
    finally:
        warnings.showwarning = show


def _function(spec: Spec, told: list[str]) -> dict[str, Any]:
    function = load_function(spec["module"], spec["file"], spec["function"])
    started_at = time.perf_counter()
    returned = function(Path(spec["folder"]), **spec["variables"])
    seconds = time.perf_counter() - started_at
    if returned is None:
        returned = {}
    if not isinstance(returned, dict):
        raise TypeError(f"{spec['function']} returned {type(returned).__name__}: return a dict of results")
    return {"results": {str(name): _plain(name, value, told) for name, value in returned.items()}, "seconds": seconds}


def _plain(name: Any, value: Any, told: list[str]) -> Any:
    """Return the value of a cell as one of Python's own types; None, and say so, if it cannot be in a cell."""
    if getattr(value, "ndim", None) == 0 and hasattr(value, "item"):
        value = value.item()
    if isinstance(value, str):
        return value.encode(errors="replace").decode()
    if value is None or isinstance(value, bool | int | float):
        return value
    if isinstance(value, numbers.Real):
        return float(value)
    told.append(
        f"result '{name}' is left empty, for it is of type {type(value).__name__}: a cell of the table is a number, a"
        " string, True, False or None; write anything else to a file in the case's folder"
    )
    return None


def _told(error: BaseException) -> str:
    """Return the first line of what went wrong; LAMMPS' errors say themselves that they are."""
    text = str(getattr(error, "message", error)).strip()
    first_line = next(iter(text.splitlines()), "")
    if first_line.startswith("ERROR"):
        return first_line
    return f"{type(error).__name__}: {first_line}" if first_line else type(error).__name__
