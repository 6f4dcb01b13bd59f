# SPDX-License-Identifier: GPL-2.0-or-later
"""The cases of a sweep: values of variables, and the name of a folder for each."""

from __future__ import annotations

import hashlib
import itertools
import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from nscd_lmp._core import NscdError

Variables = dict[str, Any]

LONGEST_NAME = 120  # characters; file systems take 255 bytes
# LAMMPS gives * and % a meaning in names of files, and commas one in formulas; shells give many.
UNSAFE = re.compile(r"[^A-Za-z0-9_.+=-]+")
OWN_COLUMNS = ("status", "seconds", "message", "warnings", "folder")


@dataclass(frozen=True)
class Case:
    """One run: the name of its folder, and the values of all variables."""

    name: str
    variables: Variables


def make_cases(
    variables: Mapping[str, Any] | None, cases: Iterable[Mapping[str, Any]] | None
) -> tuple[list[Case], Variables]:
    """Combine every case of a list with every point of a grid.

    Parameters
    ----------
    variables : mapping, optional
        Lists (also tuples, ranges, arrays) are the axes of the grid; any other value is the same in all cases.
    cases : iterable of mappings, optional
        The list.

    Returns
    -------
    list of Case
        In order of the list, then of the grid, whose last axis varies fastest.
    dict
        The values that are the same in all cases and not in their names.

    Raises
    ------
    NscdError
        There is no case, two are the same, or a name or value cannot be used.
    """
    given = {name: _plain(name, value) for name, value in (variables or {}).items()}
    axes = {name: values for name, values in given.items() if isinstance(values, list)}
    fixed = {name: value for name, value in given.items() if name not in axes}
    listed = [
        {name: _plain(name, value) for name, value in case.items()} for case in ([{}] if cases is None else cases)
    ]
    _check_axes(axes, listed, has_list=cases is not None)
    points = [dict(zip(axes, point, strict=True)) for point in itertools.product(*axes.values())]
    made = []
    for in_list, in_grid in itertools.product(listed, points):
        twice = (in_list.keys() & in_grid.keys()) | (in_list.keys() & fixed.keys())
        if twice:
            raise NscdError(f"'{sorted(twice)[0]}' is in variables and in cases: give each variable once")
        varied = in_list | in_grid
        made.append(Case(case_name(varied), varied | fixed))
    _check_names(made)
    return made, fixed


def case_name(varied: Variables) -> str:
    """Return a name of safe characters, with a hash if it says less than the values do."""
    plain = "_".join(f"{name}={_text(value)}" for name, value in varied.items()) or "case"
    name = UNSAFE.sub("_", plain)
    if name == plain and len(name) <= LONGEST_NAME:
        return name
    key = json.dumps(varied, sort_keys=True).encode()
    return f"{name[: LONGEST_NAME - 9]}-{hashlib.sha256(key).hexdigest()[:8]}"


def _text(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value)


def _plain(name: str, value: Any) -> Any:
    """Return the value as JSON keeps it, NumPy's as Python's."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, range | tuple | list):
        return [_plain(name, one) for one in value]
    if isinstance(value, dict):
        return {str(key): _plain(name, one) for key, one in value.items()}
    if value is None or isinstance(value, bool | int | float | str):
        return value
    raise NscdError(
        f"variable '{name}' has a value of type {type(value).__name__}: give numbers, strings, True, False or None,"
        " or lists of them"
    )


def _check_axes(axes: Mapping[str, Sequence[Any]], listed: Sequence[Variables], *, has_list: bool) -> None:
    empty = [name for name, values in axes.items() if not values]
    if empty:
        raise NscdError(f"variable '{empty[0]}' has no values, so the sweep has no cases: give one value at least")
    if not listed:
        raise NscdError("cases is empty, so there is nothing to run: give one case at least")
    if not axes and not has_list:
        raise NscdError("the sweep has no cases: give variables a list of values, or give cases")


def _check_names(cases: Sequence[Case]) -> None:
    for name in {name for case in cases for name in case.variables}:
        if name in OWN_COLUMNS:
            raise NscdError(f"'{name}' is a column of every sweep's table: give the variable another name")
        if not re.fullmatch(r"\w+", name):
            raise NscdError(f"'{name}' is no name of a variable: take letters, digits and _ only")
    seen: dict[str, int] = {}
    for number, case in enumerate(cases, 1):
        if case.name in seen:
            raise NscdError(f"cases {seen[case.name]} and {number} are the same, {case.name}: give each once")
        seen[case.name] = number
