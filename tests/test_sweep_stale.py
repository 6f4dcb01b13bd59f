# SPDX-License-Identifier: GPL-2.0-or-later
"""Sweeps whose code has changed: finished results are neither lost nor mixed with others."""

from __future__ import annotations

import csv
import subprocess
import sys
from pathlib import Path
from typing import Any

import processes
import pytest
import sweep_cases

import nscd_lmp
from nscd_lmp import cli
from nscd_lmp.sweeps.code import code_of

STUDY = '''
import time
import warnings
from pathlib import Path

FACTOR = 2


def estimate(x):
    return FACTOR * x


class Unused:
    pass


def study(folder, x):
    """Return an estimate."""
    (folder / "dump").write_text(str(x))
    with open("runs", "a") as file:
        file.write(f"{x}\\n")
    if Path("slow").exists():
        time.sleep(100)
    if x == 3:
        warnings.warn("three is\\n odd")
    return {"estimate": estimate(x)}  # of x


if __name__ == "__main__":
    import sys
    import nscd_lmp

    table = nscd_lmp.sweep(study, {"x": [1, 2, 3]}, folder="out", progress=False, stale=sys.argv[1])
    print(table["estimate"].tolist())
'''


@pytest.fixture(autouse=True)
def script(tmp_path, monkeypatch):
    """Work in an empty folder but for the script, whose path this is, and a study by a function."""
    Path(tmp_path, "study.py").write_text(STUDY)
    return sweep_cases.begin(tmp_path, monkeypatch)


def change(old: str, new: str) -> None:
    """Change the code of the study."""
    text = Path("study.py").read_text()
    assert old in text
    Path("study.py").write_text(text.replace(old, new))


def study(stale: Any = "refuse", xs: Any = (1, 2, 3), **more: Any) -> nscd_lmp.SweepTable:
    """Sweep over the study, whose file is read anew."""
    Path("runs").write_text("")
    return nscd_lmp.sweep("study.py:study", {"x": list(xs)}, folder="out", progress=False, stale=stale, **more)


def runs() -> int:
    """Return how many cases the last call has begun."""
    return len(Path("runs").read_text().split())


def files() -> dict[str, bytes]:
    """Return the contents of all files of the sweep."""
    return {str(path): path.read_bytes() for path in Path("out").rglob("*") if path.is_file()}


def rows(path: str) -> list[dict[str, str]]:
    """Return the rows of a CSV file."""
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def test_comments_docstrings_and_layout_are_no_change():
    first = study()
    change('"""Return an estimate."""', '"""Return\n\n    another text.\n    """')
    change("# of x", "# of another x")
    change("def estimate(x):", "def estimate(  # why\n    x,\n):")
    change("class Unused:", "class Renamed:")
    change('print(table["estimate"].tolist())', "print(table)")
    assert study().rows == first.rows and runs() == 0


@pytest.mark.parametrize(
    ("old", "new", "name"),
    [
        ("FACTOR * x", "FACTOR * x + 1", "estimate"),
        ("FACTOR = 2", "FACTOR = 3", "FACTOR"),
        ("write_text(str(x))", "write_text(repr(x))", "study"),
        ("import time", "import time as clock\nimport time", "time|clock"),
    ],
)
def test_a_change_of_the_function_or_of_what_it_uses_is_refused_and_touches_nothing(old, new, name):
    study()
    before = files()
    change(old, new)
    if "clock" in new:
        study()  # what it does not use
        return
    with pytest.raises(
        nscd_lmp.NscdError, match=f'3 finished cases .* change of {name}: stale="keep" .* stale="rerun"'
    ):
        study()
    assert files() == before and runs() == 0


def test_keep_takes_the_results_as_they_are_and_marks_them():
    study(xs=(1, 2))
    change("FACTOR * x", "FACTOR * x + 1")
    table = study("keep")
    assert runs() == 1
    assert table["estimate"].tolist() == [2, 4, 7]
    assert table.rows[0]["warnings"] == table.rows[1]["warnings"] == "run before a change of estimate"
    assert table.rows[2]["warnings"] == "three is odd"
    with pytest.raises(nscd_lmp.NscdError, match="2 finished cases"):
        study()


def test_rerun_keeps_the_old_results_aside():
    study()
    for factor in (3, 4):
        change(f"FACTOR = {factor - 1}", f"FACTOR = {factor}")
        assert study("rerun")["estimate"].tolist() == [factor, 2 * factor, 3 * factor]
    assert Path("out/superseded/x=2/dump").read_text() == Path("out/superseded/x=2.2/dump").read_text() == "2"
    old = rows("out/superseded.csv")
    assert [(row["x"], row["estimate"]) for row in old] == [
        ("1", "2"), ("1", "3"), ("2", "4"), ("2", "6"), ("3", "6"), ("3", "9"),
    ]  # fmt: skip
    assert all(row["warnings"].startswith("run before a change of FACTOR") for row in old)
    assert "three is odd" in old[-1]["warnings"]
    assert Path(old[1]["folder"], "dump").read_text() == "1"
    assert len(rows("out/sweep.csv")) == 3


def test_results_that_wait_to_be_replaced_outlive_ctrl_c():
    study()
    change("FACTOR * x", "FACTOR * x + 1")
    Path("slow").touch()
    Path("runs").write_text("")
    words = [sys.executable, "study.py", "rerun"]
    with processes.started(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        sweep_cases.wait_for(lambda: runs() == 1, "the first case")
        process.send_signal(2)
        process.communicate(timeout=20)
    kept = rows("out/sweep.csv") + rows("out/superseded.csv")
    assert sorted((row["x"], row["estimate"]) for row in kept) == [("1", "2"), ("2", "4"), ("3", "6")]
    assert all("change of estimate" in row["warnings"] for row in kept)
    assert Path("out/x=2/dump").exists() and Path("out/superseded/x=1/dump").exists()


def test_failed_cases_of_mended_code_run_again():
    change('return {"estimate": estimate(x)}', 'return {"estimate": estimate(x) / (x - 2)}')
    assert sweep_cases.statuses(study()) == ["ok", "failed", "ok"]
    change("(x - 2)", "(x - 2 or 1)")
    with pytest.raises(nscd_lmp.NscdError, match="2 finished cases"):
        study()
    assert sweep_cases.statuses(study("keep")) == ["ok"] * 3 and runs() == 1


def test_cases_of_earlier_calls_stay_in_the_file():
    study()
    assert len(study(xs=[2])) == 1
    assert [row["x"] for row in rows("out/sweep.csv")] == ["2", "1", "3"]


def test_ranks_and_results_are_what_a_result_depends_on(script):
    def heights(results: Any, **more: Any) -> nscd_lmp.SweepTable:
        return nscd_lmp.sweep(script, {"n": [20]}, folder="fall", results=results, progress=False, **more)

    first = heights(["v_height"])
    assert heights(["v_height"]).rows == first.rows
    with pytest.raises(nscd_lmp.NscdError, match="change of the results asked for"):
        heights(["v_height", "ke"])
    assert heights(["v_height", "ke"], stale="keep")["v_height"] == first["v_height"]
    assert heights(["v_height", "ke"], stale="rerun")["ke"][0] > 0
    with pytest.raises(nscd_lmp.NscdError, match=r"change of ranks \(1, now 2\)"):
        heights(["v_height", "ke"], ranks=2)


def test_changes_of_a_script_and_of_what_it_includes_are_seen(script):
    Path("more").write_text("variable height equal c_middle[3]\n")
    Path(script).write_text(sweep_cases.SCRIPT.replace("variable height equal c_middle[3]", "include more"))

    def height(**more: Any) -> float:
        table = nscd_lmp.sweep(script, {"n": [20]}, folder="fall", results=["v_height"], progress=False, **more)
        return table["v_height"][0]

    first = height()
    Path("more").write_text("# a comment\nvariable  height equal   c_middle[3]  # another\n")
    assert height() == first
    Path("more").write_text("variable height equal 2*c_middle[3]\n")
    with pytest.raises(nscd_lmp.NscdError, match="change of more"):
        height()
    assert height(stale="rerun") == pytest.approx(2 * first)


def test_command_has_the_choice(capsys):
    words = ["sweep", "study.py:study", "--vary", "x=1,2", "--folder", "out"]
    assert cli.main(words) == 0
    change("FACTOR = 2", "FACTOR = 3")
    assert cli.main(words) == 1
    assert "--stale keep, --stale rerun" in capsys.readouterr().err
    assert cli.main([*words, "--stale", "keep"]) == 0
    assert "2 cases with warnings, in their column: out/x=1: run before a change of FACTOR" in capsys.readouterr().out
    assert cli.main([*words, "--stale", "rerun"]) == 0
    assert [row["estimate"] for row in rows("out/sweep.csv")] == ["3", "6"]
    with pytest.raises(nscd_lmp.NscdError, match="unknown stale 'no': choose one of refuse, keep, rerun"):
        study("no")


def test_code_is_that_of_what_a_function_names_in_its_file(tmp_path):
    names = code_of(sweep_cases.some_slow, "some_slow")
    assert {"some_slow", "tell_process", "SECONDS_TOO_LONG", "Path", "time", "os"} <= set(names)
    assert "SCRIPT" not in names and "ranks" not in names
    assert list(code_of(len, "len")) == ["len"]  # which has no file
