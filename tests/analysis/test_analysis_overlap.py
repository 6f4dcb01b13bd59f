# SPDX-License-Identifier: GPL-2.0-or-later
"""Overlaps far below the resolution of float32."""

from __future__ import annotations

import numpy as np
import pytest
from contact_pairs import find_wall_contacts
from overlap import compute_overlap_history, compute_overlaps, compute_resolution
from packing import Packing

pytestmark = pytest.mark.fast

NOWHERE = np.zeros(3, dtype=bool)


def two_balls(overlap):
    x = np.array([[5.2e-3, 6.1e-3, 7.7e-3]] * 2)
    x[1, 0] += 1e-3 * (1.0 - overlap / 2.0)  # radii 0.5 mm
    return {"x": x, "radius": [5e-4, 5e-4]}


def test_overlap_of_1e_9_radii_is_seen_in_a_dump(write_dump):
    frame = Packing(write_dump(two_balls(1e-9))).frame(0)
    overlaps = compute_overlaps(frame.x, frame.radius, frame.bounds, frame.periodic)
    # positions of 6e-3 in float64 resolve 2e-15 of a radius of 5e-4; 1e-13 leaves a margin
    np.testing.assert_allclose(overlaps, [1e-9], atol=1e-13)
    assert compute_resolution(frame.x, frame.radius) < 1e-13


def test_gap_of_1e_9_radii_is_no_overlap(write_dump):
    frame = Packing(write_dump(two_balls(-1e-9))).frame(0)
    assert len(compute_overlaps(frame.x, frame.radius, frame.bounds, frame.periodic)) == 0


def test_overlap_through_a_periodic_face(write_dump):
    # centres 0.1 before and behind the face at x = 3, overlap 1e-9 of the radius
    x = np.array([[2.9, 0.5, 0.5], [1.1 - 1e-10, 0.5, 0.7]])
    x[1, 2] = 0.5
    path = write_dump({"x": x, "radius": [0.1, 0.1]}, bounds=((1, 3), (0, 1), (0, 1)), boundary="pp ff ff")
    frame = Packing(path).frame(0)
    overlaps = compute_overlaps(frame.x, frame.radius, frame.bounds, frame.periodic)
    np.testing.assert_allclose(overlaps, [1e-9], atol=1e-14)


def test_overlap_is_related_to_the_smaller_radius_and_walls_to_the_own():
    x = np.array([[0.0, 0.0, 0.99], [0.0, 0.0, 2.48]])
    bounds = np.array([[-9.0, 9.0]] * 3)
    overlaps = compute_overlaps(x, np.array([1.0, 0.5]), bounds, NOWHERE, [[0, 0, 0, 0, 0, 1]])
    np.testing.assert_allclose(sorted(overlaps), [0.01, 0.02], rtol=1e-12)


def test_history_has_zeros_where_nothing_overlaps(write_dump):
    path = write_dump(two_balls(1e-6), two_balls(-1e-6), steps=[10, 20])
    history = compute_overlap_history(Packing(path, dt=0.1))
    np.testing.assert_allclose(history.time, [1.0, 2.0])
    np.testing.assert_allclose(history.largest, [1e-6, 0.0], atol=1e-12)
    assert history.count.tolist() == [1, 0]


def test_resolution_of_a_6_digit_dump_is_poor(write_dump):
    frame = Packing(write_dump(two_balls(1e-9), number="%g")).frame(0)
    assert compute_resolution(frame.x, frame.radius, digits=6) == pytest.approx(1.54e-4, rel=0.01)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_grains_that_are_nowhere_are_an_error_and_not_0_overlaps(value):
    x = np.zeros((2, 3))
    x[1, 2] = value
    for planes in (None, [(0, 0, 0, 0, 0, 1)]):
        with pytest.raises(ValueError, match=r"1 of 2 grains, the first of index 1, .* not a finite number"):
            compute_overlaps(x, np.ones(2), np.array([(-1, 1)] * 3), NOWHERE, planes)
    with pytest.raises(ValueError, match="not a finite number"):
        find_wall_contacts(x, np.ones(2), [(0, 0, 0, 0, 0, 1)])
