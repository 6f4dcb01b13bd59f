# SPDX-License-Identifier: GPL-2.0-or-later
"""Contacts of known packings, and of random ones against all pairs and images."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from contact_pairs import find_grain_contacts, find_wall_contacts
from coordination import compute_coordination

pytestmark = pytest.mark.fast

EVERYWHERE, NOWHERE = np.ones(3, dtype=bool), np.zeros(3, dtype=bool)


def test_simple_cubic_has_6_contacts(simple_cubic):
    x, radius, bounds = simple_cubic
    result = compute_coordination(x, radius, bounds, EVERYWHERE)
    assert np.all(result.contacts == 6)
    assert result.n_grain_contacts == 3 * len(x)
    assert not result.rattler.any()
    assert result.mean == result.mean_backbone == 6.0


def test_face_centred_cubic_has_12_contacts(face_centred_cubic):
    x, radius, bounds = face_centred_cubic
    result = compute_coordination(x, radius, bounds, EVERYWHERE)
    assert np.all(result.contacts == 12)


@pytest.mark.parametrize("cells", [1, 2])
def test_boxes_thinner_than_two_cutoffs_count_each_image(cells):
    grid = np.stack(np.meshgrid(*[np.arange(cells)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    bounds = np.array([[0.0, 2.0 * cells]] * 3)
    result = compute_coordination(2.0 * grid, np.ones(len(grid)), bounds, EVERYWHERE)
    assert np.all(result.contacts == 6)


def test_planar_run_has_no_contacts_with_images_along_z():
    x = np.array([[1.0, 1.0, 0.0], [3.0, 1.0, 0.0]])
    bounds = np.array([[0.0, 9.0], [0.0, 9.0], [-0.5, 0.5]])  # thinner than the grains
    result = compute_coordination(x, np.ones(2), bounds, np.array([False, False, True]))
    assert result.contacts.tolist() == [1, 1]


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e4])
def test_random_grains_match_all_pairs_of_all_images(scale):
    random = np.random.default_rng(7)
    x = random.uniform(-0.5, 1.5, (300, 3)) * scale  # some lie outside of the box
    radius = random.uniform(0.02, 0.09, 300) * scale
    bounds = np.array([[0.0, 1.0], [-0.2, 0.8], [-0.6, 1.6]]) * scale
    found = find_grain_contacts(x, radius, bounds, np.array([True, True, False]))
    first, second = np.triu_indices(300, k=1)  # no grain is large enough to meet its own image
    gaps = []
    for shift in product((-2, -1, 0, 1, 2), (-2, -1, 0, 1, 2), (0,)):
        distance = np.linalg.norm(x[second] + np.array(shift) * scale - x[first], axis=1)
        gaps.append(distance - radius[first] - radius[second])
    expected = np.concatenate(gaps)
    expected = np.sort(expected[expected <= 0.0])
    assert len(found.gap) == len(expected) > 100
    # wrapping into the box rounds positions of size 1 to 1 ulp
    np.testing.assert_allclose(np.sort(found.gap), expected, atol=2e-15 * scale, rtol=0.0)


def test_walls_are_contacts_on_the_side_of_the_normal():
    x = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 5.0]])
    found = find_wall_contacts(x, np.ones(2), [[9.0, 9.0, 0.0, 0.0, 0.0, 2.0]], reach=1e-6)
    assert found.i.tolist() == [0] and found.j.tolist() == [-1]
    assert found.gap[0] == 0.0


def test_plane_without_normal_is_an_error():
    with pytest.raises(ValueError, match="normal 0 0 0"):
        find_wall_contacts(np.zeros((1, 3)), np.ones(1), [[0, 0, 0, 0, 0, 0]])


def test_rattlers_are_removed_until_none_is_left():
    # A straight chain: the ends are loose, and without them so are the next ones.
    x = np.column_stack([2.0 * np.arange(7), np.zeros(7), np.zeros(7)])
    bounds = np.array([[-50.0, 50.0]] * 3)
    chain = compute_coordination(x, np.ones(7), bounds, NOWHERE, rattler_below=2)
    assert chain.contacts.tolist() == [1, 2, 2, 2, 2, 2, 1]
    assert chain.rattler.all() and np.isnan(chain.mean_backbone)
    walls = [[-1, 0, 0, 1, 0, 0], [13, 0, 0, -1, 0, 0]]
    held = compute_coordination(x, np.ones(7), bounds, NOWHERE, walls, rattler_below=2)
    assert held.n_wall_contacts == 2 and not held.rattler.any()
    assert held.mean == 2.0


def test_gap_tolerance_is_relative_to_the_mean_radius():
    x = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 4.0 + 2e-3]])
    bounds = np.array([[-9.0, 9.0]] * 3)
    for tolerance, contacts in ((0.9e-3, 0), (1.1e-3, 1)):
        result = compute_coordination(x, np.array([1.0, 3.0]), bounds, NOWHERE, tolerance=tolerance)
        assert result.n_grain_contacts == contacts
