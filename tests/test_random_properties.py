# SPDX-License-Identifier: GPL-2.0-or-later
"""Random scenes: what no step of any of them may break.

CI runs the same few scenes each time. `NSCD_PROPERTY_MINUTES=30 pytest tests/test_random_properties.py` shares so much
time among the tests, with other scenes in every round; the seed of a round that fails is printed.
"""

from __future__ import annotations

import faulthandler
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import random_ranks
import random_runs
import random_scenes
from hypothesis import HealthCheck, given, seed, settings
from hypothesis import strategies as st
from random_scenes import Push, Scene
from test_ranks import execute

MINUTES = float(os.environ.get("NSCD_PROPERTY_MINUTES", 0))
TESTS = 4  # that share them
LONGEST = 120  # s that a scene may take before it is called a hang, and ends the tests with a traceback
QUIET = {"deadline": None, "database": None, "suppress_health_check": list(HealthCheck)}
# Kinds of faults that are not mended yet
KNOWN: tuple[str, ...] = ()


def explore(check: Callable[..., None], *strategies: Any, examples: int) -> None:
    """Have hypothesis look for arguments that fail the check: a few in CI, for minutes on demand."""

    def timed(*drawn: Any) -> None:
        faulthandler.dump_traceback_later(LONGEST, exit=True)
        try:
            check(*drawn)
        finally:
            faulthandler.cancel_dump_traceback_later()

    # hypothesis wants names of its own for what it draws
    def search(drawn: Any) -> None:
        timed(*drawn)

    drawn = st.tuples(*strategies)
    if not MINUTES:
        settings(max_examples=examples, derandomize=True, **QUIET)(given(drawn)(search))()
        return
    end, number = time.monotonic() + 60 * MINUTES / TESTS, 0
    while time.monotonic() < end:
        number += 1
        print(f"round {number}", flush=True)
        seed(number)(settings(max_examples=50, **QUIET)(given(drawn)(search)))()


CALM: dict[str, Any] = {"sizes": 1.0, "masses": 1.0, "speed": 0.1, "turns": False, "tilt": 0.0, "gravity": False}
CALM |= {"pushes": (), "obstacles": 0, "move": "stands", "grows": 0.0, "deforms": "", "mu": 0.0, "steps": 1}
COLUMNS = CALM | {"law": "gap", "tight": False, "layout": "columns", "boundary": "p p f", "dt": 1e-3}
FOUND = {
    # impacts that do not end left courses that contradict each other
    "elastic columns": Scene(n=30, seed=0, room="loose", e=1.0, **COLUMNS | {"obstacles": 1}),
    # others stop what bends a course
    "columns of 50 sizes": Scene(
        n=33,
        seed=315,
        room="loose",
        e=0.5,
        **COLUMNS | {"sizes": 50.0, "speed": 10.0, "pushes": (Push(grain=1, weights=1000.0, direction=(0, 0, -1)),)},
    ),
    # a light grain leaves the plane that it was given
    "light among heavy": Scene(
        n=14,
        seed=482,
        room="dense",
        e=0.5,
        **COLUMNS
        | {"masses": 806000.0, "layout": "apart", "speed": 1.0, "boundary": "p p p", "dt": 5e-3}
        | {"pushes": (Push(3, 0.01, (0, 0, 1)), Push(3, 0.01, (0, -1, 1)))},
    ),
    # what is jammed in a box that closes in was slowed down as if something held it
    "jammed across a face": Scene(
        n=36,
        seed=129,
        room="dense",
        e=0.0,
        **COLUMNS
        | {"layout": "overlapping", "masses": 649000.0, "speed": 0.0, "boundary": "p p p", "deforms": "none"}
        | {"mu": 1.0, "law": "moreau", "dt": 1e-4, "steps": 3},
    ),
    # an image moves with two edges of the box
    "corner of a sheared box": Scene(
        n=10,
        seed=233,
        room="dense",
        e=0.0,
        **COLUMNS | {"layout": "overlapping", "speed": 0.0, "tilt": -0.5, "deforms": "none", "law": "moreau"},
    ),
}


@pytest.mark.parametrize("scene", FOUND.values(), ids=list(FOUND))
def test_scenes_that_broke_an_invariant(scene: Scene) -> None:
    random_runs.run(scene)


# A million weights: what the core refused when it looked ahead for the next list ended the program.
@pytest.mark.parametrize("door", ["python", "script"])
def test_scene_that_moves_too_far_is_refused(door: str) -> None:
    pushes = (Push(10, 1.0, (0, 0, -1)), Push(0, 1e-5, (1, 0, 0)), Push(38, 1e6, (0, 0, -1)))
    scene = CALM | {"speed": 10.0, "turns": True, "gravity": True, "pushes": pushes, "obstacles": 1, "move": "linear"}
    scene |= {
        "mu": 0.3,
        "steps": 16,
        "law": "moreau",
        "tight": False,
        "layout": "apart",
        "boundary": "p p p",
        "dt": 1e-3,
    }
    assert random_runs.run(Scene(n=39, seed=363, room="dense", e=0.0, **scene), door).refused


def test_random_scenes_break_no_invariant() -> None:
    explore(lambda scene: random_runs.run(scene, but=KNOWN) and None, random_scenes.random_scenes(), examples=60)


def test_random_scenes_are_the_same_through_all_doors() -> None:
    def check(scene: Scene) -> None:
        python, script = (random_runs.run(scene, door, random_runs.KINDS) for door in ("python", "script"))
        # the script door can ask for a new list where the Python door has to refuse
        steps = min(len(python.states), len(script.states))
        assert python.refused or not script.refused, script.refused
        lengths = np.diag(random_scenes.place(scene).edges)
        for number in range(steps):
            one, other = (record.states[number].x for record in (python, script))
            # One door has built a list earlier, and what is wrapped is rounded; in a box that moves by its edges then.
            if (np.abs(one - other) > 0.2 * lengths).any():
                if not scene.deforms:
                    wraps = np.round((one - other) / lengths)
                    np.testing.assert_allclose(one - wraps * lengths, other, rtol=0, atol=1e-13 * lengths.max())
                return
            for name in ("x", "v", "omega"):
                one, other = (getattr(record.states[number], name) for record in (python, script))
                np.testing.assert_array_equal(one, other, err_msg=f"{name} after step {number}")

    # in slanted boxes attach moves grains by round-off: LAMMPS does when it tells its cutoff; the rate of a box under
    # remap v is known to the script door one step earlier
    explore(check, random_scenes.random_scenes(tilt=0.0).filter(lambda scene: scene.deforms != "v"), examples=30)


# What may happen between two runs, filled with a grain and with numbers.
CHANGES = {
    "goes": ["group gone id {grain}", "delete_atoms group gone compress no", "group gone delete"],
    "comes": [
        "create_atoms 1 random 1 {seed} box overlap {least} maxtry 50",
        "set atom {new} diameter {diameter}",
        "set atom {new} mass {number}",
        "group grains id {new}",
    ],
    "stops": ["group one id {grain}", "velocity one set 0 0 0", "group one delete"],
    "kicked": ["group one id {grain}", "velocity one set 0 {speed} -{speed}", "group one delete"],
    "swells": ["set atom {grain} diameter {diameter}"],
    "lighter": ["set atom {grain} mass {number}"],
    "hurries": ["timestep {step}"],
}


@pytest.mark.parametrize("door", ["python", "script"])
def test_overlaps_are_known_whatever_changes_between_runs(door: str) -> None:
    def check(scene: Scene, changes: list[tuple[str, int, float]]) -> None:
        placed = random_scenes.place(scene)
        lmp = random_scenes.build(scene, placed)
        try:
            random_runs.harden(lmp, scene, placed, door)
            lmp.command("run 3")
            for change, grain, number in changes:
                random_runs.change(lmp, scene, CHANGES[change], grain, number)
                lmp.command("run 3")  # watched_runs asks
        except Exception as error:
            random_runs.require_remedy(error)
        finally:
            lmp.close()

    change = st.tuples(st.sampled_from(list(CHANGES)), st.integers(1, 40), st.floats(0.01, 1.0))
    # LAMMPS crashes where create_atoms meets fix adapt; fix deform carries grains after a step, before the question
    alone = random_scenes.random_scenes(pushes=(), law="gap", grows=0.0, deforms="")
    explore(check, alone, st.lists(change, min_size=1, max_size=4), examples=25)


@pytest.fixture(scope="module")
def on_ranks(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder with what random_ranks.py left on 1 and on 2 ranks."""
    folder = tmp_path_factory.mktemp("ranks")
    for count in (1, 2):
        execute(count, random_ranks.__file__, str(folder))
    return folder


@pytest.mark.parametrize("door", ["python", "script"])
@pytest.mark.parametrize("number", range(len(random_ranks.SCENES)))
def test_scenes_on_several_ranks_move_as_on_one(on_ranks: Path, number: int, door: str) -> None:
    one, two = (np.load(on_ranks / f"{number}.{door}.{count}.npz") for count in (1, 2))
    scene = random_ranks.SCENES[number]
    # velocities that are unique differ by the tolerance of each step; the others by as much as the default allows
    worth = max(scene.speed, random_scenes.GRAVITY * scene.dt)
    assert np.abs(one["v"] - two["v"]).max() <= (1e-6 if scene.tight else 0.1) * worth
