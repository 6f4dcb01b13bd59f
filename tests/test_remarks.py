# SPDX-License-Identifier: GPL-2.0-or-later
"""What the end of a run tells of steps that were taken and are not what they may be taken for, by both doors."""

from __future__ import annotations

import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scenes import DOORS, FLOOR, GRAVITY, grains, harden, start

pytestmark = pytest.mark.fast

R = 0.01  # m


def misjudged() -> Any:
    """A ball of 10 g that SBP throws up again: (42) sees 1.5e-8, the relative residual is 1.5."""
    lmp = start(grains((0, 0, R), R), 1e-4, gravity=GRAVITY)
    return lmp, {"solver": "sbp", "rho": 2.5, "law": "moreau", "tol": 1e-7, "warmstart": False, "walls": [FLOOR]}


def overlapping() -> Any:
    """A ball that moves by 0.04 r a step: law moreau stops it at the midpoint, half of that in the floor."""
    lmp = start(grains((0, 0, R + 1e-7), R, v=(0, 0, -1.0)), 4e-4, vmax=2)
    return lmp, {"law": "moreau", "walls": [FLOOR]}


def overlapping_start() -> Any:
    """Two balls that start 5 % in each other, in free fall: nothing pulls them, so nothing may push them apart."""
    lmp = start(grains([(0, 0, R), (1.95 * R, 0, R)], R), 1e-4)
    return lmp, {"law": "gap"}


def passing() -> Any:
    """A ball that flies 3 radii a step."""
    lmp = start(grains((0, 0, R), R, v=(0, 0, 30.0)), 1e-3, vmax=40)
    return lmp, {"law": "moreau"}


def unsolved() -> Any:
    """A step for which one iteration is too few."""
    lmp = start(grains([(0, 0, R), (0, 0, 3 * R)], R), 1e-4, gravity=GRAVITY)
    return lmp, {"maxiter": 1, "tol": 1e-12, "solver": "pdas", "walls": [FLOOR]}


def endless() -> Any:
    """A grain at the floor, hit by a ball of 1e6 times its mass: 3141 impacts follow each other."""
    lmp = start(grains([(0, 0, R), (0, 0, 3 * R)], R, mass=[1.0, 1e6], v=[(0, 0, 0), (0, 0, -1.0)]), 1e-5, vmax=2e3)
    return lmp, {"restitution": 1.0, "walls": [FLOOR]}


TOLD = {
    misjudged: r"1 of 1 steps met tol 1e-07 of criterion \(42\) with velocities that are off by up to 1\.5 .*natural",
    overlapping: r"grains overlap by up to 0\.02 of the smaller radius: use law gap or a smaller timestep",
    overlapping_start: r"grains overlap by up to 0\.05 of the smaller radius: start without overlap, lower tol, or",
    passing: r"grains move by up to 3 of the smallest radius in a step, and law moreau does not see them pass",
    endless: r"in 1 of 1 steps more impacts followed each other than law gap takes one after another, and the rest",
    unsolved: r"1 of 1 steps were given up above tol 1e-12, and .* smaller timestep, or raise maxiter \(now 1\) or tol",
}


@pytest.fixture
def run(tmp_path: Path) -> Any:
    """Return a function that runs commands on a scene, by a door, and returns what was told."""
    opened = []

    def run(scene: Any, door: str, commands: list[str], **options: Any) -> list[str]:
        lmp, settings = scene()
        opened.append(lmp)
        log = tmp_path / f"log.{len(opened)}"
        lmp.command(f"log {log}")
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            harden(lmp, door, **settings, **options)
            lmp.commands_list(commands)
        lmp.command("log none")
        if door == "python":
            return [str(one.message) for one in told]
        return [line for line in log.read_text().splitlines() if line.startswith("WARNING: Fix nscd")]

    yield run
    for lmp in opened:
        lmp.close()


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("scene", TOLD, ids=lambda scene: scene.__name__)
def test_end_of_a_run_tells(run, scene, door):
    (told,) = run(scene, door, ["run 1"])
    assert re.search(TOLD[scene], told), told


@pytest.mark.parametrize("door", DOORS)
def test_what_is_given_up_is_told_by_the_island_that_is_off(run, door):
    # beside a ball that 1e6 times its weight presses down, a column is 1e-6 of all that contacts have to stop
    def column_beside_press() -> Any:
        lmp = start(grains([(0, 0, R), (4 * R, 0, R), (4 * R, 0, 3 * R), (4 * R, 0, 5 * R)], R), 1e-4, gravity=GRAVITY)
        load = 1e6 * GRAVITY * float(lmp.numpy.extract_atom("rmass")[0])
        lmp.commands_list(["group first id 1", f"fix press first addforce 0 0 {-load!r}"])
        return lmp, {"maxiter": 2, "solver": "pdas", "walls": [FLOOR]}

    (told,) = run(column_beside_press, door, ["run 1"])
    off = re.search(r"given up above tol 0\.001 .*off by up to (\S+) of what", told)
    assert off and float(off[1]) > 1e-2, told


def circling() -> Any:
    """A ball that a spring presses on a fixed one, which it slides round by 0.025 of a diameter a step."""
    lmp = start(grains([(0, 0, 0), (0, 0, 2 * R)], R, v=[(0, 0, 0), (0.25, 0, 0)]), 2e-3, vmax=2)
    pull = 500 * float(lmp.numpy.extract_atom("rmass")[0])
    lmp.commands_list(["group free id 2", f"fix pull free spring tether {pull!r} 0 0 0 0"])
    return lmp, {"group": "free"}


@pytest.mark.parametrize("door", DOORS)
def test_a_flow_with_too_large_a_step_is_told(run, door):
    (told,) = run(circling, door, ["run 120"])
    said = re.search(
        r"in 120 of 120 steps grains .* by more than 0\.018 of a diameter, by (\S+) in the mean, .* slow", told
    )
    assert said and float(said[1]) == pytest.approx(0.026, rel=0.1), told
    assert run(circling, door, ["run 90"]) == []  # it has to last
    assert run(circling, door, ["run 120"], restitution=0.5) == []


@pytest.mark.parametrize("door", DOORS)
def test_each_run_tells_of_its_own_steps(run, door):
    # the ball has come to rest in the floor after the second run; the overlap is still there
    assert len(run(overlapping, door, ["run 1", "run 3", "thermo 10"])) == 2
    first, second = run(passing, door, ["run 2", "velocity all set 0 0 1", "run 2", "velocity all set 0 0 30", "run 1"])
    assert "move by up to 3 " in first
    assert "move by up to 3 " in second


@pytest.mark.parametrize("door", DOORS)
def test_a_run_in_parts_and_a_script_of_runs_tell_of_all_steps(run, door, tmp_path):
    # the script brings the ball to rest after a step in which it moved by three radii
    (tmp_path / "in.runs").write_text("run 1\nvelocity all set 0 0 1\nrun 3\n")
    script = [f"include {tmp_path / 'in.runs'}"]
    assert len([told for told in run(passing, door, script) if "move by up to 3 " in told]) == 1
    parts = run(passing, door, ['run 4 every 1 "velocity all set 0 0 1"'])
    assert len([told for told in parts if "move by up to 3 " in told]) == 1


@pytest.mark.parametrize("door", DOORS)
def test_steps_that_were_misjudged_are_told_where_unconverged_ones_are_errors(run, door):
    (told,) = run(misjudged, door, ["run 1"], unconverged="error")
    assert "use criterion natural" in told


@pytest.mark.parametrize("door", DOORS)
def test_ignore_is_about_what_solvers_leave(run, door):
    assert run(misjudged, door, ["run 1"], unconverged="ignore") == []
    assert run(unsolved, door, ["run 1"], unconverged="ignore") == []
    assert len(run(overlapping, door, ["run 1"], unconverged="ignore")) == 1


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("law", ["gap", "moreau"])
def test_nothing_is_told_of_balls_at_rest(run, door, law):
    def at_rest() -> Any:
        lmp = start(grains([(0, 0, R), (0, 0, 3 * R)], R), 1e-4, gravity=GRAVITY)
        return lmp, {"law": law, "walls": [FLOOR]}

    assert run(at_rest, door, ["run 50"]) == []


@pytest.mark.parametrize("door", DOORS)
def test_overlap_that_was_allowed_is_not_told(run, door):
    assert run(overlapping_start, door, ["run 1"], overlap=0.06) == []


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("e", [0.0, 0.5, 0.9])
def test_nothing_is_told_of_impacts_that_die_away(run, door, e):
    def hit_column() -> Any:
        heights = R * (1 + 2 * np.arange(30))
        speeds = np.where(np.arange(30) == 29, -1.0, 0.0)
        lmp = start(grains(np.outer(heights, (0, 0, 1)), R, v=np.outer(speeds, (0, 0, 1))), 1e-4, gravity=GRAVITY)
        return lmp, {"restitution": e, "walls": [FLOOR], "maxiter": 10000}

    assert run(hit_column, door, ["run 50"]) == []
