# SPDX-License-Identifier: GPL-2.0-or-later
"""Packing fractions in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from bed_profile import Container, compute_bed_height, compute_container, compute_profile

pytestmark = pytest.mark.fast


def test_simple_cubic_fills_pi_over_6(simple_cubic):
    x, radius, bounds = simple_cubic
    container = compute_container(bounds, ("pp", "pp", "pp"))
    profile = compute_profile(x[:, 2], radius, container, n_slabs=7, periodic=True)
    assert profile.fraction.mean() == pytest.approx(np.pi / 6.0, rel=1e-13)
    # 4 slabs, one per layer of balls, are all alike
    layers = compute_profile(x[:, 2], radius, container, n_slabs=4, periodic=True)
    np.testing.assert_allclose(layers.fraction, np.pi / 6.0, rtol=1e-12)


def test_face_centred_cubic_fills_0_7405(face_centred_cubic):
    x, radius, bounds = face_centred_cubic
    container = compute_container(bounds, ("pp", "pp", "pp"))
    profile = compute_profile(x[:, 2], radius, container, n_slabs=11, periodic=True)
    assert profile.fraction.mean() == pytest.approx(np.pi / np.sqrt(18.0), rel=1e-13)


def test_slab_of_one_ball_has_the_volume_of_the_spherical_segment():
    profile = compute_profile(np.array([1.0]), np.array([1.0]), Container(4.0, 0.0, 9.0), 4)
    cap = np.pi * 0.5**2 * (1.0 - 0.5 / 3.0)  # height 1/2 of a unit ball
    segment = 2.0 * np.pi / 3.0 - cap
    np.testing.assert_allclose(profile.fraction * 2.0, [cap, segment, segment, cap], rtol=1e-14)


def test_profile_sums_up_to_the_volume_of_the_grains():
    random = np.random.default_rng(5)
    height, radius = random.uniform(1.0, 9.0, 200), random.uniform(0.1, 1.0, 200)
    profile = compute_profile(height, radius, Container(3.0, 0.0, 99.0), 37)
    solid = np.sum(profile.fraction * np.diff(profile.edges)) * 3.0
    assert solid == pytest.approx(4.0 / 3.0 * np.pi * np.sum(radius**3), rel=1e-13)


def test_height_of_a_stack_of_cubic_layers():
    layers = np.repeat(2.0 * np.arange(50) + 1.0, 9)
    bed = compute_bed_height(layers, np.ones(len(layers)), Container(36.0, 0.0, 999.0))
    assert bed.top == 100.0
    assert bed.centroid == pytest.approx(100.0)
    assert bed.volume_99 == pytest.approx(99.0)  # half of the uppermost of 50 layers
    # 20 to 80 % cuts layers, so the mean over them is within a layer's share of the 30
    assert bed.fraction == pytest.approx(np.pi / 6.0, abs=0.01)


def test_discs_of_a_planar_run_fill_the_area():
    container = compute_container(
        np.array([[0.0, 8.0], [0.0, 8.0], [-0.1, 0.1]]), ("ff", "ff", "pp"), axis=1, planar=True
    )
    height = np.repeat([1.0, 3.0, 5.0, 7.0], 4)
    profile = compute_profile(height, np.ones(16), container, 4)
    np.testing.assert_allclose(profile.fraction, np.pi / 4.0, rtol=1e-12)
    with pytest.raises(ValueError, match="--axis y"):
        compute_container(np.zeros((3, 2)), ("ff", "ff", "pp"), planar=True)


def test_planes_stand_for_box_faces():
    bounds = np.array([[-1.0, 9.0]] * 3)
    planes = [[0.0, 0, 0, 1, 0, 0], [4.0, 0, 0, -1, 0, 0], [0.0, 0, 0.5, 0, 0, 1]]
    container = compute_container(bounds, ("ss", "ff", "ff"), planes)
    assert container == Container(40.0, 0.5, 9.0)


def test_shrink_wrapped_side_is_no_wall():
    with pytest.raises(ValueError, match=r"xlo is shrink-wrapped.*--plane"):
        compute_container(np.array([[0.0, 1.0]] * 3), ("ss", "ff", "ff"))


def test_oblique_plane_is_an_error():
    with pytest.raises(ValueError, match="oblique"):
        compute_container(np.array([[0.0, 1.0]] * 3), ("ff",) * 3, [[0, 0, 0, 1, 1, 0]])


def test_grains_below_the_floor_are_an_error():
    with pytest.raises(ValueError, match="a floor below the grains"):
        compute_profile(np.array([1.0]), np.array([0.5]), Container(1.0, 2.0, 9.0))
