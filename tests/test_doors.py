# SPDX-License-Identifier: GPL-2.0-or-later
"""The two doors: the same bits, the same habits, and what each hands out."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest
from scenes import (
    DOORS,
    GRAVITY,
    SILENT,
    SMALL,
    forces,
    grains,
    harden,
    small_bed,
    state,
)

import nscd_lmp

BOTH = pytest.mark.parametrize("door", DOORS)
LAWS = list(nscd_lmp.LAWS)


@pytest.mark.fast
@pytest.mark.parametrize("boundary", ["f f f", "p p fm", "s s m"])
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


def test_doors_agree_to_round_off_in_a_tilted_box(start):
    random = np.random.default_rng(5)
    x = 0.1 * np.stack(np.meshgrid(*[np.arange(4.0)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    gas = grains(x + 0.05, random.uniform(0.02, 0.035, 64), mass=1.0, v=random.normal(size=x.shape))
    ends = []
    for door in DOORS:
        lmp = start(gas, 2e-4, box=[(0, 0.4)] * 3, boundary="p p p", vmax=10.0)
        lmp.command("change_box all triclinic xy final 0.1 xz final 0.07 yz final -0.12 remap")
        harden(lmp, door, restitution=1.0, criterion="natural", tol=1e-9)
        lmp.command("run 500")
        ends.append(state(lmp)[1])
    # some 1e-14 of 1 m/s, times what collisions of 0.1 s make of it
    np.testing.assert_allclose(*ends, rtol=0, atol=1e-12)


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
            local = np.array(list(attached.contacts.values())).T
        else:
            rows.append([lmp.extract_fix("nscd", 0, 1, column) for column in range(len(rows[0]))])
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
    kept.command(f"region box block -1e-4 {SMALL + 1e-4} -1e-4 {SMALL + 1e-4} -1e-4 {height!r}")
    kept.commands_list(["create_box 1 box", "comm_modify vel yes"])
    nscd_lmp.create_grains(kept, balls.x, balls.radius, mass=balls.mass)
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
    lmp.commands_list(
        ["create_box 1 box", "create_atoms 1 single 0.5 0.5 0.5", "pair_style zero 0.1", "pair_coeff * *"]
    )
    lmp.commands_list(["velocity all set 1 0 0", "fix nve all nve", "timestep 0.01", "run 10"])
    assert state(lmp)[0][0, 0] == pytest.approx(0.6, abs=1e-12)


@pytest.mark.parametrize("first", ["nscd_lmp", "lammps"])
def test_either_import_order_starts_lammps(tmp_path, first):
    second = {"nscd_lmp": "lammps", "lammps": "nscd_lmp"}[first]
    program = (
        f"import {first}\nimport {second}\n"
        f"lmp = lammps.lammps(cmdargs={SILENT!r})\nprint(lmp.has_style('fix', 'nscd'))\nlmp.close()\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == "True"


def test_fix_nscd_is_known_to_a_lammps_that_never_heard_of_the_package(tmp_path):
    environment = {k: v for k, v in os.environ.items() if not k.startswith("LAMMPS_")}
    program = (
        "from mpi4py import MPI\nimport lammps\n"
        f"lmp = lammps.lammps(cmdargs={SILENT!r})\nprint(lmp.has_style('fix', 'nscd'))\nlmp.close()\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.stdout.strip() == "True", done.stderr


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
