# SPDX-License-Identifier: GPL-2.0-or-later
"""Write what the docs say of fix nscd's keywords from the one table in the core (settings/keywords.cpp).

Three texts are made: the table of fix_nscd.md, the signature of `attach` in python.md, and the parameters in the
docstring of `nscd_lmp.attach`. Install the package first; a test holds the texts to the table.

    python docs/keyword_tables.py
"""

from __future__ import annotations

import inspect
import re
import textwrap
from pathlib import Path

import nscd_lmp
from nscd_lmp import _core
from nscd_lmp._choices import KEYWORDS, Keyword

DOCS = Path(__file__).resolve().parent
FIX, PYTHON, ATTACH = DOCS / "fix_nscd.md", DOCS / "python.md", DOCS.parent / "nscd_lmp/door/attach.py"
TYPES = {
    "number": "float",
    "whole number": "int",
    "yes or no": "bool",
    "word": "str",
    "number or stick": 'float or "stick"',
}
INDENT = " " * 4
WIDTH = 120

# What Python has in place of a keyword, or beside it.
OWN = {
    "solver": (
        "str or callable",
        "A name of :data:`nscd_lmp.SOLVERS`, or a function that takes a :class:`ContactSystem` and returns the impulses"
        " (N s), a float64 array of shape (n,), with friction (n, 2) in a planar scene and (n, 3) in space.",
    ),
    "law": ("str", "A name of :data:`nscd_lmp.LAWS`, the contact law."),
    "material": (
        "dict",
        "What contacts of two types of atoms have of their own: ``{(1, 2): nscd_lmp.Material(friction=0.3)}``. Of"
        " several that name a pair the later ones hold. With ``pair_style nscd`` give them to its ``pair_coeff``.",
    ),
    "paper": (
        "bool",
        'The settings of Barboteu & Dumont (2017) for what is None here: ``pdas``, ``moreau``, ``criterion="paper"``,'
        " tol 1e-7 m/s, no warm start.",
    ),
    "wall": (
        "sequence of Wall",
        ":class:`nscd_lmp.Plane`, :class:`nscd_lmp.Planes`, :class:`nscd_lmp.Cylinder`, and how they move from here on."
        " None: those that :func:`nscd_lmp.scene` was given, else none.",
    ),
}
PARAMETERS = {"material": "materials", "wall": "walls"}


def between(text: str, first: str, last: str, new: str) -> str:
    """Return `text` with what lies between two of its lines replaced."""
    start = text.index(first) + len(first)
    return text[:start] + new + text[text.index(last, start) :]


def table() -> str:
    """Return the rows of fix_nscd.md's table."""
    rows = (
        f"| *{k.name}* | {k.doc} | {k.range} | {k.default if k.default.strip('*') else ''} |\n"
        for k in KEYWORDS.values()
    )
    return "".join(rows)


def python_words(words: str) -> str:
    """Return what stands between two stars, as Python writes it."""
    match words.split():
        case [word] if word in KEYWORDS:
            return f"`{word}`"
        case ["yes" | "no" as word]:
            return "True" if word == "yes" else "False"
        case [word]:
            return f'``"{word}"``'
        case [keyword, word] if keyword in KEYWORDS:
            return f'``{keyword}="{word}"``'
        case _:
            return words


def in_python(text: str) -> str:
    """Return a text of the table without its markup, as a docstring has it."""
    text = re.sub(r"\[([^]]+)\]\(([^)#]+)[^)]*\)", lambda m: f"docs/{m[2]}", text)
    text = re.sub(r"f_ID\[(\d+)\]", lambda m: f"the column ``{_core.REPORT_COLUMNS[int(m[1]) - 1]}``", text)
    return re.sub(r"\*([^*]+)\*", lambda m: python_words(m[1]), text)


def parameter(keyword: Keyword) -> str:
    """Return a keyword's entry in the docstring."""
    name = PARAMETERS.get(keyword.name, keyword.name)
    optional = inspect.signature(nscd_lmp.attach).parameters[name].default is None
    kind, text = OWN.get(keyword.name, (TYPES.get(keyword.kind, ""), ""))
    if not text:
        text = in_python(keyword.doc)
        text = text[0].upper() + text[1:] + (f"; {keyword.range}." if keyword.range else ".")
    if optional and keyword.name not in PARAMETERS:
        text += f" None: {in_python(keyword.default)}."
    kind += ", optional" if optional else ""
    body = textwrap.fill(text, WIDTH, initial_indent=2 * INDENT, subsequent_indent=2 * INDENT, break_long_words=False)
    return f"{INDENT}{name} : {kind}\n{body}\n"


def signature() -> str:
    """Return the signature of attach, as python.md has it."""
    words = []
    for one in inspect.signature(nscd_lmp.attach).parameters.values():
        if one.kind is one.KEYWORD_ONLY and "*" not in words:
            words.append("*")
        default = "" if one.default is one.empty else f"={one.default!r}"
        words.append(one.name + default.replace("'", '"'))
    return textwrap.fill(f"`attach({', '.join(words)})`", WIDTH, break_on_hyphens=False)


def texts() -> dict[Path, str]:
    """Return the three files as they have to be."""
    fix, python, attach = (path.read_text() for path in (FIX, PYTHON, ATTACH))
    group = "        Atoms to move; the others are obstacles of infinite mass.\n"
    parameters = "".join(map(parameter, KEYWORDS.values()))
    return {
        FIX: between(fix, "| keyword | value | range | default |\n|---|---|---|---|\n", "\nWhat stands", table()),
        PYTHON: between(python, "## attach\n\n", "\n\nUp to `threads`", signature()),
        ATTACH: between(attach, group, "    door : str\n", parameters),
    }


if __name__ == "__main__":
    for path, text in texts().items():
        path.write_text(text)
