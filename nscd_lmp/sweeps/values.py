# SPDX-License-Identifier: GPL-2.0-or-later
"""Values of variables as words of a command line."""

from __future__ import annotations

import re

import numpy as np

from nscd_lmp._core import NscdError

RANGE = re.compile(r"([^:]+):([^:]+):(\d+)(log)?")


def read_value(word: str) -> int | float | str:
    """Return the number that a word is, or the word."""
    if not re.fullmatch(r"[-+.\deE]+", word):
        return word
    for kind in (int, float):
        try:
            return kind(word)
        except ValueError:
            continue
    return word


def read_range(word: str) -> list[float] | None:
    """Return the values of ``A:B:N`` or ``A:B:Nlog``, both ends among them; None for another word.

    Raises
    ------
    NscdError
        There is no such range.
    """
    found = RANGE.fullmatch(word)
    if not found:
        return None
    first, last, count = read_value(found[1]), read_value(found[2]), int(found[3])
    if isinstance(first, str) or isinstance(last, str):
        return None
    if count < 2 or (found[4] and not (first > 0 and last > 0)):
        raise NscdError(f"'{word}' is no range: write A:B:N with N of 2 at least, and for A:B:Nlog A and B above 0")
    values = np.geomspace(first, last, count) if found[4] else np.linspace(first, last, count)
    # 12 digits: 1e-4 is not to become 0.00010000000000000009 in a folder's name
    short = [float(f"{value:.12g}") for value in values]
    whole = isinstance(first, int) and isinstance(last, int) and all(value.is_integer() for value in short)
    return [int(value) for value in short] if whole else short


def split_list(text: str) -> list[str]:
    """Return the parts between commas that are in no brackets."""
    parts, depth = [""], 0
    for letter in text:
        depth += (letter in "([{") - (letter in ")]}")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return [part.strip() for part in parts if part.strip()]
