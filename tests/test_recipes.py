# SPDX-License-Identifier: GPL-2.0-or-later
"""The C++ listings of the documentation: built into the core's tests, which ask of them what they ask of every other.

A block in ``cpp`` is a whole file, that which the text above it names last. Others have ``<!-- not built: reason -->``.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from core_programs import ROOT, SANITIZERS, SOURCES, Program, build, names
from pages import PAGES, blocks, title

PAGE = ROOT / "docs" / "add_a_local_law.md"
# Tests that have to be told of a listing: the page says so, and what to add.
NOT_TOLD = (
    "one_visit_of_each_law_is_as_its_header_says",
    "what_is_called_solved_is_solved_by_the_impulses_alone",
)


def listings() -> dict[str, str]:
    """Return the listings by the places of their files."""
    found = {}
    for page in PAGES:
        for block in blocks(page):
            if block.language != "cpp" or block.mark is not None:
                continue
            named = re.findall(r"`([\w/]+\.cpp)`", block.above)
            assert named, f"{title(page)}, block at line {block.line}: which file it is does not stand above it"
            found[named[-1]] = block.text
    return found


def asked() -> list[str]:
    """Return the files of the core's tests that the page says take a new solver or law."""
    return sorted(set(re.findall(r"`tests/core/(\w+\.cpp)`", PAGE.read_text())))


@pytest.fixture(scope="module")
def with_listings(build_folder: Callable[[str], Path]) -> Program:
    """Return the core's tests with the listings as files; all else is shared with test_core.py."""
    folder = build_folder("core_sanitized")
    for place, text in listings().items():
        file = folder / "recipes" / place
        file.parent.mkdir(parents=True, exist_ok=True)
        if not file.exists() or file.read_text() != text:
            file.write_text(text)
    for file in (folder / "recipes").rglob("*.cpp"):
        if str(file.relative_to(folder / "recipes")) not in listings():
            file.unlink()
    return build(folder, "core_recipe_tests", SANITIZERS, names(*asked()), f"-DNSCD_RECIPES={folder / 'recipes'}")


def test_listings_are_new_files_beside_their_kind() -> None:
    assert len(listings()) == 4
    for place in listings():
        assert list((ROOT / place).parent.glob("*.cpp")) and not (ROOT / place).exists()


def test_the_page_names_tests_that_are_there() -> None:
    assert len(asked()) >= 7 and all((SOURCES / file).exists() for file in asked())


@pytest.mark.parametrize("name", [name for name in names(*asked()) if name not in NOT_TOLD])
def test_listings_pass(with_listings: Program, name: str) -> None:
    with_listings.check(name)


# Which also shows that the listings are there.
@pytest.mark.parametrize("name", NOT_TOLD)
def test_the_page_says_which_tests_have_to_be_told(with_listings: Program, name: str) -> None:
    assert f"`{name}`" in PAGE.read_text()
    assert with_listings.failure(name)
