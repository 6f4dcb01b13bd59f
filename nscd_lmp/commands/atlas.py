# SPDX-License-Identifier: GPL-2.0-or-later
"""Map where each method fails, over the two parameters that break it.

Each cell of a map is a run of a small scene, and is one of converged, slow,
stalled, diverged, energy grew, penetrated, lost atoms. Writes DIR/NAME.csv with
a row for every cell, NAME.png and NAME.svg. Cells that are finished are not run
again: after Ctrl-C, or a kill, give the same command.
"""

import argparse
from collections import Counter
from pathlib import Path

from rich.console import Console
from rich.table import Column, Table

from nscd_lmp.atlas import find_maps, make
from nscd_lmp.atlas.atlas import Made
from nscd_lmp.atlas.grid import Size
from nscd_lmp.atlas.outcomes import OUTCOMES
from nscd_lmp.commands._script_run import ScriptError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    parser.add_argument("name", nargs="?", default="all", metavar="NAME", help="one that --list shows [all]")
    parser.add_argument("--folder", "-o", type=Path, default=Path("atlas"), metavar="DIR", help="for all files [atlas]")
    parser.add_argument("--quick", action="store_true", help="a handful of cells of each map, in seconds")
    parser.add_argument("--processes", type=int, default=1, metavar="N", help="cases side by side [1]")
    parser.add_argument("--list", action="store_true", help="list the maps and end")


def main(arguments: argparse.Namespace) -> None:
    """Make the maps, and show how many cells had which outcome."""
    console = Console(highlight=False)
    if arguments.list:
        console.print(list_of_maps())
        return
    names = list(find_maps()) if arguments.name == "all" else [arguments.name]
    size = Size.QUICK if arguments.quick else Size.FULL
    made = [make(name, arguments.folder, size, arguments.processes) for name in names]
    console.print(table_of_outcomes(made))
    for one in made:
        console.print(str(one.pictures[0]), markup=False, soft_wrap=True)
    failures = [row for one in made for row in one.failures]
    for row in failures:
        console.print(f"{row['folder']}: {row['message']}", style="red", markup=False, soft_wrap=True)
    if failures:
        raise ScriptError(f"{len(failures)} cases have failed, and their cells are left out")


def list_of_maps() -> Table:
    """Return names, titles and numbers of cells of the maps."""
    table = Table(Column("name", no_wrap=True), "what is mapped", "cells")
    for name, one in find_maps().items():
        table.add_row(name, one.TITLE, str(len(one.PANELS) * len(one.X.values) * len(one.Y.values)))
    return table


def table_of_outcomes(made: list[Made]) -> Table:
    """Return how many cells of each map had which outcome, and how many failed without a word."""
    outcomes = [Column(name.replace(" ", "\n"), justify="right") for name in [*OUTCOMES, "not told"]]
    # narrow, so that no heading is cut where a line has 80 characters
    table = Table(Column("map", no_wrap=True), *outcomes, box=None, padding=(0, 1, 0, 0), pad_edge=False)
    for one in made:
        counted = Counter(cell["outcome"] for cell in one.cells)
        table.add_row(one.name, *(str(counted[name] or "") for name in OUTCOMES), str(len(one.silent) or ""))
    return table
