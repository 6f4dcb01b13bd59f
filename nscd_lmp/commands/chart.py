# SPDX-License-Identifier: GPL-2.0-or-later
"""Draw error against time, for rigid and for penalty contacts.

Runs a scene by every solver under both contact laws, over tolerances and time
steps, and by LAMMPS' penalty models over stiffness and time step, in one go and
timed in one way. DIR/NAME.csv has the numbers, DIR/NAME.png and .svg the
picture. After Ctrl-C or a kill the same command goes on.
"""

import argparse
from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from nscd_lmp.commands._script_run import ScriptError
from nscd_lmp.sweeps.earlier import CHOICES, REFUSE

ALL = "all"
MOST_MESSAGES = 5


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    parser.add_argument("names", nargs="*", metavar="NAME", help="charts that --list shows, or all")
    parser.add_argument("--list", action="store_true", help="show the names of the charts")
    parser.add_argument("--quick", action="store_true", help="few small runs, seconds in all, to see that it works")
    parser.add_argument("--folder", "-o", type=Path, metavar="DIR", help="[charts, with --quick charts_quick]")
    parser.add_argument("--draw-only", action="store_true", help="draw again from the tables, without any run")
    parser.add_argument(
        "--processes", type=int, default=1, metavar="N", help="cases side by side; they slow each other [1]"
    )
    parser.add_argument("--ranks", type=int, default=1, metavar="N", help="MPI ranks of each case [1]")
    parser.add_argument("--timeout", type=float, metavar="S", help="stop a case after so many seconds")
    parser.add_argument("--retry", action="store_true", help="run again what failed earlier")
    parser.add_argument(
        "--stale", choices=CHOICES, default=REFUSE, help="runs of earlier code: as of nscd-lmp sweep [refuse]"
    )


def main(arguments: argparse.Namespace) -> None:
    """Make the charts, one after another."""
    from nscd_lmp.charts import chart, scenes
    from nscd_lmp.charts.size import Size

    console = Console(highlight=False)
    if not console.is_terminal:
        console = Console(highlight=False, width=160)  # a file has room
    if arguments.list:
        console.print(_list(scenes.find_scenes()))
        return
    if not arguments.names:
        raise ScriptError("no chart is named: give names that --list shows, or all")
    names = list(scenes.find_scenes()) if ALL in arguments.names else arguments.names
    for name in names:
        chart.find_scene(name)
    size = Size.QUICK if arguments.quick else Size.FULL
    folder = arguments.folder or Path("charts_quick" if arguments.quick else "charts")
    failed = 0
    for name in names:
        if arguments.draw_only:
            made = chart.redraw(name, folder)
        else:
            made = chart.make(
                name,
                folder,
                size,
                processes=arguments.processes,
                ranks=arguments.ranks,
                timeout=arguments.timeout,
                retry=arguments.retry,
                stale=arguments.stale,
            )
        _report(console, made)
        failed += len(made.failures)
    if failed and arguments.quick:
        raise ScriptError(f"{failed} runs have failed: --retry runs them again")


def _list(found: dict) -> Table:
    table = Table(show_header=False)
    for name, scene in found.items():
        table.add_row(name, Text(scene.TITLE))
    return table


def _report(console: Console, made) -> None:
    """Print what was made: for each error the cheapest rigid and penalty runs below powers of ten."""
    from nscd_lmp.charts.report import closing_table

    console.print(closing_table(made.scene, made.rows))
    for row in made.failures[:MOST_MESSAGES]:
        console.print(f"{row['method']}, dt {row['dt']:g}: {row['message']}", style="red", markup=False)
    if len(made.failures) > MOST_MESSAGES:
        console.print(f"... {len(made.failures)} runs failed: column message of {made.table}", markup=False)
    for path in (made.table, *made.pictures):
        console.print(str(path), markup=False, soft_wrap=True)
