# SPDX-License-Identifier: GPL-2.0-or-later
"""Piles, blocks and pairs with friction: rest, sliding without lift, more than one solution, and the warm start."""

from __future__ import annotations

from typing import Any

import coulomb
import numpy as np
import pytest
from frictional_beds import DT, TOL, contact_problem, impulses, incline, one_step, pile, reference, walls
from scenes import GRAVITY, grains, harden, per_atom, state

import nscd_lmp

SOLVERS, LAWS = list(nscd_lmp.FRICTIONAL_SOLVERS), list(nscd_lmp.LAWS)
EVERY_SOLVER = pytest.mark.parametrize("solver", SOLVERS)
EVERY_LAW = pytest.mark.parametrize("law", LAWS)
EVERY_DIMENSION = pytest.mark.parametrize("dim", [2, 3])
AGREE = 1e-9  # m/s, as in test_frictional_bed.py


@EVERY_DIMENSION
def test_impulses_differ_between_solvers_by_what_the_grains_do_not_feel(start, dim):
    systems: list[Any] = []
    found = []
    for solver in (reference(systems), *nscd_lmp.LOCAL_LAWS):
        options: dict[str, Any] = {"law": "gap", "friction": 1.0, "walls": walls(dim, None, False)}
        velocity, attached = one_step(start, pile(dim, 4), dim, solver=solver, **options)
        assert np.abs(velocity).max() <= AGREE  # it rests
        found.append(impulses(systems[-1][0], attached.contacts))
    given = systems[-1][1]
    w, largest = given.w, found[0].max()
    assert np.linalg.matrix_rank(w, tol=1e-9 * np.linalg.norm(w, 2)) < len(w)
    for p in found:
        # each is a solution by the measure of the reference, which knows nothing of the criterion
        assert coulomb.error(given, p) <= AGREE
        np.testing.assert_allclose(w @ (p - found[0]).ravel(), 0, atol=AGREE)
    # by far more than AGREE / W_nn: the reference and SBP from each other and from PDAS
    for one, other in ((0, 1), (0, -1), (1, -1)):
        assert np.abs(found[one] - found[other]).max() > 1e-3 * largest


def test_solvers_may_choose_different_solutions_where_coulomb_s_law_leaves_a_choice(start):
    # Three discs on an incline of 3 degrees. Any pressure between the two at the base holds: with much of it the pile
    # rests, with little it spreads and rolls. Both obey the law to round-off, so which one is found depends on the
    # path: EBP, EAL and PDAS end with the least pressure, SBP and SAL creep up to rest
    speeds = {}
    for solver in SOLVERS:
        systems: list[Any] = []

        def record(system, systems=systems):
            systems.append(system)
            return np.zeros((len(system), 2))

        options: dict[str, Any] = {"friction": 0.6, "walls": walls(2, 0.6, False), "tol": TOL, "maxiter": 100000}
        for taken in (record, solver):
            lmp = incline(start, pile(2, 2), 2, 0.05)
            attached = harden(lmp, solver=taken, unconverged="ignore", **options)
            lmp.command("run 1")
        assert coulomb.error(contact_problem(systems[0]), impulses(systems[0], attached.contacts)) <= 1e-11
        speeds[solver] = np.abs(state(lmp)[1]).max()
    assert speeds["sbp"] <= AGREE < 1e-4 < speeds["pdas"]


def block(speed, height=2):
    """Return a block of 3 x 3 x `height` touching spheres on the floor that moves at the speed, m/s."""
    x = np.stack(np.meshgrid(np.arange(3.0), np.arange(3.0), np.arange(float(height)), indexing="ij"), axis=-1)
    return grains(x.reshape(-1, 3) + np.array([0, 0, 0.5]), 0.5, v=(speed * np.cos(0.3), speed * np.sin(0.3), 0))


@pytest.mark.parametrize(("layers", "steps"), [(1, 20), (2, 1)])
@EVERY_LAW
@EVERY_SOLVER
def test_sliding_block_of_grains_does_not_lift(start, solver, law, layers, steps):
    # only one step of two layers: the upper grains then roll off the lower ones, which the floor slows down and turns
    balls = block(1.0, layers)
    balls.x[:, 2] *= 1 - 1e-12  # law moreau sees it shut
    lmp = start(balls, DT, gravity=GRAVITY, vmax=2.0)
    options: dict[str, Any] = {
        "friction": 0.5,
        "walls": walls(3, None, False),
        "tol": TOL,
        "maxiter": 100000,
        "recovery": 0.0,
    }
    attached = harden(lmp, law=law, solver=solver, **options)
    for step in range(1, steps + 1):
        lmp.command("run 1 post no")
        v = state(lmp)[1]
        assert np.abs(v[:, 2]).max() <= 1e-10  # tol, a mean of 42 contacts
        mean = v @ [np.cos(0.3), np.sin(0.3), 0]
        assert mean.mean() == pytest.approx(1.0 - 0.5 * GRAVITY * DT * step, abs=1e-10)
    assert attached.stats["unconverged_steps"][-1] == 0


def test_convex_relaxation_would_lift_the_sliding_block(start):
    systems: list[Any] = []
    options: dict[str, Any] = {"law": "gap", "friction": 0.5, "walls": walls(3, None, False), "recovery": 0.0}
    one_step(start, block(1.0), 3, solver=reference(systems), **options)
    system, given, p = systems[-1]
    exact, lifted = given.velocity(p), given.velocity(coulomb.relaxed(given, np.zeros(len(p))))
    floor = system.body_j < 0
    assert floor.sum() == 9
    assert np.abs(exact[floor, 0]).max() <= 1e-11
    # to the 1e-6 of the interior point method: dilation at v_n = mu |u_t|
    np.testing.assert_allclose(lifted[floor, 0], 0.5 * coulomb.norms(lifted[floor, 1:]), rtol=0, atol=1e-5)
    assert lifted[floor, 0].min() > 0.2


@EVERY_DIMENSION
@pytest.mark.parametrize("solver", [solver for solver in SOLVERS if solver != "interior_point"])
def test_sticking_pile_rests_on_an_incline_and_its_warm_start_knows_the_friction(start, solver, dim):
    iterations = {}
    options: dict[str, Any] = {"friction": "stick", "walls": walls(dim, None, False), "tol": 1e-9, "maxiter": 100000}
    for warmstart in (False, True):
        lmp = incline(start, pile(dim, 4), dim, 0.05)
        attached = harden(lmp, solver=solver, warmstart=warmstart, **options)
        lmp.command("run 5")
        assert attached.stats["unconverged_steps"][-1] == 0
        assert np.abs(state(lmp)[1]).max() <= 1e-8  # tol, a mean of 22 or 46 contacts
        iterations[warmstart] = attached.stats["iterations"]
    sweeps = nscd_lmp.SOLVERS[solver].kind == "local law"
    assert iterations[True][0] == iterations[False][0]
    if sweeps:
        assert iterations[True][0] > 100
    # Every step is the problem of the first again, off by the tolerance. Without the friction of the last step it would
    # cost as much as from nothing. Solvers that need few iterations have fewer to spare.
    assert iterations[True][1] <= iterations[False][1] / (8 if sweeps else 2)
    assert iterations[True][3:].max() <= 2


# Stick is a large coefficient on the central path, which folds.
@EVERY_DIMENSION
def test_interior_point_gives_a_sticking_pile_up_and_says_so(start, dim):
    lmp = incline(start, pile(dim, 4), dim, 0.05)
    options: dict[str, Any] = {"friction": "stick", "walls": walls(dim, None, False), "tol": 1e-9, "maxiter": 100000}
    attached = harden(lmp, solver="interior_point", warmstart=False, **options)
    with pytest.warns(UserWarning, match="steps were given up above tol"):
        lmp.command("run 5")
    assert attached.stats["unconverged_steps"][-1] > 0


def test_reference_agrees_that_the_sticking_pile_rests(start):
    systems: list[Any] = []
    lmp = incline(start, pile(2, 4), 2, 0.05)
    harden(lmp, solver=reference(systems), friction="stick", walls=walls(2, None, False))
    lmp.command("run 1")
    system, given, _ = systems[-1]
    assert np.isinf(system.friction).all()
    assert np.linalg.matrix_rank(given.w, tol=1e-9 * np.linalg.norm(given.w, 2)) < len(given.w)
    assert np.abs(state(lmp)[1]).max() <= 1e-10
    assert np.abs(per_atom(lmp, "omega")).max() <= 1e-10


@EVERY_DIMENSION
def test_velocities_that_a_python_solver_sees_are_those_without_its_start_impulses(start, dim):
    # were they not, the second step would be solved for another weight and end above tol
    systems: list[Any] = []
    lmp = incline(start, pile(dim, 2), dim, 0.0)
    attached = harden(lmp, solver=reference(systems), friction=1.0, walls=walls(dim, None, False), tol=1e-9)
    lmp.command("run 3")
    assert attached.stats["unconverged_steps"][-1] == 0
    system, _, p = systems[-1]
    assert np.abs(system.start - p).max() <= 1e-6 * p.max()
    floor = system.body_j < 0
    np.testing.assert_allclose(system.velocity[floor], -GRAVITY * DT, rtol=0, atol=1e-10)


@EVERY_DIMENSION
def test_start_impulse_of_a_pair_turns_with_it(start, dim):
    # half a radian a step about an axis across the line of centres
    dt, rate = 1e-3, 500.0
    normal = np.array([0.6, 0.8, 0]) if dim == 2 else np.array([2.0, -1.0, 2.0]) / 3
    axis = np.cross(normal, [0.8, -0.6, 0])
    axis /= np.linalg.norm(axis)
    x = 0.8 * np.outer([0.5, -0.5], normal)  # an overlap that the straight way of a step does not open
    lmp = start(grains(x, 0.5, v=rate * np.cross(axis, x)), dt, planar=dim == 2, vmax=500.0)
    seen = []

    def solve(system):
        impulse = 1e-9 * np.array([[3.0, 1.0, 2.0][:dim]])  # N s, which moves nothing
        seen.append((system, impulse))
        return impulse

    harden(lmp, solver=solve, law="gap", friction=0.5, recovery=0.0, unconverged="ignore")
    lmp.command("run 2")
    (before, impulse), (after, _) = seen
    frames = [np.concatenate([s.normal[:, None], s.tangents], axis=1)[0] for s in (before, after)]
    push, kept = impulse[0] @ frames[0], after.start[0] @ frames[1]
    assert before.normal[0] @ after.normal[0] < 0.97  # it has turned
    spin = before.normal[0] @ after.normal[0], np.cross(before.normal[0], after.normal[0])
    rotated = spin[0] * push + np.cross(spin[1], push) + spin[1] * (spin[1] @ push) / (1 + spin[0])  # Rodrigues
    np.testing.assert_allclose(kept, rotated, rtol=0, atol=1e-22)
