# SPDX-License-Identifier: GPL-2.0-or-later
"""Run a LAMMPS script with a progress bar and a closing table.

The script runs in this process as by `lmp -in SCRIPT -var ...`. What LAMMPS
prints is in its log file; --screen shows it here, in place of the bar. Ctrl-C
ends the run after a whole step and goes on with the commands behind it, so that
what the script writes at its end is written; Ctrl-C again ends at once. So does
SIGTERM, which batch systems send when the time is up.
"""

import argparse
from pathlib import Path

from nscd_lmp.commands._script_run import ScriptError, run_script


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    parser.add_argument("script", metavar="SCRIPT", type=Path, help="LAMMPS input script")
    parser.add_argument(
        "-var",
        "-v",
        nargs="+",
        action="append",
        default=[],
        dest="variables",
        metavar=("NAME", "VALUE"),
        help="set an index variable of the script, as lmp does; repeatable",
    )
    parser.add_argument("--log", metavar="FILE", help="LAMMPS' log file, none for no log [log.lammps]")
    parser.add_argument("--screen", action="store_true", help="show what LAMMPS prints, without a bar")


def main(arguments: argparse.Namespace) -> None:
    """Run the script."""
    for name, *values in arguments.variables:
        if not values:
            raise ScriptError(f"-var {name} has no value: write -var NAME VALUE")
    run_script(arguments.script, arguments.variables, log=arguments.log, screen=arguments.screen)
