# SPDX-License-Identifier: GPL-2.0-or-later
"""Many runs of one script or function: a grid or list of variables' values, and a table at the end."""

from __future__ import annotations

import os
import shutil
import sys
import sysconfig
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

from mpi4py import MPI

from nscd_lmp._core import NscdError
from nscd_lmp.sweeps import earlier
from nscd_lmp.sweeps.cases import OWN_COLUMNS, Case, make_cases
from nscd_lmp.sweeps.function import FunctionTask, is_reference, refuse_while_loading
from nscd_lmp.sweeps.pool import run_cases
from nscd_lmp.sweeps.record import CASE, OK, RESULT, claimed, finished, read_result, write_json
from nscd_lmp.sweeps.script import ScriptTask
from nscd_lmp.sweeps.table import Row, SweepTable

Result = dict[str, Any]

TABLE = "sweep.csv"


def sweep(
    run: str | os.PathLike[str] | Callable[..., Any],
    variables: Mapping[str, Any] | None = None,
    *,
    cases: Iterable[Mapping[str, Any]] | None = None,
    folder: str | os.PathLike[str],
    processes: int = 1,
    ranks: int = 1,
    timeout: float | None = None,
    results: str | Sequence[str] | Mapping[str, str] = (),
    retry: bool = False,
    stale: Literal["refuse", "keep", "rerun"] = "refuse",
    progress: bool = True,
) -> SweepTable:
    """Run a LAMMPS script or a Python function for each of many cases.

    Each case runs in a process of its own with a folder of its own, ``folder/CASE``. One that fails, crashes or takes
    too long is a row of the table like the others. Cases that an earlier call has finished are not run again: a
    sweep that was killed goes on with the same call.

    Parameters
    ----------
    run : path, function or str
        A LAMMPS script, or a function ``f(folder, **variables)`` that returns a dict of numbers, strings, True, False
        and None. It is at the top level of a module or file, given as itself or by ``"module:name"`` or
        ``"file.py:name"``; `folder` is the case's, as a ``pathlib.Path``. Scripts and functions run in the working
        directory of the caller. A script has the case's folder as variable ``folder``.
    variables : mapping, optional
        Values by name. A list (tuple, range, array) is an axis of the grid, any other value the same in all cases. A
        script gets them as index variables, as by ``lmp -var``; ``${folder}`` in a string is its case's folder.
    cases : iterable of mappings, optional
        A list of cases in place of a grid; with a grid, each is combined with each of its points.
    folder : path
        Where all is kept; made if it is not there.
    processes : int
        How many cases run side by side.
    ranks : int
        MPI ranks of each case, started by ``mpiexec``. A function is then called on every rank, and rank 0's results
        are taken.
    timeout : float, optional
        Seconds after which a case is stopped.
    results : str, sequence of str or mapping
        Of a script: what LAMMPS tells at its end, as formulas of an equal-style variable, such as ``ke``,
        ``f_nscd[3]``, ``v_name``, ``c_ID[1]``; a mapping gives each a name. The totals of fix nscd and its vector
        (``last_...``) come by themselves.
    retry : bool
        Run again what failed or took too long in an earlier call.
    stale : str
        What to do where cases were finished before a change of the code (of the script and what it includes; of the
        function and what it uses of its file; comments, docstrings and layout aside), of `ranks` or of `results`:
        ``"refuse"`` is an error that says what has changed; ``"keep"`` takes their results, marked in the column
        ``warnings``; ``"rerun"`` runs them again, and keeps the old ones in ``folder/superseded`` and
        ``folder/superseded.csv``.
    progress : bool
        Show on standard error how far the sweep is.

    Returns
    -------
    SweepTable
        Rows in the order of the cases: variables, results, ``status`` (ok, failed, timeout, killed), ``seconds``
        (wall, of the run alone), ``message`` (why it failed), ``warnings`` and ``folder``. ``folder/sweep.csv`` has the
        same, and below them the cases that earlier calls have finished and this one has not.

    Raises
    ------
    NscdError
        Something cannot be as it was given, or `folder` holds another sweep, or finished cases of earlier code and
        `stale` is ``"refuse"``; nothing has run then, and all files are as they were.
    KeyboardInterrupt
        Ctrl-C was pressed: what ran was stopped, what was finished is kept and in the table.
    """
    refuse_while_loading()
    _check_numbers(processes, ranks, timeout)
    if stale not in earlier.CHOICES:
        raise NscdError(f"unknown stale {stale!r}: choose one of {', '.join(earlier.CHOICES)}")
    task = _new_task(run, results)
    made, fixed = make_cases(variables, cases)
    home = _short(Path(folder))
    task.check(made, home)
    with claimed(home, task.name, fixed):
        going = _Sweep(task, made, home, ranks)
        going.find(retry=retry, timeout=timeout, stale=stale)
        return going.run(processes, timeout, progress)


class _Sweep:
    """A sweep whose folder is claimed."""

    def __init__(self, task: ScriptTask | FunctionTask, cases: list[Case], home: Path, ranks: int) -> None:
        self.task = task
        self.cases = {home / case.name: case for case in cases}
        self.home = home
        self.ranks = ranks
        self.mpiexec = _mpiexec(ranks)
        self.found: dict[Path, Result] = {}
        self.superseded: dict[Path, tuple[Result, list[str]]] = {}  # finished results that wait to be replaced

    def find(self, *, retry: bool, timeout: float | None, stale: str) -> None:
        """Look for what earlier calls have finished."""
        for folder, case in self.cases.items():
            result = read_result(folder)
            if result is None or not finished(result, retry=retry, timeout=timeout):
                continue
            changed = earlier.changes(result["key"], self.key(case))
            if not changed:
                self.found[folder] = result
            elif result["status"] == OK:  # what has failed runs again: its code was mended
                self.superseded[folder] = (result, changed)
        if stale == earlier.REFUSE and self.superseded:
            changed = [name for _, changed in self.superseded.values() for name in changed]
            earlier.refuse(self.home, len(self.superseded), changed)
        if stale == earlier.KEEP:
            self.found |= {folder: _marked(*one) for folder, one in self.superseded.items()}
            self.superseded.clear()

    def run(self, processes: int, timeout: float | None, progress: bool) -> SweepTable:
        """Run what is not there, and write the table however that ends."""
        missing = [folder for folder in self.cases if folder not in self.found]
        from nscd_lmp.sweeps.watch import Watch  # brings rich, which import nscd_lmp does without

        watch = Watch(len(self.cases), [self.row(folder) for folder in self.found], quiet=not progress)

        def ended(folder: Path, result: Result) -> None:
            self.found[folder] = result
            watch.ended(folder.name, self.row(folder))

        try:
            with watch.on():
                run_cases(map(self.prepare, missing), processes, timeout, ended)
        finally:
            # a result that still waits to be replaced is not lost
            self.found |= {folder: _marked(*one) for folder, one in self.superseded.items()}
            table = SweepTable([self.row(folder) for folder in self.cases if folder in self.found], self.home / TABLE)
            table.write(self.others())
            self.write_superseded()
        return table

    def key(self, case: Case) -> dict[str, Any]:
        """Return all that a result depends on; one with another key is not that of the case."""
        return {"variables": case.variables, "ranks": self.ranks} | self.task.key(case, self.home / case.name)

    def prepare(self, folder: Path) -> tuple[Path, dict[str, Any]]:
        """Make the folder of a case, empty but for what the worker has to know; return it with the key."""
        case = self.cases[folder]
        if folder in self.superseded:
            earlier.supersede(folder, *self.superseded.pop(folder))
        elif (folder / CASE).exists():
            shutil.rmtree(folder)
        folder.mkdir(exist_ok=True)
        path = [entry or os.getcwd() for entry in sys.path]
        spec = {"variables": case.variables, "key": self.key(case), "mpiexec": self.mpiexec, "path": path}
        write_json(folder / CASE, spec | self.task.spec(case, self.home))
        return folder, self.key(case)

    def others(self) -> list[Row]:
        """Return the rows of cases that earlier calls have finished and this one has not."""
        rows = []
        for folder in sorted({path.parent for path in self.home.glob(f"*/{RESULT}")} - self.cases.keys()):
            result = read_result(folder)
            if result is not None and finished(result, retry=False, timeout=0):
                case = Case(folder.name, result["key"]["variables"])
                changed = earlier.changes(result["key"], self.key(case))
                rows.append(self.row_of(folder, _marked(result, changed) if changed else result))
        return rows

    def write_superseded(self) -> None:
        """Write the table of superseded results, if there are any."""
        home = self.home / earlier.SUPERSEDED
        results = {path.parent: read_result(path.parent) for path in sorted(home.glob(f"*/{RESULT}"))}
        rows = [
            self.row_of(folder, result | {"warnings": [result[earlier.SUPERSEDED], *result.get("warnings", [])]})
            for folder, result in results.items()
            if result is not None and earlier.SUPERSEDED in result
        ]
        if rows:
            SweepTable(rows, home.with_suffix(".csv")).write()

    def row(self, folder: Path) -> Row:
        """Return a finished case as a row of the table."""
        return self.row_of(folder, self.found[folder])

    def row_of(self, folder: Path, result: Result) -> Row:
        """Return a result as a row."""
        variables = result["key"]["variables"]
        taken = (*variables, *OWN_COLUMNS)
        expected = ("steps", *self.task.results) if isinstance(self.task, ScriptTask) else ()
        results = dict.fromkeys(expected) | result["results"]
        return {
            **variables,
            **{f"result_{name}" if name in taken else name: value for name, value in results.items()},
            "status": result["status"],
            "seconds": result["seconds"],
            "message": result["message"],
            "warnings": "; ".join(result.get("warnings", [])),
            "folder": str(folder),
        }


def _marked(result: Result, changed: list[str]) -> Result:
    """Return a result of earlier code, with what has changed since among its warnings."""
    return result | {"warnings": [earlier.mark(changed), *result.get("warnings", [])]}


def _new_task(
    run: str | os.PathLike[str] | Callable[..., Any], results: str | Sequence[str] | Mapping[str, str]
) -> ScriptTask | FunctionTask:
    formulas = results if isinstance(results, Mapping) else {one: one for one in _listed(results)}
    if (isinstance(run, str) and is_reference(run)) or not isinstance(run, str | os.PathLike):
        if formulas:
            raise NscdError("results are formulas for a LAMMPS script: a function returns its results as a dict")
        return FunctionTask(run)
    return ScriptTask(Path(run), formulas)


def _short(folder: Path) -> Path:
    """Return the path from the working directory if it is there: without the blanks of the folders above."""
    return Path(os.path.relpath(folder)) if folder.resolve().is_relative_to(Path.cwd()) else folder.resolve()


def _listed(names: str | Sequence[str]) -> Sequence[str]:
    return [names] if isinstance(names, str) else names


def _check_numbers(processes: int, ranks: int, timeout: float | None) -> None:
    world = MPI.COMM_WORLD.Get_size()
    if world > 1:
        raise NscdError(
            f"a sweep was begun on {world} MPI ranks, each of which would run all of it: start it without mpiexec,"
            " and give processes (cases side by side) or ranks (of each case)"
        )
    for name, number in (("processes", processes), ("ranks", ranks)):
        if number < 1:
            raise NscdError(f"{name} = {number} must be 1 at least")
    if timeout is not None and not timeout > 0:
        raise NscdError(f"timeout = {timeout} s must be above 0; None is no limit")
    cores = len(os.sched_getaffinity(0))
    if processes * ranks > cores:
        warnings.warn(
            f"processes x ranks = {processes} x {ranks} is more than the {cores} cores: cases slow each other down, and"
            " their seconds say little",
            stacklevel=3,
        )


def _mpiexec(ranks: int) -> list[str]:
    """Return the words that start a program on several ranks, none for one."""
    if ranks == 1:
        return []
    program = shutil.which("mpiexec", path=sysconfig.get_path("scripts")) or shutil.which("mpiexec")
    if program is None:
        raise NscdError(f"ranks = {ranks} needs mpiexec, which is not there: pip install mpich, or take ranks = 1")
    return [program, "-n", str(ranks)]
