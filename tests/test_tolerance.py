# SPDX-License-Identifier: GPL-2.0-or-later
"""What `tol` means: a number keeps the unit of its criterion, whether it is the default or is given."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scenes import DOORS, FLOOR, GRAVITY, cloud, harden, state

import nscd_lmp

pytestmark = pytest.mark.fast

WIDTH = 0.1  # m
NATURAL: Any = {"criterion": None}  # `harden` leaves such a tol as it is given


@pytest.fixture
def fallen(start):
    """Return a function that lets 30 grains of 1 to 2 cm fall on a floor; their velocities (m/s), the description."""

    def fallen(door: str = "python", **options: Any) -> tuple[Any, str]:
        balls = cloud(30, (0.01, 0.02), WIDTH)
        box = [(0, WIDTH), (0, WIDTH), (-0.01, 1.0)]
        lmp = start(balls, 1e-3, gravity=GRAVITY, boundary="p p f", box=box, vmax=2.0)
        attached = harden(lmp, door, walls=[FLOOR], **({"solver": "apgs"} | options))
        lmp.command("run 100")
        return state(lmp)[1], attached.description if attached else ""

    return fallen


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("law", nscd_lmp.LAWS)
def test_the_default_said_is_the_default(fallen, law, door):
    plain, described = fallen(door, law=law)
    for given in (NATURAL | {"tol": 1e-3}, {"criterion": "natural", "tol": 1e-3}, {"criterion": "natural"}):
        v, again = fallen(door, law=law, **given)
        np.testing.assert_array_equal(v, plain)
        assert again == described
    paper, _ = fallen(door, law=law, criterion="paper", tol=1e-3)
    assert not np.array_equal(paper, plain)  # in m/s it is another tolerance


def test_description_names_the_criterion(fallen):
    assert "tol 0.001 (natural map), overlap" in fallen()[1]
    assert "tol 1e-05 (natural map), overlap" in fallen(**NATURAL, tol=1e-5)[1]
    assert "tol 1e-05 (criterion paper)" in fallen(criterion="paper", tol=1e-5)[1]
    assert "tol 1e-06 (criterion paper)" in fallen(paper=True, solver="pdas", tol=1e-6)[1]


def test_a_tol_beside_a_tighter_one_leaves_less_overlap(start):
    deepest = []
    for tol in (1e-2, 1e-5):
        balls = cloud(30, (0.01, 0.02), WIDTH)
        box = [(0, WIDTH), (0, WIDTH), (-0.01, 1.0)]
        lmp = start(balls, 1e-3, gravity=GRAVITY, boundary="p p f", box=box, vmax=2.0)
        attached = nscd_lmp.attach(lmp, walls=[FLOOR], tol=tol)
        lmp.command("run 100")
        deepest.append(attached.stats["largest_overlap_ratio"].max())
    assert deepest[1] < 1e-4 < deepest[0] < 1e-3  # `overlap`, 5e-4 a step, is in force beside any tol


def test_numbers_of_a_script_are_those_of_lammps(fallen):
    np.testing.assert_array_equal(fallen("script", restitution="+0.5")[0], fallen("script", restitution=0.5)[0])
