# SPDX-License-Identifier: GPL-2.0-or-later
"""Triangles of an STL file, binary or text."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]
_HEADER = 84  # bytes of a binary file ahead of its triangles, the last four their number
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def read_stl(path: str | Path) -> Array:
    """Read the triangles of an STL file.

    A file is binary if its length is what its count of triangles says, whatever its first word is.

    Parameters
    ----------
    path : str or Path
        STL file.

    Returns
    -------
    triangles : ndarray, (n, 3, 3), float64
        Corners, in the unit of the file.

    Raises
    ------
    FileNotFoundError
        There is no such file.
    ValueError
        The file is no STL file, is cut short, has no triangles or has numbers that are not finite.
    """
    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(f"'{path}': there is no such file")
    data = path.read_bytes()
    count = int.from_bytes(data[_HEADER - 4 : _HEADER], "little")
    if len(data) >= _HEADER and len(data) == _HEADER + count * _TRIANGLE.itemsize:
        triangles: Array = np.frombuffer(data, _TRIANGLE, count, _HEADER)["corners"].astype(np.float64)
    elif data.lstrip()[:5].lower() == b"solid":
        triangles = _read_text(path, data.decode("ascii", errors="replace"))
    else:
        raise ValueError(
            f"'{path}' is no STL file: it does not begin with 'solid', and its {len(data)} bytes are not those of a"
            f" binary file of {count} triangles ({_HEADER + count * _TRIANGLE.itemsize})"
        )
    if len(triangles) == 0:
        raise ValueError(f"'{path}' has no triangles")
    if not np.isfinite(triangles).all():
        raise ValueError(f"'{path}' has corners that are not finite numbers")
    return triangles


def _read_text(path: Path, text: str) -> Array:
    """Corners that follow the word vertex, three to a triangle."""
    lines = [(number, line.split()) for number, line in enumerate(text.splitlines(), 1)]
    corners = []
    for number, words in lines:
        if words and words[0].lower() == "vertex":
            try:
                x, y, z = (float(word) for word in words[1:])
            except ValueError:
                raise ValueError(f"'{path}', line {number}: 'vertex' needs three numbers") from None
            corners.append((x, y, z))
    loops = sum(words[:1] != [] and words[0].lower() == "endloop" for _, words in lines)
    if len(corners) != 3 * loops:
        raise ValueError(
            f"'{path}' has {len(corners)} corners in {loops} loops that end: three belong to each. Is it cut short?"
        )
    return np.array(corners, dtype=np.float64).reshape(-1, 3, 3)
