# SPDX-License-Identifier: GPL-2.0-or-later
"""LAMMPS' soft walls beside rigid grains: they work at short timesteps, and their limit is told by name."""

from math import exp, pi, sqrt
from pathlib import Path

import pytest
from lammps import lammps

pytestmark = [pytest.mark.fast, pytest.mark.overlaps_not_asked("the wall is soft, and no wall of ours")]

MASS, RADIUS, SPRING, GRAVITY = 1.0, 0.1, 1e4, 10.0
CONTACT_TIME = pi * sqrt(MASS / SPRING)


def column(log: Path, dt: float, grains: int = 3) -> lammps:
    """Return a column of rigid grains above a soft floor at z = 0, without damping."""
    lmp = lammps(cmdargs=["-screen", "none", "-log", str(log)])
    lmp.commands_list(
        [
            "units si",
            "atom_style sphere",
            "atom_modify map yes",
            "boundary f f f",
            "region box block -1 1 -1 1 -1 9",
            "create_box 1 box",
            *[f"create_atoms 1 single 0 0 {RADIUS + 2 * RADIUS * k}" for k in range(grains)],
            f"set group all diameter {2 * RADIUS}",
            f"set group all mass {MASS}",
            "pair_style nscd",
            "pair_coeff * *",
            f"fix g all gravity {GRAVITY} vector 0 0 -1",
            f"fix floor all wall/gran hooke {SPRING} NULL 100 NULL 0 0 zplane 0 NULL",
            "fix hard all nscd",
            f"timestep {dt}",
        ]
    )
    return lmp


def test_a_column_rests_on_a_soft_floor(tmp_path: Path) -> None:
    lmp = column(tmp_path / "log", CONTACT_TIME / 20)
    lmp.command("run 4000")
    sinks = RADIUS - lmp.extract_atom("x")[0][2]
    assert sinks == pytest.approx(3 * MASS * GRAVITY / SPRING, rel=1e-3)
    lmp.close()


@pytest.mark.parametrize("share", [0.05, 0.2])
def test_a_soft_floor_throws_grains_too_fast_by_a_known_factor(tmp_path: Path, share: float) -> None:
    """A spring without damping, whose force is that of a step's start: per step amplitudes grow by 1 + (w dt)^2 / 4.

    A contact lasts pi / (w dt) steps; LAMMPS needs some damping, or its forces are no numbers.
    """
    lmp = column(tmp_path / "log", share * CONTACT_TIME, grains=1)
    floor = f"fix floor all wall/gran hooke {SPRING} NULL 1e-9 NULL 0 0 zplane 0 NULL"
    lmp.commands_list(["unfix floor", "set group all z 1.1", floor, "thermo 0", "run 1 post no"])
    z, v = lmp.extract_atom("x")[0], lmp.extract_atom("v")[0]
    falls = 0.0
    while not (z[2] > RADIUS and v[2] > 0):
        lmp.command("run 1 pre no post no")
        if z[2] > RADIUS and v[2] < 0:
            falls = sqrt(v[2] ** 2 + 2 * GRAVITY * (z[2] - RADIUS))
    leaves = sqrt(v[2] ** 2 + 2 * GRAVITY * (z[2] - RADIUS))
    lmp.close()
    assert leaves / falls == pytest.approx(exp(pi**2 / 4 * share), rel=0.02)


def test_a_soft_wall_is_told_by_name_once(tmp_path: Path) -> None:
    lmp = column(tmp_path / "log", CONTACT_TIME / 20)
    lmp.commands_list(["run 1", "run 1"])
    lmp.close()
    told = [line for line in (tmp_path / "log").read_text().splitlines() if "soft wall" in line]
    assert len(told) == 1
    assert "Fix nscd hard: fix floor (style wall/gran) is a soft wall" in told[0] and "fix wall/nscd" in told[0]
