# SPDX-License-Identifier: GPL-2.0-or-later
"""Run a script or Python function for many values of its variables.

Each case runs in a process and a folder of its own, DIR/NAME=VALUE,...; one
that fails is a row of the table DIR/sweep.csv like the others. Cases that are
finished are not run again: after Ctrl-C, or a kill, give the same command.
RUN is a LAMMPS script, FILE.py:FUNCTION or MODULE:FUNCTION.
"""

import argparse
import csv
import re
import warnings
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from nscd_lmp.commands._script_run import ScriptError
from nscd_lmp.sweeps.cases import OWN_COLUMNS
from nscd_lmp.sweeps.earlier import CHOICES, REFUSE
from nscd_lmp.sweeps.record import OK
from nscd_lmp.sweeps.sweep import sweep
from nscd_lmp.sweeps.table import Row, SweepTable
from nscd_lmp.sweeps.values import read_range, read_value, split_list

# Columns of the table on the terminal, if no results were asked for: these, or the first.
SHOWN = ("worst_overlap_ratio", "iterations", "unconverged_steps")
MOST_RESULTS = 5
MOST_MESSAGES = 10


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    parser.add_argument("run", metavar="RUN", help="LAMMPS input script, or Python function")
    parser.add_argument("--folder", "-o", type=Path, required=True, metavar="DIR", help="where all is kept")
    parser.add_argument(
        "--vary",
        action="append",
        default=[],
        metavar="NAME=V,V,...",
        help="values of a variable, an axis of the grid; A:B:N is N values from A to B, A:B:Nlog by equal factors;"
        " repeatable",
    )
    parser.add_argument(
        "--set", action="append", default=[], metavar="NAME=V", help="a value for all cases; repeatable"
    )
    parser.add_argument("--cases", type=Path, metavar="CSV", help="cases in place of a grid, a row each")
    parser.add_argument(
        "--results", default="", metavar="R,R,...", help="of a script: ke, f_nscd[3], v_name, NAME=FORMULA, ..."
    )
    parser.add_argument("--processes", type=int, default=1, metavar="N", help="cases side by side [1]")
    parser.add_argument("--ranks", type=int, default=1, metavar="N", help="MPI ranks of each case [1]")
    parser.add_argument("--timeout", type=float, metavar="S", help="stop a case after so many seconds")
    parser.add_argument("--retry", action="store_true", help="run again what failed earlier")
    parser.add_argument(
        "--stale",
        choices=CHOICES,
        default=REFUSE,
        help="cases that were finished before a change of the code: say so and stop, keep their results, or run them"
        " again and keep the old ones aside [refuse]",
    )
    parser.add_argument("--allow-failures", action="store_true", help="exit with 0 though cases have failed")


def main(arguments: argparse.Namespace) -> None:
    """Run the cases, and show the table."""
    axes, fixed = _named(arguments.vary, "--vary"), _named(arguments.set, "--set")
    both = sorted(axes.keys() & fixed.keys())
    if both:
        raise ScriptError(f"'{both[0]}' is in --vary and in --set: give each variable once")
    results = dict(_result(text) for text in split_list(arguments.results))
    cases = _read_cases(arguments.cases) if arguments.cases else None
    with warnings.catch_warnings():
        warnings.showwarning = _show_warning
        table = sweep(
            arguments.run,
            {name: _axis(text) for name, text in axes.items()} | {n: read_value(text) for n, text in fixed.items()},
            cases=cases,
            folder=arguments.folder,
            processes=arguments.processes,
            ranks=arguments.ranks,
            timeout=arguments.timeout,
            results=results,
            retry=arguments.retry,
            stale=arguments.stale,
        )
    varied = list(axes | (cases[0] if cases else {}))
    console = Console(highlight=False)
    console.print(closing_table(table, varied, [*fixed, *OWN_COLUMNS], list(results)))
    for row in table.failures[:MOST_MESSAGES]:
        console.print(f"{row['folder']}: {row['message']}", style="red", markup=False, soft_wrap=True)
    warned = [row for row in table if row["warnings"]]
    if warned:
        first = f"{warned[0]['folder']}: {warned[0]['warnings']}"
        console.print(f"{len(warned)} cases with warnings, in their column: {first}", markup=False, soft_wrap=True)
    console.print(str(table.path), markup=False, soft_wrap=True)
    if table.failures and not arguments.allow_failures:
        raise ScriptError(f"{len(table.failures)} of {len(table)} cases have failed: --retry runs them again")


def closing_table(table: SweepTable, varied: list[str], hidden: list[str], results: list[str]) -> Table:
    """Return the table for the terminal: what was varied, the results or the first of them, and how cases ended."""
    others = [name for name in table.columns if name not in (*varied, *hidden)]
    shown = [name for name in results if name in others]
    shown = shown or [name for name in SHOWN if name in others] or others[:MOST_RESULTS]
    columns = [*varied, *shown, "status", "seconds"]
    drawn = Table()
    for name in columns:
        drawn.add_column(Text(name), overflow="fold")
    for row in table:
        style = None if row["status"] == OK else "red"
        drawn.add_row(*(Text(_cell(row, name)) for name in columns), style=style)
    return drawn


def _cell(row: Row, name: str) -> str:
    value = row[name]
    return "" if value is None else f"{value:.4g}" if isinstance(value, float) else str(value)


def _named(texts: list[str], option: str) -> dict[str, str]:
    named: dict[str, str] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals or not name or not value:
            raise ScriptError(f"{option} {text} is not NAME=VALUE: write for instance {option} dt=1e-4")
        if name in named:
            raise ScriptError(f"'{name}' is given twice by {option}: give all its values at once, {name}=V,V,...")
        named[name] = value
    return named


def _axis(text: str) -> list[Any]:
    values: list[Any] = []
    for word in split_list(text):
        values += read_range(word) or [read_value(word)]
    return values


def _result(text: str) -> tuple[str, str]:
    named = re.fullmatch(r"(\w+)=([^=].*)", text)
    return (named[1], named[2]) if named else (text, text)


def _read_cases(path: Path) -> list[dict[str, Any]]:
    with open(path, newline="", encoding="utf-8-sig") as file:
        reader = csv.DictReader(file)
        rows = list(reader)
    head = reader.fieldnames or []
    twice = sorted({name for name in head if head.count(name) > 1})
    if twice:
        raise ScriptError(f"'{path}' has the column '{twice[0]}' twice: give each variable once")
    ragged = [number for number, row in enumerate(rows, 2) if None in row or None in row.values()]
    if ragged:
        raise ScriptError(f"line {ragged[0]} of '{path}' has not as many cells as its head: give each variable a value")
    return [{name: read_value(text) for name, text in row.items()} for row in rows]


def _show_warning(message: Any, *_: Any, **__: Any) -> None:
    Console(stderr=True, highlight=False).print(f"nscd-lmp: warning: {message}", markup=False, soft_wrap=True)
