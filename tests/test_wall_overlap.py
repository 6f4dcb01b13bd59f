# SPDX-License-Identifier: GPL-2.0-or-later
"""The promise of fix nscd beside curved and moving walls: nothing overlaps by more than 5e-4 of the smaller radius.

The distances to the walls are numpy's, from the scene's own formulas; what runs report of planes and cylinders is also
asked behind every run (watched_runs.py).
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from all_pairs import Surface, largest_overlap, of_lammps
from scenes import cloud, grains, state
from walled import series, walled

pytestmark = pytest.mark.fast

PROMISE = 5e-4  # of the smaller radius, keyword overlap
SMALL, LARGE = 0.06, 0.11  # m, radii


def drum(x, t):
    return np.minimum(0.95 - np.hypot(x[:, 0], x[:, 2]), 0.6 - np.abs(x[:, 1]))


def cone(x, t):
    """Of half-width 0.05 at z = 0 and 2 at z = 2, without a lid."""
    slope = 1.95 / 2
    side = (0.05 + slope * x[:, 2] - np.hypot(x[:, 0], x[:, 1])) / math.hypot(1, slope)
    return np.minimum(side, x[:, 2])


def bowl(x, t):
    centre = (0.1 * math.sin(8 * t), 0, 0.3 + 0.05 * math.sin(11 * t))
    return 1.3 - np.linalg.norm(x - centre, axis=1)


def turned(x, angle):
    """Return the points as a frame sees them that has turned about z."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return x @ np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])


def block(x, half_length, half_width, height):
    """Return the distance from the outside to a block on the floor; points within are at 0."""
    beyond = np.stack([np.abs(x[:, 0]) - half_length, np.abs(x[:, 1]) - half_width, x[:, 2] - height], axis=1)
    return np.linalg.norm(np.maximum(beyond, 0), axis=1)


def mixer(x, t):
    own = turned(x, 3 * t)
    blades = np.minimum(block(own, 0.45, 0.03, 0.3), block(own, 0.03, 0.4, 0.2))
    return np.minimum.reduce([blades, 0.9 - np.hypot(x[:, 0], x[:, 1]), x[:, 2]])


def box(x, t):
    """Turning about y."""
    angle = 1.5 * t
    a, c = x[:, 0] * math.cos(angle) - x[:, 2] * math.sin(angle), x[:, 2] * math.cos(angle) + x[:, 0] * math.sin(angle)
    return np.minimum.reduce([0.7 - np.abs(a), 0.5 - np.abs(x[:, 1]), c + 0.7, 0.9 - c])


# Distances, lift of the cloud, number of grains, commands.
SCENES = {
    "drum by words": (
        *(drum, -0.6, 60),
        ["fix w all wall/nscd ycylinder 0.95 rotate 4 0 0 0 0 1 0", "fix ends all wall/nscd yplane -0.6 0.6"],
    ),
    "drum that is a region": (
        *(drum, -0.6, 60),
        ["region r cylinder y 0 0 0.95 -0.6 0.6 rotate v_drum 0 0 0 0 1 0", "fix w all wall/nscd region r"],
    ),
    "cone": (cone, 0.6, 60, ["region r cone z 0 0 0.05 2 0 2 open 2", "fix w all wall/nscd region r"]),
    "bowl that is shaken": (
        *(bowl, -0.5, 60),
        ["region r sphere 0 0 0.3 1.3 move v_x NULL v_z", "fix w all wall/nscd region r"],
    ),
    "blades that turn": (
        *(mixer, 0.42, 40),
        [
            "region a block -0.45 0.45 -0.03 0.03 0 0.3 rotate v_blade 0 0 0 0 0 1",
            "region b block -0.03 0.03 -0.4 0.4 0 0.2 rotate v_blade 0 0 0 0 0 1",
            "region r union 2 a b side out",
            *("fix w all wall/nscd region r", "fix c all wall/nscd zcylinder 0.9", "fix f all wall/nscd zplane 0 NULL"),
        ],
    ),
    "box that turns": (
        *(box, -0.5, 60),
        ["region r block -0.7 0.7 -0.5 0.5 -0.7 0.9 rotate v_box 0 0 0 0 1 0", "fix w all wall/nscd region r"],
    ),
}
VARIABLES = [
    *("variable drum equal PI/2*step*dt", "variable blade equal 3*step*dt", "variable box equal 1.5*step*dt"),
    *("variable x equal 0.1*sin(8*step*dt)", "variable z equal 0.05*sin(11*step*dt)"),
]  # fmt: skip


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("mu", [0, 0.5])
@pytest.mark.parametrize("seed", [1, 2])
def test_beds_keep_the_promise_on_overlap(scene, mu, seed):
    """Two seconds: falls of half a metre, in which a step of 1e-3 s is a twentieth of a radius, and the flow behind."""
    distance, lift, count, commands = SCENES[scene]
    dt = 1e-3
    balls = cloud(count, (SMALL, LARGE), 1.0, seed)
    balls.x += (-0.5, -0.5, lift)
    lmp = walled(balls, *VARIABLES, f"fix hard all nscd friction {mu}", *commands, dt=dt, box=8.0)

    def true_overlap(lmp):
        now = lmp.extract_global("ntimestep") * dt
        return largest_overlap(of_lammps(lmp, walls=[Surface(lambda x: distance(x, now))])).ratio

    true = series(lmp, 2000, true_overlap, every=40)
    told = lmp.extract_fix("hard", 0, 2, 0, 4)  # the worst of all steps
    assert true.max() <= told * (1 + 1e-6) + 1e-9
    assert told < PROMISE
    assert lmp.extract_fix("hard", 0, 2, 0, 6) == 0  # steps that were given up
    lmp.close()


def test_a_long_step_beside_a_narrow_curve_overlaps_by_no_more_than_the_arc():
    """A ball that slides by s in a step along a curve of radius L leaves it by s^2/(8 L) at most, and comes back."""
    radius, length, dt = 0.1, 0.1, 4e-3  # a ball in a cylinder of twice its size
    speed = 2.5
    lmp = walled(grains([0, 0, -length], radius, 1.0, v=[speed, 0, 0]), "fix hard all nscd", dt=dt, gravity=(0, 0, 0))
    lmp.commands_list(["region r cylinder y 0 0 0.2 -1 1", "fix w all wall/nscd region r"])
    overlap = series(lmp, 500, lambda lmp: np.hypot(*state(lmp)[0][0, [0, 2]]) - length)
    assert overlap.max() < (speed * dt) ** 2 / (8 * length)
    lmp.close()
