# SPDX-License-Identifier: GPL-2.0-or-later
"""Converged answers that a chart's cases are compared with, computed once a chart and kept in its folder."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Arrays = dict[str, NDArray[np.float64]]


def kept(folder: Path, name: str, make: Callable[[], Arrays]) -> Arrays:
    """Return the arrays of ``NAME.npz`` beside a case's folder, made if they are not there.

    Cases that run side by side may both make it; they make the same.
    """
    path = folder.parent / f"{name}.npz"
    if not path.is_file():
        part = folder / f"{name}_{os.getpid()}.npz"
        np.savez(part, **make())  # type: ignore[arg-type]
        part.replace(path)
    with np.load(path) as file:
        return {key: file[key] for key in file}
