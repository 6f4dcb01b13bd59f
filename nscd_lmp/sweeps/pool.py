# SPDX-License-Identifier: GPL-2.0-or-later
"""Cases side by side, each in a process of its own."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterable
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from nscd_lmp.sweeps.record import FAILED, KILLED, RESULT, TIMEOUT, read_json, write_json

SECONDS_BETWEEN_LOOKS = 0.02
SECONDS_TO_END = 3.0  # for mpiexec to end its ranks
OUTPUT, ERRORS = "stdout.txt", "stderr.txt"
WORKER = Path(__file__).with_name("worker.py")
# What a launcher tells its own ranks; a case would take itself for one of them.
LAUNCHED = re.compile(r"^(PMI|PMIX|HYDI|MPI_LOCAL|OMPI_COMM_WORLD|SLURM_PROCID)")
WHERE = re.compile(r" \([\w./]+:\d+\)$")
MOST_WARNINGS = 20
FROM_OUTSIDE = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP)


@dataclass
class Running:
    """A case that runs."""

    folder: Path
    key: dict[str, Any]
    process: subprocess.Popen[bytes]
    started_at: float


def run_cases(
    cases: Iterable[tuple[Path, dict[str, Any]]],
    processes: int,
    timeout: float | None,
    ended: Callable[[Path, dict[str, Any]], None],
) -> None:
    """Run cases whose folders have a ``case.json``, and see that each leaves a ``result.json``.

    Parameters
    ----------
    cases : iterable of (folder, key)
        In the order in which they start; the next one is asked for when there is room for it.
    processes : int
        How many run side by side.
    timeout : float, optional
        Seconds after which a case is stopped.
    ended : callable
        Is told folder and result of every case that ends. An exception, Ctrl-C among them, stops all cases.
    """
    waiting, running = iter(cases), list[Running]()
    more = True
    try:
        while more or running:
            while more and len(running) < processes:
                case = next(waiting, None)
                more = case is not None
                running += [_start(*case)] if case is not None else []
            time.sleep(SECONDS_BETWEEN_LOOKS)
            for one in list(running):
                result = _look(one, timeout)
                if result is not None:
                    running.remove(one)
                    ended(one.folder, result)
    finally:
        for one in running:
            _ask_to_end(one.process)
        for one in running:
            _stop(one.process)


def _start(folder: Path, key: dict[str, Any]) -> Running:
    environment = {name: value for name, value in os.environ.items() if not LAUNCHED.match(name)}
    with ExitStack() as stack:
        output, errors = (stack.enter_context(open(folder / name, "wb")) for name in (OUTPUT, ERRORS))
        process = subprocess.Popen(
            [sys.executable, str(WORKER), str(folder.resolve()), str(os.getpid())],
            stdin=subprocess.DEVNULL, stdout=output, stderr=errors, env=environment, start_new_session=True,
        )  # fmt: skip
    return Running(folder, key, process, time.monotonic())


def _look(case: Running, timeout: float | None) -> dict[str, Any] | None:
    """Return the result of a case that has ended, or that has to because of its time."""
    seconds = time.monotonic() - case.started_at
    late = timeout is not None and seconds > timeout
    if case.process.poll() is None and not late:
        return None
    if case.process.returncode is None:
        _ask_to_end(case.process)
    _stop(case.process)
    told = _warnings_of_lammps(case.folder)
    result = read_json(case.folder / RESULT)
    if result is not None and not told:
        return result
    if result is None:
        result = {"key": case.key, "results": {}, "seconds": seconds}
        if late:
            message = f"stopped after {timeout:g} s: give a larger timeout, or a smaller case"
            result |= {"status": TIMEOUT, "timeout": timeout, "message": message}
        else:
            result |= _post_mortem(case)
    result["warnings"] = [*result.get("warnings", []), *told]
    write_json(case.folder / RESULT, result)
    return result


def _warnings_of_lammps(folder: Path) -> list[str]:
    """Return what LAMMPS has warned of on its screen, each once, without the places in its code."""
    with open(folder / OUTPUT, encoding="utf-8", errors="replace") as file:
        told = dict.fromkeys(WHERE.sub("", line.strip()) for line in file if line.startswith("WARNING: "))
    return list(told)[:MOST_WARNINGS]


def _post_mortem(case: Running) -> dict[str, Any]:
    """Return status and message of a process that has left no result."""
    printed = "".join((case.folder / name).read_text(errors="replace") for name in (OUTPUT, ERRORS))
    code = case.process.returncode
    of_rank = re.search(r"signal (\d+)\)|KILLED BY SIGNAL: (\d+)", printed)  # mpiexec's words
    number = -code if code < 0 else int(of_rank[1] or of_rank[2]) if of_rank else 0
    errors = [line for line in printed.splitlines() if line.startswith("ERROR")]
    if number in FROM_OUTSIDE:
        return {"status": KILLED, "message": f"killed by {signal.Signals(number).name}, from outside or for its memory"}
    if number:
        message = f"crashed by {signal.Signals(number).name}: see {ERRORS} in its folder"
    elif code == 0:
        message = "ended before its script did, as by the command quit: leave that out, results are read at the end"
    else:
        message = f"ended with exit code {code} and no result: see {ERRORS} in its folder"
    return {"status": FAILED, "message": errors[0] if errors else message}


def _ask_to_end(process: subprocess.Popen[bytes]) -> None:
    if process.poll() is None:
        process.terminate()


def _stop(process: subprocess.Popen[bytes]) -> None:
    """Wait for a process that was asked to end, then kill it and what it has started."""
    try:
        process.wait(SECONDS_TO_END)
    except subprocess.TimeoutExpired:
        pass
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    process.wait()
