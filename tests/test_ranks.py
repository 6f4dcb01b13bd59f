# SPDX-License-Identifier: GPL-2.0-or-later
"""Several MPI ranks: any number gives the one-rank velocities, the same number the same bits, and one failure ends all.

One-rank answers are those of the same program on one rank, whose physics the other tests show.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import processes
import pytest
import ranks_beds

import nscd_lmp

TESTS = Path(__file__).parent
BUILDERS = TESTS / "builders"
PYTHONPATH = os.pathsep.join(map(str, (TESTS, TESTS / "references", BUILDERS)))
DOORS = ("script", "python")
SECONDS = 60  # a hang is a failure
# Shared memory alone, with a speed of its own: UCX refuses networks without one, as virtual machines have them.
MPI_ON_ONE_HOST = {"UCX_TLS": "self,sysv", "UCX_SYSV_BW": "10000MBs", "MPIR_CVAR_NOLOCAL": "1"}

# Largest difference of velocities, m/s. Gravity gives 2e-3 in a step. A residual of tol on the mean contact is
# amplified by the bed's condition, about 100 times. Friction is looser: all contacts of a grain, sliding by little, can
# turn it.
TOLERANCES = {"bed": 2e-7, "moreau": 2e-7, "column": 1e-9, "impacts": 1e-9, "friction": 5e-5, "shear": 5e-5}
NEWTON = ("bed",)
NUMBERS = (2, 3, 4)  # of ranks

Answers = Callable[[int, str], Any]


def execute(ranks: int, *words: str) -> None:
    """Run a Python program on several ranks; fail with what it printed, or if it hangs."""
    done = processes.run(
        [Path(sys.prefix) / "bin" / "mpiexec", "-n", str(ranks), sys.executable, *words], SECONDS,
        env=os.environ | MPI_ON_ONE_HOST | {"PYTHONPATH": PYTHONPATH}, stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )  # fmt: skip
    if done.returncode != 0:
        pytest.fail(f"exit status {done.returncode}\n{done.stdout[-3000:]}", pytrace=False)


@pytest.fixture(scope="module")
def answers(tmp_path_factory: pytest.TempPathFactory) -> Answers:
    """Return a function of a number of ranks and a case of ranks_scene.py, which returns what that leaves."""
    folder = tmp_path_factory.mktemp("ranks")
    ranks_beds.make(folder)

    def ask(ranks: int, case: str) -> Any:
        left = folder / f"{case}.{ranks}.npz"
        if not left.exists():
            execute(ranks, str(BUILDERS / "ranks_scene.py"), case, str(folder), str(folder))
        return np.load(left)

    return ask


def cases() -> list[tuple[str, int]]:
    """Return the names of all cases that are compared with one rank, and on how many ranks.

    The bed is run through both doors on each number of ranks; in the other scenes the doors take turns.
    """
    beds = [(f"bed_{door}_{newton}", n) for door in DOORS for newton in ("on", "off") for n in NUMBERS]
    others = [scene for scene in TOLERANCES if scene not in NEWTON]
    return beds + [
        (f"{scene}_{DOORS[(k + turn) % 2]}", n) for k, scene in enumerate(others) for turn, n in enumerate(NUMBERS)
    ]


@pytest.mark.parametrize(("case", "ranks"), cases())
def test_any_number_of_ranks_gives_the_velocities_of_one(answers: Answers, case: str, ranks: int) -> None:
    one, several = answers(1, case), answers(ranks, case)
    assert np.abs(one["v"]).max() > 0
    np.testing.assert_allclose(several["v"], one["v"], rtol=0, atol=TOLERANCES[case.split("_")[0]])


# A shift of the images that was forgotten on one rank would be 0.05 m/s; the growth is 4e-4 m/s. Law gap moves a grain
# by its mean velocity or by that at the end, whichever opens its contacts: where both do but for what a solve is off,
# ranks may choose otherwise, which is g dt^2 / 2 of its place and below g dt, 2e-3 m/s, in the next step.
@pytest.mark.parametrize(
    ("case", "tolerance"), [("box x_python", 2e-3), ("box v_script", 2e-3), ("growth_script", 1e-9)]
)
def test_boxes_that_move_and_grains_that_grow_have_the_velocities_of_one_rank(
    answers: Answers, case: str, tolerance: float
) -> None:
    one, several = answers(1, case), answers(3, case)
    assert np.abs(one["v"]).max() > 1e-4
    np.testing.assert_allclose(several["v"], one["v"], rtol=0, atol=tolerance)


@pytest.mark.parametrize("solver", nscd_lmp.SOLVERS)
def test_every_solver_gives_the_velocities_of_one_rank_on_two(answers: Answers, solver: str) -> None:
    one, several = answers(1, f"solver_{solver}"), answers(2, f"solver_{solver}")
    np.testing.assert_allclose(several["v"], one["v"], rtol=0, atol=1e-9)


def test_python_solver_of_the_contacts_of_each_rank_gives_the_velocities_of_one_rank(answers: Answers) -> None:
    one, several = answers(1, "python_solver"), answers(2, "python_solver")
    np.testing.assert_allclose(several["v"], one["v"], rtol=0, atol=1e-9)


@pytest.mark.parametrize("door", DOORS)
def test_same_number_of_ranks_gives_the_same_bits(answers: Answers, door: str) -> None:
    twice = answers(2, f"fall_{door}"), answers(2, f"fall_again_{door}")
    for name in ("x", "v", "omega"):
        assert np.array_equal(twice[0][name], twice[1][name])


@pytest.mark.parametrize("ranks", [2, 3])
def test_both_doors_give_the_same_bits(answers: Answers, ranks: int) -> None:
    both = [answers(ranks, f"bed_{door}_on") for door in DOORS]
    assert np.array_equal(both[0]["v"], both[1]["v"])


def test_traffic_counts_what_a_sweep_needs(answers: Answers) -> None:
    """Corrections to owners and velocities back, and one reduction; a step needs little besides."""
    alone, both = answers(1, "bed_python_on"), answers(2, "bed_python_on")
    assert not alone["traffic"].any()
    exchanges, messages, volume, reductions = both["traffic"]
    sweeps = both["sweeps"]
    assert 2 * sweeps <= exchanges <= 2.2 * sweeps + 20
    assert messages <= exchanges + 4  # letters
    assert 3 * 8 * sweeps < volume
    assert sweeps <= reductions <= 1.2 * sweeps + 40


@pytest.mark.parametrize("door", DOORS)
def test_warm_start_follows_grains_to_other_ranks(answers: Answers, door: str) -> None:
    warm, cold = answers(2, f"warm_{door}"), answers(2, f"cold_{door}")
    owned = warm["owned"]
    assert min(abs(np.diff(owned))) >= 6, "most of the column must change its rank"
    assert min(cold["iterations"][1:]) > 100
    assert max(warm["iterations"][1:]) < min(cold["iterations"][1:]) / 5


@pytest.mark.parametrize("ranks", [2, 3])
@pytest.mark.parametrize("door", DOORS)
def test_value_that_is_no_number_on_one_rank_ends_all_with_one_message(answers: Answers, door: str, ranks: int) -> None:
    told = answers(ranks, f"nan_{door}")["told"]
    assert len(told) == ranks
    assert len(set(told)) == 1
    assert "velocity or force that is not a finite number" in told[0]


@pytest.mark.parametrize("door", DOORS)
def test_ranks_that_may_use_different_cores_agree_on_how_to_wait(answers: Answers, tmp_path: Path, door: str) -> None:
    """Ranks that wait in different calls would wait for ever: one here sees fewer cores than there are ranks."""
    beds = tmp_path
    ranks_beds.make(beds)
    program = [sys.executable, str(BUILDERS / "ranks_scene.py"), f"moreau_{door}", str(beds), str(beds)]
    pin = "import os, sys; os.sched_setaffinity(0, [min(os.sched_getaffinity(0))]); os.execv(sys.argv[1], sys.argv[1:])"
    pinned = [sys.executable, "-c", pin, *program]
    environment = {name: value for name, value in MPI_ON_ONE_HOST.items() if name != "MPIR_CVAR_NOLOCAL"}
    done = subprocess.run(
        [Path(sys.prefix) / "bin" / "mpiexec", "-n", "1", *pinned, ":", "-n", "2", *program],
        env=os.environ | environment | {"PYTHONPATH": PYTHONPATH}, stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=SECONDS, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-3000:]
    together = np.load(beds / f"moreau_{door}.3.npz")
    np.testing.assert_allclose(together["v"], answers(1, f"moreau_{door}")["v"], rtol=0, atol=TOLERANCES["moreau"])


@pytest.mark.parametrize("ranks", [2, 3])
def test_exception_in_a_python_solver_on_one_rank_ends_all(answers: Answers, ranks: int) -> None:
    told = answers(ranks, "flawed_solver")["told"]
    assert told[-1] == "ZeroDivisionError: a flaw of the solver"
    assert all("ZeroDivisionError: a flaw of the solver" in one for one in told)


@pytest.mark.parametrize("door", DOORS)
def test_ranks_find_a_pair_beyond_the_list_together(answers: Answers, door: str) -> None:
    one, two = answers(1, f"beyond_{door}"), answers(2, f"beyond_{door}")
    assert set(one["told"]) == set(two["told"]) == {"nothing"}
    np.testing.assert_allclose(two["x"], one["x"], rtol=0, atol=1e-8)
    assert one["x"][3, 1] - one["x"][2, 1] >= 1.1 - 1e-8


@pytest.mark.fast
@pytest.mark.parametrize("door", DOORS)
def test_ranks_refuse_together_what_lies_beyond_their_images(answers: Answers, door: str) -> None:
    """One rank has everything; of two, one has no image of the far grain."""
    assert set(answers(1, f"unknown_{door}")["told"]) == {"nothing"}
    told = answers(2, f"unknown_{door}")["told"]
    assert len(set(told)) == 1
    assert "contacts could be missed: grain" in told[0]
    assert "comm_modify cutoff" in told[0]


SCRIPT = """
units si
atom_style sphere
boundary p p f
processors 2 1 1
region box block 0 1e-2 0 1e-2 0 1e-2
create_box 1 box
comm_modify vel yes
create_atoms 1 single 4.9e-3 5e-3 0.5e-3
create_atoms 1 single 5.8e-3 5e-3 0.5e-3
set group all diameter 1e-3 density 2500
pair_style zero 1.5e-3
pair_coeff * *
neighbor 5e-4 bin
timestep 1e-4
fix gravity all gravity 9.81 vector 0 0 -1
fix nscd all nscd wall plane 0 0 0 0 0 1
thermo 1
thermo_style custom step f_nscd[1] f_nscd[8]
dump contacts all local 1 contacts.dump index f_nscd[1] f_nscd[2] f_nscd[10]
run 2
"""


def test_lmp_and_nscd_lmp_run_take_a_script_on_two_ranks(tmp_path: Path) -> None:
    (tmp_path / "in.two").write_text(SCRIPT)
    commands = Path(sys.prefix) / "bin"
    for program in (["lmp", "-in"], ["nscd-lmp", "run"]):
        command = [commands / "mpiexec", "-n", "2", commands / program[0], *program[1:], "in.two"]
        done = subprocess.run(
            command, cwd=tmp_path, env=os.environ | MPI_ON_ONE_HOST, stdin=subprocess.DEVNULL, capture_output=True,
            text=True, timeout=SECONDS, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stdout + done.stderr
        log = (tmp_path / "log.lammps").read_text()
        assert "2 by 1 by 1 MPI processor grid" in log
        rows = [line.split() for line in log.splitlines() if line.split()[:1] == ["2"]]
        assert rows[-1][1] == "3", "two floor contacts and the pair that straddles the ranks"
        written = (tmp_path / "contacts.dump").read_text()
        assert written.count("ITEM: NUMBER OF ENTRIES\n3\n") == 2
