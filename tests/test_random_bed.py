# SPDX-License-Identifier: GPL-2.0-or-later
"""All solvers on the problems of dense beds, against the same quadratic program solved by other means."""

from __future__ import annotations

import numpy as np
import pytest
from scenes import GRAVITY, box_walls, cloud, grains, harden, state
from scipy.optimize import nnls

import nscd_lmp

SOLVERS, LAWS = list(nscd_lmp.SOLVERS), list(nscd_lmp.LAWS)
WIDTH = 3.2  # m; boulders of 0.25 to 0.5 m, for which criterion (42) bounds velocities
TOL = 1e-12


def least_distance(system):
    """Return the impulses by the least distance programming of Lawson & Hanson (1974), an active set method.

    Wanted are the velocities u = M^1/2 v nearest to the free ones under A u >= -bias. With A = (M^-1/2 H)^T
    and h the bound on the correction x, non-negative least squares on [A^T; h^T] y = (0, 1) gives
    x = A^T y / (1 - h y), the impulses are y / (1 - h y).
    """
    w = system.delassus()
    free = system.velocity
    # a factor of W by its eigenvectors; W may be singular
    values, vectors = np.linalg.eigh(w)
    root = (vectors * np.sqrt(np.maximum(values, 0))).T
    scale = np.abs(free).max() or 1.0
    h = -free / scale
    y, _ = nnls(np.vstack([root, h]), np.append(np.zeros(len(root)), 1.0), maxiter=100 * len(h))
    active = y > 0
    # polish: the equations of the active set, least squares because it may be hyperstatic
    impulse = y / (1 - h @ y) * scale
    rest = w[np.ix_(active, active)] @ impulse[active] + free[active]
    impulse[active] -= np.linalg.lstsq(w[np.ix_(active, active)], rest, rcond=1e-13)[0]
    check_optimality(w, free, impulse)
    return impulse


def check_optimality(w, free, impulse):
    """Assert the Karush-Kuhn-Tucker conditions of the reference, to round-off of the velocities."""
    velocity = w @ impulse + free
    scale = np.abs(free).max()
    largest = np.abs(w) @ np.abs(impulse) + np.abs(free)  # the terms that cancel in `velocity`
    eps = 1e-12 * max(scale, largest.max())
    assert velocity.min(initial=0) >= -eps
    assert (impulse * w.diagonal()).min(initial=0) >= -eps
    assert np.abs(np.minimum(velocity, impulse * w.diagonal())).max(initial=0) <= eps


@pytest.fixture(scope="module")
def bed():
    """Return a settled bed of 80 boulders, as grains with positions and random velocities of 1 m/s."""
    import scenes

    balls = cloud(80, (0.25, 0.5), WIDTH, seed=3)
    lmp = scenes.start(balls, 1e-2, gravity=GRAVITY, box=[(-1, 6), (-1, 6), (-1, 12)], vmax=20.0)
    harden(lmp, solver="pdas", law="gap", tol=1e-9, maxiter=20000, walls=box_walls(WIDTH), unconverged="ignore")
    lmp.command("run 300")
    balls.x, _ = state(lmp)
    lmp.close()
    balls.x *= 0.998  # overlaps of 1 mm, so that the random velocities do not open contacts before law moreau looks
    balls.v = np.random.default_rng(4).normal(size=balls.x.shape)
    return balls


def one_step(start, balls, walls, **options):
    """Return the velocities after a step of 1 ms, and what attach returned."""
    lmp = start(balls, 1e-3, gravity=GRAVITY, vmax=10.0)
    attached = harden(lmp, walls=walls, tol=TOL, maxiter=1000000, **options)
    lmp.command("run 1")
    return state(lmp)[1], attached


@pytest.fixture(scope="module")
def references():
    """Return a store of reference velocities, which take longer than what they are for."""
    return {}


@pytest.mark.parametrize("e", [0.0, 0.5])
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("solver", SOLVERS)
def test_velocities_of_a_shaken_bed_are_those_of_the_quadratic_program(start, bed, references, solver, law, e):
    walls = box_walls(WIDTH)
    if (law, e) not in references:
        references[law, e], attached = one_step(
            start, bed, walls, law=law, restitution=e, solver=least_distance, unconverged="ignore"
        )
        assert attached.stats["contacts"][0] > 160  # a bed: more than two contacts a grain
    velocity, attached = one_step(start, bed, walls, law=law, restitution=e, solver=solver)
    assert attached.stats["unconverged_steps"][0] == 0
    # ||dv||_M^2 = (p - p*)(v - v*) <= p v + p* max(0, -v) <= n tol (1 + p*) would allow 1e-5; NLGS ends far
    # closer, at tol times the sweeps it needs a decade, about 1e2 to 1e3
    np.testing.assert_allclose(velocity, references[law, e], rtol=0, atol=1e-9)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("law", LAWS)
def test_impulses_of_a_bed_account_for_every_change_of_velocity(start, bed, law, solver):
    # what the contact rows say is what happened: v = v_free + M^-1 H p
    velocity, attached = one_step(start, bed, box_walls(WIDTH), law=law, restitution=0.5, solver=solver)
    rows = attached.contacts
    normal = np.array([rows["nx"], rows["ny"], rows["nz"]]).T
    expected = bed.v - [0, 0, GRAVITY * 1e-3]
    np.add.at(
        expected,
        rows["tag_i"].astype(int) - 1,
        rows["impulse"][:, None] * normal / mass_of(bed, rows["tag_i"]),
    )
    pairs = rows["tag_j"] > 0
    push = (rows["impulse"][:, None] * normal)[pairs] / mass_of(bed, rows["tag_j"][pairs])
    np.subtract.at(expected, rows["tag_j"][pairs].astype(int) - 1, push)
    # NLGS adds to the velocities in each of up to 1e4 sweeps: a rounding of 1e-16 each, with random signs
    np.testing.assert_allclose(velocity, expected, rtol=0, atol=1e-12)
    assert rows["impulse"].min() >= -TOL * bed.mass.max()


def mass_of(balls, tags):
    """Return the masses of tagged grains as a column."""
    return balls.mass[tags.astype(int) - 1][:, None]


def crystal():
    """Return 27 touching spheres of unequal masses in a cubic grid that fills a box, and its walls.

    Every sphere touches up to six others or walls: 81 velocities, but 108 contacts, all of them shut.
    """
    x = np.stack(np.meshgrid(*[0.5 + np.arange(3.0)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    random = np.random.default_rng(5)
    balls = grains(x, 0.5, mass=random.uniform(50, 500, 27), v=random.normal(size=(27, 3)))
    lid = nscd_lmp.Plane((0, 0, 3), (0, 0, -1))
    return balls, [*box_walls(3.0), lid]


@pytest.mark.parametrize("solver", SOLVERS)
def test_velocities_of_a_hyperstatic_crystal_are_unique_though_its_impulses_are_not(start, solver):
    balls, walls = crystal()
    systems = []

    def reference(system):
        systems.append((system, least_distance(system)))
        return systems[-1][1]

    expected, attached = one_step(start, balls, walls, law="gap", solver=reference, unconverged="ignore")
    system, impulse = systems[-1]
    w = system.delassus()
    assert len(system) == 108
    assert np.linalg.matrix_rank(w, tol=1e-9 * np.linalg.norm(w, 2)) <= 81
    velocity, attached = one_step(start, balls, walls, law="gap", solver=solver)
    np.testing.assert_allclose(velocity, expected, rtol=0, atol=1e-9)  # as above
    # the same motion from other impulses: they differ by more than any tolerance, in the null space of W
    # alone
    difference = attached.contacts["impulse"] - impulse
    assert np.abs(difference).max() > 1e-3 * impulse.max()
    np.testing.assert_allclose(w @ difference, 0, atol=1e-9)


@pytest.mark.parametrize("warmstart", [False, True])
@pytest.mark.parametrize("solver", SOLVERS)
def test_two_floors_in_one_place_share_the_weight(start, solver, warmstart):
    # the smallest hyperstatic scene: only the sum of the two impulses is determined
    balls = grains((0, 0, 0.5), 0.5)
    floors = [nscd_lmp.Plane((0, 0, 0), (0, 0, 1))] * 2
    velocity, attached = one_step(start, balls, floors, law="gap", solver=solver, warmstart=warmstart)
    assert abs(velocity[0, 2]) <= 2 * TOL
    total = attached.contacts["impulse"].sum()
    assert total == pytest.approx(balls.mass[0] * GRAVITY * 1e-3, abs=2 * TOL * balls.mass[0])
