# SPDX-License-Identifier: GPL-2.0-or-later
"""What `attach` hands out, and what a solver written in Python is handed."""

from __future__ import annotations

import numpy as np
import pytest
from scenes import FLOOR, GRAVITY, box_walls, cloud, energy, grains, harden, small_bed, state

import nscd_lmp

pytestmark = pytest.mark.fast

LAWS = list(nscd_lmp.LAWS)


def test_contacts_tell_point_normal_gap_and_impulse(start):
    # a ball rests in the corner of the floor and an inclined plane, on which it presses: statics gives the
    # impulses
    slope = np.array([np.sin(0.5), 0, np.cos(0.5)])
    mass, dt = 3.0, 1e-3
    lmp = start(grains((0, 0, 0.5), 0.5, mass=mass), dt)
    steep = nscd_lmp.Plane(np.array([0, 0, 0.5]) - 0.5 * slope, slope)
    lmp.command(f"fix push all addforce {-5 * slope[0]} 0 {-7 * slope[2]}")
    attached = nscd_lmp.attach(lmp, walls=[FLOOR, steep], criterion="paper", tol=1e-13)
    lmp.command("run 2")
    contacts = attached.contacts
    assert contacts["tag_i"].tolist() == [1, 1]
    order = np.argsort(-contacts["tag_j"])  # floor is wall 0: -1, the slope -2
    assert contacts["tag_j"][order].tolist() == [-1, -2]
    normals = np.array([contacts[key][order] for key in ("nx", "ny", "nz")]).T
    np.testing.assert_allclose(normals, [(0, 0, 1), slope], rtol=0, atol=1e-15)
    points = np.array([contacts[key][order] for key in ("x", "y", "z")]).T
    np.testing.assert_allclose(points, [(0, 0, 0), np.array([0, 0, 0.5]) - 0.5 * slope], rtol=0, atol=1e-12)
    np.testing.assert_allclose(contacts["gap"], 0, atol=1e-12)
    # p_floor n_floor + p_slope n_slope + push dt = 0
    balance = np.linalg.solve(normals[:, [0, 2]].T, dt * np.array([5 * slope[0], 7 * slope[2]]))
    np.testing.assert_allclose(contacts["impulse"][order], balance, rtol=0, atol=mass * 1e-12)


def test_stats_are_read_without_copying_what_was_read_and_keep_their_rows(start):
    lmp = start(grains((0, 0, 0.5), 0.5, v=(0.1, 0, 0)), 1e-3, gravity=GRAVITY, vmax=4.0)
    attached = nscd_lmp.attach(lmp, walls=[FLOOR])
    assert len(attached.stats) == 0
    seen = []
    for steps in (3, 1, 40, 0, 2):
        lmp.command(f"run {steps} post no")
        seen.append((attached.stats, attached.stats.copy()))
    for view, copy in seen:
        np.testing.assert_array_equal(view, copy)
        assert not view.flags.writeable
    last = attached.stats
    assert last["step"].tolist() == list(range(1, 47))
    assert np.shares_memory(last, attached.stats)  # nothing is copied where no step was taken
    attached.detach()
    np.testing.assert_array_equal(attached.stats, last)


def test_contact_between_grains_lies_between_them(start):
    normal = np.array([2.0, -1.0, 2.0]) / 3
    lmp = start(grains([0.7 * normal, (0, 0, 0)], [0.2, 0.5], v=[-normal, (0, 0, 0)]), 1e-4)
    attached = nscd_lmp.attach(lmp, criterion="paper", tol=1e-12)
    lmp.command("run 1")
    contacts = attached.contacts
    sign = 1 if contacts["tag_i"][0] == 1 else -1  # the normal points from j to i
    reported = sign * np.array([contacts[key][0] for key in ("nx", "ny", "nz")])
    np.testing.assert_allclose(reported, normal, rtol=0, atol=1e-15)
    x, _ = state(lmp)
    # on the line of centres, 0.5 from the second ball
    point = np.array([contacts[key][0] for key in ("x", "y", "z")])
    np.testing.assert_allclose(point, x[1] + 0.5 * normal, rtol=0, atol=1e-12)


def gauss_seidel(system):
    """Ten lines of a researcher's own solver: projected Gauss-Seidel on the dense matrix."""
    w, impulse, free = system.delassus(), system.start.copy(), system.velocity
    for _ in range(20000):
        before = impulse.copy()
        for k in range(len(impulse)):
            impulse[k] = max(0.0, impulse[k] - (w[k] @ impulse + free[k]) / w[k, k])
        if np.abs(w.diagonal() * (impulse - before)).max(initial=0) < 1e-13:
            break
    return impulse


@pytest.mark.parametrize("e", [0.0, 0.5])
@pytest.mark.parametrize("warmstart", [True, False])
@pytest.mark.parametrize("law", LAWS)
def test_python_solver_gives_the_velocities_of_the_built_in(start, law, warmstart, e):
    balls = cloud(30, (0.25, 0.5), 2.1)  # boulders, for which criterion (42) bounds velocities
    balls.v[:] = (0.5, 0.3, -1.0)
    ends = []
    for solver in ("pdas", gauss_seidel):
        lmp = start(balls, 2e-3, gravity=GRAVITY, vmax=8.0)
        harden(
            lmp, solver=solver, law=law, tol=1e-12, maxiter=100000, warmstart=warmstart, restitution=e,
            walls=box_walls(2.1), unconverged="error" if solver == "pdas" else "ignore",
        )  # fmt: skip
        lmp.command("run 40")
        ends.append(state(lmp))
    # both stop when a sweep corrects less than 1e-12 m/s or so; slow modes hide about 100 times that in a
    # step, and 40 steps of a few impacts each pass it on
    np.testing.assert_allclose(ends[1][1], ends[0][1], rtol=0, atol=1e-8)


def test_python_solver_sees_the_problem_of_the_step(start):
    seen = []

    def look(system):
        seen.append(system)
        return np.maximum(0, -system.velocity / system.delassus().diagonal())

    balls = grains([(0, 0, 0.5), (3, 0, 0.5 + 1e-3)], 0.5, mass=[2.0, 4.0], v=[(0, 0, 0), (0, 0, -2.0)])
    lmp = start(balls, 1e-3, gravity=GRAVITY, vmax=4.0)
    nscd_lmp.attach(lmp, solver=look, law="gap", walls=[FLOOR])
    lmp.command("run 1")
    (system,) = seen
    assert len(system) == 2
    assert system.body_i.tolist() == [0, 1]
    assert system.body_j.tolist() == [-1, -1]
    np.testing.assert_allclose(system.inverse_mass, [0.5, 0.25], rtol=1e-15)
    np.testing.assert_allclose(system.delassus(), np.diag([0.5, 0.25]), rtol=1e-15)
    np.testing.assert_allclose(system.gap, [0, 1e-3], rtol=0, atol=1e-16)
    # law gap: v_n + gap / dt; round-off of the gap, 1e-16 m, over dt
    np.testing.assert_allclose(system.bias, [0, 1.0], rtol=0, atol=1e-12)
    np.testing.assert_allclose(system.velocity, [-GRAVITY * 1e-3, -1.0 - GRAVITY * 1e-3], rtol=0, atol=1e-12)


def test_python_solver_that_is_wrong_is_counted_as_not_converged(start):
    lmp = start(grains((0, 0, 0.5), 0.5), 1e-3, gravity=GRAVITY)
    attached = nscd_lmp.attach(lmp, solver=lambda system: np.zeros(len(system)), walls=[FLOOR])
    with pytest.warns(UserWarning, match="3 of 3 steps were given up above tol"):
        lmp.command("run 3")
    # without an impulse the ball falls, and the penetration part of (42) is its speed past the gap constraint
    assert attached.stats["penetration"][0] == pytest.approx(GRAVITY * 1e-3, rel=1e-12)


def test_stats_have_a_row_a_step_with_the_seconds(start):
    lmp, balls, walls = small_bed(start, "f f f")
    attached = nscd_lmp.attach(lmp, walls=walls, law="moreau", criterion="paper", tol=1e-7)
    assert len(attached.stats) == 0
    lmp.command("run 200")
    lmp.command("run 100")
    stats = attached.stats
    assert stats["step"].tolist() == list(range(1, 301))
    columns = "contacts iterations criterion motion bipotential penetration relative_residual largest_overlap"
    columns += " dissipated_energy largest_overlap_ratio unconverged_steps energy_limited_steps worst_residual"
    columns += " accepted_steps"
    columns += " seconds_contacts seconds_solver"
    assert stats.dtype.names == ("step", *columns.split())
    parts = stats["motion"] + stats["bipotential"] + stats["penetration"]
    np.testing.assert_allclose(stats["criterion"], parts, rtol=1e-15)
    assert (stats["criterion"] < 1e-7).all()
    assert (stats["seconds_contacts"] >= 0).all() and (stats["seconds_solver"] >= 0).all()
    assert 0 < stats["seconds_solver"].sum() < 60
    # energy is counted from the start of each run, and what the contacts took is what is missing
    taken = stats["dissipated_energy"][199] + stats["dissipated_energy"][299]
    missing = energy(balls, balls.x, balls.v, GRAVITY) - energy(balls, *state(lmp), GRAVITY)
    # theta = 1/2: exact but for round-off, 300 steps of 1e-16 on 1e-6 J
    assert taken == pytest.approx(missing, rel=1e-9)
    rows = attached.contacts
    assert list(rows) == nscd_lmp._core.CONTACT_COLUMNS[:10]  # without friction no tangential impulses
    assert all(len(column) == stats["contacts"][-1] for column in rows.values())
    smaller = np.minimum(
        balls.radius[rows["tag_i"].astype(int) - 1],
        np.where(rows["tag_j"] > 0, balls.radius[np.maximum(rows["tag_j"], 1).astype(int) - 1], np.inf),
    )
    assert stats["largest_overlap"][-1] == -rows["gap"].min()
    assert stats["largest_overlap_ratio"][-1] == pytest.approx((-rows["gap"] / smaller).max(), rel=1e-15)


def test_description_tells_what_was_chosen(start):
    lmp, _, walls = small_bed(start, "f f f")
    attached = nscd_lmp.attach(lmp, walls=walls, solver="sal", law="moreau", restitution=0.3)
    for word in ("law moreau", "SAL", "rho", "0.3", "5 walls", "frictionless"):
        assert word in attached.description


def test_detach_gives_lammps_back(start):
    lmp, _, walls = small_bed(start, "f f f")
    methods = [name for name in vars(lmp) if callable(getattr(lmp, name))]
    attached = nscd_lmp.attach(lmp, walls=walls)
    lmp.command("run 5")
    attached.detach()
    assert [name for name in vars(lmp) if callable(getattr(lmp, name))] == methods
    before, speed = state(lmp)
    lmp.command("run 5")  # nothing integrates now
    np.testing.assert_array_equal(state(lmp)[0], before)
    lmp.commands_list(["fix nve all nve/sphere", "run 1"])
    # velocity Verlet with gravity alone: dt v + dt^2 g / 2
    moved = state(lmp)[0] - before
    np.testing.assert_allclose(moved, 1e-4 * speed - [0, 0, 0.5e-8 * GRAVITY], rtol=0, atol=1e-15)
    assert len(attached.stats) == 5  # what was measured stays
    lmp.command("unfix nve")
    again = nscd_lmp.attach(lmp, walls=walls, law="moreau")
    lmp.command("run 5")
    assert len(again.stats) == 5


def test_second_attach_on_the_same_instance_is_refused_or_replaces_the_first(start):
    lmp, balls, walls = small_bed(start, "f f f")
    first = nscd_lmp.attach(lmp, walls=walls, law="moreau")
    try:
        second = nscd_lmp.attach(lmp, walls=walls, law="moreau")
    except nscd_lmp.NscdError:
        second = first
    lmp.command("run 1")
    assert len(first.stats) + len(second.stats) == (2 if second is first else 1)
    # one step of free fall, not two
    np.testing.assert_allclose(state(lmp)[1][:, 2], -GRAVITY * 1e-4, rtol=1e-12)
    assert balls.x.shape == state(lmp)[0].shape
