# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes that random search found, cut down to what mattered."""

from __future__ import annotations

import numpy as np
import pytest
import random_runs
from random_scenes import Scene
from scenes import DOORS, FLOOR, GRAVITY, grains, harden, per_atom, state, trajectory

import nscd_lmp

pytestmark = pytest.mark.fast

BOTH = pytest.mark.parametrize("door", DOORS)
LAWS = list(nscd_lmp.LAWS)
RADIUS = 0.05


@BOTH
def test_grain_that_lands_keeps_its_overlap_bound_while_a_far_one_is_pushed(start, door):
    # the midpoint displacement was allowed to drive it in by ten tolerances of the far grain's velocity
    balls = grains([(0, 0, RADIUS), (5, 5, 5)], RADIUS, mass=[1.0, 1e-4], v=[(0, 0, -0.09), (0, 0, 0)])
    lmp = start(balls, 1e-3, gravity=GRAVITY, vmax=200.0)
    lmp.commands_list(["group far id 2", "fix push far addforce 9.81 0 0"])
    harden(lmp, door, walls=[FLOOR])
    x, _ = trajectory(lmp, 1)
    assert (RADIUS - x[:, 0, 2]).max() <= 5e-4 * RADIUS


@BOTH
@pytest.mark.parametrize("e", [0.0, 1.0])
def test_pair_that_meets_late_in_a_step_of_law_moreau_overlaps_and_is_reported(start, door, e):
    # apart at the middle of the step, so no contact yet; 0.5 mm deep at its end, as the run's check of all pairs sees
    lmp = start(grains([(0, 0, 0), (1.0015, 0, 0)], 0.5, v=[(1.0, 0, 0), (-1.0, 0, 0)]), 1e-3)
    attached = harden(lmp, door, law="moreau", restitution=e)
    lmp.command("run 1")
    said = attached.stats["largest_overlap"][-1] if attached else lmp.extract_fix("nscd", 0, 1, 7)
    assert said == pytest.approx(5e-4, rel=1e-9)
    assert (attached.stats["contacts"][-1] if attached else lmp.extract_fix("nscd", 0, 1, 0)) == 0


@BOTH
def test_pair_beyond_the_list_that_meets_late_in_a_step_of_law_moreau_is_reported(start, door):
    # listed up to 0.17 m apart, 0.19 m at the start and 0.09 m at the end of the step
    lmp = start(grains([(0, 0, 0), (0.19, 0, 0)], RADIUS, v=[(100.0, 0, 0), (0, 0, 0)]), 1e-3)
    lmp.commands_list(["pair_style zero 0.12", "pair_coeff * *", "neighbor 0.05 nsq"])
    attached = harden(lmp, door, law="moreau")
    lmp.command("run 1")
    said = attached.stats["largest_overlap"][-1] if attached else lmp.extract_fix("nscd", 0, 1, 7)
    assert said == pytest.approx(0.01, rel=1e-9)


def corner(far, spins):
    """Return a grain that turns and meets three walls at once, which would make energy, and a far pair that meets."""
    x = [((RADIUS - 0.28 * RADIUS) / 0.96, RADIUS, RADIUS), (5, 2, 2), (5 + 2 * RADIUS, 2, 2)]
    random = np.random.default_rng(10)
    v, turn = -np.abs(random.normal(size=3)), 2 / RADIUS * random.normal(size=3)
    return grains(x, RADIUS, 1.0, [v, (far, 0, 0), (-far, 0, 0)], omega=[turn, spins, spins])


WALLS = [FLOOR, nscd_lmp.Plane((0, 0, 0), (0.96, 0, 0.28)), nscd_lmp.Plane((0, 0, 0), (0, 1, 0))]
TIGHT = {"criterion": "natural", "tol": 1e-10, "maxiter": 100000}


@BOTH
@pytest.mark.parametrize("law", LAWS)
def test_elastic_pair_parts_as_it_met_while_impulses_elsewhere_are_scaled_back(start, door, law):
    lmp = start(corner(0.5, (0, 0, 0)), 1e-4, box=[(-1, 7)] * 3, vmax=60.0)
    harden(lmp, door, walls=WALLS, law=law, restitution=1.0, friction=0.5, **TIGHT)
    lmp.command("run 1")
    np.testing.assert_allclose(state(lmp)[1][1:, 0], [-0.5, 0.5], rtol=0, atol=1e-8)


@BOTH
@pytest.mark.parametrize("law", LAWS)
def test_grain_in_a_corner_makes_no_energy_while_others_dissipate(start, door, law):
    balls = corner(50.0, (0, 0, 2000.0))
    lmp = start(balls, 1e-4, box=[(-1, 7)] * 3, vmax=60.0)
    harden(lmp, door, walls=WALLS, law=law, restitution=1.0, friction=0.5, **TIGHT)
    spin = 0.2 * RADIUS**2 * (balls.omega[0] ** 2).sum()
    lmp.command("run 1")
    after = 0.2 * RADIUS**2 * (per_atom(lmp, "omega")[0] ** 2).sum() + 0.5 * (state(lmp)[1][0] ** 2).sum()
    assert after <= (0.5 * (balls.v[0] ** 2).sum() + spin) * (1 + 1e-8)


@BOTH
def test_contacts_that_do_not_push_connect_no_islands(door):
    # a slow column was judged by what a fast grain beside it had at stake, and thrown at twice its speed
    scene = Scene(
        n=31, seed=88, sizes=50.0, masses=1e6, layout="columns", room="loose", speed=10.0, turns=False,
        boundary="p p f", tilt=0.0, gravity=False, pushes=(), obstacles=0, move="stands", grows=0.0, deforms="",
        e=0.9, mu=0.3, law="gap", dt=1e-3, steps=3, tight=False,
    )  # fmt: skip
    random_runs.run(scene, door)
