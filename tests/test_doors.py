"""The two doors: the same bits, the same habits, and what each hands out."""

from __future__ import annotations

import os
import subprocess
import sys

import nscd_lmp
import numpy as np
import pytest
from lammps import lammps
from scenes import DOORS, FLOOR, GRAVITY, SILENT, box_walls, cloud, energy, fill, forces, grains, harden, state

BOTH = pytest.mark.parametrize("door", DOORS)
LAWS = list(nscd_lmp.LAWS)
WIDTH = 4e-3  # m; the small bed below is a quarter of the paper's


def small_bed(start, boundary: str, dt: float = 1e-4):
    """Return an instance with 120 grains at rest above a floor of 4 x 4 mm, and the walls they need."""
    balls = cloud(120, (0.25e-3, 0.5e-3), WIDTH)
    height = float(balls.x[:, 2].max() + 1e-3)
    periodic = boundary.startswith("p")
    side = (0, WIDTH) if periodic else (-1e-4, WIDTH + 1e-4)
    lmp = start(balls, dt, gravity=GRAVITY, boundary=boundary, box=[side, side, (-1e-4, height)])
    return lmp, balls, [FLOOR] if periodic else box_walls(WIDTH)


@pytest.mark.parametrize("boundary", ["f f f", "p p f"])
@pytest.mark.parametrize("e", [0.0, 0.5])
@pytest.mark.parametrize("law", LAWS)
def test_doors_give_the_same_bits(start, law, e, boundary):
    end = []
    for door in DOORS:
        lmp, _, walls = small_bed(start, boundary)
        harden(lmp, door, law=law, restitution=e, walls=walls, unconverged="ignore")
        lmp.command("run 400")
        lmp.command("run 100")  # a second run reneighbors first and starts from the kept impulses
        end.append((*state(lmp), forces(lmp)))
    for python, script in zip(*end, strict=True):
        np.testing.assert_array_equal(python, script)
    assert end[0][0][:, 2].max() < 4.6e-3  # it has fallen, from 10 mm, into a bed


@pytest.mark.parametrize("solver", nscd_lmp.SOLVERS)
def test_doors_give_the_same_bits_and_columns_with_every_solver(start, solver):
    rows, ends = [], []
    for door in DOORS:
        lmp, _, walls = small_bed(start, "f f f")
        attached = harden(lmp, door, solver=solver, walls=walls, warmstart=False, unconverged="ignore", maxiter=200)
        lmp.command("run 300")
        ends.append(np.hstack(state(lmp)))
        if door == "python":
            rows.append([attached.stats[name][-1] for name in nscd_lmp._core.REPORT_COLUMNS])
            local = np.array([attached.contacts[name] for name in nscd_lmp._core.CONTACT_COLUMNS]).T
        else:
            rows.append([lmp.extract_fix("nscd", 0, 1, column) for column in range(11)])
            assert lmp.extract_fix("nscd", 0, 0) == rows[0][1]  # the scalar is the iteration count
            table = lmp.numpy.extract_fix("nscd", 2, 2)
            np.testing.assert_array_equal(table, local)
    np.testing.assert_array_equal(ends[0], ends[1])
    assert rows[0] == rows[1]


@BOTH
def test_same_input_gives_the_same_bits_in_a_second_instance_and_after_clear(start, door):
    ends = []
    kept, balls, walls = small_bed(start, "f f f")
    other, _, _ = small_bed(start, "f f f")  # alive at the same time
    for lmp in (kept, other):
        harden(lmp, door, walls=walls)
    for lmp in (kept, other):
        lmp.command("run 300")
        ends.append(np.hstack(state(lmp)))
    kept.command("clear")
    height, reach = float(balls.x[:, 2].max() + 1e-3), float(balls.radius.max())
    kept.commands_list(["units si", "atom_style sphere", "boundary f f f", "atom_modify sort 0 0"])
    kept.command(f"region box block -1e-4 {WIDTH + 1e-4} -1e-4 {WIDTH + 1e-4} -1e-4 {height!r}")
    kept.commands_list(["create_box 1 box", "comm_modify vel yes"])
    fill(kept, balls)
    kept.commands_list([f"pair_style zero {2 * reach + 2e-4!r}", "pair_coeff * *"])
    kept.commands_list([f"neighbor {0.5 * reach!r} nsq", "neigh_modify every 1 delay 0 check yes"])
    kept.commands_list(["timestep 1e-4", f"fix gravity all gravity {GRAVITY} vector 0 0 -1"])
    harden(kept, door, walls=walls)
    kept.command("run 300")
    ends.append(np.hstack(state(kept)))
    np.testing.assert_array_equal(ends[0], ends[1])
    np.testing.assert_array_equal(ends[0], ends[2])


@BOTH
def test_run_after_clear_is_plain_lammps(start, door):
    lmp, _, walls = small_bed(start, "f f f")
    harden(lmp, door, walls=walls)
    lmp.commands_list(["run 2", "clear", "units si", "atom_style sphere", "region box block 0 1 0 1 0 1"])
    lmp.commands_list(["create_box 1 box", "create_atoms 1 single 0.5 0.5 0.5", "pair_style zero 0.1", "pair_coeff * *"])
    lmp.commands_list(["velocity all set 1 0 0", "fix nve all nve", "timestep 0.01", "run 10"])
    assert state(lmp)[0][0, 0] == pytest.approx(0.6, abs=1e-12)


@pytest.mark.parametrize("first", ["nscd_lmp", "lammps"])
def test_either_import_order_starts_lammps(tmp_path, first):
    second = {"nscd_lmp": "lammps", "lammps": "nscd_lmp"}[first]
    program = f"import {first}\nimport {second}\nlmp = lammps.lammps(cmdargs={SILENT!r})\nprint(lmp.version())\nlmp.close()\n"
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) == lammps(cmdargs=SILENT).version()


def test_fix_nscd_is_known_to_a_lammps_that_never_heard_of_the_package(tmp_path):
    environment = {k: v for k, v in os.environ.items() if not k.startswith("LAMMPS_")}
    program = (
        "from mpi4py import MPI\nimport lammps\n"
        f"lmp = lammps.lammps(cmdargs={SILENT!r})\nprint(lmp.has_style('fix', 'nscd'))\nlmp.close()\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=60,
        check=False,
    )  # fmt: skip
    assert done.stdout.strip() == "True", done.stderr


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


@BOTH
@pytest.mark.parametrize("law", LAWS)
def test_atoms_outside_the_group_are_obstacles_that_do_not_move(start, door, law):
    # a pyramid: four balls are the ground, not in the group, one lies in their hollow and may move
    side = 2.2 * 0.5
    ground = np.array([(0, 0, 0), (side, 0, 0), (0, side, 0), (side, side, 0)])
    top = np.array([side / 2, side / 2, np.sqrt(1 - side**2 / 2)])
    balls = grains([*ground, top], 0.5)
    lmp = start(balls, 1e-3, gravity=GRAVITY)
    lmp.command("group free id 5")
    harden(lmp, door, "free", law=law, tol=1e-12)
    lmp.command("run 100")
    x, v = state(lmp)
    np.testing.assert_array_equal(x[:4], ground)
    np.testing.assert_array_equal(v[:4], 0)
    # moreau first falls for a step; then nothing moves: 100 steps of 4e-12 m/s
    np.testing.assert_allclose(x[4], top, rtol=0, atol=GRAVITY * 1e-6 + 1e-12)
    np.testing.assert_allclose(v[4], 0, atol=4e-12)


@BOTH
@pytest.mark.parametrize("law", LAWS)
def test_obstacle_that_another_fix_moves_hits_with_its_velocity(start, door, law):
    # w = 5 m/s against v = -1 m/s: v leaves with w + e (w - v), from a thing of infinite mass
    balls = grains([(0, 0, 0), (0, 0, 1.0)], 0.5, v=[(0, 0, 5.0), (0, 0, -1.0)])
    lmp = start(balls, 1e-4, vmax=20.0)
    lmp.commands_list(["group piston id 1", "group free id 2", "fix piston piston move linear 0 0 5"])
    harden(lmp, door, "free", law=law, restitution=0.5, tol=1e-12)
    lmp.command("run 2")
    assert state(lmp)[1][1, 2] == pytest.approx(8.0, abs=4e-12)


@BOTH
def test_fixes_of_force_count_wherever_they_stand(start, door):
    # gravity after the contact fix, through `fix addforce` too; a ball at rest bears both
    weight = 2.0
    lmp = start(grains((0, 0, 0.5), 0.5, mass=3.0), 1e-3)
    attached = harden(lmp, door, walls=[FLOOR], law="gap", tol=1e-12)
    lmp.commands_list([f"fix push all addforce 0 0 {-weight}", f"fix gravity all gravity {GRAVITY} vector 0 0 -1"])
    lmp.command("run 3")
    pressed = (weight + 3 * GRAVITY) * 1e-3
    measured = attached.contacts["impulse"][0] if attached else lmp.numpy.extract_fix("nscd", 2, 2)[0, 9]
    assert measured == pytest.approx(pressed, rel=1e-9)  # tol over W p = 1e-12 / 1e-2
    assert forces(lmp)[0, 2] == pytest.approx(weight + 3 * GRAVITY, rel=1e-9)


@BOTH
def test_forces_after_a_step_are_the_mean_contact_forces(start, door):
    lmp, balls, walls = small_bed(start, "f f f")
    attached = harden(lmp, door, walls=walls)
    lmp.command("run 300")
    before = state(lmp)[1]
    lmp.command("run 1")
    change = (state(lmp)[1] - before) * balls.mass[:, None] / 1e-4
    change[:, 2] += balls.mass * GRAVITY
    # difference of two velocities near 0.1 m/s: 1e-17 times m / dt = 1e-2
    np.testing.assert_allclose(forces(lmp), change, rtol=0, atol=1e-17)
    rows = np.array(list(attached.contacts.values())).T if attached else lmp.numpy.extract_fix("nscd", 2, 2).copy()
    total = np.zeros_like(before)
    for tag_i, tag_j, *_, nx, ny, nz, _, impulse in rows:
        total[int(tag_i) - 1] += impulse / 1e-4 * np.array([nx, ny, nz])
        if tag_j > 0:
            total[int(tag_j) - 1] -= impulse / 1e-4 * np.array([nx, ny, nz])
    # sums of about six impulses of 1e-10 N s over 1e-4 s
    np.testing.assert_allclose(forces(lmp), total, rtol=0, atol=1e-17)


def test_contacts_tell_point_normal_gap_and_impulse(start):
    # a ball rests in the corner of the floor and an inclined plane, on which it presses: statics gives the impulses
    slope = np.array([np.sin(0.5), 0, np.cos(0.5)])
    mass, dt = 3.0, 1e-3
    lmp = start(grains((0, 0, 0.5), 0.5, mass=mass), dt)
    steep = nscd_lmp.Plane(np.array([0, 0, 0.5]) - 0.5 * slope, slope)
    lmp.command(f"fix push all addforce {-5 * slope[0]} 0 {-7 * slope[2]}")
    attached = nscd_lmp.attach(lmp, walls=[FLOOR, steep], tol=1e-13)
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


def test_contact_between_grains_lies_between_them(start):
    normal = np.array([2.0, -1.0, 2.0]) / 3
    lmp = start(grains([0.7 * normal, (0, 0, 0)], [0.2, 0.5], v=[-normal, (0, 0, 0)]), 1e-4)
    attached = nscd_lmp.attach(lmp, tol=1e-12)
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
    w, impulse = system.delassus(), system.start.copy()
    free = system.velocity - w @ impulse  # the start impulses are in the velocity already
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
    # both stop when a sweep corrects less than 1e-12 m/s or so; slow modes hide about 100 times that in a step,
    # and 40 steps of a few impacts each pass it on
    np.testing.assert_allclose(ends[1][1], ends[0][1], rtol=0, atol=1e-8)


def test_python_solver_sees_the_problem_of_the_step(start):
    seen = []

    def look(system):
        seen.append(system)
        return np.maximum(0, system.start - system.velocity / system.delassus().diagonal())

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


@BOTH
@pytest.mark.parametrize("law", LAWS)
def test_several_runs_are_one_long_run_when_nothing_is_set_up_between(start, door, law):
    ends = []
    for pieces in ((60,), (20, 39, 1)):
        lmp, _, walls = small_bed(start, "f f f")
        harden(lmp, door, law=law, walls=walls)
        for number, steps in enumerate(pieces):
            lmp.command(f"run {steps}" + (" pre no" if number else ""))
        ends.append(np.hstack(state(lmp)))
    np.testing.assert_array_equal(ends[0], ends[1])


@BOTH
def test_setup_of_a_run_takes_no_step(start, door):
    lmp, balls, walls = small_bed(start, "f f f")
    attached = harden(lmp, door, walls=walls)
    for _ in range(3):
        lmp.command("run 0")
    np.testing.assert_array_equal(state(lmp)[0], balls.x)
    assert attached is None or len(attached.stats) == 0


def test_stats_have_a_row_a_step_with_the_seconds(start):
    lmp, balls, walls = small_bed(start, "f f f")
    attached = nscd_lmp.attach(lmp, walls=walls, law="moreau")
    assert len(attached.stats) == 0
    lmp.command("run 200")
    lmp.command("run 100")
    stats = attached.stats
    assert stats["step"].tolist() == list(range(1, 301))
    assert stats.dtype.names == (
        "step", "contacts", "iterations", "criterion", "motion", "bipotential", "penetration", "relative_residual",
        "largest_overlap", "dissipated_energy", "largest_overlap_ratio", "unconverged_steps", "seconds_contacts",
        "seconds_solver",
    )  # fmt: skip
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
    assert set(rows) == set(nscd_lmp._core.CONTACT_COLUMNS)
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
