# SPDX-License-Identifier: GPL-2.0-or-later
"""What a sweep keeps in files, so that another one can go on where it was ended."""

from __future__ import annotations

import fcntl
import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from nscd_lmp._core import NscdError

SWEEP = "sweep.json"
CASE = "case.json"
RESULT = "result.json"
LOCK = ".sweep.lock"

# How a case can end. Killed means from outside; what crashes by itself has failed.
OK, FAILED, TIMEOUT, KILLED = "ok", "failed", "timeout", "killed"


def write_json(path: Path, content: Any) -> None:
    """Write all of a file or nothing."""
    write_text(path, json.dumps(content, indent=1) + "\n")


def write_text(path: Path, text: str) -> None:
    """Write all of a file or nothing."""
    unfinished = path.with_name(f"{path.name}.{os.getpid()}")
    with open(unfinished, "w", encoding="utf-8", newline="") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.replace(unfinished, path)


def read_json(path: Path) -> Any:
    """Return the content, or None if there is none that can be read."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


def read_result(folder: Path) -> dict[str, Any] | None:
    """Return the result that an earlier sweep left in the folder of a case, or None."""
    result = read_json(folder / RESULT)
    return result if isinstance(result, dict) and isinstance(result.get("key"), dict) else None


def finished(result: dict[str, Any] | None, *, retry: bool, timeout: float | None) -> bool:
    """Return whether a case has ended and does not have to run again.

    Parameters
    ----------
    result : dict, optional
        What :func:`read_result` found.
    retry : bool
        Run again what failed or took too long.
    timeout : float, optional
        Seconds that a case may take now; one that was stopped after less runs again.
    """
    status = result.get("status") if result else None
    if result is None or status not in (OK, FAILED, TIMEOUT):
        return False
    longer = status == TIMEOUT and (timeout is None or timeout > result["timeout"])
    return status == OK or not (retry or longer)


@contextmanager
def claimed(folder: Path, run: str, fixed: dict[str, Any]) -> Iterator[None]:
    """Make the folder and keep other sweeps out of it.

    Raises
    ------
    NscdError
        It holds another sweep, or another process works in it.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / LOCK, "w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise NscdError(
                f"another sweep is at work in '{folder}': wait for its end, or give another folder"
            ) from None
        _compare(folder, run, fixed)
        write_json(folder / SWEEP, {"run": run, "fixed": fixed})
        yield


def _compare(folder: Path, run: str, fixed: dict[str, Any]) -> None:
    before = read_json(folder / SWEEP)
    if before is None:
        return
    if before["run"] != run:
        raise NscdError(
            f"folder '{folder}' holds a sweep of {before['run']}, not of {run}: give another folder, or delete it"
        )
    names = before["fixed"].keys() | fixed.keys()
    other = sorted(name for name in names if before["fixed"].get(name) != fixed.get(name))
    if other:
        name = other[0]
        raise NscdError(
            f"folder '{folder}' holds a sweep with {name} = {before['fixed'].get(name)}, not {fixed.get(name)}: give"
            f" another folder, or make '{name}' an axis by a list of values"
        )
