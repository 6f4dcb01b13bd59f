# SPDX-License-Identifier: GPL-2.0-or-later
"""Sweeps: the table and the files that come of scripts and functions, and the command."""

from __future__ import annotations

import csv
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import processes
import pytest
import sweep_cases
from test_cli import PROGRAM

import nscd_lmp
from nscd_lmp import cli
from nscd_lmp.sweeps.values import read_range, read_value, split_list


@pytest.fixture(autouse=True)
def script(tmp_path, monkeypatch):
    """Work in an empty folder but for the script, whose path this is."""
    return sweep_cases.begin(tmp_path, monkeypatch)


@pytest.mark.fast
def test_grid_over_a_script_has_a_row_for_each_point_in_order(script):
    table = nscd_lmp.sweep(
        script,
        {"n": [20, 30], "dt": np.array([1e-4, 2e-4]), "law": "gap"},
        folder="out",
        processes=2,
        results=["ke", "v_height", "f_hard[1]"],
        progress=False,
    )
    assert [(row["n"], row["dt"], row["law"]) for row in table] == [
        (n, dt, "gap") for n in (20, 30) for dt in (1e-4, 2e-4)
    ]
    assert sweep_cases.statuses(table) == ["ok"] * 4
    assert table["steps"].tolist() == [200, 100] * 2
    assert table.columns[-5:] == ["status", "seconds", "message", "warnings", "folder"]
    for row in table:
        home = Path("out", f"n={row['n']}_dt={row['dt']}")
        assert row["folder"] == str(home)
        # what LAMMPS printed in its log, and what it wrote where the variable `folder` said
        assert f"{row['steps']}   {row['ke']:.8g}".split() in [
            line.split() for line in (home / "log.lammps").read_text().splitlines()
        ]
        heights = np.loadtxt(home / "dump.last", skiprows=9)[:, 3]
        assert row["v_height"] == pytest.approx(heights.mean(), rel=1e-5)  # the dump has 6 digits
        assert len(heights) == row["n"]
        assert row["f_hard[1]"] == row["last_contacts"] > 0
        assert 0 < row["seconds_solver"] + row["seconds_contacts"] < row["seconds"] < 10
        assert row["worst_overlap_ratio"] < 1e-3  # what law gap promises
        assert row["unconverged_steps"] == 0


def test_table_file_has_the_rows_with_all_digits(script):
    table = nscd_lmp.sweep(script, {"dt": [1e-4, 2e-4]}, folder="out", results={"energy": "ke"}, progress=False)
    with open(table.path, newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == table.columns
    assert [float(row["energy"]) for row in rows] == table["energy"].tolist()
    assert [float(row["seconds"]) for row in rows] == table["seconds"].tolist()


def test_list_of_cases_with_a_grid_is_every_case_at_every_point():
    listed = [{"base": 2, "add": 0}, {"base": 3}]
    table = nscd_lmp.sweep(sweep_cases.power, {"exponent": (1, 2)}, cases=listed, folder="out", progress=False)
    assert [(row["base"], row["exponent"], row["power"]) for row in table] == [
        (2, 1, 2), (2, 2, 4), (3, 1, 4), (3, 2, 10),
    ]  # fmt: skip
    assert table.rows[0]["add"] == 0 and table.rows[2]["add"] is None
    assert Path("out/base=3_exponent=2/seen").read_text() == "3"


def test_function_of_a_program_file_is_found_by_each_case():
    Path("study.py").write_text(
        "import nscd_lmp\n\n\ndef double(folder, x):\n    import factor\n\n    return {'double': factor.two * x}\n\n\n"
        "if __name__ == '__main__':\n"
        "    table = nscd_lmp.sweep(double, {'x': [1, 2.5]}, folder='out', progress=False)\n"
        "    print(table['double'].tolist(), table['status'])\n"
    )
    Path("factor.py").write_text("two = 2\n")
    done = subprocess.run([sys.executable, "study.py"], capture_output=True, text=True, check=True)
    assert done.stdout == "[2.0, 5.0] ['ok' 'ok']\n"
    table = nscd_lmp.sweep("study.py:double", {"x": [4]}, folder="by_name", progress=False)
    assert table["double"].tolist() == [8]


def test_two_ranks_give_the_results_of_one(script):
    one = nscd_lmp.sweep(script, {"dt": [2e-4]}, folder="one", results="v_height", progress=False)
    two = nscd_lmp.sweep(script, {"dt": [2e-4]}, folder="two", ranks=2, results="v_height", progress=False)
    assert "1 by 2 by 1 MPI processor grid" in Path("two/dt=0.0002/log.lammps").read_text()
    # impacts within tol, in other orders; the grains have fallen by a third
    assert two["v_height"] == pytest.approx(one["v_height"], rel=1e-2)
    asked = nscd_lmp.sweep(sweep_cases.ranks, {"x": [1]}, folder="asked", ranks=2, progress=False)
    assert asked.rows[0]["ranks"] == 2


def test_columns_that_results_share_with_variables_are_told_apart(script):
    with_steps = sweep_cases.SCRIPT.replace("run $(ceil(0.02/v_dt))", "variable steps index 5\nrun ${steps}")
    Path(script).write_text(with_steps)
    named = {"iterations": "f_hard[1][6]+1", "seconds": "2*step"}
    table = nscd_lmp.sweep(script, {"steps": [3, 4]}, folder="out", results=named, progress=False)
    assert table["steps"].tolist() == table["result_steps"].tolist() == [3, 4]
    assert table["result_seconds"].tolist() == [6, 8]
    assert table["iterations"].tolist() == [1, 1]  # grains have not met yet
    assert all(0 < seconds < 3 for seconds in table["seconds"])


def test_names_of_folders_are_safe_short_and_different():
    longs = ["x" * 300 + "1", "x" * 300 + "2"]
    table = nscd_lmp.sweep(sweep_cases.same, {"word": ["a/../b *", "a/../b %", *longs]}, folder="out", progress=False)
    names = [Path(row["folder"]).name for row in table]
    assert table["word"].tolist() == ["a/../b *", "a/../b %", *longs]
    assert len(set(names)) == 4
    assert all(len(name) <= 120 and not set(name) & set("/* %,") for name in names)


# the command


def test_command_prints_a_table_and_exits_1_after_failures(script, capsys):
    words = ["sweep", script, "--vary", "n=20,30", "--vary", "then=nothing,fail", "--set", "dt=2e-4", "--folder", "out"]
    assert cli.main([*words, "--results", "height=c_middle[3],f_hard[1]"]) == 1
    shown = capsys.readouterr()
    assert "2 of 4 cases have failed" in shown.err
    assert "out/sweep.csv" in shown.out
    rows = [line.split("│")[1:-1] for line in shown.out.splitlines() if line.startswith("│")]
    cells = [[cell.strip() for cell in row] for row in rows if row[0].strip()]
    assert [(row[0], row[1], row[4]) for row in cells] == [
        ("20", "nothing", "ok"), ("20", "fail", "failed"), ("30", "nothing", "ok"), ("30", "fail", "failed"),
    ]  # fmt: skip
    assert float(cells[0][2]) > 0 and cells[1][2] == ""
    assert cli.main([*words, "--results", "height=c_middle[3],f_hard[1]", "--allow-failures"]) == 0
    assert "4 of 4 cases are there already" in capsys.readouterr().err


def test_warnings_of_lammps_and_of_python_reach_the_row(script):
    table = nscd_lmp.sweep(script, {"law": ["gap", "moreau"]}, folder="out", progress=False)
    assert table.rows[0]["warnings"] == ""
    assert "WARNING: Fix nscd hard: grains overlap by up to" in table.rows[1]["warnings"]
    assert "(" not in table.rows[1]["warnings"]  # no places in the code of LAMMPS
    again = nscd_lmp.sweep(script, {"law": ["gap", "moreau"]}, folder="out", progress=False)
    assert again.rows == table.rows
    table = nscd_lmp.sweep(sweep_cases.warned, {"x": [1]}, folder="warned", progress=False)
    assert table.rows[0]["warnings"] == "first; second of two lines"
    assert table.rows[0]["status"] == "failed" and table.path.read_text().count("first; second") == 1


def test_script_with_includes_runs_from_any_folder(script, tmp_path, monkeypatch):
    Path("inputs/parts").mkdir(parents=True)
    Path("inputs/parts/middle").write_text("include inputs/parts/last\n")
    Path("inputs/parts/last").write_text("variable height equal c_middle[3]\n")
    text = sweep_cases.SCRIPT.replace("variable height equal c_middle[3]", "include inputs/${part}")
    Path("inputs/in.fall").write_text("variable part index parts/middle\n" + text)
    Path("else where").mkdir()
    for folder in ("else where", "."):
        monkeypatch.chdir(tmp_path / folder)
        path = tmp_path / "inputs" / "in.fall"
        table = nscd_lmp.sweep(path, {"n": [20]}, folder="out", results=["v_height"], progress=False)
        assert sweep_cases.statuses(table) == ["ok"], table.rows[0]["message"]
        assert Path("out/n=20/dump.last").exists()
        if folder == ".":  # where the script finds all by itself, it is run as it is
            assert not list(Path("out/n=20").glob("in.*"))
    assert not list((tmp_path / "inputs").glob("*dump*"))


def test_command_takes_cases_of_a_file_and_functions(capsys):
    Path("cases.csv").write_text("base,exponent\n2,3\n10,0.5\n")
    function = f"{sweep_cases.__file__}:power"
    assert cli.main(["sweep", function, "--cases", "cases.csv", "--folder", "out", "--set", "add=1"]) == 0
    assert [row.split(",")[:4] for row in Path("out/sweep.csv").read_text().splitlines()[1:]] == [
        ["2", "3", "1", "9.0"], ["10", "0.5", "1", str(10**0.5 + 1)],
    ]  # fmt: skip
    # as spreadsheets save it
    Path("cases.csv").write_text("base,exponent\n2,3\n10,0.5\n", encoding="utf-8-sig")
    assert cli.main(["sweep", function, "--cases", "cases.csv", "--folder", "out", "--set", "add=1"]) == 0
    Path("cases.csv").write_text("base,exponent,base\n2,3,4\n")
    assert cli.main(["sweep", function, "--cases", "cases.csv", "--folder", "out"]) == 1
    assert "'cases.csv' has the column 'base' twice" in capsys.readouterr().err
    Path("cases.csv").write_text("base,exponent\n2\n")
    assert cli.main(["sweep", function, "--cases", "cases.csv", "--folder", "out"]) == 1
    assert "line 2 of 'cases.csv'" in capsys.readouterr().err


@pytest.mark.fast
def test_command_tells_what_is_wrong(script, capsys):
    for words, told in (
        (["--vary", "n"], "--vary n is not NAME=VALUE"),
        (["--vary", "dt=0:1:5log"], "'0:1:5log' is no range"),
        (["--vary", "n=1", "--vary", "n=2"], "'n' is given twice by --vary"),
        (["--vary", "n=1", "--set", "n=2"], "'n' is in --vary and in --set"),
        ([], "no cases"),
    ):
        assert cli.main(["sweep", script, "--folder", "out", *words]) == 1
        assert told in capsys.readouterr().err


def test_command_is_interrupted_by_ctrl_c(script):
    words = [*PROGRAM, "sweep", script, "--vary", "then=nothing,forever", "--folder", "out"]
    with processes.started(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        sweep_cases.wait_for(lambda: Path("out/then=forever/dump.last").exists(), "the second case")
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=20)
    assert process.returncode == 130
    assert "interrupted" in err
    assert len(Path("out/sweep.csv").read_text().splitlines()) == 2


@pytest.mark.fast
def test_words_of_the_command_line_are_numbers_words_ranges_and_lists():
    assert [read_value(word) for word in ("3", "1e-4", "-2.5", "gap", "e", "1-2")] == [3, 1e-4, -2.5, "gap", "e", "1-2"]
    assert read_range("1e-5:1e-3:3log") == [1e-5, 1e-4, 1e-3]
    assert read_range("0:10:3") == [0, 5, 10]
    assert read_range("0:1:3") == [0, 0.5, 1]
    assert read_range("a:b:3") is None
    assert split_list("ke, f_a[1], max(v_a,v_b)") == ["ke", "f_a[1]", "max(v_a,v_b)"]
