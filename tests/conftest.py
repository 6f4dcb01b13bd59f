"""Instances of LAMMPS that end with the test that asked for them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
import scenes


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
