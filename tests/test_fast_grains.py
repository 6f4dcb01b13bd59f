# SPDX-License-Identifier: GPL-2.0-or-later
"""Grains that an impulse makes many times as fast as any was: they pass nothing, and nothing is hidden."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from all_pairs import largest_overlap, of_lammps
from scenes import DOORS, FLOOR, GRAVITY, grains, harden, state

BOTH = pytest.mark.parametrize("door", DOORS)


def last(lmp: Any, attached: Any, name: str, column: int) -> float:
    """Return a number of the last step's report."""
    return float(attached.stats[name][-1] if attached else lmp.extract_fix("nscd", 0, 1, column))


@BOTH
@pytest.mark.parametrize("r", [0.02, 0.01])
@pytest.mark.parametrize("mu", [0.0, 0.3])
def test_heavy_ball_that_falls_on_a_layer_of_small_grains_goes_through_none(start, door, r, mu):
    # they fly off at 60 m/s: 0.5 and 1.4 of a radius deep, and 0.0000 reported
    random = np.random.default_rng(1)
    row = 2.08 * r * (np.arange(10) - 4.5)
    layer = np.stack([*np.meshgrid(row, row), np.full((10, 10), r)], axis=-1).reshape(-1, 3)
    layer[:, :2] += 0.04 * r * random.uniform(-1, 1, (100, 2))
    x = [*layer, (0.3 * r, 0.2 * r, 2 * r + 1.001)]
    balls = grains(x, [r] * 100 + [1.0], [1e-4] * 100 + [8.0], v=[(0, 0, 0)] * 100 + [(0, 0, -2.0)])
    lmp = start(balls, 5e-4, gravity=GRAVITY, box=[(-9, 9), (-9, 9), (-1, 9)], vmax=100.0)
    attached = harden(lmp, door, walls=[FLOOR], friction=mu, unconverged="ignore")
    lmp.command("run 0 post no")
    flagged = 0.0
    for _ in range(40):
        lmp.command("run 1 pre no post no")
        before, flagged = flagged, last(lmp, attached, "unconverged_steps", 10)
        true = largest_overlap(of_lammps(lmp, walls=[(FLOOR.point, FLOOR.normal)])).ratio
        assert last(lmp, attached, "largest_overlap_ratio", 9) == pytest.approx(true, rel=1e-9, abs=1e-12)
        assert true <= 1e-3 or flagged > before
    # without friction, which holds them, they get more than four times as fast as the heavy ball
    assert mu or np.linalg.norm(state(lmp)[1], axis=1).max() > 8
    assert flagged <= 2


def chain(last_gap: float) -> tuple[Any, Any]:
    """Return elastic balls in a row, each lighter than the one before, but the last, and gaps of 1e-3 but one."""
    mass = np.array([1e6, 1e5, 1e4, 1e3, 1e2, 1e1, 1e6])
    places = np.cumsum([0.0] + [1.001] * 5 + [1 + last_gap])
    return mass, grains([(place, 0, 0) for place in places], 0.5, mass, v=[(1.0, 0, 0)] + [(0, 0, 0)] * 6)


@BOTH
@pytest.mark.parametrize("dt", [1e-3, 1e-2])
def test_chain_of_elastic_balls_ever_lighter_gives_on_its_velocity_impact_by_impact(start, door, dt):
    mass, balls = chain(last_gap=10.0)
    lmp = start(balls, dt, box=[(-2, 60), (-1, 1), (-1, 1)], vmax=30.0)
    harden(lmp, door, restitution=1.0)
    # each meets one at rest: v' = v 2 m / (m + m'), and what it leaves behind, v (m - m') / (m + m')
    right, arrives = [], 1.0
    for m, lighter in itertools.pairwise(mass[:-1]):
        right.append(arrives * (m - lighter) / (m + lighter))
        arrives *= 2 * m / (m + lighter)
    lmp.command(f"run {round(0.1 / dt)}")
    np.testing.assert_allclose(state(lmp)[1][:, 0], [*right, arrives, 0], rtol=1e-5)


@BOTH
@pytest.mark.parametrize("gap", [0.05, 0.15, 0.19])
def test_lightest_of_a_chain_of_elastic_balls_does_not_fly_through_the_next(start, door, gap):
    # it gets 20 times as fast as any was, in one step
    mass, balls = chain(gap)
    lmp = start(balls, 1e-2, box=[(-2, 60), (-1, 1), (-1, 1)], vmax=30.0)
    attached = harden(lmp, door, restitution=1.0, unconverged="ignore")
    lmp.command("run 0 post no")
    flagged, left = 0.0, 5e-4
    for _ in range(30):
        lmp.command("run 1 pre no post no")
        x, v = (values[:, 0] for values in state(lmp))
        before, flagged = flagged, last(lmp, attached, "unconverged_steps", 10)
        overlap = (1 - np.diff(x).min()) / 0.5
        left = max(left, overlap) if flagged > before else left
        assert overlap <= left * (1 + 1e-6)
        assert 0.5 * (mass * v**2).sum() <= 0.5 * mass[0] * (1 + 1e-9)
    assert (mass * v).sum() == pytest.approx(mass[0], rel=1e-9)


@BOTH
@pytest.mark.parametrize("mass", [1e-3, 1e3])
def test_grain_that_two_obstacles_squeeze_out_does_not_fly_through_a_heavy_one(start, door, mass):
    # nothing stops the obstacles, so it takes the heavy one along
    r, h = 0.1, 0.05
    apart = np.sqrt((1 + r) ** 2 - h**2)
    balls = grains([(-apart, 0, 0), (apart, 0, 0), (0, h, 0), (0, 0.35, 0)], [1, 1, r, r], [1, 1, 1e-3, mass])
    lmp = start(balls, 1e-2, vmax=4.0)
    lmp.commands_list(["group left id 1", "group right id 2", "group free id 3 4"])
    lmp.commands_list(["fix left left move linear 0.9 0 0", "fix right right move linear -0.9 0 0"])
    attached = harden(lmp, door, "free")
    lmp.command("run 0 post no")
    for _ in range(10):
        lmp.command("run 1 pre no post no")
        true = largest_overlap(of_lammps(lmp, "free"))
        assert last(lmp, attached, "largest_overlap_ratio", 9) == pytest.approx(true.ratio, abs=1e-12)
        assert true.ratio <= 5e-4 * (1 + 1e-6)
    y = state(lmp)[0][:, 1]
    assert y[3] - y[2] >= 2 * r * (1 - 1e-3)
    assert last(lmp, attached, "unconverged_steps", 10) == 0
