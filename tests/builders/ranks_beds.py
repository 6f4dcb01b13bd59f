# SPDX-License-Identifier: GPL-2.0-or-later
"""The grains that test_ranks.py starts from, made on one rank."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import ranks_scene
from numpy.typing import NDArray

WIDTH = 5.2e-3  # m; periodic, so more than two images of the largest grain's reach


def save(beds: Path, name: str, x: NDArray[np.float64], radius: NDArray[np.float64], **more: object) -> None:
    """Write a file as ranks_scene.start reads it."""
    n = len(x)
    box = (WIDTH, WIDTH, x[:, 2].max() + 4e-3)
    standard = {"box": box, "boundary": "p p f", "v": np.zeros((n, 3)), "type": np.ones(n)}
    np.savez(beds / f"{name}.npz", x=x, radius=radius, **(standard | more))


def cloud(layers: int, edge: int = 5) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return places and radii of grains near the points of a lattice, apart from each other."""
    random = np.random.default_rng(1)
    cell = WIDTH / edge
    corners = np.stack(np.meshgrid(range(edge), range(edge), range(layers), indexing="ij"), axis=-1).reshape(-1, 3)
    radius = random.uniform(0.5, 0.98, len(corners)) * ranks_scene.LARGEST
    room = (cell / 2 - radius)[:, None]
    return (corners + 0.5) * cell + random.uniform(-1, 1, corners.shape) * room, radius


def make(beds: Path) -> None:
    """Write all of them."""
    x, radius = cloud(layers=6)
    fall = np.array([0.0, 0.0, -0.3]) * (x[:, 2:] / x[:, 2].max())
    save(beds, "falling", x, radius, v=fall)
    settled = ranks_scene.run(beds, "falling", "script", steps=800, tol=1e-7)
    save(beds, "bed", settled["x"], radius, v=settled["v"])
    few = settled["x"][:, 2] < np.sort(settled["x"][:, 2])[40]
    save(beds, "small", settled["x"][few], radius[few])
    save(beds, "column", np.array([[1e-3, 1e-3, (2 * k + 1) * 0.4e-3] for k in range(12)]), np.full(12, 0.4e-3))
    height = settled["x"][:, 2]
    plate = height < np.quantile(height, 0.15)
    save(beds, "shear", settled["x"], radius, v=plate[:, None] * [0.1, 0.0, 0.0], type=1 + plate)
    # which contacts are impacts is a matter of thresholds: in a dense bed round-off moves grains by up to 1e-3 m/s
    save(beds, "gas", x, radius, v=np.random.default_rng(2).normal(size=x.shape) * 0.3)
