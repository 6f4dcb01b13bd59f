# SPDX-License-Identifier: GPL-2.0-or-later
"""Grains that cross a wall by more than their diameter in a step, walls that are thin: what a plane holds, others hold.

Each was found by looking for grains that were on the other side without a word.
"""

from pathlib import Path

import numpy as np
import pytest
from scenes import grains, state
from walled import walled

pytestmark = pytest.mark.fast

RADIUS, DT = 0.05, 1e-2
FLOOR = """solid floor
facet normal 0 0 1
outer loop
vertex -3 -3 0
vertex 3 -3 0
vertex 3 3 0
endloop
endfacet
facet normal 0 0 1
outer loop
vertex -3 -3 0
vertex 3 3 0
vertex -3 3 0
endloop
endfacet
endsolid floor
"""
BLOCK = "region q block -3 3 -3 3 -2 0 side out"


def floor(kind: str, folder: Path) -> list[str]:
    """Return the commands of a floor at z = 0."""
    (folder / "floor.stl").write_text(FLOOR)
    words = {"plane": "zplane 0 NULL", "mesh": f"mesh {folder / 'floor.stl'}", "region": "region q"}
    return [BLOCK, f"fix w all wall/nscd {words[kind]}"]


@pytest.mark.parametrize("restitution", [0.0, 0.5])
@pytest.mark.parametrize("moves", [0.9, 1.1, 3.0, 20.0])
@pytest.mark.parametrize("kind", ["mesh", "region"])
def test_fast_grains_stay_on_their_side(kind, moves, restitution, tmp_path):
    """They move by so many diameters in a step."""
    random = np.random.default_rng(3)
    x = np.column_stack([0.25 * np.arange(-4, 5), np.zeros(9), random.uniform(0.3, 1.3, 9)])
    found = []
    for wall in ("plane", kind):
        balls = grains(x, RADIUS, v=[(0, 0, -moves * 2 * RADIUS / DT)] * 9)
        lmp = walled(balls, "fix hard all nscd", *floor(wall, tmp_path), dt=DT, material=f"restitution {restitution}")
        lmp.command("run 20")
        found.append(state(lmp)[0][:, 2])
        lmp.close()
    assert (found[1] > RADIUS - 1e-3 * RADIUS).all()
    assert found[1] == pytest.approx(found[0], rel=1e-5)


@pytest.mark.parametrize("kind", ["plane", "mesh", "region"])
def test_a_grain_that_is_struck_at_a_wall_stays_on_its_side(kind, tmp_path):
    """It is slow before the step in which a large one hits it."""
    balls = grains([(0, 0, 0.45), (0, 0, 2.9)], [0.1, 2.0], mass=[1.0, 8000.0], v=[(0, 0, 0), (0, 0, -3.0)])
    lmp = walled(
        balls,
        "fix hard all nscd",
        *floor(kind, tmp_path),
        dt=0.1,
        gravity=(0, 0, -1e-9),
        box=6.0,
        material="restitution 1",
    )
    lmp.command("run 12")
    z = state(lmp)[0][:, 2]
    lmp.close()
    assert z.min() > 0.0999


def test_a_region_that_the_fix_moves_takes_the_place_of_its_grains_along():
    """A grain that follows it down leaves the place where the region is by its own words."""
    region = ["region r block -1 1 -1 1 0 2", "fix w all wall/nscd region r wiggle z -0.1 2"]
    lmp = walled(grains([(0, 0, 0.1)], 0.1), "fix hard all nscd", *region)
    lmp.command("run 1000")
    assert state(lmp)[0][0, 2] == pytest.approx(0.1 - 0.2, abs=1e-4)
    lmp.close()


def test_nothing_is_carried_ahead_of_the_first_step_of_a_run():
    lmp = walled(grains([(0, 0, 0.1)], 0.1), "fix hard all nscd", "fix w all wall/nscd zplane 0 NULL", "run 10")
    assert lmp.numpy.extract_fix("w", 0, 1, 2) < 0
    lmp.command("run 0")
    assert [lmp.numpy.extract_fix("w", 0, 1, k) for k in (2, 6)] == [0, 0]
    lmp.close()
