# SPDX-License-Identifier: GPL-2.0-or-later
"""The Python door on Debian's LAMMPS: a build of 2021 with package PYTHON and OpenMPI, no C++ exceptions.

The package is built for the system's Python and runs there by ``fix external`` and ``fix python/invoke``.
"""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import debian_scene
import pytest

import nscd_lmp

ROOT = Path(__file__).parent.parent
PYTHON = Path("/usr/bin/python3")
PACKAGES = "python3-lammps python3-mpi4py python3-numpy python3-venv python3-dev"
DOORS = ("external", "invoke")

Run = Callable[[str, str, Path], dict[str, Any]]

FLIGHT = 34  # steps until the lowest of the 4 grains lands: a solver has nothing to solve before that


def environment() -> dict[str, str]:
    """Return the environment without what points to the tests' own Python and LAMMPS."""
    ours = ("PYTHON", "VIRTUAL_ENV", "LAMMPS", "LD_LIBRARY_PATH")
    return {name: value for name, value in os.environ.items() if not name.startswith(ours)}


def execute(*words: str | Path, **variables: str) -> None:
    """Run a program; fail with what it printed."""
    done = subprocess.run(
        words, env=environment() | variables, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT, text=True, timeout=600,
    )  # fmt: skip
    if done.returncode != 0:
        pytest.fail(f"exit status {done.returncode}\n{done.stdout[-5000:]}", pytrace=False)


def library() -> Path | None:
    """Return Debian's LAMMPS library if the system's Python can use it."""
    found = sorted(Path("/usr/lib").glob("*/liblammps.so.0"))
    words = [PYTHON, "-c", "import lammps, mpi4py, numpy, venv, ensurepip; lammps.lammps.has_style"]
    usable = PYTHON.exists() and subprocess.run(words, env=environment(), capture_output=True).returncode == 0
    return found[0] if found and usable else None


@pytest.fixture(scope="session")
def debian(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """Return a function that runs a case of debian_scene.py by a door on Debian's LAMMPS."""
    lammps = library()
    if lammps is None:
        pytest.skip(f"needs Debian's LAMMPS: apt-get install {PACKAGES}")
    home = tmp_path_factory.mktemp("debian")
    # The system's lammps, mpi4py and numpy serve; --no-deps keeps PyPI's lammps out, whose version number
    # Debian's module cannot read.
    execute(PYTHON, "-m", "venv", "--system-site-packages", home / "venv")
    execute(home / "venv" / "bin" / "pip", "install", "--quiet", "--no-deps", ROOT)
    # Debian ships the library without the name under which its own Python module looks for it.
    (home / "lib").mkdir()
    (home / "lib" / "liblammps.so").symlink_to(lammps)

    def run(case: str, door: str, folder: Path) -> dict[str, Any]:
        script = Path(debian_scene.__file__)
        execute(home / "venv" / "bin" / "python", script, case, door, folder, LD_LIBRARY_PATH=str(home / "lib"))
        answer: dict[str, Any] = json.loads((folder / "answer.json").read_text())
        return answer

    return run


@pytest.mark.parametrize("case", ["bed", "rough_bed"])
def test_trajectories_are_those_of_todays_lammps_to_the_last_bit(debian: Run, tmp_path: Path, case: str) -> None:
    # The neighbor lists of the two releases come in the same order, so the solver's iterates are the same.
    folders = {name: tmp_path / name for name in ("today", *DOORS)}
    for folder in folders.values():
        folder.mkdir()
    answers = {door: debian(case, door, folders[door]) for door in DOORS}
    answers["today"] = getattr(debian_scene, case)("external", folders["today"])
    steps = {name: (folder / "steps").read_bytes() for name, folder in folders.items()}
    assert steps["external"] == steps["invoke"]
    assert steps["external"] == steps["today"]
    assert answers["external"].pop("last fix") == answers["today"].pop("last fix") == "external"
    assert answers["invoke"].pop("last fix") == "python/invoke"
    assert answers["external"] == answers["invoke"] == answers["today"]
    assert answers["invoke"]["steps"] == list(range(1, 801))
    assert answers["invoke"]["contacts"] > 150  # a settled bed: 3 contacts a grain
    assert answers["invoke"]["in main"] == []


@pytest.mark.parametrize("door", DOORS)
def test_python_solver_gives_what_the_compiled_one_gives(debian: Run, tmp_path: Path, door: str) -> None:
    answer = debian("python_solver", door, tmp_path)
    python, compiled = answer["dissipated"]
    assert len(python) == len(compiled) == 500
    assert python == pytest.approx(compiled, rel=1e-12)  # one division a contact, summed over 500 steps
    assert python[-1] > 0


@pytest.mark.parametrize("case", ["exception", "interrupt"])
@pytest.mark.parametrize("door", DOORS)
def test_exception_in_a_solver_reaches_the_caller(debian: Run, tmp_path: Path, door: str, case: str) -> None:
    answer = debian(case, door, tmp_path)
    error = {"exception": "ZeroDivisionError('a flaw of the solver')", "interrupt": "KeyboardInterrupt()"}
    assert answer["raised"] == error[case]
    # Call 200 of the solver, in a step that was not taken, ended both runs; the next run goes on.
    assert (answer["before"], answer["after"], answer["calls"]) == (FLIGHT + 199, FLIGHT + 299, 300)


@pytest.mark.parametrize("door", DOORS)
def test_exception_in_the_first_call_reaches_the_caller(debian: Run, tmp_path: Path, door: str) -> None:
    answer = debian("exception_at_once", door, tmp_path)
    assert answer["raised"] and (answer["before"], answer["after"], answer["calls"]) == (FLIGHT, FLIGHT + 100, 101)


@pytest.mark.parametrize("door", DOORS)
def test_ctrl_c_takes_effect_after_a_compiled_run(debian: Run, tmp_path: Path, door: str) -> None:
    # It must not be raised inside LAMMPS, which would end the process.
    answer = debian("interrupt_compiled", door, tmp_path)
    assert (answer["raised"], answer["steps"]) == ("KeyboardInterrupt()", 500)


@pytest.mark.parametrize("door", DOORS)
def test_bad_input_is_refused(debian: Run, tmp_path: Path, door: str) -> None:
    answer = debian("refusals", door, tmp_path)
    expected = {
        "group": "unknown group 'nobody': choose one of all",
        "door": "unknown door 'window': choose one of external, invoke",
        "integrator": "moved by fix other (style nve/sphere) too",
        "reach": "less than the largest diameter",
        "pair style": "no pair style is defined",
    }
    assert answer.keys() == expected.keys()
    for name, text in expected.items():
        assert text in answer[name]


def test_invoke_is_refused_where_lammps_lacks_package_python() -> None:
    lmp = debian_scene.start(4)
    if lmp.has_style("fix", "python/invoke"):
        pytest.skip("this LAMMPS has package PYTHON")
    with pytest.raises(nscd_lmp.NscdError, match=r"fix python/invoke, .* \(package PYTHON\): use door="):
        nscd_lmp.attach(lmp, door="invoke")
