# SPDX-License-Identifier: GPL-2.0-or-later
"""A layer that is squeezed until nothing can give way: no grain is thrown, and the message says what is the matter."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scenes import DOORS, GRAVITY, box_walls, grains, harden, refusal, state

BOTH = pytest.mark.parametrize("door", DOORS)
R, SIDE, LID = 0.05, 6, 0.03  # m, grains along an edge, m/s
FASTEST = 1000 * LID  # m/s: grains slip out at hundreds of times the lid's speed where it pushes them nearly sideways


def squeezed(start: Any, seed: int) -> tuple[Any, int, list[Any]]:
    """Return an instance with a layer of grains in a box under a lid that comes down, their number, and the walls."""
    random = np.random.default_rng(seed)
    edge = 2 * R * 1.02
    width = SIDE * edge
    radius = R * random.uniform(0.9, 1.0, SIDE**2)
    x = [
        ((k // SIDE + 0.5) * edge, (k % SIDE + 0.5) * edge, radius[k] + 0.1 * R * random.uniform())
        for k in range(SIDE**2)
    ]
    lid = [((k // 9 + 0.5) * 1.4 * R, (k % 9 + 0.5) * 1.4 * R, 3.4 * R) for k in range(81)]
    n = len(x)
    balls = grains([*x, *lid], [*radius, *[R] * len(lid)], 1.0)
    lmp = start(balls, 1e-3, gravity=GRAVITY, box=[(-0.5, width + 0.5)] * 2 + [(-1, 2)], vmax=20.0)
    lmp.commands_list([f"group layer id 1:{n}", f"group lid id {n + 1}:{len(balls)}"])
    lmp.command(f"fix lid lid move linear 0 0 {-LID}")
    return lmp, n, box_walls(width)


# A scene is as hard through either door: they take turns.
@pytest.mark.parametrize(("seed", "door"), [(1, "python"), (2, "script"), (3, "python"), (7, "script")])
def test_layer_that_a_lid_squeezes_is_not_thrown(start, door, seed):
    # grains were as fast as 57,000 m/s in steps that were called solved, 163 m/s over some that were given up
    lmp, n, walls = squeezed(start, seed)
    attached = harden(lmp, door, "layer", walls=walls, unconverged="ignore")
    lmp.command("run 750 post no")
    for _ in range(350):
        lmp.command("run 1 pre no post no")
        assert np.linalg.norm(state(lmp)[1][:n], axis=1).max() <= FASTEST
    unsolved = attached.stats["unconverged_steps"][-1] if attached else lmp.extract_fix("nscd", 0, 1, 10)
    assert unsolved > 100  # it has jammed


@BOTH
def test_step_of_a_layer_that_can_no_longer_give_way_says_so(start, door):
    lmp, _, walls = squeezed(start, 1)
    harden(lmp, door, "layer", walls=walls, unconverged="error")
    with pytest.raises(
        refusal(door), match=r"nothing can give way.*leave the grains room, or stop the obstacle"
    ) as told:
        lmp.command("run 1500")
    assert "maxiter" not in str(told.value)
