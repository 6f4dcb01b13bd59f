# SPDX-License-Identifier: GPL-2.0-or-later
"""Keyword min_bounce: pairs that meet slower do not bounce, faster ones do as without it."""

import numpy as np
import pytest
from scenes import DOORS, FLOOR, grains, harden, refusal, state

pytestmark = pytest.mark.fast

BOTH = pytest.mark.parametrize("door", DOORS)
RADIUS, RESTITUTION, LEAST = 0.1, 0.5, 0.2


@BOTH
@pytest.mark.parametrize("speed", [0.19, 0.21])
def test_a_ball_that_meets_the_floor_slower_stops(start, door, speed):
    lmp = start(grains([(0, 0, RADIUS + 0.01)], RADIUS, v=[(0, 0, -speed)]), 1e-2)
    harden(lmp, door, walls=[FLOOR], restitution=RESTITUTION, min_bounce=LEAST)
    lmp.command("run 20")
    assert state(lmp)[1][0, 2] == pytest.approx(RESTITUTION * speed if speed > LEAST else 0.0, abs=1e-9)


@BOTH
def test_a_row_of_balls_stops_where_it_has_slowed_down(start, door):
    """A ball hits two that touch: the impacts pass on while they are fast enough."""
    places = [(0, 0, 0), (2.2 * RADIUS, 0, 0), (4.2 * RADIUS, 0, 0)]
    lmp = start(grains(places, RADIUS, v=[(0.3, 0, 0), (0, 0, 0), (0, 0, 0)]), 1e-2)
    harden(lmp, door, restitution=RESTITUTION, min_bounce=0.25)
    lmp.command("run 20")
    v = state(lmp)[1][:, 0]
    # The first impact bounces: 0.075 and 0.225 m/s. The second, of 0.225, does not: both go on with half of that.
    assert np.allclose(v, [0.075, 0.1125, 0.1125], atol=1e-9)


@BOTH
@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"min_bounce": -1.0, "restitution": 0.5}, "min_bounce = -1 must be >= 0"),
        ({"min_bounce": 0.1}, "min_bounce = 0.1 has no effect without restitution: leave it out"),
        ({"min_bounce": 0.1, "restitution": 0.5, "law": "moreau"}, "min_bounce goes with law gap"),
    ],
)
def test_min_bounce_that_means_nothing_is_refused(start, door, options, message):
    lmp = start(grains([(0, 0, 1)], RADIUS), 1e-2)
    with pytest.raises(refusal(door), match=message):
        harden(lmp, door, **options)
        lmp.command("run 1")
