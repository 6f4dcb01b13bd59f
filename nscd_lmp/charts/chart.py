# SPDX-License-Identifier: GPL-2.0-or-later
"""A chart: the runs of a scene by all methods, their table, and the picture."""

from __future__ import annotations

import csv
import importlib
import io
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any, Literal

from nscd_lmp._core import NscdError
from nscd_lmp._version import __version__
from nscd_lmp.charts import scenes
from nscd_lmp.charts.draw import draw
from nscd_lmp.charts.pareto import COST, is_number
from nscd_lmp.charts.size import Size
from nscd_lmp.sweeps.record import write_text
from nscd_lmp.sweeps.sweep import sweep

Row = dict[str, Any]

LEFT_OUT = ("seconds", "folder", "warnings")  # columns of the sweep's table that say nothing of the chart
TEXT = ("chart", "method", "status", "message", "version", "processor", "size")


@dataclass(frozen=True)
class Chart:
    """What was made: rows of the table, its file, and the pictures."""

    name: str
    scene: ModuleType
    rows: list[Row]
    table: Path
    pictures: list[Path]

    @property
    def failures(self) -> list[Row]:
        """The rows of runs that failed."""
        return [row for row in self.rows if row["status"] != "ok"]


def find_scene(name: str) -> ModuleType:
    """Return the scene of a chart."""
    names = scenes.names()
    if name not in names:
        raise NscdError(f"there is no chart '{name}': choose one of {', '.join(names)}, or all")
    return importlib.import_module(f"{scenes.__name__}.{name}")


def make(
    name: str,
    folder: Path,
    size: Size = Size.FULL,
    *,
    processes: int = 1,
    ranks: int = 1,
    timeout: float | None = None,
    retry: bool = False,
    stale: Literal["refuse", "keep", "rerun"] = "refuse",
    progress: bool = True,
) -> Chart:
    """Run what a chart has not got yet, and draw it.

    Parameters
    ----------
    name : str
        Of the scene.
    folder : Path
        For ``NAME.csv``, ``NAME.png``, ``NAME.svg``, and the runs in ``NAME.runs``.
    size : Size
    processes : int
        Cases side by side. They share memory and caches: take 1 where seconds are to be published.
    ranks, timeout, retry, stale, progress
        As of :func:`nscd_lmp.sweep`.
    """
    scene = find_scene(name)
    swept = sweep(
        scene.run,
        cases=scene.cases(size),
        folder=folder / f"{name}.runs",
        processes=processes,
        ranks=ranks,
        timeout=timeout,
        retry=retry,
        stale=stale,
        progress=progress,
    )
    origin = {"size": size.value, "version": __version__, "processor": _processor()}
    rows = []
    for row in swept.rows:
        kept = {key: value for key, value in row.items() if key not in LEFT_OUT}
        solve, simulated = kept.get("solve_seconds"), kept.get("simulated")
        kept[COST] = solve / simulated if is_number(solve) and is_number(simulated) else None
        rows.append({"chart": name} | kept | origin)
    table = folder / f"{name}.csv"
    _write(rows, table)
    return Chart(name, scene, rows, table, draw(scene, rows, folder / name))


def redraw(name: str, folder: Path) -> Chart:
    """Draw a chart from its table, without any run."""
    scene, table = find_scene(name), folder / f"{name}.csv"
    if not table.is_file():
        raise NscdError(f"there is no table '{table}' to draw: make the chart first, without --draw-only")
    rows = read(table)
    return Chart(name, scene, rows, table, draw(scene, rows, folder / name))


def read(table: Path) -> list[Row]:
    """Return the rows of a chart's table; empty cells are None."""
    with open(table, newline="", encoding="utf-8") as file:
        return [{key: _value(key, text) for key, text in row.items()} for row in csv.DictReader(file)]


def _value(column: str, text: str) -> Any:
    if column in TEXT:
        return text
    if text == "":
        return None
    try:
        return float(text)
    except ValueError:
        return text


def _write(rows: list[Row], path: Path) -> None:
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    write_text(path, text.getvalue())


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return ""
    return next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), "")
