# SPDX-License-Identifier: GPL-2.0-or-later
"""The check that every run is asked: closed forms, and its two ways against each other."""

from __future__ import annotations

import all_pairs
import numpy as np
import pytest
import scenes
import watched_runs
from all_pairs import Spheres, largest_overlap

pytestmark = pytest.mark.fast

CUBE = 10 * np.eye(3)
SLANTED = np.array([[2.0, 0, 0], [0.9, 2.0, 0], [-0.8, 0.7, 2.0]])


def spheres(x, radius, edges=CUBE, periodic=(True, True, True), moves=True, walls=()):
    x = np.array(x, dtype=float)
    n = len(x)
    radius, moves = np.broadcast_to(radius, n).astype(float), np.broadcast_to(moves, n)
    return Spheres(x, radius, np.arange(1, n + 1), moves, edges, periodic, walls)


@pytest.mark.parametrize("x", [[(0, 0, 0), (0.7, 0, 0)], [(0.1, 0, 0), (9.4, 0, 0)], [(0, 0.1, 0), (30, -49.4, 0)]])
def test_pair_overlaps_by_what_its_nearest_images_do(x):
    found = largest_overlap(spheres(x, [0.5, 0.4]))
    distance = abs(np.subtract(*x) - 10 * np.rint(np.subtract(*x) / 10)).sum()
    assert found.largest == pytest.approx(0.9 - distance, rel=1e-12)
    assert found.ratio == pytest.approx((0.9 - distance) / 0.4, rel=1e-12)
    assert found.where == "grains 1 and 2"


def test_largest_overlap_and_largest_ratio_may_be_of_two_pairs():
    found = largest_overlap(spheres([(0, 0, 0), (1.8, 0, 0), (5, 0, 0), (5.19, 0, 0)], [1, 1, 0.1, 0.1]))
    assert found.largest == pytest.approx(0.2) and found.ratio == pytest.approx(0.2)
    found = largest_overlap(spheres([(0, 0, 0), (1.8, 0, 0), (5, 0, 0), (5.1, 0, 0)], [1, 1, 0.1, 0.1]))
    assert found.largest == pytest.approx(0.2) and found.ratio == pytest.approx(1.0)


def test_walls_count_and_pairs_of_obstacles_do_not():
    walls = [((0, 0, 0), (0, 0, 2)), ((0, 0, 9), (0, 0, -1))]
    x = [(1, 1, 0.4), (5, 5, 8.8), (5, 5, 8.5)]
    found = largest_overlap(spheres(x, 0.5, periodic=(True, True, False), moves=[True, False, False], walls=walls))
    assert found.largest == pytest.approx(0.1)
    assert found.where == "grain 1 and wall 1"


@pytest.mark.parametrize("edges", [2 * np.eye(3), SLANTED])
@pytest.mark.parametrize("periodic", [(True, True, True), (True, True, False), (False, False, False)])
def test_trees_find_what_all_pairs_find(monkeypatch, edges, periodic):
    random = np.random.default_rng(1)
    for _ in range(20):
        scene = spheres(
            random.uniform(-0.2, 1.2, (60, 3)) @ edges, 0.15 * 30 ** -random.uniform(0, 1, 60), edges, periodic
        )
        found = []
        for few in (1000, 0):
            monkeypatch.setattr(all_pairs, "FEW", few)
            found.append(largest_overlap(scene))
        assert found[0].largest == pytest.approx(found[1].largest, rel=1e-9)
        assert found[0].ratio == pytest.approx(found[1].ratio, rel=1e-9)


def test_dump_and_live_object_hold_the_same_scene(start, tmp_path):
    balls = scenes.cloud(30, (0.2, 0.5), 3.0)
    balls.x *= 0.8
    lmp = start(balls, 1e-3, box=[(0, 4)] * 3, boundary="p p p")
    lmp.commands_list(["change_box all triclinic", "change_box all xy final 1.2 yz final -0.7 boundary p p p"])
    lmp.command(f"write_dump all custom {tmp_path / 'dump'} id x y z radius modify format float %.17g")
    ((_, dumped),) = all_pairs.of_dump(tmp_path / "dump")
    live = largest_overlap(all_pairs.of_lammps(lmp))
    assert live.largest > 0.01
    assert largest_overlap(dumped).largest == pytest.approx(live.largest, rel=1e-9)


def test_run_whose_overlap_is_misreported_fails(start, monkeypatch):
    lmp = start(scenes.grains([(0, 0, 0), (0.9, 0, 0)], 0.5), 1e-3)
    scenes.harden(lmp)
    lmp.command("run 1")
    monkeypatch.setattr(watched_runs, "reported", lambda *_: {"largest_overlap": 0.2, "largest_overlap_ratio": 0.2})
    with pytest.raises(AssertionError, match=r"largest_overlap is said to be 0.2, of all pairs it is 0.1 "):
        lmp.command("run 1")
