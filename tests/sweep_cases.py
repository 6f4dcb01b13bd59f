# SPDX-License-Identifier: GPL-2.0-or-later
"""What the tests of sweeps run: a script, functions, and as a program a sweep to be ended, ``sweep_cases.py RANKS``."""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import processes

import nscd_lmp

SECONDS_TOO_LONG = 100
MPI_ON_ONE_HOST = {"UCX_TLS": "self,sysv", "UCX_SYSV_BW": "10000MBs", "MPIR_CVAR_NOLOCAL": "1"}  # see test_ranks.py

# A few dozen grains fall on a floor.
SCRIPT = """
variable n index 30
variable dt index 2e-4
variable law index gap
variable then index nothing
variable folder index .
variable dump index none
units si
atom_style sphere
boundary p p f
processors * * 1
region box block 0 4e-3 0 4e-3 0 8e-3
create_box 1 box
region cloud block 0 4e-3 0 4e-3 0.5e-3 8e-3
create_atoms 1 random ${n} 1 cloud overlap 0.9e-3 maxtry 1000
set group all diameter 0.8e-3 density 2500
pair_style zero 1.1e-3
pair_coeff * *
comm_modify vel yes
fix gravity all gravity 9.81 vector 0 0 -1
fix hard all nscd law ${law} wall plane 0 0 0 0 0 1
timestep ${dt}
compute middle all com
variable height equal c_middle[3]
thermo 20
thermo_style custom step ke
run $(ceil(0.02/v_dt))
write_dump all custom ${folder}/dump.last id x y z
if "${then} == fail" then "fix wrong all no/such"
if "${then} == quit" then "quit"
if "${then} == forever" then "run 2000000000"
"""


def begin(folder: Path, monkeypatch: Any) -> str:
    """Work in an empty folder, write the script there, and return its path."""
    monkeypatch.chdir(folder)
    for name, value in MPI_ON_ONE_HOST.items():
        monkeypatch.setenv(name, value)
    Path("in.fall").write_text(SCRIPT)
    return "in.fall"


def statuses(table: nscd_lmp.SweepTable) -> list[str]:
    """Return the column."""
    return [row["status"] for row in table]


def is_running(process: int) -> bool:
    """Return whether there is such a process; one that has ended and waits to be asked for its exit code is not."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def wait_for(condition: Callable[[], bool], what: str, seconds: float = 30.0) -> None:
    """Wait until the condition holds; fail after some seconds."""
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, f"{what} did not come within {seconds} s"
        time.sleep(0.02)


@contextmanager
def study(*words: str) -> Iterator[subprocess.Popen[str]]:
    """Run this file as a program, a sweep of 6 cases of which 1, 2 and 3 are quick, from the start of number 4 on."""
    program = [sys.executable, __file__, *words]
    with processes.started(program, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        wait_for(lambda: Path("out/x=4/process.0").exists(), "the fourth case")
        yield process


def same(folder: Path, word: Any) -> None:
    """Return nothing."""


def power(folder: Path, base: float, exponent: float, add: float = 1) -> dict[str, Any]:
    """Return a NumPy value, and leave a file."""
    (folder / "seen").write_text(str(base))
    return {"power": np.float64(base) ** exponent + add}


def ranks(folder: Path, x: int) -> dict[str, Any]:
    """Return the number of ranks, of rank 0 alone."""
    from mpi4py import MPI

    tell_process(folder)
    return {"ranks": MPI.COMM_WORLD.size if MPI.COMM_WORLD.rank == 0 else 0}


def warned(folder: Path, x: int) -> dict[str, Any]:
    """Warn, each time anew, and fail."""
    for text in ("first", "second\nof two lines", "first"):
        warnings.warn(text, stacklevel=1)
    raise ValueError("in the end")


def counted(folder: Path, x: int) -> dict[str, Any]:
    """Fail for x = 2, until a file appears."""
    with open("runs", "a") as file:
        file.write(f"{x}\n")
    if x == 2 and not Path("x2_may_pass").exists():
        raise ValueError("x is 2")
    return {"square": x * x}


def fail(folder: Path, way: str) -> Any:
    """End in some way."""
    if way == "raise":
        print("said before")
        raise ValueError("first line\nsecond line")
    if way == "exit":
        sys.exit(3)
    if way == "crash":
        ctypes.string_at(0)
    if way == "kill":
        os.kill(os.getpid(), signal.SIGKILL)
    if way == "hang":
        time.sleep(SECONDS_TOO_LONG)
    if way == "slow":
        time.sleep(1.5)
    return {"list": [1, 2], "array": {"a": np.zeros(2), "b": np.float64(2.5)}}.get(way)


def fail_on_rank_1(folder: Path, way: str) -> None:
    """End rank 1 in some way while the others wait for it."""
    from mpi4py import MPI

    tell_process(folder)
    MPI.COMM_WORLD.Barrier()
    if MPI.COMM_WORLD.rank == 1:
        fail(folder, way)
    MPI.COMM_WORLD.Barrier()


def some_slow(folder: Path, x: int) -> dict[str, Any]:
    """Take long from x = 4 on, until a file is there."""
    tell_process(folder)
    if x >= 4 and not Path("quick").exists():
        time.sleep(SECONDS_TOO_LONG)
    return {"square": x * x}


def tell_process(folder: Path) -> None:
    """Leave the number of the process in a file of the rank."""
    from mpi4py import MPI

    unfinished = folder / f"{MPI.COMM_WORLD.rank}.unfinished"
    unfinished.write_text(str(os.getpid()))
    unfinished.rename(folder / f"process.{MPI.COMM_WORLD.rank}")


if __name__ == "__main__":
    table = nscd_lmp.sweep(some_slow, {"x": range(1, 7)}, folder="out", ranks=int(sys.argv[1]))
    print(table["square"].tolist())
