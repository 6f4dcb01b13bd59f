# SPDX-License-Identifier: GPL-2.0-or-later
"""What is refused and told of scenes is the same on all of several ranks."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from scenes import DOORS
from test_ranks import BUILDERS, execute

Told = dict[str, Any]


@pytest.fixture(scope="module", params=DOORS)
def told(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Told]:
    """Return the door and, for each case, the warnings and the error that each rank was told."""
    path: Path = tmp_path_factory.mktemp("ranks") / "told"
    execute(2, str(BUILDERS / "doors_ranks_scene.py"), request.param, str(path))
    return request.param, json.loads(path.read_text())


MOVED = r"(is moved by fix other|has been moved by another fix)"


@pytest.mark.parametrize(
    ("case", "error"),
    [("bonded", "is bonded, and special_bonds"), ("moved", MOVED), ("moved, new lists", MOVED)],
)
def test_all_ranks_are_refused_with_one_message(told: tuple[str, Told], case: str, error: str) -> None:
    _, answers = told
    (said,) = {refused for _, refused in answers[case]}
    assert re.search(error, said)


def test_exclusions_are_told_and_nothing_else_is_taken_for_one(told: tuple[str, Told]) -> None:
    door, answers = told
    for case in ("excluded", "mix", "mix, newton off"):
        for said, error in answers[case]:
            assert error == ""
            assert any("exclude" in one for one in said) == (door == "python" and case == "excluded")
