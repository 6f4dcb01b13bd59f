# SPDX-License-Identifier: GPL-2.0-or-later
"""Instances of LAMMPS and processes that end with the test that asked for them, and a question behind each run."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import core_programs
import processes
import pytest
import scenes
import watched_runs


@pytest.fixture(scope="session", autouse=True)
def every_run_is_asked() -> Iterator[None]:
    """Compare the overlap that a run reports with that of all pairs, see `watched_runs`."""
    end = watched_runs.install()
    yield
    end()


@pytest.fixture(scope="session", autouse=True)
def processes_end_with_pytest() -> Iterator[None]:
    """Mark all that tests start, and have it hear Ctrl-C, which shells let what they put into the background ignore."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    watcher = processes.mark()
    yield
    left = processes.end(os.getpid(), thorough=True)
    watcher.communicate()
    assert not left, f"left behind by the tests, and ended: {left}"


@pytest.fixture(autouse=True)
def no_process_is_left() -> Iterator[None]:
    """Fail a test that leaves a process behind, and end that."""
    yield
    left = processes.end(os.getpid())
    assert not left, f"left behind by this test, and ended: {left}"


@pytest.fixture(autouse=True)
def asked_unless_marked(request: pytest.FixtureRequest) -> Iterator[None]:
    """Leave the question out in tests that are marked `overlaps_not_asked(reason)`."""
    if request.node.get_closest_marker("overlaps_not_asked") is None:
        yield
        return
    with watched_runs.unasked():
        yield


@pytest.fixture
def start() -> Iterator[Callable[..., Any]]:
    """Return `scenes.start`, whose instances are closed at the end of the test."""
    opened = []

    def begin(*args: Any, **kwargs: Any) -> Any:
        opened.append(scenes.start(*args, **kwargs))
        return opened[-1]

    yield begin
    for lmp in opened:
        lmp.close()


@pytest.fixture
def sedimentation() -> Iterator[Callable[..., Any]]:
    """Return `scenes.sedimentation`, whose instances are closed at the end of the test."""
    opened = []

    def begin(*args: Any, **kwargs: Any) -> Any:
        made = scenes.sedimentation(*args, **kwargs)
        opened.append(made[0])
        return made

    yield begin
    for lmp in opened:
        lmp.close()


@pytest.fixture(scope="session")
def build_folder(request: pytest.FixtureRequest) -> Callable[[str], Path]:
    """Return a function that names a build folder, kept in pytest's cache: a second run compiles little."""
    if not any(core_programs.tool(compiler) for compiler in ("c++", "g++", "clang++")):
        pytest.skip("there is no C++ compiler")
    return lambda name: request.config.cache.mkdir(name)
