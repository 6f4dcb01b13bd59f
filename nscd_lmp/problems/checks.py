# SPDX-License-Identifier: GPL-2.0-or-later
"""What a contact problem must fulfil before the compiled core sees it; every check is one pass over arrays.

scipy is imported where it is used: it would double the time that `import nscd_lmp` takes.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nscd_lmp._core import NscdError

Floats = NDArray[np.float64]

LARGEST_ASYMMETRY = 0.05  # of sqrt(W_ii W_jj)
SPEEDS = 1e-130, 1e130  # m/s, whose squares a double holds, and those of what impulses do
LARGEST_FRICTION = 1e6  # mu^2 must leave room beside 1 in a double
UNIT_LENGTH = 1e-6
CHUNK = 1 << 18  # blocks that are compared with their mirror images at a time

ROWS = {1: "one row", 2: "rows N, T1", 3: "rows N, T1, T2"}


@dataclass(frozen=True)
class BlockRows:
    """W by block rows: the blocks row_start[k] to row_start[k + 1] stand in block row k, sorted by column.

    row_start (n + 1,) int64, column (b,) int32, block (b, d, d) float64.
    """

    row_start: NDArray[np.int64]
    column: NDArray[np.int32]
    block: Floats

    def __len__(self) -> int:
        """Return the number of block rows."""
        return len(self.row_start) - 1

    def rows(self) -> NDArray[np.int64]:
        """Return the block row of every block."""
        return np.repeat(np.arange(len(self)), np.diff(self.row_start))

    def diagonal_blocks(self) -> Floats:
        """Return the blocks on the diagonal, (n, d, d), 0 where none is stored."""
        found = np.zeros((len(self), *self.block.shape[1:]))
        rows = self.rows()
        own = rows == self.column
        found[rows[own]] = self.block[own]
        return found

    def matrix(self) -> Any:
        """Return a copy as scipy.sparse.bsr_array."""
        from scipy import sparse

        size = len(self) * self.block.shape[1]
        return sparse.bsr_array((self.block.copy(), self.column.copy(), self.row_start.copy()), shape=(size, size))


def others(bad: NDArray[np.bool_]) -> str:
    """Return how many there are besides the one that a message names."""
    count = int(np.count_nonzero(bad)) - 1
    return f" ({count} more like it)" if count > 0 else ""


def floats(name: str, values: ArrayLike) -> Floats:
    """Return the values as a C-contiguous float64 array of finite numbers."""
    try:
        array = np.array(values, dtype=np.float64, order="C")
    except (TypeError, ValueError) as error:
        raise NscdError(f"{name} must be an array of real numbers: {error}") from error
    bad = ~np.isfinite(array)
    if bad.any():
        place = np.argwhere(bad)[0]
        raise NscdError(f"{name}[{', '.join(map(str, place))}] = {array[tuple(place)]} must be finite{others(bad)}")
    return array


def block_rows(matrix: Any, dim: int) -> BlockRows:
    """Return W, sparse or dense, by block rows of finite numbers; W itself is left alone."""
    from scipy import sparse

    if not sparse.issparse(matrix):
        matrix = np.asarray(matrix)
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1]:
        raise NscdError(f"W has the shape {matrix.shape} and must be square: (n dim, n dim) for n contacts")
    if matrix.shape[0] % dim:
        raise NscdError(f"W has {matrix.shape[0]} rows, not a multiple of dim = {dim}: a contact has {ROWS[dim]}")
    if matrix.dtype.kind not in "biuf":
        raise NscdError(f"W has the type {matrix.dtype} and must hold real numbers")
    if not (sparse.issparse(matrix) and matrix.format == "bsr" and matrix.blocksize == (dim, dim)):
        matrix = sparse.csr_array(matrix, dtype=np.float64)
        matrix = matrix.tobsr(blocksize=(dim, dim))
    matrix = sparse.bsr_array(matrix, dtype=np.float64, copy=True)
    matrix.sort_indices()
    matrix.sum_duplicates()
    blocks = BlockRows(
        matrix.indptr.astype(np.int64), matrix.indices.astype(np.int32), np.ascontiguousarray(matrix.data)
    )
    bad = ~np.isfinite(blocks.block)
    if bad.any():
        at, i, j = np.argwhere(bad)[0]
        row, column = blocks.rows()[at], blocks.column[at]
        raise NscdError(
            f"W[{row * dim + i}, {column * dim + j}] = {blocks.block[at, i, j]} (contacts {row} and {column}) must be"
            f" finite{others(bad)}"
        )
    return blocks


def check_matrix(blocks: BlockRows) -> None:
    """Refuse what no Delassus matrix has: negative diagonals, entries beyond sqrt(W_ii W_jj), asymmetry."""
    diagonal = np.einsum("kii->ki", blocks.diagonal_blocks())
    bad = diagonal < 0
    if bad.any():
        k, i = np.argwhere(bad)[0]
        raise NscdError(
            f"contact {k}: W[{k * diagonal.shape[1] + i}, {k * diagonal.shape[1] + i}] = {diagonal[k, i]:.6g} must be"
            f" >= 0, as W is positive semidefinite, u = W p + q: check its sign{others(bad)}"
        )
    rows, scale = blocks.rows(), np.sqrt(diagonal)
    key = rows * len(blocks) + blocks.column  # ascending
    for start in range(0, len(key), CHUNK):
        part = slice(start, start + CHUNK)
        row, column = rows[part], blocks.column[part].astype(np.int64)
        mirror = np.searchsorted(key, column * len(blocks) + row)
        mirror[mirror == len(key)] = 0
        there = key[mirror] == column * len(blocks) + row
        here, across = blocks.block[part], blocks.block[mirror].swapaxes(1, 2) * there[:, None, None]
        limit = scale[row][:, :, None] * scale[column][:, None, :]
        check_entries(here, across, limit, row, column)


def check_entries(here: Floats, across: Floats, limit: Floats, row: NDArray[Any], column: NDArray[Any]) -> None:
    """Refuse entries W_ij that are too large beside the diagonal, or too different from W_ji."""
    large = np.abs(here + across) > 2 * (1 + LARGEST_ASYMMETRY) * limit
    uneven = np.abs(here - across) > LARGEST_ASYMMETRY * limit
    bad = large | uneven
    if not bad.any():
        return
    at, i, j = np.argwhere(bad)[0]
    dim = here.shape[1]
    first, second = row[at] * dim + i, column[at] * dim + j
    whose = f"contact {row[at]}" if row[at] == column[at] else f"contacts {row[at]} and {column[at]}"
    entry = f"W[{first}, {second}] = {here[at, i, j]:.6g}"
    if limit[at, i, j] == 0:
        raise NscdError(
            f"{whose}: {entry} stands in a row or column whose diagonal is 0: W is positive semidefinite, so such a row"
            " must be 0 throughout"
        )
    if large[at, i, j]:
        raise NscdError(
            f"{whose}: {entry} is larger than sqrt(W_ii W_jj) = {limit[at, i, j]:.6g}: W is not positive semidefinite;"
            " check the order of its rows, contact by contact N, T1[, T2]"
        )
    raise NscdError(
        f"{whose}: {entry} and W[{second}, {first}] = {across[at, i, j]:.6g} differ by more than"
        f" {LARGEST_ASYMMETRY:.0%} of sqrt(W_ii W_jj) = {limit[at, i, j]:.6g}: W must be symmetric, up to what an"
        " integration scheme adds; if it holds one triangle alone, give W + W^T - diag(W)"
    )


def check_contacts(blocks: Floats, q: Floats, mu: Floats | None) -> None:
    """Refuse contacts whose own block (n, d, d) cannot do what q (n, d) and mu (n,) ask for."""
    check_movable(blocks[:, 0, 0], q[:, 0])
    if mu is None:
        return
    tangential = blocks[:, 1:, 1:]
    least = tangential[:, 0, 0]
    if tangential.shape[1] == 2:
        cross = 0.5 * (tangential[:, 0, 1] + tangential[:, 1, 0])
        mean, half = 0.5 * (least + tangential[:, 1, 1]), 0.5 * (least - tangential[:, 1, 1])
        # the smallest eigenvalue, less the round-off of a mean that is the radius
        least = mean * (1 - 1e-15) - np.hypot(half, cross)
    bad = (mu > 0) & (blocks[:, 0, 0] > 0) & ~(least > 0)
    if bad.any():
        k = int(np.argmax(bad))
        raise NscdError(
            f"contact {k} with mu = {mu[k]:.6g}: the smallest eigenvalue of its tangential block of W is"
            f" {max(least[k], 0.0) if least[k] > -1e-12 else least[k]:.6g} and must be > 0 for friction to act on;"
            f" give this contact mu = 0{others(bad)}"
        )


def check_speeds(q: Floats) -> None:
    """Refuse velocities whose squares a double cannot hold: residuals are measured by their norm."""
    largest = float(np.abs(q).max(initial=0.0))
    if largest and not SPEEDS[0] < largest < SPEEDS[1]:
        raise NscdError(
            f"the largest of q is {largest:.3g} m/s: it must be between {SPEEDS[0]:g} and {SPEEDS[1]:g}, or 0; choose"
            " another unit of velocity"
        )


def check_movable(w_nn: Floats, q_n: Floats) -> None:
    """Refuse contacts that penetrate and that no impulse can move."""
    bad = (w_nn == 0) & (q_n < 0)
    if bad.any():
        k = int(np.argmax(bad))
        raise NscdError(
            f"contact {k}: no impulse can move it, W_nn = 0, but q_n = {q_n[k]:.6g} m/s < 0: leave the contact out, or"
            f" give one of its bodies a finite mass{others(bad)}"
        )


def coefficients(mu: ArrayLike | None, contacts: int, dim: int) -> Floats | None:
    """Return Coulomb's coefficients (n,), None in dim 1."""
    if mu is None:
        if dim > 1:
            raise NscdError(f"mu is missing, which dim = {dim} needs: give Coulomb's coefficient, 0 for none")
        return None
    try:
        array = np.array(mu, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise NscdError(f"mu must be a number or an array of them: {error}") from error
    if array.shape not in ((), (contacts,)):
        raise NscdError(f"mu has the shape {array.shape} and must be a number or an array of shape ({contacts},)")
    array = np.array(np.broadcast_to(array, contacts))
    bad = ~((array >= 0) & ((array <= LARGEST_FRICTION) | np.isinf(array)))
    if bad.any():
        k = int(np.argmax(bad))
        raise NscdError(
            f"contact {k}: mu = {array[k]:.6g} must be from 0 to {LARGEST_FRICTION:.0e}, or infinite for a contact that"
            f" does not slip{others(bad)}"
        )
    if dim > 1:
        return array
    if array.any():
        raise NscdError(
            f"mu = {array.max():.6g} with dim = 1, which has no tangents: give dim = 2 or 3, and W, q with their rows"
        )
    return None


def check_frames(normal: Floats, tangents: Floats) -> None:
    """Refuse directions (n, 3) and (n, d - 1, 3) that are not unit vectors at right angles."""
    axes = np.concatenate([normal[:, None, :], tangents], axis=1)
    products = axes @ axes.swapaxes(1, 2)
    bad = (np.abs(products - np.eye(axes.shape[1])) > 2 * UNIT_LENGTH).any(axis=(1, 2))
    if bad.any():
        k = int(np.argmax(bad))
        raise NscdError(
            f"contact {k}: normal and tangents have the scalar products {products[k].round(6).tolist()} and must be"
            f" unit vectors at right angles, to {UNIT_LENGTH}{others(bad)}"
        )
    if axes.shape[1] == 2 and (flat := axes[:, :, 2] != 0).any():
        k = int(np.argmax(flat.any(axis=1)))
        raise NscdError(
            f"contact {k}: normal or tangent leaves the x-y plane, but one tangent means a planar scene: give two"
        )


def check_bodies(body_i: NDArray[np.int32], body_j: NDArray[np.int32], bodies: int) -> None:
    """Refuse indices that name no body, and contacts of a body with itself."""
    for name, body in (("body_i", body_i), ("body_j", body_j)):
        bad = (body < -1) | (body >= bodies)
        if bad.any():
            k = int(np.argmax(bad))
            raise NscdError(
                f"contact {k}: {name} = {body[k]} must be an index into the {bodies} inverse masses, or -1 for an"
                f" obstacle{others(bad)}"
            )
    bad = (body_i == body_j) & (body_i >= 0)
    if bad.any():
        k = int(np.argmax(bad))
        raise NscdError(f"contact {k}: body {body_i[k]} touches itself: body_i and body_j must differ{others(bad)}")
