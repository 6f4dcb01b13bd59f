# SPDX-License-Identifier: GPL-2.0-or-later
"""The pages of the documentation and the code blocks on them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parent.parent
README = ROOT / "README.md"
PAGES = [README, *sorted((ROOT / "docs").rglob("*.md"))]
BLOCK = re.compile(
    r"^(?:<!-- (?P<mark>[\w ]+): (?P<reason>.+?) -->\n+)?```(?P<language>\w*)[^\n]*\n(?P<text>.*?)^```$",
    re.M | re.S,
)


@dataclass
class Block:
    line: int
    mark: str | None
    reason: str | None
    language: str
    text: str
    above: str  # what stands between the block before and this one


def title(page: Path) -> str:
    """Return the place of a page, for the names of tests."""
    return str(page.relative_to(ROOT))


def blocks(page: Path) -> list[Block]:
    """Return the fenced code blocks of a page."""
    text, end, found = page.read_text(), 0, []
    for match in BLOCK.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        found.append(Block(line, **match.groupdict(), above=text[end : match.start()]))
        end = match.end()
    return found


def prose(page: Path) -> str:
    """Return the text of a page without its code blocks."""
    return BLOCK.sub("", page.read_text())
