# SPDX-License-Identifier: GPL-2.0-or-later
"""Sweeps: what is refused, with value, limit and remedy, and what is warned of."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
import sweep_cases

import nscd_lmp


@pytest.fixture(autouse=True)
def script(tmp_path, monkeypatch):
    """Work in an empty folder but for the script, whose path this is."""
    return sweep_cases.begin(tmp_path, monkeypatch)


@pytest.mark.parametrize(
    ("variables", "cases", "told"),
    [
        (None, None, "no cases"),
        ({"n": 20}, None, "no cases"),
        ({"n": []}, None, "'n' has no values"),
        (None, [], "cases is empty"),
        ({"n": [20, 20]}, None, "cases 1 and 2 are the same, n=20"),
        ({"n": [20]}, [{"n": 30}], "'n' is in variables and in cases"),
        ({"folder": ["a", "b"]}, None, "another name"),
        ({"n b": [1]}, None, "letters, digits and _"),
        ({"n": [object()]}, None, "type object"),
        ({"n": [None]}, None, "cannot be None"),
        ({"m": [20]}, None, "never uses the variable 'm'"),
        ({"low": [1e-7]}, None, "it uses law"),
    ],
)
def test_wrong_cases_are_refused_before_anything_runs(script, variables, cases, told):
    with pytest.raises(nscd_lmp.NscdError, match=told):
        nscd_lmp.sweep(script, variables, cases=cases, folder="out", progress=False)
    assert not Path("out").exists()


@pytest.mark.parametrize(
    ("settings", "told"),
    [
        ({"processes": 0}, "processes = 0"),
        ({"ranks": 0}, "ranks = 0"),
        ({"timeout": 0.0}, "timeout = 0.0 s"),
        ({"folder": "my out"}, "blank"),
    ],
)
def test_wrong_settings_are_refused_before_anything_runs(script, settings, told):
    with pytest.raises(nscd_lmp.NscdError, match=told):
        nscd_lmp.sweep(script, {"n": [20]}, progress=False, **({"folder": "out"} | settings))
    assert sorted(path.name for path in Path().iterdir()) == ["in.fall"]


def test_functions_that_cases_cannot_import_are_refused():
    def inner(folder):
        return {}

    for function in (inner, lambda folder: {}):
        with pytest.raises(nscd_lmp.NscdError, match="top level"):
            nscd_lmp.sweep(function, {"x": [1]}, folder="out")
    with pytest.raises(nscd_lmp.NscdError, match="no function 'nosuch'"):
        nscd_lmp.sweep("sweep_cases:nosuch", {"x": [1]}, folder="out")
    with pytest.raises(nscd_lmp.NscdError, match=r"same\(folder, x\)"):
        nscd_lmp.sweep(sweep_cases.same, {"x": [1]}, folder="out")
    with pytest.raises(nscd_lmp.NscdError, match="returns its results"):
        nscd_lmp.sweep(sweep_cases.same, {"word": [1]}, folder="out", results=["ke"])
    with pytest.raises(nscd_lmp.NscdError, match=r"no script 'in\.absent'"):
        nscd_lmp.sweep("in.absent", {"x": [1]}, folder="out")


def test_file_that_sweeps_as_it_is_imported_is_told_of_the_guard():
    Path("study.py").write_text(
        "import nscd_lmp\n\n\ndef f(folder, x):\n    pass\n\n\n"
        "print(nscd_lmp.sweep(f, {'x': [1]}, folder='out', progress=False).rows[0]['message'])\n"
    )
    done = subprocess.run([sys.executable, "study.py"], capture_output=True, text=True, check=True)
    assert 'if __name__ == "__main__":' in done.stdout


def test_folder_of_another_sweep_is_refused(script):
    nscd_lmp.sweep(script, {"n": [20], "law": "gap"}, folder="out", progress=False)
    with pytest.raises(nscd_lmp.NscdError, match=r"holds a sweep of in\.fall, not of in\.other"):
        Path("in.other").write_text(sweep_cases.SCRIPT)
        nscd_lmp.sweep("in.other", {"n": [20], "law": "gap"}, folder="out", progress=False)
    with pytest.raises(nscd_lmp.NscdError, match="law = gap, not moreau"):
        nscd_lmp.sweep(script, {"n": [20], "law": "moreau"}, folder="out", progress=False)


def test_two_sweeps_at_once_in_a_folder_are_refused():
    with sweep_cases.study("1"), pytest.raises(nscd_lmp.NscdError, match="another sweep is at work"):
        nscd_lmp.sweep(sweep_cases.counted, {"x": [1]}, folder="out", progress=False)


def test_sweep_on_several_ranks_is_refused():
    mpiexec = Path(sys.prefix) / "bin" / "mpiexec"
    code = "import nscd_lmp, sweep_cases; print(nscd_lmp.sweep(sweep_cases.ranks, {'x': [1]}, folder='out').rows)"
    for ranks in ("2", "1"):
        done = subprocess.run(
            [mpiexec, "-n", ranks, sys.executable, "-c", code], capture_output=True, text=True, timeout=60,
            env=os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
        )  # fmt: skip
        if ranks == "2":
            assert "without mpiexec" in done.stderr
        else:
            assert "'ranks': 1" in done.stdout, done.stderr


def test_more_ranks_than_cores_are_warned_of(monkeypatch):
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0})
    with pytest.warns(UserWarning, match="2 x 1 is more than the 1 cores"):
        nscd_lmp.sweep(sweep_cases.same, {"word": [1]}, folder="out", processes=2, progress=False)


def test_files_that_cases_would_share_are_warned_of(script):
    Path(script).write_text(sweep_cases.SCRIPT + '\nif "${n} > 0" then &\n  "dump d all custom 1 ${dump} id"\nrun 1\n')
    for dump in ("none", "${folder}/dump.d", "shared.d"):
        settings = {"variables": {"n": [20, 21], "dump": dump, "law": "gap"}, "folder": dump[-6:], "progress": False}
        if dump == "shared.d":
            with pytest.warns(UserWarning, match=r"the same file 'shared\.d'"):
                nscd_lmp.sweep(script, **settings)
        else:
            nscd_lmp.sweep(script, **settings)
    assert Path("dump.d/n=20/dump.d").exists()


def test_variables_of_included_files_are_known_and_of_unknown_files_warned_of(script):
    os.mkdir("parts")
    Path("parts/settings").write_text("variable tol index 1e-7\nfix hard all nscd tol ${tol}\n")
    Path(script).write_text('if "1" then "variable parts index parts"\ninclude ${parts}/settings\n')
    told = "never uses the variable 'nosuch'"
    with pytest.raises(nscd_lmp.NscdError, match=told):
        nscd_lmp.sweep(script, {"tol": [1e-7], "nosuch": 1}, folder="out", progress=False)
    os.rename("parts/settings", "parts/later")
    with pytest.warns(UserWarning, match=f"{told}.* unless .*settings does"):
        assert sweep_cases.statuses(nscd_lmp.sweep(script, {"nosuch": [1]}, folder="out", progress=False)) == ["failed"]


def test_unknown_column_is_told(script):
    table = nscd_lmp.sweep(sweep_cases.same, {"word": [1]}, folder="out", progress=False)
    with pytest.raises(nscd_lmp.NscdError, match="no column 'wrod': it has word"):
        table["wrod"]
