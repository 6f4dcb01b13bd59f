# SPDX-License-Identifier: GPL-2.0-or-later
"""Outlines of walls lie on the walls, end where the box does, and are read from words as fix wall/nscd has them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from sphere_rendering import View, rasterize
from wall_mesh import Mesh
from wall_outlines import compute_bounds_with_walls, compute_wall_outlines
from wall_words import KINDS, read_walls

SCRIPT = Path(__file__).resolve().parents[2] / "analysis" / "bed_picture.py"
BOX = np.array([[-1.0, 1.0], [-1.0, 1.0], [-1.0, 1.0]])
GRAINS = np.array([[0.0, 0.0, -0.3], [0.1, 0.0, -0.2], [0.0, 0.2, -0.1]])
EYE = np.array([3.0, -8.0, 4.0])

# distance of points from the surface, by hand
SURFACES = {
    "plane 0.1 0.2 0 1 2 3": lambda p: ((p - [0.1, 0.2, 0.0]) @ [1.0, 2.0, 3.0]) / np.sqrt(14.0),
    "zplane -0.5 NULL": lambda p: p[:, 2] + 0.5,
    "ycylinder 0.9": lambda p: np.hypot(p[:, 0], p[:, 2]) - 0.9,
    "cylinder 0.1 0 0 1 2 2 0.8": lambda p: np.linalg.norm(np.cross(p - [0.1, 0, 0], [1, 2, 2]), axis=1) / 3.0 - 0.8,
    "cylinder x 0.1 0.2 1.1 INF 0.5": lambda p: np.hypot(p[:, 1] - 0.1, p[:, 2] - 0.2) - 1.1,
    "cone z 0.1 -0.1 0.2 0.9 -0.8 0.6": lambda p: (
        (np.hypot(p[:, 0] - 0.1, p[:, 1] + 0.1) - 0.2 - 0.5 * (p[:, 2] + 0.8)) / np.sqrt(1.25)
    ),
    "cone y 0 0 1.6 0 -2 2": lambda p: (np.hypot(p[:, 0], p[:, 2]) - 0.4 * (2.0 - p[:, 1])) / np.sqrt(1.16),
    "sphere 0.1 0.2 0.3 1.2": lambda p: np.linalg.norm(p - [0.1, 0.2, 0.3], axis=1) - 1.2,
    "block -0.5 0.6 -0.7 INF EDGE 0.8": lambda p: np.min(
        np.abs(np.column_stack([p[:, 0] + 0.5, p[:, 0] - 0.6, p[:, 1] + 0.7, p[:, 2] - 0.8])), axis=1
    ),
}


def outlines(*walls: str, x: np.ndarray = GRAINS, bounds: np.ndarray = BOX) -> list[np.ndarray]:
    return compute_wall_outlines(read_walls([wall.split() for wall in walls]), x, bounds, EYE)


@pytest.mark.parametrize("wall", SURFACES)
def test_outline_lies_on_the_surface_and_in_the_box(wall):
    points = np.concatenate(outlines(wall))
    assert len(points) > 50
    # a section is divided by a slope that can be small: some round-offs of the box' size
    assert np.abs(SURFACES[wall](points)).max() < 1e-12
    # cut where a margin of 1e-10 of the box' reach ends, twice its diagonal
    assert np.all(points >= BOX[:, 0] - 1e-9) and np.all(points <= BOX[:, 1] + 1e-9)


def test_outlines_of_a_cylinder_are_its_rims_and_its_silhouette():
    lines = outlines("ycylinder 0.9")
    rims = [line for line in lines if np.ptp(line[:, 1]) < 1e-9]
    assert sorted(round(line[0, 1]) for line in rims) == [-1, 1]
    assert all(np.allclose(line[0], line[-1], atol=1e-12) for line in rims)
    sides = [line for line in lines if np.ptp(line[:, 1]) > 1.0]
    assert len(sides) == 2 and len(lines) == 4
    for side in sides:  # the ray from the eye touches the surface: it is perpendicular to the normal
        normal = side[0] * [1.0, 0.0, 1.0]
        assert normal @ (EYE - side[0]) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("wall", ["sphere 0 0 0 0.7", "cone z 0 0 0.2 0.9 -0.9 0.9", "cylinder 0 0 0 1 1 1 0.4"])
def test_silhouette_is_where_the_rendered_shape_ends(wall):
    """The shape is filled with balls that touch it from inside: lines are at or beyond the edge of what is drawn."""
    (shape,) = read_walls([wall.split()])
    random = np.random.default_rng(1)
    x = random.uniform(-0.9, 0.9, (4000, 3))
    x = x[(shape.distance(x) > 0.02) & (shape.distance(x) < 0.1)]
    if wall.startswith("cone"):
        x = x[shape.extent(x) > 0.1]
    view = View.fit(np.array(np.meshgrid(*BOX)).reshape(3, -1).T, EYE, 9.0, 300)
    _, owner = rasterize(view, x, shape.distance(x))
    column, row, _ = view.project(np.concatenate(compute_wall_outlines([shape], x, BOX, view.eye)))
    covered = np.argwhere(owner >= 0)
    # all that the balls cover lies within the smallest box of the lines in the picture, up to a pixel
    assert covered[:, 0].min() > row.min() - 1.5 and covered[:, 0].max() < row.max() + 1.5
    assert covered[:, 1].min() > column.min() - 1.5 and covered[:, 1].max() < column.max() + 1.5


def test_box_cuts_the_round_walls_in_closed_forms():
    rim = [line for line in outlines("sphere 0 0 0 1.25") if np.allclose(line[:, 2], -1.0, atol=1e-9)]
    assert len(rim) == 1 and np.allclose(np.hypot(rim[0][:, 0], rim[0][:, 1]), 0.75, atol=1e-12)
    upright = outlines("zcylinder 1.25")  # its circles leave the box at y = 0.75
    assert min(abs(abs(line[0, 1]) - 0.75) for line in upright) < 1e-9
    # a face along the axis meets a cone in two straight lines, another one in a branch of a hyperbola
    half = outlines("cone z 0 0 0 1 -1 1", "plane 0 0 0 0 1 0", x=GRAINS + np.array([0.0, 0.5, 0.0]))
    straight = [line for line in half if np.allclose(line[:, 1], 0.0, atol=1e-9) and np.ptp(line[:, 2]) > 1.9]
    assert {int(np.sign(line[len(line) // 2, 0])) for line in straight} >= {-1, 1}
    cut = np.concatenate(outlines("cone z 0 0 0 1 -1 1", "plane 0 0.5 0 0 -1 0"))
    on_cone = np.abs(np.hypot(cut[:, 0], cut[:, 1]) - 0.5 * (cut[:, 2] + 1.0)) < 1e-12
    branch = cut[on_cone & (np.abs(cut[:, 1] - 0.5) < 1e-9)]
    assert branch[np.argmin(branch[:, 2])] == pytest.approx([0.0, 0.5, 0.0], abs=2e-3)


def test_walls_that_hold_the_grains_end_the_others():
    lone = outlines("zplane -0.5 NULL")
    assert len(lone) == 4  # the rectangle in the box
    lines = outlines("zplane -0.5 NULL", "zcylinder 0.8")
    points = np.concatenate(lines)
    assert np.all(points[:, 2] > -0.5 - 1e-9) and np.all(np.hypot(points[:, 0], points[:, 1]) < 0.8 + 1e-9)
    assert sum(bool(np.allclose(line[:, 2], -0.5, atol=1e-9)) for line in lines) == 1  # the foot of the cylinder
    # an obstacle among the grains ends nothing
    around = np.array([[0.9, 0.0, 0.0], [-0.9, 0.0, 0.0], [0.0, 0.9, 0.0]])
    assert len(outlines("zplane 0 NULL", "sphere 0 0 0 0.3", x=around)) > 5


def test_lines_in_common_are_drawn_once():
    block = outlines("block -0.5 0.5 -0.5 0.5 -0.5 0.5")
    assert len(block) == 12
    planes = outlines("xplane -0.5 0.5", "yplane -0.5 0.5", "zplane -0.5 0.5")
    assert len(planes) == 12
    assert len(outlines("block -1 1 -1 1 -1 1")) == 12  # the box itself


def cube_mesh(half: float) -> np.ndarray:
    """Twelve triangles of a cube, wound outwards."""
    faces = []
    for axis in range(3):
        for side in (-1.0, 1.0):
            u, v = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
            square = [side * np.eye(3)[axis] + a * u + b * v for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            square = square if side > 0 else square[::-1]
            faces += [[square[0], square[1], square[2]], [square[0], square[2], square[3]]]
    return half * np.array(faces)


@pytest.mark.parametrize("turned", [False, True])
def test_mesh_is_drawn_by_its_sharp_edges(turned):
    triangles = cube_mesh(0.5)
    if turned:
        triangles[::2] = triangles[::2, ::-1]  # wound against their neighbours
    lines = compute_wall_outlines([Mesh(triangles)], GRAINS, BOX, EYE)
    assert len(lines) == 12  # and no diagonal
    assert all(np.linalg.norm(line[-1] - line[0]) == pytest.approx(1.0) for line in lines)


def test_mesh_is_cut_to_the_box_and_shows_where():
    lines = compute_wall_outlines([Mesh(cube_mesh(0.5))], GRAINS, np.array([[-1, 1], [-1, 1], [-1, 0.25]]), EYE)
    points = np.concatenate(lines)
    assert points[:, 2].max() == pytest.approx(0.25, abs=1e-9)
    assert np.all(np.abs(np.abs(points).max(axis=1) - 0.5) < 1e-12)
    rim = [line for line in lines if np.allclose(line[:, 2], 0.25, atol=1e-9)]
    assert sum(np.linalg.norm(line[-1] - line[0]) for line in rim) == pytest.approx(4.0)


def smooth_mesh() -> np.ndarray:
    """The lower half of a sphere of radius 0.8, of 48 x 12 patches, whose edges are all blunt."""
    around, down = np.meshgrid(2 * np.pi * np.arange(49) / 48, np.pi / 2 * np.arange(13) / 12, indexing="ij")
    place = 0.8 * np.stack([np.sin(down) * np.cos(around), np.sin(down) * np.sin(around), -np.cos(down)], axis=-1)
    a, b, c, d = place[:-1, :-1], place[1:, :-1], place[1:, 1:], place[:-1, 1:]
    return np.concatenate([np.stack([a, b, c], 2).reshape(-1, 3, 3), np.stack([a, c, d], 2).reshape(-1, 3, 3)])


def test_smooth_mesh_is_drawn_by_its_rim_and_its_silhouette():
    lines = compute_wall_outlines([Mesh(smooth_mesh())], GRAINS, BOX, EYE)
    rim = [line for line in lines if np.allclose(line[:, 2], 0.0, atol=1e-9)]
    assert len(rim) == 48
    rest = np.array([line.mean(axis=0) for line in lines if line[:, 2].min() < -1e-9])
    assert 10 < len(rest) < 120  # of 1776 edges
    toward = EYE - rest
    # a facet has 7.5 degrees, so the silhouette's edges are that near to where the ray touches
    cosine = np.einsum("nc,nc->n", rest, toward) / np.linalg.norm(rest, axis=1) / np.linalg.norm(toward, axis=1)
    assert np.abs(np.degrees(np.arcsin(cosine))).max() < 10.0


def test_shown_box_ends_above_the_bed_unless_a_wall_closes_in_it():
    radius = np.full(3, 0.1)
    high = np.array([[-1.0, 1.0], [-1.0, 1.0], [-1.0, 9.0]])

    def top(wall, whole=False):
        return compute_bounds_with_walls(read_walls([wall.split()]), GRAINS, radius, high, whole)[2, 1]

    assert top("zcylinder 1") == pytest.approx(0.0 + 0.06 * 0.4)  # the bed goes from -0.4 to 0
    assert top("zcylinder 1", whole=True) == 9.0
    assert top("ycylinder 1") == 1.0 and top("sphere 0 0 1 1.5") == 2.5
    assert top("cone z 0 0 0.1 1 0 5") == 5.0 and top("cone x 0 0 0.5 1 -1 1") == 1.0
    assert top("sphere 0 0 0 100") == top("block INF INF INF INF INF 20") == top("zcylinder 1")


@pytest.mark.parametrize(
    ("wall", "message"),
    [
        ("wedge 1 2", "unknown wall 'wedge': choose one of plane, xplane"),
        ("plane 0 0 0 0 0", "wall plane: too few words; its form is: plane x y z nx ny nz"),
        ("plane 0 0 0 0 0 0", "the direction 0 0 0 is none"),
        ("sphere 0 0 zero 1", "'zero' is not a finite number"),
        ("sphere 0 0 nan 1", "'nan' is not a finite number"),
        ("sphere 0 0 0 -1", "the radius -1 must be > 0"),
        ("zcylinder 1 2", "'2' is too much"),
        ("cylinder q 0 0 1 0 1", "'q' is not a finite number"),
        ("cylinder z 0 0 1 1 0", "lo = 1 must be below hi = 0"),
        ("cone w 0 0 1 2 0 1", "the axis 'w' must be x, y or z"),
        ("cone z 0 0 -1 2 0 1", "the radius -1 must be >= 0"),
        ("cone z 0 0 0 0 0 1", "both radii are 0"),
        ("cone z 0 0 1 2 1 1", "lo = 1 must be below hi = 1"),
        ("block 0 1 0 1 2 1", "lo = 2 must be below hi = 1"),
        ("zplane NULL NULL", "both sides are NULL"),
    ],
)
def test_wrong_walls_are_told(wall, message):
    with pytest.raises(ValueError, match="wall") as told:
        read_walls([wall.split()])
    assert message in str(told.value)


def test_every_kind_of_wall_is_tried():
    tried = {wall.split()[0] for wall in SURFACES} | {"mesh"}
    assert {kind.lstrip("xyz") for kind in KINDS} == {kind.lstrip("xyz") for kind in tried}


def draw(folder: Path, dump: Path, *words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(SCRIPT), str(dump), "--size", "160", "-o", str(folder / "bed.png"), *words]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.fixture
def heap(write_dump):
    random = np.random.default_rng(3)
    x = random.uniform(-0.4, 0.4, (40, 3)) * [1.0, 1.0, 0.5] + [0.0, 0.0, -0.3]
    return write_dump({"x": x, "radius": np.full(40, 0.1)}, bounds=BOX)


def test_script_draws_walls(heap, tmp_path):
    floor = ["--wall", "zplane", "-0.6", "NULL"]
    done = draw(tmp_path, heap, *floor, "--wall", "cylinder", "0", "0", "-1e-2", "0", "0", "1", "0.9")
    assert done.returncode == 0, done.stderr
    pixels = matplotlib.image.imread(tmp_path / "bed.png")
    assert pixels[..., :3].std() > 0.02
    assert draw(tmp_path, heap).returncode == 0
    assert matplotlib.image.imread(tmp_path / "bed.png").shape != pixels.shape  # the box, not the walls


def test_script_error_of_a_wall_is_one_message(heap, tmp_path):
    for words, message in (
        (["wedge"], "unknown wall 'wedge'"),
        (["mesh", "no.stl"], "'no.stl': there is no such"),
        (["sphere", "9", "9", "9", "2"], "no line of the walls lies in the box from (-1 -1 -1)"),
    ):
        done = draw(tmp_path, heap, "--wall", *words)
        assert done.returncode == 2 and message in done.stderr and "Traceback" not in done.stderr
