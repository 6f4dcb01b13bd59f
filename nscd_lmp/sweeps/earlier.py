# SPDX-License-Identifier: GPL-2.0-or-later
"""Results of earlier code: what has changed since, and where they are kept once they are superseded."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from nscd_lmp._core import NscdError
from nscd_lmp.sweeps.record import RESULT, write_json

Key = dict[str, Any]

REFUSE, KEEP, RERUN = "refuse", "keep", "rerun"
CHOICES = (REFUSE, KEEP, RERUN)
SUPERSEDED = "superseded"  # folder of cases; with .csv, their table


def changes(before: Key, now: Key) -> list[str]:
    """Return what a result depends on and was not the same when it was made, in words."""
    told = []
    if json.dumps(before.get("variables")) != json.dumps(now.get("variables")):  # in which NaN is NaN
        told.append("the variables' values")
    if before.get("ranks") != now.get("ranks"):
        told.append(f"ranks ({before.get('ranks')}, now {now.get('ranks')})")
    if before.get("results", {}) != now.get("results", {}):
        told.append("the results asked for")
    old, new = before.get("code"), now["code"]
    if not isinstance(old, dict):
        return [*told, "the code"]
    return told + [name for name in dict.fromkeys([*new, *old]) if old.get(name) != new.get(name)]


def refuse(folder: Path, cases: int, changed: list[str]) -> None:
    """Raise, since finished results are of other code.

    Parameters
    ----------
    folder : Path
        Of the sweep.
    cases : int
        How many have such a result.
    changed : list of str
        What has changed, of all of them.
    """
    names = ", ".join(dict.fromkeys(changed))
    raise NscdError(
        f"{cases} finished cases in '{folder}' were run before a change of {names}:"
        ' stale="keep" takes their results as they are, stale="rerun" runs them again and keeps the old ones in'
        f" {folder / SUPERSEDED}, another folder"
        " leaves all there is alone (on the command line --stale keep, --stale rerun)"
    )


def supersede(folder: Path, result: dict[str, Any], changed: list[str]) -> None:
    """Move the folder of a case to the superseded ones, and mark its result."""
    home = folder.parent / SUPERSEDED
    home.mkdir(exist_ok=True)
    place, number = home / folder.name, 1
    while place.exists():
        number += 1
        place = home / f"{folder.name}.{number}"
    write_json(folder / RESULT, result | {SUPERSEDED: mark(changed)})
    os.rename(folder, place)


def mark(changed: list[str]) -> str:
    """Return what a row says of a result that is older than a change."""
    return f"run before a change of {', '.join(changed)}"
