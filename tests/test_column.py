# SPDX-License-Identifier: GPL-2.0-or-later
"""A column of grains, the worst case of Gauss-Seidel and one with closed forms for everything."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scenes import FLOOR, GRAVITY, grains, harden, state

import nscd_lmp

pytestmark = pytest.mark.fast

SOLVERS, LAWS = list(nscd_lmp.SOLVERS), list(nscd_lmp.LAWS)
RADIUS, DT = 0.5, 1e-3


def column(n, mass=1000.0):
    """Return n balls at rest one on another; 0.5 and 1 m are binary numbers, so every gap is exactly 0."""
    return grains([(0, 0, RADIUS + k * 2 * RADIUS) for k in range(n)], RADIUS, mass=mass)


def stand(start, balls, steps=1, **options):
    """Return the rows of `.contacts` from the bottom up, and what attach returned, after some steps."""
    lmp = start(balls, DT, gravity=GRAVITY)
    attached = harden(lmp, walls=[FLOOR], **options)
    lmp.command(f"run {steps}")
    rows = attached.contacts
    return {name: column[np.argsort(rows["z"])] for name, column in rows.items()}, attached, lmp


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("solver", SOLVERS)
def test_column_bears_at_each_contact_the_weight_above_it(start, solver, law):
    n, mass = 12, 1000.0
    rows, attached, lmp = stand(start, column(n), solver=solver, law=law, tol=1e-13, maxiter=100000)
    assert attached.stats["unconverged_steps"][-1] == 0
    weight = mass * GRAVITY * DT
    expected = weight * np.arange(n, 0, -1)  # n m g dt at the bottom, m g dt at the top
    # errors of the velocities, up to tol N^2 of the slowest mode, over W
    np.testing.assert_allclose(rows["impulse"], expected, rtol=0, atol=1e-13 * n**2 * mass)
    np.testing.assert_allclose(state(lmp)[1], 0, atol=1e-13 * n**2)


@pytest.mark.parametrize("law", LAWS)
def test_column_stands_still_for_a_second(start, law):
    n = 8
    balls = column(n)
    rows, _, lmp = stand(start, balls, steps=1000, law=law, tol=1e-12, maxiter=10000)
    # nothing sinks: less than 1000 steps of the velocity error, tol N^2
    np.testing.assert_allclose(state(lmp)[0], balls.x, rtol=0, atol=1000 * DT * 1e-12 * n**2)
    np.testing.assert_allclose(rows["impulse"], 1000 * GRAVITY * DT * np.arange(n, 0, -1), rtol=1e-9)


def sweeps_a_decade(start, solver, balls, rates=(1e-6, 1e-10)):
    """Return the iterations in which criterion (42) falls by ten, between two tolerances, from P = 0."""
    counts = []
    for tol in rates:
        _, attached, _ = stand(start, balls, solver=solver, law="moreau", tol=tol, maxiter=1000000, warmstart=False)
        assert attached.stats["unconverged_steps"][-1] == 0
        counts.append(attached.stats["iterations"][-1])
    return (counts[1] - counts[0]) / math.log10(rates[0] / rates[1])


def relaxation_rate(jacobi: float, omega: float) -> float:
    """Return the share of the error that a relaxed Gauss-Seidel sweep leaves on a chain (Young 1954)."""
    root = 0.5 * (omega * jacobi + math.sqrt((omega * jacobi) ** 2 - 4 * (omega - 1)))
    return root**2


# What the criterion's own steps, spread by 1/64 near its end, leave to the count, and the start of the
# asymptotics.
COUNTED = 0.05


@pytest.mark.parametrize("n", [5, 10, 20, 40])
@pytest.mark.parametrize("solver", nscd_lmp.LOCAL_LAWS)
def test_sweeps_a_decade_of_a_column_are_those_of_gauss_seidel(start, solver, n):
    # W of the column is the chain with one fixed end, Jacobi's factor cos(pi / 2n): 0.93 n^2 for PDAS
    omega = nscd_lmp.SOLVERS[solver].default
    expected = -1 / math.log10(relaxation_rate(math.cos(math.pi / (2 * n)), omega))
    measured = sweeps_a_decade(start, solver, column(n))
    assert measured == pytest.approx(expected, rel=COUNTED, abs=1)
    if omega == 1 and n >= 20:
        assert measured / n**2 == pytest.approx(0.93, rel=2 * COUNTED)


@pytest.mark.parametrize("ratio", [10.0, 100.0, 1000.0])
@pytest.mark.parametrize("solver", ["ebp", "eal", "pdas"])
def test_sweeps_a_decade_of_heavy_on_light_grow_with_the_mass_ratio(start, solver, ratio):
    # two contacts, Jacobi's factor squared is R / (R + 1): ln 10 / ln(1 + 1/R) = 2.3 R
    expected = math.log(10) / math.log(1 + 1 / ratio)
    measured = sweeps_a_decade(start, solver, column(2, mass=[1.0, ratio]))
    assert measured == pytest.approx(expected, rel=COUNTED, abs=1)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("solver", SOLVERS)
def test_heavy_on_light_bears_both_weights(start, solver, law):
    mass = np.array([1.0, 1000.0])
    rows, attached, _ = stand(start, column(2, mass), solver=solver, law=law, tol=1e-11, maxiter=1000000)
    assert attached.stats["unconverged_steps"][-1] == 0
    # an impulse errs by a velocity over W, of up to tol times the 2300 sweeps of a decade
    np.testing.assert_allclose(rows["impulse"], GRAVITY * DT * np.array([1001.0, 1000.0]), rtol=1e-6)


@pytest.mark.parametrize("law", LAWS)
def test_warm_start_spares_the_column_its_sweeps(start, law):
    # from the second step on the impulses are known
    _, attached, _ = stand(start, column(20), steps=20, law=law, solver="pdas", tol=1e-9, maxiter=100000)
    iterations = attached.stats["iterations"]
    assert iterations[0] > 500
    assert iterations[-1] <= 2
