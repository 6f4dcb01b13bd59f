# SPDX-License-Identifier: GPL-2.0-or-later
"""The program ``nscd-lmp``: one subcommand for every module of :mod:`nscd_lmp.commands`."""

import argparse
import importlib
import pkgutil
import re
import sys
from collections.abc import Sequence
from types import ModuleType

from nscd_lmp import commands
from nscd_lmp._core import NscdError
from nscd_lmp._version import __version__
from nscd_lmp.commands._script_run import ScriptError
from nscd_lmp.commands._signals import exit_code, signals_heard

EXIT_ERROR = 1

DESCRIPTION = "Hard grains in LAMMPS by nonsmooth contact dynamics (NSCD): scripts run, swept, charted and mapped."

# argparse takes only -1 and -0.5 for numbers; -4e-3 is one too.
NEGATIVE_NUMBER = re.compile(r"-\.?\d")


def find_commands() -> dict[str, ModuleType]:
    """Return the modules of the subcommands by name; a leading underscore marks what they share."""
    names = [module.name for module in pkgutil.iter_modules(commands.__path__)]
    subcommands = [name for name in names if not name.startswith("_")]
    return {name: importlib.import_module(f"{commands.__name__}.{name}") for name in subcommands}


def new_parser() -> argparse.ArgumentParser:
    """Return the parser of the program with all subcommands."""
    parser = argparse.ArgumentParser(prog="nscd-lmp", description=DESCRIPTION)
    parser.add_argument("--version", action="version", version=f"nscd_lmp {__version__}")
    subparsers = parser.add_subparsers(metavar="COMMAND", required=True)
    for name, module in find_commands().items():
        text = module.__doc__ or ""
        command = subparsers.add_parser(
            name,
            help=text.splitlines()[0],
            description=text,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        command._negative_number_matcher = NEGATIVE_NUMBER
        module.add_arguments(command)
        command.set_defaults(main=module.main)
    return parser


def main(words: Sequence[str] | None = None) -> int:
    """Run the program.

    Parameters
    ----------
    words : sequence of str, optional
        The command line without the program's name; that of the process if left out.

    Returns
    -------
    int
        Exit code: 0, 1 after an error, 130 after Ctrl-C, 143 after SIGTERM. With a script that ends by LAMMPS'
        ``quit N`` this does not return: the process ends with code N.
    """
    arguments = new_parser().parse_args(words)
    try:
        with signals_heard():
            arguments.main(arguments)
    except (ScriptError, NscdError, OSError) as error:
        print(f"nscd-lmp: error: {error}", file=sys.stderr)
        return EXIT_ERROR
    except KeyboardInterrupt as interrupt:
        print("nscd-lmp: interrupted", file=sys.stderr)
        return exit_code(interrupt)
    return 0
