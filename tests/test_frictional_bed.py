# SPDX-License-Identifier: GPL-2.0-or-later
"""Dense beds with friction: all solvers against a reference that takes all contacts at once."""

from __future__ import annotations

from typing import Any

import coulomb
import numpy as np
import pytest
from contact_matrices import DISC, SPHERE, inverse_masses, jacobian
from frictional_beds import (
    DT,
    PAIRS,
    TOL,
    contact_problem,
    impulses,
    one_step,
    reference,
    settled,
    shaken,
    tangential,
    walls,
)
from scenes import GRAVITY, Grains

import nscd_lmp

SOLVERS, LAWS = list(nscd_lmp.FRICTIONAL_SOLVERS), list(nscd_lmp.LAWS)
EVERY_SOLVER = pytest.mark.parametrize("solver", SOLVERS)
EVERY_LAW = pytest.mark.parametrize("law", LAWS)
EVERY_DIMENSION = pytest.mark.parametrize("dim", [2, 3])
# m/s. The reference is right to 1e-11, NLGS ends at tol, 1e-12, times the sweeps it needs for a decade, 1e2 to 1e3.
# Found are 1e-11 and less; impacts in a row (law gap, e > 0) pass errors on.
AGREE = 1e-9
# Where the central path of interior_point folds before the solution, which the step says: law, dimension, scene.
FOLDS = {("moreau", 2, "rest"), ("gap", 2, "rest"), ("gap", 3, "rest")}


@pytest.fixture(scope="module")
def beds():
    """Return settled beds of boulders, 60 discs and 60 spheres, by their dimension."""
    return {2: settled(2), 3: settled(3)}


@pytest.fixture(scope="module")
def references():
    """Return a store of reference velocities, which take longer than what they are for."""
    return {}


# Every law in each dimension has every scene, and one of the two that move inelastic, the other with restitution: a
# reference takes seconds.
PROBLEMS = [
    (law, dim, scene, *((0.5, 0.3) if scene == ("box", "heap")[(k + dim) % 2] else (0.0, 0.0)))
    for k, law in enumerate(LAWS)
    for dim in (2, 3)
    for scene in ("rest", "box", "heap")
]


@pytest.mark.parametrize(("law", "dim", "scene", "e", "e_t"), PROBLEMS)
@EVERY_SOLVER
def test_velocities_of_a_shaken_bed_are_those_of_the_reference(
    start, beds, references, solver, law, dim, scene, e, e_t
):
    # The heap is the bed without its sides. Velocities need not be unique (test_coulomb.py, test_frictional_piles.py):
    # most beds have several solutions for one of the laws or scenes, each of them right to 1e-13; these two have not
    balls = shaken(beds[dim], {"rest": 0.0, "box": 0.1, "heap": 1.0}[scene], dim)
    options: dict[str, Any] = {"law": law, "restitution": e, "e_t": e_t, "walls": walls(dim, sides=scene != "heap")}
    key = (dim, law, scene, e)
    if key not in references:
        systems: list[Any] = []
        references[key], attached = one_step(start, balls, dim, solver=reference(systems), **options)
        check_kinds(systems, len(balls))
    velocity, attached = one_step(start, balls, dim, solver=solver, **options)
    folds = solver == "interior_point" and (law, dim, scene) in FOLDS
    assert attached.stats["unconverged_steps"][0] == folds
    if not folds:
        np.testing.assert_allclose(velocity, references[key], rtol=0, atol=AGREE)


def check_kinds(systems, grains):
    """Assert that the largest problem is one of a bed: open, sticking and slipping contacts, walls and pairs."""
    system, given, p = max(systems, key=lambda entry: len(entry[0]))
    assert len(system) > 1.4 * grains
    assert set(system.friction) == {PAIRS, 0.8}
    slipping = coulomb.norms(given.velocity(p)[:, 1:]) > 1e-6
    kinds = [p[:, 0] == 0, (p[:, 0] > 0) & slipping, (p[:, 0] > 0) & ~slipping]
    assert min(kind.sum() for kind in kinds) >= 1


@EVERY_DIMENSION
@EVERY_LAW
def test_python_solver_sees_the_matrix_that_lever_arms_give(start, beds, law, dim):
    balls = shaken(beds[dim], 0.1, dim)
    systems: list[Any] = []
    one_step(start, balls, dim, solver=reference(systems), law=law)
    system = systems[0][0]
    # radii do not matter to W as long as spins are measured by surface velocities
    ones = np.ones(len(system.inverse_mass))
    g = jacobian(system.body_i, system.body_j, system.normal, system.tangents, ones)
    with np.errstate(divide="ignore"):
        inverse = inverse_masses(1 / system.inverse_mass, ones, DISC if dim == 2 else SPHERE)
    expected = g * inverse @ g.T
    np.testing.assert_allclose(system.delassus(), expected, rtol=0, atol=1e-14 * expected.max())
    n, t1 = system.normal, system.tangents[:, 0]
    if dim == 2:
        np.testing.assert_array_equal(t1, np.column_stack([-n[:, 1], n[:, 0], 0 * n[:, 0]]))
    else:
        np.testing.assert_allclose(system.tangents[:, 1], np.cross(n, t1), rtol=0, atol=1e-15)
        np.testing.assert_allclose((n * t1).sum(axis=1), 0, atol=1e-15)


@EVERY_DIMENSION
@EVERY_SOLVER
def test_impulses_of_a_bed_account_for_every_change_of_velocity_and_spin(start, beds, solver, dim):
    # what the contact rows say is what happened: v = v_free + M^-1 G p
    balls = shaken(beds[dim], 0.1, dim)
    velocity, attached = one_step(start, balls, dim, solver=solver, law="gap", restitution=0.5, e_t=0.3)
    rows = attached.contacts
    normal, push = np.column_stack([rows["nx"], rows["ny"], rows["nz"]]), tangential(rows)
    assert np.abs((normal * push).sum(axis=1)).max() <= 1e-13 * rows["impulse"].max()
    assert (coulomb.norms(push) <= np.where(rows["tag_j"] > 0, PAIRS, 0.8) * rows["impulse"] + 1e-9).all()
    expected = np.hstack([balls.v, balls.omega * balls.radius[:, None]])
    expected[:, 1 if dim == 2 else 2] -= GRAVITY * DT
    kappa = DISC if dim == 2 else SPHERE
    for tag, sign in ((rows["tag_i"].astype(int), 1), (rows["tag_j"].astype(int), -1)):
        grain = tag[tag > 0] - 1
        impulse = rows["impulse"][:, None] * normal + push
        change = np.hstack([sign * impulse, -np.cross(normal, push) / kappa])[tag > 0]
        np.add.at(expected, grain, change / balls.mass[grain, None])
    # NLGS adds to the velocities in each of up to 1e5 sweeps: a rounding of 1e-16 each, with random signs
    np.testing.assert_allclose(velocity, expected, rtol=0, atol=1e-11)


def turned(balls, angle):
    """Return the grains turned about the vertical axis."""
    cosine, sine = np.cos(angle), np.sin(angle)
    matrix = np.array([(cosine, sine, 0), (-sine, cosine, 0), (0, 0, 1)])
    return Grains(balls.x @ matrix, balls.radius, balls.mass, balls.v @ matrix, balls.omega @ matrix), matrix


@pytest.mark.parametrize("angle", [np.pi / 4, 2.5])
@EVERY_SOLVER
def test_turned_bed_moves_turned(start, beds, solver, angle):
    bed = shaken(beds[3], 0.1, 3)
    ends = []
    for turn in (0.0, angle):
        balls, matrix = turned(bed, turn)
        planes = [
            nscd_lmp.Plane(wall.point @ matrix, wall.normal @ matrix, friction=wall.friction) for wall in walls(3)
        ]
        velocity, attached = one_step(start, balls, 3, solver=solver, law="gap", walls=planes)
        assert attached.stats["unconverged_steps"][0] == 0
        ends.append((velocity.reshape(-1, 3) @ matrix.T).ravel())
    # contacts come in another order; no tangent is preferred, or the error would be that of the slip, 0.1
    np.testing.assert_allclose(ends[0], ends[1], rtol=0, atol=1e-10)


@EVERY_DIMENSION
@EVERY_LAW
@EVERY_SOLVER
def test_heap_on_a_floor_that_holds_its_grains_is_solved_or_reported(start, beds, solver, law, dim):
    # Contacts that stick at any cost need not have a solution (test_coulomb.py), nor one with unique velocities, so the
    # answer itself is looked at. The disc heap has one; where none is found the step says so.
    balls = shaken(beds[dim], 1.0, dim)
    systems: list[Any] = []

    def record(system):
        systems.append(system)
        return np.zeros((len(system), dim))

    for taken in (record, solver):
        options: dict[str, Any] = {"walls": walls(dim, "stick", False), "maxiter": 10000, "unconverged": "ignore"}
        velocity, attached = one_step(start, balls, dim, solver=taken, law=law, **options)
    solved = attached.stats["unconverged_steps"][0] == 0
    assert solved == (attached.stats["criterion"][0] < TOL)
    assert solved or dim == 3
    assert np.abs(velocity).max() <= 2 * max(np.abs(balls.v).max(), np.abs(balls.omega * balls.radius[:, None]).max())
    if solved:
        given, p = contact_problem(systems[0]), impulses(systems[0], attached.contacts)
        assert coulomb.error(given, p) <= AGREE
        held = np.isinf(systems[0].friction) & (p[:, 0] > 0)
        assert held.sum() >= 3
        assert np.abs(given.velocity(p)[held]).max() <= AGREE
