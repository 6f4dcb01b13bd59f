# SPDX-License-Identifier: GPL-2.0-or-later
"""The analysis scripts on the import path, and a writer of dump files."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

ANALYSIS = Path(__file__).resolve().parents[2] / "analysis"
sys.path.insert(0, str(ANALYSIS))


def _frame_text(step: int, columns: dict[str, Any], bounds: Any, boundary: str, number: str) -> str:
    count = len(next(iter(columns.values())))
    lines = ["ITEM: TIMESTEP", str(step), "ITEM: NUMBER OF ATOMS", str(count)]
    lines.append(f"ITEM: BOX BOUNDS {boundary}")
    lines += [f"{low:.16e} {high:.16e}" for low, high in bounds]
    lines.append("ITEM: ATOMS id type " + " ".join(columns))
    for k in range(count):
        lines.append(f"{k + 1} 1 " + " ".join(number % values[k] for values in columns.values()))
    return "\n".join(lines) + "\n"


@pytest.fixture
def write_dump(tmp_path: Path) -> Callable[..., Path]:
    """Write frames of a dump; each frame is a dict of columns, ``x`` may be an (n, 3) array."""

    def write(
        *frames: dict[str, Any],
        bounds: Any = ((0, 1), (0, 1), (0, 1)),
        boundary: str = "ff ff ff",
        steps: Any = None,
        number: str = "%.17g",
        name: str = "bed.dump",
    ) -> Path:
        text = ""
        for k, frame in enumerate(frames):
            columns: dict[str, Any] = {}
            for key, values in frame.items():
                array = np.asarray(values, dtype=float)
                if array.ndim == 2:
                    names = {"x": "x y z", "v": "vx vy vz", "omega": "omegax omegay omegaz"}[key]
                    columns.update(zip(names.split(), array.T, strict=True))
                else:
                    columns[key] = array
            step = k if steps is None else steps[k]
            text += _frame_text(step, columns, bounds, boundary, number)
        path = tmp_path / name
        path.write_text(text)
        return path

    return write


@pytest.fixture
def simple_cubic() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """4 x 4 x 4 touching balls of 1 mm radius in a periodic box away from the origin."""
    cells = np.stack(np.meshgrid(*[np.arange(4)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    low = np.array([-3e-3, 2e-3, 10e-3])
    bounds = np.column_stack([low, low + 8e-3])
    return low + 2e-3 * cells + 0.3e-3, np.full(64, 1e-3), bounds


@pytest.fixture
def face_centred_cubic() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """3 x 3 x 3 cubes of 4 touching unit balls in a periodic box."""
    side = 2.0 * np.sqrt(2.0)
    cells = np.stack(np.meshgrid(*[np.arange(3)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    basis = np.array([[0, 0, 0], [0.5, 0.5, 0], [0.5, 0, 0.5], [0, 0.5, 0.5]])
    x = side * (cells[:, None, :] + basis).reshape(-1, 3)
    return x, np.ones(len(x)), np.array([[0.0, 3 * side]] * 3)
