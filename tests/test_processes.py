# SPDX-License-Identifier: GPL-2.0-or-later
"""What tests start ends with them: the checks of `processes` find what is left behind, and end it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import processes
import pytest
from sweep_cases import is_running, wait_for

pytestmark = pytest.mark.fast

SLEEP = ["sleep", "321"]
# No process has this number, so what is left behind is no matter of this session's; another's tests have another.
NUMBER = -os.getpid()
PROGRAM = """
import subprocess, sys, processes
processes.mark()
print(subprocess.Popen(["sleep", "321"]).pid, flush=True)
sys.stdin.read()
"""


@pytest.mark.parametrize("words", [SLEEP, ["sh", "-c", "sleep 321 &"]])
def test_process_that_is_left_behind_is_told_and_ended(monkeypatch: pytest.MonkeyPatch, words: list[str]) -> None:
    monkeypatch.setattr(processes, "SECONDS_TO_END", 0.2)
    child = subprocess.Popen(words, env=os.environ | {processes.MARK: f"{NUMBER}"}, start_new_session=True)
    if words[0] == "sh":
        child.wait()  # its own child is nobody's
    assert processes.end(NUMBER) == [" ".join(SLEEP)]
    wait_for(lambda: not processes.left(NUMBER), "the end", 5)
    child.wait()


def test_process_that_ends_by_itself_is_waited_for() -> None:
    child = subprocess.Popen(["sleep", "0.3"], env=os.environ | {processes.MARK: f"{NUMBER}"})
    assert processes.left(NUMBER)
    assert processes.end(NUMBER) == []
    child.wait()


@pytest.mark.parametrize("how", ["killed", "ended"])
def test_processes_end_however_pytest_ends(how: str) -> None:
    words = [sys.executable, "-c", PROGRAM]
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).parent)}
    with processes.started(
        words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment, cwd="/"
    ) as process:
        sleeper = int(process.stdout.readline())
        assert is_running(sleeper)
        if how == "killed":
            os.kill(process.pid, signal.SIGKILL)
        else:
            process.stdin.close()
        wait_for(lambda: not is_running(sleeper), "the end of what it has started", 10)


def raised() -> None:
    raise AssertionError("the test fails")


@pytest.mark.parametrize("fails", [raised, lambda: None])
def test_started_program_ends_with_its_block(fails: Callable[[], None]) -> None:
    try:
        with processes.started(["sh", "-c", "sleep 321 & sleep 321"]) as process:
            wait_for(lambda: len(group(process.pid)) == 3, "all three", 5)
            fails()
    except AssertionError:
        assert fails is raised
    wait_for(lambda: not group(process.pid), "the end of the group", 5)


def group(leader: int) -> list[int]:
    """Return the processes of a group that run."""
    ids = [int(name) for name in os.listdir("/proc") if name.isdecimal()]
    return [one for one in ids if is_running(one) and _group_of(one) == leader]


def _group_of(process: int) -> int:
    try:
        return os.getpgid(process)
    except ProcessLookupError:
        return 0


def test_program_that_takes_too_long_is_ended_with_what_it_has_started() -> None:
    began = time.monotonic()
    with pytest.raises(subprocess.TimeoutExpired):
        processes.run(["sh", "-c", "sleep 321 & sleep 321"], 0.3, stdout=subprocess.PIPE)
    assert time.monotonic() - began < 60
