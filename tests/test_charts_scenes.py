# SPDX-License-Identifier: GPL-2.0-or-later
"""Charts with closed forms: rigid contacts err as their scheme does, penalty contacts less with more stiffness."""

from __future__ import annotations

import numpy as np
import pytest

from nscd_lmp.charts.chart import find_scene
from nscd_lmp.charts.penalty import contact_duration
from nscd_lmp.charts.scenes import _lone_balls as lone
from nscd_lmp.charts.scenes import bouncing_ball, oblique_impact

EXACT = 1e-12
EVERY_LAW = pytest.mark.parametrize("law", ["gap", "moreau"])


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Return a function that runs a scene once."""
    monkeypatch.setattr(lone, "REPEATS", 1)
    return lambda name, **case: find_scene(name).run(tmp_path, **case)


def soft_and_stiff(run, name, stiffnesses, mass):
    """Return the results of two stiffnesses, each with 1/20 of its contact duration."""
    for k in stiffnesses:
        yield run(name, method="granular/hooke", stiffness=k, dt=contact_duration(k, mass) / 20)


@EVERY_LAW
@pytest.mark.parametrize("name", ["sliding_ball", "slide_to_roll"])
def test_end_of_sliding_is_met_to_second_order(run, law, name):
    # the step in which sliding ends moves as if it ended in its middle: mu g dt^2 / 8 at most
    for dt in (1e-2, 1e-3):
        found = run(name, method=f"{law}/pdas", tol=1e-10, dt=dt)
        slowest = 0.5**2 / (2 * 0.3 * 9.81) if name == "sliding_ball" else 0.5 * 5 / 7 * 0.3
        assert found["distance_error"] < 0.3 * 9.81 * dt**2 / 8 / slowest * 1.01
        assert found["creep" if name == "sliding_ball" else "speed_error"] < EXACT
        assert found["overlap"] < EXACT
        assert found["simulated"] == pytest.approx(0.6 if name == "sliding_ball" else 0.3)


@pytest.mark.parametrize("name", ["sliding_ball", "slide_to_roll"])
def test_penalty_balls_sink_by_their_weight(run, name):
    stiffnesses = (1e4, 1e5)
    soft, stiff = soft_and_stiff(run, name, stiffnesses, lone.mass())
    for found, k in zip((soft, stiff), stiffnesses, strict=True):
        assert found["overlap"] == pytest.approx(lone.mass() * 9.81 / k / 0.01, rel=1e-3)
    assert stiff["distance_error"] < 0.5 * soft["distance_error"] < 0.01


@EVERY_LAW
def test_bounces_are_timed_to_a_step(run, law):
    coarse, fine = (run("bouncing_ball", method=f"{law}/pdas", tol=1e-10, dt=dt) for dt in (1e-3, 1e-4))
    assert fine["height_error"] < 1e-3 and coarse["height_error"] < 1e-2
    assert fine["rest_error"] < 1e-3 and coarse["rest_error"] < 1e-2
    if law == "gap":
        assert fine["overlap"] < EXACT
    else:
        assert fine["overlap"] <= bouncing_ball.SPEED * 1e-4 / 0.01


def test_time_of_rest_is_near_that_of_infinitely_many_bounces():
    everything = bouncing_ball.FALL * (1 + bouncing_ball.RESTITUTION) / (1 - bouncing_ball.RESTITUTION)
    assert 0.9 * everything < bouncing_ball.rest() < everything
    assert bouncing_ball.DURATION > everything


def test_penalty_bounces_come_near_with_stiffness(run):
    soft, stiff = soft_and_stiff(run, "bouncing_ball", (1e5, 1e6), lone.mass())
    assert stiff["overlap"] == pytest.approx(soft["overlap"] / 10**0.5, rel=0.05)
    assert stiff["rest_error"] < soft["rest_error"] < 0.2


@EVERY_LAW
def test_oblique_impacts_of_rigid_balls_are_exact(run, law):
    found = run("oblique_impact", method=f"{law}/pdas", tol=1e-13, dt=1e-3)
    assert max(found["tangential_error"], found["normal_error"]) < EXACT
    along, away = oblique_impact.closed_form()
    limit = 3.5 * 0.25 * 1.87 / 1.43
    sticks = np.tan(oblique_impact.ANGLES) < limit
    assert 50 < sticks.sum() < 60
    np.testing.assert_allclose(along[sticks], (1 - 2 / 7 * 1.43) * np.sin(oblique_impact.ANGLES[sticks]))
    np.testing.assert_allclose(away, 0.87 * np.cos(oblique_impact.ANGLES))


def test_oblique_impacts_of_penalty_balls_differ_where_they_stick_and_slide(run):
    soft, stiff = soft_and_stiff(run, "oblique_impact", (1e4, 1e6), lone.mass(3e-3, 1319.0))
    assert stiff["overlap"] < 0.2 * soft["overlap"]
    assert max(soft["normal_error"], stiff["normal_error"]) < 0.02
    assert min(soft["tangential_error"], stiff["tangential_error"]) > 0.03
