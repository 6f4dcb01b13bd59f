# SPDX-License-Identifier: GPL-2.0-or-later
"""Least x m x / 2 + c x over second-order cones |x_t| <= x_0, by a primal-dual interior point method.

Mehrotra's predictor and corrector in Nesterov & Todd's scaling: Vandenberghe (2010), The CVXOPT linear and quadratic
cone program solvers, sections 4 to 7. A step factorises m plus a block diagonal, so m may be singular.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import linalg

Array = NDArray[np.float64]


def norms(vectors: Array) -> Array:
    """Return the lengths of row vectors."""
    return np.sqrt((vectors**2).sum(axis=1))


def minimum(m: Array, c: Array, steps: int = 60) -> Array:
    """Return x (n, d), n cones of dimension d; m (n d, n d), c (n, d). It is right to about 1e-6 of the largest c."""
    shape, n = c.shape, len(c)
    if n == 0:
        return np.zeros(shape)
    size = max(1e-300, float(np.abs(c).max()))
    x, z = np.zeros(shape), np.zeros(shape)
    x[:, 0] = z[:, 0] = size
    for _ in range(steps):
        miss = (m @ x.ravel()).reshape(shape) + c - z
        gap = float((x * z).sum()) / n
        if gap <= 1e-12 * size**2 and np.abs(miss).max() <= 1e-9 * size:
            break
        if min((lorentz(x) / x[:, 0]).min(), (lorentz(z) / z[:, 0]).min()) < 1e-8:  # as far as round-off lets it go
            break
        scaling, back = nesterov_todd(x, z)
        try:
            factor = linalg.cho_factor(m + block_diagonal(scaling @ scaling), check_finite=False)
        except linalg.LinAlgError:
            break
        lam = apply(scaling, x)
        # predictor, then the corrector
        dx, dz = direction(m, factor, scaling, -lam, miss)
        reach = min(1.0, longest(x, dx), longest(z, dz))
        bend = product(apply(scaling, dx), apply(back, dz))
        bend[:, 0] -= gap * (1 - reach) ** 3
        dx, dz = direction(m, factor, scaling, -lam - quotient(lam, bend), miss)
        reach = min(1.0, 0.99 * longest(x, dx), 0.99 * longest(z, dz))
        if not reach > 1e-6:
            break
        x, z = x + reach * dx, z + reach * dz
    return x


def direction(m: Array, factor: Any, scaling: Array, right: Array, miss: Array) -> tuple[Array, Array]:
    """Return dx and dz with dz = m dx + miss and S dx + S^-1 dz = right."""
    dx = linalg.cho_solve(factor, (apply(scaling, right) - miss).ravel(), check_finite=False).reshape(right.shape)
    return dx, (m @ dx.ravel()).reshape(right.shape) + miss


def apply(matrices: Array, vectors: Array) -> Array:
    """Return the product of each matrix and vector."""
    return np.einsum("kij,kj->ki", matrices, vectors)


def lorentz(x: Array) -> Array:
    """Return sqrt(x_0^2 - |x_t|^2) of points inside the second-order cone."""
    length = norms(x[:, 1:])
    return np.sqrt(np.maximum((x[:, 0] - length) * (x[:, 0] + length), 1e-300))


def nesterov_todd(x: Array, z: Array) -> tuple[Array, Array]:
    """Return the symmetric S with S x = S^-1 z, and S^-1, (n, d, d) each."""
    unit_x, unit_z = x / lorentz(x)[:, None], z / lorentz(z)[:, None]
    mirrored = unit_z.copy()
    mirrored[:, 1:] *= -1
    w = unit_x + mirrored
    w /= lorentz(w)[:, None]
    beta = np.sqrt(lorentz(x) / lorentz(z))[:, None, None]
    out = []
    for sign, factor in ((-1, 1 / beta), (1, beta)):
        s = np.empty((*x.shape, x.shape[1]))
        s[:, 0, 0] = w[:, 0]
        s[:, 0, 1:] = s[:, 1:, 0] = sign * w[:, 1:]
        s[:, 1:, 1:] = np.eye(x.shape[1] - 1) + w[:, 1:, None] * w[:, None, 1:] / (1 + w[:, 0])[:, None, None]
        out.append(factor * s)
    return out[0], out[1]


def block_diagonal(matrices: Array) -> Array:
    """Return the dense matrix that has the matrices (n, d, d) on its diagonal."""
    n, d, _ = matrices.shape
    out = np.zeros((n, d, n, d))
    out[np.arange(n), :, np.arange(n), :] = matrices
    return out.reshape(n * d, n * d)


def product(x: Array, y: Array) -> Array:
    """Return the Jordan product of the second-order cone."""
    return np.column_stack([(x * y).sum(axis=1), x[:, :1] * y[:, 1:] + y[:, :1] * x[:, 1:]])


def quotient(x: Array, r: Array) -> Array:
    """Return the y whose Jordan product with x is r."""
    first = (x[:, 0] * r[:, 0] - (x[:, 1:] * r[:, 1:]).sum(axis=1)) / lorentz(x) ** 2
    return np.column_stack([first, (r[:, 1:] - first[:, None] * x[:, 1:]) / x[:, :1]])


def longest(x: Array, dx: Array) -> float:
    """Return the largest a with x + a dx in the cone."""
    size = lorentz(x)
    unit = x / size[:, None]
    along = unit[:, 0] * dx[:, 0] - (unit[:, 1:] * dx[:, 1:]).sum(axis=1)
    across = dx[:, 1:] - ((along + dx[:, 0]) / (unit[:, 0] + 1))[:, None] * unit[:, 1:]
    rate = ((norms(across) - along) / size).max()
    return 1 / rate if rate > 0 else np.inf
