# SPDX-License-Identifier: GPL-2.0-or-later
"""The program nscd-lmp: what it prints, what it writes and its exit codes."""

import os
import re
import signal
import subprocess
import sys
import time
from io import StringIO
from pathlib import Path

import processes
import pytest
from rich.console import Console

import nscd_lmp
from nscd_lmp import cli
from nscd_lmp.commands import _progress

PROGRAM = [sys.executable, "-c", "import sys; from nscd_lmp.cli import main; sys.exit(main())"]

# One ball, dropped from 1 mm above a plane: 14 steps of 1 ms in free fall, then rest.
SCENE = """
units si
atom_style sphere
boundary f f f
region box block -1 1 -1 1 0 1
create_box 1 box
create_atoms 1 single 0 0 0.101
set group all diameter 0.2 density 2500
pair_style zero 0.3
pair_coeff * *
comm_modify vel yes
timestep 1e-3
fix g all gravity 9.81 vector 0 0 -1
fix contact all nscd law moreau wall plane 0 0 0 0 0 1
thermo 1
thermo_style custom step f_contact[1] f_contact[2] f_contact[8] f_contact[9]
"""


@pytest.fixture
def write_script(tmp_path, monkeypatch):
    """Work in an empty folder, and write scripts there: the scene and more commands."""
    monkeypatch.chdir(tmp_path)

    def write(commands: str, scene: str = SCENE) -> str:
        Path("in.test").write_text(scene + commands)
        return "in.test"

    return write


def table_value(text: str, name: str) -> str:
    """Return the first word of a row of the closing table."""
    found = re.search(rf"│ {re.escape(name)} +│ +(\S+)", text)
    assert found, f"no row {name!r} in\n{text}"
    return found[1]


def thermo_rows(log: str) -> list[list[float]]:
    """Return the thermo output of a log file, without the line for the setup of the run."""
    table = re.search(r"Step .*\n((?:[-+.\de ]+\n)+)", Path(log).read_text())
    assert table
    return [[float(word) for word in line.split()] for line in table[1].splitlines()][1:]


@pytest.mark.fast
def test_run_closing_table_agrees_with_thermo_output(write_script, capsys):
    assert cli.main(["run", write_script("run 40"), "--log", "log.test"]) == 0
    shown = capsys.readouterr().out
    rows = thermo_rows("log.test")
    assert len(rows) == 40
    assert table_value(shown, "steps") == "40"
    assert table_value(shown, "contacts in the last step") == "1"
    assert float(table_value(shown, "mean iterations per step")) == pytest.approx(
        sum(row[2] for row in rows) / 40, abs=0.05
    )  # the table has one decimal
    assert float(table_value(shown, "worst overlap")) == pytest.approx(max(r[3] for r in rows), rel=5e-3)
    assert float(table_value(shown, "worst overlap / radius")) == pytest.approx(max(r[3] for r in rows) / 0.1, rel=5e-3)
    assert float(table_value(shown, "energy dissipated by contacts")) == pytest.approx(rows[-1][4], rel=5e-4)
    assert table_value(shown, "steps given up") == "0"


def test_run_shares_of_time_add_up(write_script, capsys):
    cli.main(["run", write_script("run 2000"), "--log", "none"])
    shown = capsys.readouterr().out
    parts = [float(table_value(shown, f"time in {part}")) for part in ("LAMMPS", "contacts", "solver")]
    assert sum(parts) == pytest.approx(float(table_value(shown, "wall time")), abs=0.021)  # four rounded numbers


@pytest.mark.fast
def test_run_sums_over_runs_loops_new_fixes_and_clear(write_script, capsys):
    again = """
run 10
run 30 upto
run 9 every 4 "print half"
unfix contact
fix contact all nscd law moreau wall plane 0 0 0 0 0 1
run 1
clear
next turn
jump in.test top
"""
    script = write_script(SCENE + again, scene="variable turn loop 2\nlabel top\n")
    assert cli.main(["run", script]) == 0
    assert table_value(capsys.readouterr().out, "steps") == str(2 * (30 + 9 + 1))


def test_run_twice_in_one_process_starts_from_zero(write_script, capsys):
    script = write_script("run 40")
    cli.main(["run", script])
    cli.main(["run", script])
    assert re.findall(r"│ steps +│ +(\d+)", capsys.readouterr().out) == ["40", "40"]


def test_run_counts_a_step_of_two_fixes_once(write_script, capsys):
    commands = """
group none empty
fix second none nscd
run 7
"""
    assert cli.main(["run", write_script(commands)]) == 0
    assert table_value(capsys.readouterr().out, "steps") == "7"


def test_run_sets_variables_as_lmp_does(write_script, capsys):
    script = write_script('print "values ${a} ${b} ${n}"\nnext n\nprint "next ${n}"\nrun 1')
    assert cli.main(["run", script, "-var", "a", "-4e-3", "-v", "b", "x", "-var", "n", "1", "2"]) == 0
    log = Path("log.lammps").read_text()
    assert "values -4e-3 x 1\n" in log
    assert "next 2\n" in log


def test_run_refuses_a_variable_without_a_value(write_script, capsys):
    assert cli.main(["run", write_script("run 1"), "-var", "n", "--screen"]) == 1
    assert "-var n has no value: write -var NAME VALUE" in capsys.readouterr().err


def test_run_takes_a_script_that_begins_with_a_byte_order_mark(write_script, capsys):
    script = Path(write_script("run 3"))
    script.write_text(script.read_text().lstrip(), encoding="utf-8-sig")
    assert cli.main(["run", str(script)]) == 0
    assert table_value(capsys.readouterr().out, "steps") == "3"


def test_run_screen_shows_what_lammps_prints(write_script, capfd):
    assert cli.main(["run", write_script('print "seen by the user"\nrun 3'), "--screen"]) == 0
    shown = capfd.readouterr().out
    assert "seen by the user" in shown
    assert "Loop time" in shown
    assert table_value(shown, "steps") == "3"


def test_run_without_steps_says_so(write_script, capsys):
    assert cli.main(["run", write_script("")]) == 0
    assert table_value(capsys.readouterr().out, "steps by fix nscd") == "none"


def test_run_hands_on_warnings(write_script, capsys):
    hard = "fix contact all nscd solver sbp rho 0.1 maxiter 1 tol 1e-12 wall plane 0 0 0 0 0 1\nrun 40"
    assert cli.main(["run", write_script(hard)]) == 0
    shown = capsys.readouterr()
    assert "steps were given up above tol 1e-12" in shown.err
    assert int(table_value(shown.out, "steps given up")) > 0


@pytest.mark.fast
def test_run_lammps_error_exits_1_and_shows_the_part_before(write_script, capsys):
    assert cli.main(["run", write_script("run 5\nfix wrong all no/such")]) == 1
    shown = capsys.readouterr()
    assert "Unrecognized fix style 'no/such'" in shown.err
    assert "Last input line: fix wrong all no/such" in shown.err
    assert table_value(shown.out, "steps") == "5"


def test_run_error_of_fix_nscd_exits_1_with_its_words(write_script, capsys):
    assert cli.main(["run", write_script("fix bad all nscd solver nosuch")]) == 1
    assert "nosuch" in capsys.readouterr().err


def test_run_missing_script_exits_1(write_script, capsys):
    assert cli.main(["run", "in.absent"]) == 1
    error = capsys.readouterr().err
    assert "no script 'in.absent'" in error
    assert os.getcwd() in error


def test_run_unwritable_log_exits_1(write_script, capsys):
    assert cli.main(["run", write_script("run 1"), "--log", "absent/log"]) == 1
    assert "absent/log" in capsys.readouterr().err


@pytest.mark.fast
@pytest.mark.parametrize("words", [["walk"], [], ["run"], ["demo", "--solver", "nosuch"]])
def test_wrong_usage_exits_2(words, capsys):
    with pytest.raises(SystemExit) as ended:
        cli.main(words)
    assert ended.value.code == 2


def test_quit_in_a_script_ends_with_its_code_and_the_table(write_script):
    ended = subprocess.run([*PROGRAM, "run", write_script("run 5\nquit 7")], capture_output=True, text=True)
    assert ended.returncode == 7
    assert table_value(ended.stdout, "steps") == "5"


@pytest.mark.parametrize(
    ("way", "number"),
    [(list, signal.SIGINT), (list, signal.SIGTERM), (processes.deaf, signal.SIGTERM)],
)
def test_ctrl_c_ends_the_run_but_not_the_script(write_script, way, number):
    script = write_script("shell touch started\nthermo 1000000\nrun 2000000000\nshell touch last_command")
    words = way([*PROGRAM, "run", script, "--log", "none"])
    with processes.started(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        deadline = time.monotonic() + 60
        while not Path("started").exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        time.sleep(0.3)  # into the run
        if way is processes.deaf:  # as a shell's background job it goes on after Ctrl-C
            process.send_signal(signal.SIGINT)
            time.sleep(0.3)
            assert process.poll() is None
        process.send_signal(number)
        out, err = process.communicate(timeout=60)
    assert process.returncode == 128 + number
    assert "interrupted" in err
    assert 0 < int(table_value(out, "steps")) < 2_000_000_000
    assert Path("last_command").exists()


def test_bar_shows_every_run_from_its_first_step():
    terminal = Console(file=StringIO(), force_terminal=True, width=80)
    counts = _progress.Counts(first_step=100, last_step=300, step=150, step_contacts=12, step_iterations=34)
    bar = _progress.RunBar()
    with bar.on(terminal):
        bar.show(_progress.Counts())
        assert bar.bar.tasks[0].total is None
        bar.show(counts)
        assert (bar.bar.tasks[0].completed, bar.bar.tasks[0].total) == (50, 200)
        assert "12 contacts · 34 iterations" in bar.bar.line
        counts.first_step, counts.last_step, counts.step = 300, 310, 301
        bar.show(counts)
        assert (bar.bar.tasks[0].completed, bar.bar.tasks[0].total) == (1, 10)


def test_lines_without_a_terminal(write_script, capsys, monkeypatch):
    monkeypatch.setattr(_progress, "SECONDS_BETWEEN_LINES", 0.0)
    assert cli.main(["run", write_script("run 300000"), "--log", "none", "-var", "unused", "0"]) == 0
    shown = capsys.readouterr().out
    assert re.search(r"^step \d+ of 300000, time \S+, \d+ steps/s, 1 contacts, \d+ iterations$", shown, re.M)
    assert "━" not in shown


@pytest.mark.fast
def test_info_names_build_doors_solvers_and_laws(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    assert cli.main(["info"]) == 0
    shown = capsys.readouterr().out
    unfolded = re.sub(r" *│\n│ +│ ", "", shown)  # long paths are
    for part in ("20250722", "fix nscd: yes", "nscdplugin", "fix external: yes", "MPI", "OpenMP threads"):
        assert part in unfolded
    for name in (*nscd_lmp.SOLVERS, *nscd_lmp.LAWS, nscd_lmp.__version__):
        assert name in shown
    for solver in nscd_lmp.SOLVERS.values():
        parameter = (solver.parameter, f"{solver.default:g}") if solver.parameter else ("-", "-")
        cells = (solver.name, solver.title, solver.kind, *parameter)
        assert re.search(r" +│ +".join(map(re.escape, cells)) + " ", shown)
    assert "unknowns per contact: 1, with friction 3, in dimension 2 with friction 2" in shown
    assert max(len(line) for line in shown.splitlines()) <= 80


def test_demo_writes_pictures_into_a_folder_with_a_blank(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert cli.main(["demo", "--n", "20", "--output", "my demo"]) == 0
    shown = capsys.readouterr().out
    for picture in ("bed_picture.png", "kinetic_energy.png", "overlap.png"):
        assert f"my demo/{picture}" in shown
        assert Path("my demo", picture).read_bytes().startswith(b"\x89PNG")
    assert float(table_value(shown, "worst overlap / radius")) < 1e-3  # what law gap promises
    assert table_value(shown, "steps given up") == "0"
    assert os.getcwd() == str(tmp_path)


def test_demo_too_few_grains_exits_1(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert cli.main(["demo", "--n", "3"]) == 1
    assert "at least 10" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.fast
def test_every_command_has_help_within_80_columns(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    for name in cli.find_commands():
        with pytest.raises(SystemExit) as ended:
            cli.main([name, "--help"])
        assert ended.value.code == 0
        assert max(len(line) for line in capsys.readouterr().out.splitlines()) <= 80
