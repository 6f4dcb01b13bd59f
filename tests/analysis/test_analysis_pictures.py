# SPDX-License-Identifier: GPL-2.0-or-later
"""The rendering, and each script from its command line to its picture."""

from __future__ import annotations

import subprocess
import sys
from itertools import product
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from bed_picture import compute_colors, compute_shown_bounds
from command_line import plain_decimals
from sphere_rendering import View, rasterize, render_bed

ANALYSIS = Path(__file__).resolve().parents[2] / "analysis"
SCRIPTS = ["bed_picture", "bed_profile", "coordination", "kinetic_energy", "overlap"]


@pytest.fixture
def bed_dump(write_dump):
    """Two frames of 60 grains, moving and partly overlapping."""
    random = np.random.default_rng(2)
    frames = [
        {
            "x": random.uniform(0.1e-2, 0.9e-2, (60, 3)),
            "v": random.normal(size=(60, 3)),
            "omega": random.normal(size=(60, 3)),
            "radius": random.uniform(5e-4, 1e-3, 60),
            "mass": np.ones(60),
        }
        for _ in range(2)
    ]
    return write_dump(*frames, bounds=((0, 0.01),) * 3, steps=[0, 100])


def run_script(name, *words):
    return subprocess.run(
        [sys.executable, str(ANALYSIS / f"{name}.py"), *map(str, words)],
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize("name", SCRIPTS)
def test_script_prints_a_table_and_writes_a_picture(name, bed_dump, tmp_path):
    output = tmp_path / "new" / f"{name}.png"
    done = run_script(name, bed_dump, "--output", output, *(["--size", 200] * (name == "bed_picture")))
    assert done.returncode == 0, done.stderr
    assert "step 100" in done.stdout and "│" in done.stdout
    pixels = matplotlib.image.imread(output)
    assert min(pixels.shape[:2]) > 200
    assert pixels[..., :3].std() > 0.02  # an empty chart would be one colour


@pytest.mark.parametrize("name", SCRIPTS)
def test_script_error_is_one_message_without_traceback(name, write_dump):
    done = run_script(name, write_dump({"x": [[0.0, 0.0, 0.0]]}))
    assert done.returncode == 2
    assert "lacks the columns radius" in done.stderr and "Traceback" not in done.stderr


def test_negative_numbers_with_exponents_are_values_of_plane(bed_dump, tmp_path):
    plane = ["--plane", "-4e-3", "0", "-1.5E-3", "0", "0", "1"]
    done = run_script("coordination", bed_dump, *plane, "-o", tmp_path / "c.png")
    assert done.returncode == 0, done.stderr
    assert plain_decimals(["-4e-3", "-o", "1e-3", "-.5E2"]) == ["-0.004", "-o", "1e-3", "-50"]


def cube(half):
    return half * np.array(list(product((-1.0, 1.0), repeat=3)))


def test_ray_meets_the_nearest_of_two_spheres():
    x, radius = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 3.0]]), np.array([1.0, 0.5])
    view = View.fit(cube(2.0), np.array([0.0, 0.0, 1.0]), 20.0, 200)  # from above
    depth, owner = rasterize(view, x, radius)
    assert owner[100, 100] == 1 and owner[0, 0] == -1
    assert depth[100, 100] == pytest.approx(16.5, abs=1e-3)  # eye at z = 20, top of ball 3.5
    column, row, _ = view.project(np.array([[0.9, 0.0, 0.0]]))
    assert owner[round(row[0]), round(column[0])] == 0


def test_silhouette_of_a_sphere_has_the_area_of_its_cone():
    view = View.fit(cube(1.2), np.array([0.0, -1.0, 0.0]), 10.0, 800)
    _, owner = rasterize(view, np.zeros((1, 3)), np.array([1.0]))
    tangent = np.tan(np.arcsin(0.1))
    # the count of pixels in a circle is off by about its perimeter over its area: 1e-3 here
    assert np.sum(owner == 0) * view.pixel**2 == pytest.approx(np.pi * tangent**2, rel=2e-3)


def test_grain_in_the_shadow_is_darker():
    # The sun stands behind the camera, to the left and above; the second grain is in its way.
    x = np.array([[0.0, 0.0, 1.0], [-1.5, -1.75, 3.7], [6.0, 0.0, 1.0]])
    bounds = np.array([[-2.0, 8.0], [-2.0, 2.0], [0.0, 5.0]])
    pixels, view, depth = render_bed(x, np.ones(3), np.full((3, 3), 0.7), bounds, -90.0, 20.0, 300)
    assert pixels.shape[0] * 2 == depth.shape[0] and pixels.min() >= 0.0 and pixels.max() <= 1.0
    brightness = []
    for centre in (x[0], x[2]):
        column, row, _ = view.project((centre + np.array([0.0, -0.7, 0.7]))[None])
        brightness.append(pixels[int(row[0] / 2), int(column[0] / 2)].mean())
    assert brightness[0] < 0.7 * brightness[1]


def test_box_much_higher_than_the_bed_is_cut_at_the_highest_grain():
    x, radius = np.array([[0.5, 0.5, 0.5]]), np.array([0.5])
    bounds = np.array([[0.0, 1.0], [0.0, 1.0], [0.0, 10.0]])
    shown, cut = compute_shown_bounds(x, radius, bounds)
    assert cut and shown[2].tolist() == [0.0, 1.0]
    shown, cut = compute_shown_bounds(x, radius, bounds, whole_box=True)
    assert not cut and shown[2, 1] == 10.0


def test_stray_grain_does_not_take_the_colour_scale():
    values = np.append(np.linspace(0.0, 1.0, 999), 50.0)
    rgb, scale, ends = compute_colors(values)
    assert rgb.shape == (1000, 3) and ends == "max"
    assert scale.vmax is not None and scale.vmax < 1.01
    _, scale, ends = compute_colors(np.full(5, 2.0))
    assert scale.vmin == 2.0 and ends == "neither"
