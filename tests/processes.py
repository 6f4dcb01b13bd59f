# SPDX-License-Identifier: GPL-2.0-or-later
"""Processes that tests start: none outlives its test, nor pytest, however these end.

All that descends from pytest carries a mark in its environment, and is found by it in /proc. Run as a program, this
file waits until pytest is gone, whatever has ended it, and then ends what carries the mark.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

MARK = "NSCD_TESTS_OF"
SECONDS_TO_END = 5.0  # for those that are ending when their test does, as MPI's launcher
foreign: set[int] = set()  # processes without the mark; a look at all of them for each test would cost a second in all


def mark() -> subprocess.Popen[bytes]:
    """Mark what this process starts from now on; return the program that ends it when this process is gone."""
    words = [sys.executable, __file__, f"{os.getpid()}"]
    watcher = subprocess.Popen(words, stdin=subprocess.PIPE, start_new_session=True)
    os.environ[MARK] = f"{os.getpid()}"
    return watcher


def left(number: int, *, thorough: bool = False) -> dict[int, str]:
    """Return what runs of the processes that carry the mark of process `number`: IDs and command lines."""
    if thorough:
        foreign.clear()
    there = {int(name) for name in os.listdir("/proc") if name.isdecimal()}
    foreign.intersection_update(there)
    found = {}
    for process in there - foreign - {os.getpid()}:
        try:
            environment = environment_of(process).split(b"\0")
            command = Path(f"/proc/{process}/cmdline").read_bytes().replace(b"\0", b" ")
        except OSError:  # it has ended, or is not ours
            continue
        if f"{MARK}={number}".encode() in environment:
            found[process] = command.decode(errors="replace").strip()
        else:
            foreign.add(process)
    return found


def environment_of(process: int) -> bytes:
    """Return the environment of a process; one that has just been started has none yet, and is waited for a little."""
    for _again in range(50):
        environment = Path(f"/proc/{process}/environ").read_bytes()
        if environment or not is_program(process):
            break
        time.sleep(0.001)
    return environment


def is_program(process: int) -> bool:
    """Return whether it runs a file; the kernel's own and those that have ended do not."""
    try:
        return bool(os.readlink(f"/proc/{process}/exe"))
    except FileNotFoundError:
        return False


def end(number: int, *, thorough: bool = False) -> list[str]:
    """Wait a little for the processes of the mark to end, then end them; return the command lines of those."""
    deadline = time.monotonic() + SECONDS_TO_END
    while found := left(number, thorough=thorough):
        if time.monotonic() > deadline:
            for process in found:
                try:
                    os.kill(process, signal.SIGKILL)
                except ProcessLookupError:
                    pass
            return list(found.values())
        time.sleep(0.02)
    return []


@contextmanager
def started(words: Sequence[Any], **options: Any) -> Iterator[subprocess.Popen[Any]]:
    """Start a program with a group of its own, and kill the group at the end of the ``with`` block."""
    process = subprocess.Popen(words, start_new_session=True, **options)
    try:
        yield process
    finally:
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        process.wait()


def run(words: Sequence[Any], seconds: float, **options: Any) -> subprocess.CompletedProcess[Any]:
    """Run a program as ``subprocess.run`` does; after so many seconds it is ended with all it has started."""
    with started(words, **options) as process:
        out, err = process.communicate(timeout=seconds)
    return subprocess.CompletedProcess(words, process.returncode, out, err)


def deaf(words: Sequence[Any]) -> list[Any]:
    """Return the words that start a program with SIGINT ignored, as a script's shell does behind ``&``."""
    return ["sh", "-c", 'trap "" INT; exec "$@"', "sh", *words]


if __name__ == "__main__":
    sys.stdin.read()
    for _again in range(3):  # what was about to start another when it was ended
        for one in left(int(sys.argv[1]), thorough=True):
            try:
                os.kill(one, signal.SIGKILL)
            except ProcessLookupError:
                pass
        time.sleep(0.2)
