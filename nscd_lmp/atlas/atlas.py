# SPDX-License-Identifier: GPL-2.0-or-later
"""Maps found, run by the sweep, written as tables and drawn."""

from __future__ import annotations

import csv
import hashlib
import importlib
import pkgutil
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast

from nscd_lmp._core import NscdError
from nscd_lmp.atlas import maps, outcomes, scenes, trial
from nscd_lmp.atlas.draw import draw
from nscd_lmp.atlas.grid import Cell, Size, cells_of
from nscd_lmp.atlas.map import Map
from nscd_lmp.sweeps.record import write_text
from nscd_lmp.sweeps.sweep import sweep
from nscd_lmp.sweeps.table import SweepTable

CELLS = "cells.csv"  # of a case
ALL = "all"  # panels in one case


@dataclass
class Made:
    """A map that was made."""

    name: str
    table: Path
    pictures: list[Path]
    cells: list[Cell]
    failures: list[Cell] = field(default_factory=list)

    @property
    def silent(self) -> list[Cell]:
        """Return the cells that failed without a word of the software."""
        return [cell for cell in self.cells if outcomes.is_silent(cell["outcome"], cell["told"])]


def find_maps() -> dict[str, Map]:
    """Return the maps by name, in their order."""
    names = [module.name for module in pkgutil.iter_modules(maps.__path__) if not module.name.startswith("_")]
    found = {name: cast(Map, importlib.import_module(f"{maps.__name__}.{name}")) for name in names}
    return dict(sorted(found.items(), key=lambda entry: entry[1].ORDER))


def find_map(name: str) -> Map:
    """Return the map of this name."""
    found = find_maps()
    if name not in found:
        raise NscdError(f"there is no map '{name}': choose one of {', '.join(found)}")
    return found[name]


def run_panel(folder: Path, map: str, panel: str, size: str, code: str) -> dict[str, Any]:
    """Run the cells of a panel, or of all, one after another, into a table of the folder; a case of the sweep."""
    made = find_map(map)
    cells = cells_of(made.X, made.Y, Size(size))
    panels = list(made.PANELS) if panel == ALL else [panel]
    run = [(one, cell, made.run(one, cell)) for one in panels for cell in cells]
    rows = [{"panel": one, **cell, **columns} for one, cell, columns in run if columns is not None]
    _write_table(folder / CELLS, rows)
    return {"cells": len(rows)} | {name: sum(row["outcome"] == name for row in rows) for name in outcomes.OUTCOMES}


def make(name: str, folder: Path, size: Size = Size.FULL, processes: int = 1, progress: bool = True) -> Made:
    """Run a map, write its table and draw it.

    Cells that an earlier call has finished are not run again, unless the map's code has changed.

    Parameters
    ----------
    name : str
        Of :func:`find_maps`.
    folder : Path
        For ``NAME.csv``, ``NAME.png`` and ``NAME.svg``, and the folder ``NAME`` of the sweep.
    size : Size
    processes : int
        Cases side by side.
    progress : bool
        Show on standard error how far the sweep is.

    Returns
    -------
    Made

    Raises
    ------
    NscdError
        There is no such map, or none of its cells has run.
    """
    made = find_map(name)
    code = fingerprint(made)
    panels = made.PANELS if size is Size.FULL else (ALL,)  # a process starts in the time of many quick cells
    cases = [{"map": name, "panel": panel, "size": size.value, "code": code} for panel in panels]
    home = folder / name
    table = sweep(run_panel, cases=cases, folder=home, processes=processes, stale="rerun", progress=progress)
    cells = [cell for row in table if row["status"] == "ok" for cell in _read_table(Path(row["folder"]) / CELLS)]
    if not cells:
        raise NscdError(f"no cell of map {name} has run: {_first_message(table)}")
    path = folder / f"{name}.csv"
    _write_table(path, cells)
    return Made(name, path, draw(made, cells, folder / name), cells, table.failures)


def fingerprint(made: Map) -> str:
    """Return a hash of all code that decides what a map shows."""
    modules: list[Any] = [made, outcomes, scenes, trial]
    shared = sorted(Path(maps.__path__[0]).glob("_[a-z]*.py"))  # of several maps
    text = b"".join(path.read_bytes() for path in (*(Path(module.__file__) for module in modules), *shared))
    return hashlib.sha256(text).hexdigest()[:8]


def _first_message(table: SweepTable) -> str:
    return str(table.failures[0]["message"]) if table.failures else "there are none"


def _write_table(path: Path, rows: list[Cell]) -> None:
    names = list(dict.fromkeys(name for row in rows for name in row))
    lines = [names, *([row.get(name, "") for name in names] for row in rows)]
    text = "".join(_csv_line(line) for line in lines)
    write_text(path, text)


def _csv_line(values: list[Any]) -> str:
    quoted = (str(value).replace('"', '""') for value in values)
    return ",".join(f'"{text}"' if any(sign in text for sign in ',"\n') else text for text in quoted) + "\n"


def _read_table(path: Path) -> list[Cell]:
    with open(path, newline="", encoding="utf-8") as file:
        return [{name: _value(text) for name, text in row.items()} for row in csv.DictReader(file)]


def _value(text: str) -> Any:
    try:
        return float(text)
    except ValueError:
        return text
