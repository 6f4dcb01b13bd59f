# SPDX-License-Identifier: GPL-2.0-or-later
"""What the command lines of the analysis scripts share."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Callable, Sequence
from decimal import Decimal

import matplotlib
from chart import LENGTH_UNITS, STYLE
from rich.console import Console
from rich.table import Table

_NEGATIVE_EXPONENTIAL = re.compile(r"-(\d+\.?\d*|\.\d+)[eE][-+]?\d+")


def new_parser(description: str | None, output: str, frames: str = "frame") -> argparse.ArgumentParser:
    """Make a parser with the dump file and the options common to all scripts.

    Parameters
    ----------
    description : str or None
        Shown by ``--help``; the script's docstring.
    output : str
        Default name of the picture.
    frames : str
        What ``--frame`` chooses, for its help text.
    """
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dump", help="LAMMPS text dump: dump custom with id x y z radius ...")
    parser.add_argument("--output", "-o", default=output, metavar="PNG", help=f"[{output}]")
    parser.add_argument("--frame", type=int, default=-1, help=f"{frames}; from 0, or from the end with -1 [-1]")
    parser.add_argument(
        "--length-unit",
        choices=["auto", *LENGTH_UNITS],
        default="auto",
        help="unit of the picture for a dump in metres; raw: lengths as they are [auto]",
    )
    return parser


def add_plane_option(parser: argparse.ArgumentParser, meaning: str) -> None:
    """Add the repeatable ``--plane``."""
    parser.add_argument(
        "--plane",
        nargs=6,
        type=float,
        action="append",
        dest="planes",
        metavar=("X", "Y", "Z", "NX", "NY", "NZ"),
        help=f"{meaning}: a point, and a normal that points to the grains; repeatable",
    )


def positive_int(word: str) -> int:
    """Read a whole number of at least 1."""
    number = int(word)
    if number < 1:
        raise argparse.ArgumentTypeError(f"{number} given, at least 1 is needed")
    return number


def add_time_options(parser: argparse.ArgumentParser) -> None:
    """Add ``--dt`` and ``--every``."""
    parser.add_argument("--dt", type=float, help="time step of the LAMMPS run in s [time in steps]")
    parser.add_argument("--every", type=positive_int, default=1, help="use each EVERY-th frame [1]")


def plain_decimals(words: Sequence[str]) -> list[str]:
    """Rewrite -4e-3 as -0.004: argparse takes a negative number with an exponent for an option."""
    return [format(Decimal(word), "f") if _NEGATIVE_EXPONENTIAL.fullmatch(word) else word for word in words]


def print_table(title: str, rows: Sequence[tuple[str, str]]) -> None:
    """Print names and values."""
    table = Table(show_header=False)
    table.add_column(no_wrap=True)
    table.add_column(justify="right", no_wrap=True)
    for row in rows:
        table.add_row(*row)
    console = Console()
    console.print(title, style="bold", highlight=False)
    console.print(table)


def run(main: Callable[[Sequence[str]], None]) -> int:
    """Run a script on ``sys.argv``; an error in the user's data becomes a message and code 2."""
    try:
        with matplotlib.rc_context(STYLE):
            main(plain_decimals(sys.argv[1:]))
    except (ValueError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0
