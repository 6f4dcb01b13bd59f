# SPDX-License-Identifier: GPL-2.0-or-later
"""Neighbor lists that are as short as pairs need: no contact is missed, and none is missed where there is none."""

from __future__ import annotations

import math
import re
from contextlib import nullcontext
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scenes import DOORS, FLOOR, Grains, grains, harden, refusal, state

import nscd_lmp

pytestmark = pytest.mark.fast

BOTH = pytest.mark.parametrize("door", DOORS)


def true_overlap(lmp: Any, balls: Grains, lengths: tuple[float, float, float] = (math.inf,) * 3) -> float:
    """Return the largest overlap of all pairs, m; lengths of the box along periodic axes."""
    x, _ = state(lmp)
    apart = x[:, None] - x[None]
    for axis, length in enumerate(lengths):
        if math.isfinite(length):
            apart[..., axis] -= length * np.rint(apart[..., axis] / length)
    gap = np.linalg.norm(apart, axis=2) - balls.radius[:, None] - balls.radius[None]
    np.fill_diagonal(gap, math.inf)
    return max(0.0, -gap.min())


def shorten(lmp: Any, cutoff: float, skin: float, *more: str) -> None:
    """Give the pair style another cutoff and skin."""
    lmp.commands_list([f"pair_style zero {cutoff}", "pair_coeff * *", f"neighbor {skin} bin", *more])


def builds(lmp: Any, steps: int) -> int:
    """Run, and return in how many steps the neighbor list was built."""
    count = 0
    for k in range(steps):
        lmp.command(f"run 1 pre {'no' if k else 'yes'} post no")
        count += lmp.extract_setting("neigh_ago") == 0
    return count


SIDE, LAYERS = 6, 5
LENGTH = 1.05 * SIDE


def flow(start: Any, dt: float) -> tuple[Any, Grains]:
    """Return a flow down a chute: layers at 13 to 17 diameters a unit of time, a little disturbed."""
    random = np.random.default_rng(1)
    place = np.array([(i, j, k) for k in range(LAYERS) for j in range(SIDE) for i in range(SIDE)], dtype=float)
    x = 1.05 * place + 0.5 + random.uniform(-0.015, 0.015, place.shape)
    v = random.uniform(-0.3, 0.3, place.shape)
    v[:, 0] += 13 + place[:, 2]
    balls = grains(x, 0.5, v=v, mass=1.0)
    box = [(0.0, LENGTH), (0.0, LENGTH), (-1.0, 1.05 * LAYERS + 1)]
    return start(balls, dt, box=box, boundary="p p f"), balls


@pytest.mark.parametrize("dt", [5e-3, 1e-2])
@BOTH
def test_flow_that_moves_together_runs_with_a_cutoff_for_its_neighbors(start, door, dt):
    # a cutoff for the fastest grain would be 1 + 2 dt v = 1.34 diameters at the larger step
    lmp, balls = flow(start, dt)
    shorten(lmp, 1.02, 0.1)
    attached = harden(lmp, door, criterion="natural", tol=1e-8, maxiter=100000)
    met = 0.0
    for _ in range(10):
        lmp.command("run 3")
        overlap = true_overlap(lmp, balls, (LENGTH, LENGTH, math.inf))
        reported = attached.stats["largest_overlap"][-1] if attached else lmp.extract_fix("nscd", 0, 1, 7)
        assert overlap < 1e-6
        assert reported == pytest.approx(overlap, abs=1e-6)
        met += attached.stats["contacts"][-1] if attached else lmp.extract_fix("nscd", 0, 1, 0)
    assert met > 0


def test_flow_that_moves_together_builds_no_more_lists_than_it_does_without_contacts(start):
    counts = []
    for style in ("nve/sphere", "nscd"):
        lmp, _ = flow(start, 1e-3)
        shorten(lmp, 1.02, 0.1)
        lmp.command(f"fix nscd all {style}")
        counts.append(builds(lmp, 30))
    assert counts[1] <= counts[0] + 1


@BOTH
def test_obstacle_that_moves_needs_no_cutoff_beyond_the_diameter(start, door):
    # a plate of three grains that fix move lifts past resting grains, at half a radius a step
    x = [(1.2 * k, 0, 0.5) for k in range(3)] + [(1.2 * k, 1.3, -3 + 0.99 * k) for k in range(3)]
    balls = grains(x, 0.5, mass=1.0)
    lmp = start(balls, 1e-2)
    shorten(lmp, 1.0, 0.25)
    lmp.commands_list(["group plate id 4 5 6", "group rest id 1 2 3", "fix lift plate move linear 0 0 25"])
    harden(lmp, door, "rest", walls=[FLOOR])
    lmp.command("run 25")
    assert np.abs(state(lmp)[1][:3]).max() == 0


@BOTH
def test_obstacle_that_comes_too_fast_for_the_list_is_met(start, door):
    # within a step the piston goes from one side of the grain to the other
    lmp = start(grains([(0, 0, 5.5), (0, 0, 13.0)], 0.5, mass=1.0), 1e-2)
    shorten(lmp, 1.0, 0.25)
    lmp.commands_list(["group piston id 2", "group rest id 1", "fix push piston move linear 0 0 -900"])
    harden(lmp, door, "rest")
    lmp.command("run 1")
    assert state(lmp)[0][:, 2] == pytest.approx([3.0, 4.0], abs=1e-6)


def test_types_of_obstacles_need_no_cutoff_of_their_own(start):
    # fix nscd alone: the Python door knows one cutoff for all types
    lmp = start(grains([(0, 0, 1.01)], 0.5, mass=1.0, v=(0, 0, -1)), 1e-3)
    lmp.command("clear")
    lmp.commands_list(
        [
            "units si", "atom_style sphere", "boundary f f f", "region box block -9 9 -9 9 -9 9", "create_box 2 box",
            "create_atoms 1 single 0 0 1.01", "create_atoms 2 single 0 0 0", "create_atoms 2 single 0.9 0 0",
            "set group all diameter 1 density 1", "velocity all set 0 0 0", "group grain type 1",
            "velocity grain set 0 0 -1", "pair_style zero 1.1", "pair_coeff * *", "pair_coeff 2 2 0.01",
            "neighbor 0.1 nsq", "timestep 1e-3", "fix nscd grain nscd tol 1e-12", "run 30",
        ]
    )  # fmt: skip
    assert state(lmp)[0][0, 2] == pytest.approx(1.0, abs=1e-9)


def nip(start: Any, **options: Any) -> tuple[Any, Grains]:
    """Return two heavy grains that squeeze out a light one, at 22 times their speed and towards a grain far away."""
    h = 0.05
    c = math.sqrt(1.1**2 - h**2)
    x = [(-c, 0, 0), (c, 0, 0), (0, h, 0), (0, 2.65, 0)]
    v = [(0.9, 0, 0), (-0.9, 0, 0), (0, 0, 0), (0, 0, 0)]
    balls = grains(x, [1, 1, 0.1, 1], mass=[10, 10, 1e-3, 1e6], v=v)
    lmp = start(balls, 0.1, **options)
    shorten(lmp, 2.1, 0.2)
    return lmp, balls


EXACT: dict[str, Any] = {"criterion": "natural", "tol": 1e-10, "maxiter": 100000}


@BOTH
@pytest.mark.parametrize("solver", ["auto", "active_set"])
def test_grain_that_is_squeezed_out_meets_one_beyond_the_list(start, door, solver):
    lmp, balls = nip(start)
    attached = harden(lmp, door, solver=solver, **EXACT)
    lmp.command("run 1")
    assert true_overlap(lmp, balls) < 1e-8
    assert (attached.stats["contacts"][-1] if attached else lmp.extract_fix("nscd", 0, 1, 0)) == 3
    # the light grain is stopped where it touches the far one
    assert state(lmp)[0][2, 1] == pytest.approx(1.55, abs=1e-6)
    lmp.command("run 5")
    assert true_overlap(lmp, balls) < 1e-6


def number_to_type(message: str, before: str) -> float:
    return float(re.search(rf"{before} ([-+.e0-9]+)", message)[1].rstrip("."))  # type: ignore[index]


@BOTH
@pytest.mark.parametrize("law", ["gap", "moreau"])
def test_pairs_that_the_list_lacks_are_found(start, door, law):
    # a grain 0.5 ahead of two that fall at ten times the speed that the list has room for; it is never built again
    balls = grains([(0, 0, 0), (0, 0, 1.5), (0, 0, 2.6)], 0.5, mass=1.0, v=[(0, 0, 0), (0, 0, -105), (0, 0, -105)])
    lmp = start(balls, 1e-2)
    shorten(lmp, 1.02, 0.1)
    lmp.command("neigh_modify delay 100000 check no")
    harden(lmp, door, law=law, **EXACT)
    lmp.command("run 3")
    assert state(lmp)[1][:, 2] == pytest.approx(np.full(3, -70.0), rel=1e-6)
    if law == "gap":
        assert true_overlap(lmp, balls) < 1e-6


@pytest.mark.parametrize(("cutoff", "tells"), [(1.02, True), (1.3, False)])
def test_list_that_lacks_pairs_for_long_is_told(start, cutoff, tells):
    # a grain falls on one that lies on the floor; the list of the start, which stays, lacks the pair or has it
    lmp = start(grains([(0, 0, 0.5), (0, 0, 1.7)], 0.5, mass=1.0, v=[(0, 0, 0), (0, 0, -1.0)]), 1e-3, gravity=10.0)
    shorten(lmp, cutoff, 0.1)
    lmp.command("neigh_modify delay 100000 check no")
    nscd_lmp.attach(lmp, walls=[FLOOR])
    told = "list lacked pairs that meet.*raise the cutoff of the pair style, to 1.2 at most"
    with pytest.warns(UserWarning, match=told) if tells else nullcontext():
        lmp.command("run 500")
    assert state(lmp)[0][:, 2] == pytest.approx([0.5, 1.5], abs=1e-4)


@BOTH
def test_cutoff_that_a_list_below_the_diameter_is_told_is_enough(start, door):
    balls = grains([(0, 0, 0), (0, 0, 1.01)], 0.5, mass=1.0, v=[(0, 0, 0), (0, 0, -3)])
    lmp = start(balls, 1e-2)
    shorten(lmp, 0.5, 0.1, "comm_modify cutoff 3")
    harden(lmp, door)
    with pytest.raises(refusal(door), match=r"skin are 0\.4 less than the largest diameter") as caught:
        lmp.command("run 1")
    shorten(lmp, number_to_type(str(caught.value), "cutoff of the pair style to"), 0.1)
    lmp.command("run 2")
    assert state(lmp)[1][0, 2] < 0


@BOTH
def test_images_that_a_refused_step_asks_for_are_enough(start, door):
    # the grain leaves through the face of a periodic box, towards the image of one in its middle
    box = [(-4.0, 4.0), (-2.0, 6.0), (-4.0, 4.0)]
    lmp, _ = nip(start, box=box, boundary="p p p")
    lmp.command("displace_atoms all move 0 -1.9 0")
    harden(lmp, door, **EXACT)
    with pytest.raises(refusal(door), match=r"contacts could be missed: grain \d can meet one") as caught:
        lmp.command("run 1")
    lmp.close()
    lmp, balls = nip(start, box=box, boundary="p p p")
    lmp.command(f"comm_modify cutoff {number_to_type(str(caught.value), 'comm_modify cutoff')}")
    lmp.command("displace_atoms all move 0 -1.9 0")
    attached = harden(lmp, door, **EXACT)
    lmp.command("run 1")
    assert true_overlap(lmp, balls, (8.0, 8.0, 8.0)) < 1e-8
    assert (attached.stats["contacts"][-1] if attached else lmp.extract_fix("nscd", 0, 1, 0)) == 3  # one with an image


@BOTH
def test_grain_that_is_squeezed_out_in_the_middle_of_a_periodic_box_is_no_error(start, door):
    lmp, balls = nip(start, box=[(-9.0, 9.0)] * 3, boundary="p p p")
    harden(lmp, door, **EXACT)
    lmp.command("run 1")
    assert true_overlap(lmp, balls, (18.0,) * 3) < 1e-8


def test_both_doors_give_the_same_bits_beyond_the_list(start):
    found: list[NDArray[np.float64]] = []
    for door in DOORS:
        lmp, _ = nip(start)
        harden(lmp, door, **EXACT)
        lmp.command("run 4")
        found.append(state(lmp)[0])
    assert np.array_equal(*found)
