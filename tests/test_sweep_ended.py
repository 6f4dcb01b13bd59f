# SPDX-License-Identifier: GPL-2.0-or-later
"""Cases that fail, and sweeps that are ended and go on."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import sweep_cases

import nscd_lmp


@pytest.fixture(autouse=True)
def script(tmp_path, monkeypatch):
    """Work in an empty folder but for the script, whose path this is."""
    return sweep_cases.begin(tmp_path, monkeypatch)


def test_failed_script_is_a_row_beside_good_ones(script):
    table = nscd_lmp.sweep(script, {"then": ["nothing", "fail", "quit"], "n": 20}, folder="out", progress=False)
    assert sweep_cases.statuses(table) == ["ok", "failed", "failed"]
    assert table.rows[0]["message"] == ""
    assert table.rows[1]["message"].startswith("ERROR: Unrecognized fix style 'no/such'")
    assert table.rows[1]["steps"] == 100 and table.rows[1]["worst_overlap_ratio"] < 1e-3
    assert "quit" in table.rows[2]["message"]
    assert [row["then"] for row in table.failures] == ["fail", "quit"]
    assert np.isnan(table["worst_overlap_ratio"][2])


def test_result_that_lammps_cannot_tell_fails_the_case_and_keeps_the_others(script):
    table = nscd_lmp.sweep(script, {"n": [20]}, folder="out", results=["nosuch", "ke"], progress=False)
    assert sweep_cases.statuses(table) == ["failed"]
    assert table.rows[0]["message"].startswith("result 'nosuch': ERROR")
    assert table.rows[0]["nosuch"] is None and table.rows[0]["ke"] > 0


def test_every_way_to_fail_of_a_function_is_a_row():
    ways = ["no", "raise", "exit", "crash", "kill", "hang", "list", "array"]
    table = nscd_lmp.sweep(sweep_cases.fail, {"way": ways}, folder="out", timeout=5, processes=2, progress=False)
    assert dict(zip(ways, sweep_cases.statuses(table), strict=True)) == dict.fromkeys(ways, "failed") | {
        "no": "ok", "kill": "killed", "hang": "timeout", "array": "ok",
    }  # fmt: skip
    message = dict(zip(ways, table["message"], strict=True))
    assert message["raise"] == "ValueError: first line"
    assert "SIGSEGV" in message["crash"]
    assert "SIGKILL" in message["kill"]
    assert "5 s" in message["hang"] and table.rows[ways.index("hang")]["seconds"] > 5
    assert "a dict" in message["list"]
    # a result that is no scalar is left out, and the others are there
    array = table.rows[ways.index("array")]
    assert (
        array["a"] is None and array["b"] == 2.5 and "'a' is left empty, for it is of type ndarray" in array["warnings"]
    )
    assert Path("out/way=raise/stdout.txt").read_text() == "said before\n"
    assert "second line" in Path("out/way=raise/stderr.txt").read_text()


@pytest.mark.parametrize(("way", "status"), [("raise", "failed"), ("hang", "timeout"), ("crash", "failed")])
def test_failure_of_one_of_two_ranks_ends_both(way, status):
    table = nscd_lmp.sweep(sweep_cases.fail_on_rank_1, {"way": [way]}, folder="out", ranks=2, timeout=5, progress=False)
    assert sweep_cases.statuses(table) == [status]
    if way == "raise":
        assert table.rows[0]["message"] == "ValueError: first line"
    if way == "crash":
        assert "SIGSEGV" in table.rows[0]["message"]
    processes = [int(path.read_text()) for path in Path("out", f"way={way}").glob("process.*")]
    assert len(processes) == 2
    sweep_cases.wait_for(lambda: not any(map(sweep_cases.is_running, processes)), "the end of the ranks", 5)


# sweeps that go on


def runs() -> int:
    """Return how many cases of sweep_cases.counted have begun."""
    return len(Path("runs").read_text().split())


def test_finished_cases_are_not_run_again_and_failed_ones_on_demand():
    def again(**more):
        Path("runs").write_text("")
        return nscd_lmp.sweep(sweep_cases.counted, {"x": [1, 2, 3]}, folder="out", progress=False, **more)

    first = again()
    assert (runs(), sweep_cases.statuses(first)) == (3, ["ok", "failed", "ok"])
    assert again().rows == first.rows and runs() == 0
    assert sweep_cases.statuses(again(retry=True)) == ["ok", "failed", "ok"] and runs() == 1
    Path("x2_may_pass").touch()
    assert sweep_cases.statuses(again(retry=True)) == ["ok"] * 3 and runs() == 1
    Path("out/x=1/result.json").write_text('{"status"')  # as by a full disk
    assert sweep_cases.statuses(again()) == ["ok"] * 3 and runs() == 1
    assert sweep_cases.statuses(again(ranks=2, stale="rerun")) == ["ok"] * 3 and runs() == 6


def test_cases_that_were_killed_or_had_less_time_run_again():
    def again(ways, timeout):
        table = nscd_lmp.sweep(sweep_cases.fail, {"way": ways}, folder="out", timeout=timeout, progress=False)
        return table, Path(table.rows[0]["folder"], "result.json").stat().st_mtime_ns

    for way, timeout in (("kill", 20), ("slow", 0.6)):
        (_, first), (_, second) = again([way], timeout), again([way], timeout)
        assert (second > first) == (way == "kill")
    table, _ = again(["slow"], 20)
    assert sweep_cases.statuses(table) == ["ok"]


@pytest.mark.parametrize("ranks", ["1", "2"])
def test_sweep_that_was_killed_leaves_no_process_and_goes_on(ranks):
    with sweep_cases.study(ranks) as process:
        sweep_cases.wait_for(lambda: len(list(Path("out/x=4").glob("process.*"))) == int(ranks), "all ranks")
        cases = [int(path.read_text()) for path in Path("out").glob("*/process.*")]
        assert sum(map(sweep_cases.is_running, cases)) >= int(ranks)
        process.kill()
        process.wait()
    sweep_cases.wait_for(lambda: not any(map(sweep_cases.is_running, cases)), "the end of the cases", 10)
    before = {name: Path(f"out/x={name}/result.json").stat().st_mtime_ns for name in (1, 2, 3)}
    Path("quick").touch()
    done = subprocess.run([sys.executable, sweep_cases.__file__, ranks], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == str([1, 4, 9, 16, 25, 36])
    assert before == {name: Path(f"out/x={name}/result.json").stat().st_mtime_ns for name in (1, 2, 3)}
    assert "3 of 6 cases are there already" in done.stderr
    assert "[4/6] x=4: ok, " in done.stderr


def test_ctrl_c_stops_the_cases_and_keeps_the_finished():
    with sweep_cases.study("1") as process:
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=20)
    assert "KeyboardInterrupt" in err
    assert not any(sweep_cases.is_running(int(path.read_text())) for path in Path("out").glob("*/process.0"))
    assert [line.split(",")[0] for line in Path("out/sweep.csv").read_text().splitlines()] == ["x", "1", "2", "3"]
