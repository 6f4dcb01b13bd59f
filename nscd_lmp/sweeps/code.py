# SPDX-License-Identifier: GPL-2.0-or-later
"""The code that the results of a function depend on, as far as its own file has it."""

from __future__ import annotations

import ast
import hashlib
import inspect
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

Code = dict[str, str]


def code_of(function: Callable[..., Any], name: str) -> Code:
    """Return hashes of a function's code and of all that it uses of its file, by name.

    Comments, docstrings and layout do not count. Used is what the function names, and what that names in its turn:
    functions, classes and values at the top level of the file, and its imports. Other files are not looked at.

    Parameters
    ----------
    function : callable
        At the top level of a file.
    name : str
        By which the file knows it.
    """
    try:
        file = inspect.getsourcefile(inspect.unwrap(function))
        tree = ast.parse(Path(str(file)).read_text(encoding="utf-8-sig"))
    except (OSError, TypeError, SyntaxError, ValueError):  # there is no such file, or it is no longer what was run
        return {name: _hash(repr(getattr(getattr(function, "__code__", None), "co_code", "")))}
    parts = _parts(_WithoutDocstrings().visit(tree))
    found: Code = {}
    waiting = [name]
    while waiting:
        one = waiting.pop()
        if one in found or one not in parts:
            continue
        found[one] = _hash("\n".join(map(ast.unparse, parts[one])))
        waiting += [node.id for part in parts[one] for node in ast.walk(part) if isinstance(node, ast.Name)]
    return found


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]


class _WithoutDocstrings(ast.NodeTransformer):
    """Takes the docstrings out."""

    def _strip(self, node: Any) -> Any:
        self.generic_visit(node)
        if ast.get_docstring(node, clean=False) is not None:
            node.body = node.body[1:] or [ast.Pass()]
        return node

    visit_FunctionDef = visit_AsyncFunctionDef = visit_ClassDef = _strip


def _parts(tree: ast.Module) -> dict[str, list[ast.stmt]]:
    """Return the statements at the top level of a file that decide what a name means there."""
    parts: dict[str, list[ast.stmt]] = {}
    for statement in tree.body:
        for name in dict.fromkeys(_decided(statement)):
            parts.setdefault(name, []).append(statement)
    return parts


def _decided(statement: ast.stmt) -> Iterator[str]:
    if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        yield statement.name
    elif isinstance(statement, ast.Import | ast.ImportFrom):
        yield from (alias.asname or alias.name.partition(".")[0] for alias in statement.names)
    elif isinstance(statement, ast.Assign):
        yield from _named(*statement.targets)
    elif isinstance(statement, ast.AnnAssign | ast.AugAssign):
        yield from _named(statement.target)
    elif not _of_program(statement):  # a call or block may change whatever it names
        yield from _named(statement)


def _named(*nodes: ast.AST) -> Iterator[str]:
    for node in (one for top in nodes for one in ast.walk(top)):
        if isinstance(node, ast.Name):
            yield node.id
        elif isinstance(node, ast.FunctionDef | ast.ClassDef):
            yield node.name


def _of_program(statement: ast.stmt) -> bool:
    """Return whether it is the part under ``if __name__ == "__main__":``."""
    return isinstance(statement, ast.If) and any(
        isinstance(node, ast.Name) and node.id == "__name__" for node in ast.walk(statement.test)
    )
