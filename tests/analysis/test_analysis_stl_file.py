# SPDX-License-Identifier: GPL-2.0-or-later
"""STL files, binary and text, and what is said of damaged ones."""

from __future__ import annotations

import numpy as np
import pytest
from stl_file import read_stl

TRIANGLES = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 1, 0], [0, 0, 1.5]]])


def text(triangles: np.ndarray) -> str:
    lines = ["solid part of two"]
    for corners in triangles:
        lines += ["facet normal 0 0 1", "  outer loop"]
        lines += [f"    vertex {x:e} {y:e} {z:e}" for x, y, z in corners]
        lines += ["  endloop", "endfacet"]
    return "\n".join([*lines, "endsolid part of two", ""])


def binary(triangles: np.ndarray, header: bytes = b"solid of a program that writes binary files") -> bytes:
    rows = [np.concatenate([np.zeros(3), corners.ravel()]).astype("<f4").tobytes() + b"\0\0" for corners in triangles]
    return header.ljust(80) + len(triangles).to_bytes(4, "little") + b"".join(rows)


@pytest.mark.parametrize("data", [text(TRIANGLES).encode(), text(TRIANGLES).upper().encode(), binary(TRIANGLES)])
def test_triangles_are_read(tmp_path, data):
    (tmp_path / "a.stl").write_bytes(data)
    assert np.array_equal(read_stl(tmp_path / "a.stl"), TRIANGLES)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "is no STL file"),
        (b"ply\nformat ascii", "is no STL file"),
        (binary(TRIANGLES, b"cut")[:-7], "is no STL file"),
        (b"solid empty\nendsolid empty\n", "has no triangles"),
        (text(TRIANGLES).rpartition("    vertex")[0].encode(), "5 corners in 1 loops that end"),
        (text(TRIANGLES).replace("1.500000e+00", "high").encode(), "line 13: 'vertex' needs three numbers"),
        (binary(TRIANGLES * np.nan), "not finite numbers"),
    ],
)
def test_damaged_files_are_named(tmp_path, data, message):
    path = tmp_path / "a.stl"
    path.write_bytes(data)
    with pytest.raises(ValueError, match=r"a\.stl") as told:
        read_stl(path)
    assert message in str(told.value)


def test_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"no\.stl"):
        read_stl(tmp_path / "no.stl")
