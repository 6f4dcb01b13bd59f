"""Instances of LAMMPS that end with the test that asked for them, and a question behind each of their runs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import core_programs
import pytest
import scenes
import watched_runs


@pytest.fixture(scope="session", autouse=True)
def every_run_is_asked() -> Iterator[None]:
    """Compare the overlap that a run reports with that of all pairs, see `watched_runs`."""
    end = watched_runs.install()
    yield
    end()


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
