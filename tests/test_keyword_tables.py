# SPDX-License-Identifier: GPL-2.0-or-later
"""Keywords stand in one table, in the core: docs, signature and docstring are those that are made from it."""

from __future__ import annotations

import importlib.util
import inspect
from pathlib import Path
from types import ModuleType

import pytest

import nscd_lmp
from nscd_lmp._choices import KEYWORDS

pytestmark = pytest.mark.fast

ROOT = Path(__file__).parents[1]
PYTHON_ALONE = {"lmp", "group", "door", "materials", "walls"}


@pytest.fixture(scope="module")
def tables() -> ModuleType:
    spec = importlib.util.spec_from_file_location("keyword_tables", ROOT / "docs/keyword_tables.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_docs_and_docstring_are_made_from_the_table(tables: ModuleType) -> None:
    for path, text in tables.texts().items():
        assert path.read_text() == text, f"{path} is not what docs/keyword_tables.py writes: run it"


def test_attach_takes_every_keyword_and_has_its_default() -> None:
    parameters = inspect.signature(nscd_lmp.attach).parameters
    assert set(parameters) - PYTHON_ALONE == {name for name, keyword in KEYWORDS.items() if not keyword.repeats}
    for name, keyword in KEYWORDS.items():
        given = None if keyword.repeats else parameters[name].default
        if given is None or name == "paper":  # what `paper` may set, and what depends on others
            continue
        assert keyword.value == (given if isinstance(given, str) else f"{given:g}"), name


def test_a_keyword_of_the_table_is_told_of_whole() -> None:
    for keyword in KEYWORDS.values():
        assert keyword.doc and keyword.default, keyword.name
        assert keyword.kind in {"number", "whole number", "number or stick", "yes or no", "word"} or keyword.repeats
        assert bool(keyword.choices) == (keyword.kind == "word"), keyword.name
