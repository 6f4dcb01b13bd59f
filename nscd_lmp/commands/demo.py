# SPDX-License-Identifier: GPL-2.0-or-later
"""Run the sedimentation of 500 balls and picture the bed.

The scene of Barboteu and Dumont (2017), section 5.2, by contact law gap at time
steps of 2e-4 s: balls fall into a box until they rest. Writes a dump, a log and
three pictures.
"""

import argparse
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import resources
from pathlib import Path

from rich.console import Console
from rich.table import Table

from nscd_lmp._choices import SOLVERS
from nscd_lmp.commands._script_run import ScriptError, run_script

DUMP = "dump.sedimentation"
LOG = "log.sedimentation"
TIMESTEP = 2e-4  # s
FRAMES = 100
PAPER_GRAINS = 500
PAPER_BOX = 8e-3  # m
SETTLING_TIME = 0.1  # s, of the paper's balls until kinetic energy is 1/1000 of its maximum
FEWEST_GRAINS = 10  # fewer would need a box narrower than the largest of them


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    parser.add_argument(
        "--output",
        "-o",
        type=Path,
        default=Path("nscd-demo"),
        metavar="DIR",
        help="for the files [nscd-demo]",
    )
    parser.add_argument(
        "--n", type=int, default=PAPER_GRAINS, help=f"number of grains, the box grows along [{PAPER_GRAINS}]"
    )
    parser.add_argument(
        "--solver", choices=list(SOLVERS), default="auto", metavar="NAME", help="one that `nscd-lmp info` lists [auto]"
    )


def main(arguments: argparse.Namespace) -> None:
    """Run the scene, then the analysis, and print where the files are."""
    if arguments.n < FEWEST_GRAINS:
        raise ScriptError(f"--n {arguments.n} is too few for the scene: take at least {FEWEST_GRAINS}")
    console = Console(highlight=False)
    width = PAPER_BOX * (arguments.n / PAPER_GRAINS) ** (1 / 3)
    package = resources.files("nscd_lmp")
    with resources.as_file(package / "inputs") as inputs, resources.as_file(package / "analysis") as analysis:
        arguments.output.mkdir(parents=True, exist_ok=True)
        with _working_in(arguments.output):
            variables = {"inputs": str(inputs), "n": str(arguments.n), "solver": arguments.solver}
            run_script(inputs / "in.sedimentation", list((variables | _scene(width)).items()), log=LOG)
            with console.status("drawing the pictures"):
                pictures = _draw(analysis, width)
    console.print(_files(arguments.output, pictures))


def _scene(width: float) -> dict[str, str]:
    """Return variables of the script for a box of this width (m) and a run long enough to fill it."""
    steps = round(SETTLING_TIME * (width / PAPER_BOX) ** 0.5 / TIMESTEP)
    return {
        "lx": repr(width),
        "dt": repr(TIMESTEP),
        "steps": str(steps),
        "every": str(-(-steps // FRAMES)),
        "law": "gap",
        # with a warm start (42) calls steps solved that are off (docs/method.md)
        "criterion": "natural",
        "tol": "1e-3",
        "warmstart": "yes",
        "dump": DUMP,
    }


def _draw(analysis: Path, width: float) -> dict[str, str]:
    """Run the analysis scripts side by side; return their pictures by what they show."""
    planes = ["0 0 0 0 0 1", "0 0 0 1 0 0", f"{width!r} 0 0 -1 0 0", "0 0 0 0 1 0", f"0 {width!r} 0 0 -1 0"]
    walls = [word for plane in planes for word in ("--plane", *plane.split())]
    times = ["--dt", repr(TIMESTEP)]
    options = {"bed_picture": [], "kinetic_energy": times, "overlap": times + walls}
    running = {}
    for script, words in options.items():
        command = [sys.executable, str(analysis / f"{script}.py"), DUMP, "-o", f"{script}.png", *words]
        running[script] = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    try:
        for script, process in running.items():
            _, errors = process.communicate()
            if process.returncode != 0:
                raise ScriptError(f"{script}.py ended with code {process.returncode}: {errors.strip()}")
    finally:
        for process in running.values():  # those that still run when one failed, or Ctrl-C came
            process.kill()
            process.wait()
    return {script.replace("_", " "): f"{script}.png" for script in options}


def _files(folder: Path, pictures: dict[str, str]) -> Table:
    table = Table(show_header=False)
    table.add_column(no_wrap=True)
    table.add_column(overflow="fold")
    for shown, picture in pictures.items():
        table.add_row(shown, str(folder / picture))
    table.add_row("positions in time", str(folder / DUMP))
    table.add_row("LAMMPS' log", str(folder / LOG))
    return table


@contextmanager
def _working_in(folder: Path) -> Iterator[None]:
    """Change the working directory: LAMMPS cannot take paths with blanks, but plain file names."""
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)
