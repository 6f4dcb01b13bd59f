# SPDX-License-Identifier: GPL-2.0-or-later
"""Delassus matrices from lever arms, by one dense Jacobian of all contacts."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SPHERE, DISC = 2 / 5, 1 / 2  # moments of inertia, in m r^2


def tangents(normal: Any, dim: int) -> Array:
    """Return the tangents (n, dim - 1, 3): (-n_y, n_x, 0) in the plane, in space any t1 and t2 = n x t1."""
    n = np.asarray(normal, dtype=float)
    if dim == 2:
        return np.column_stack([-n[:, 1], n[:, 0], 0 * n[:, 0]])[:, None]
    t1 = np.cross(n, np.eye(3)[np.abs(n).argmin(axis=1)])
    t1 /= np.linalg.norm(t1, axis=1)[:, None]
    return np.stack([t1, np.cross(n, t1)], axis=1)


def jacobian(body_i: Any, body_j: Any, normal: Any, tangent: Any, radius: Any) -> Array:
    """Return G (n d, 6 m), which takes (v, omega) of each of m bodies to the contact points' relative velocities.

    Rows contact by contact: N, T1[, T2]; j may be -1, a body that does not move. They touch at x_i - r_i n.
    """
    normal, radius = np.asarray(normal, dtype=float), np.asarray(radius, dtype=float)
    axes = np.concatenate([normal[:, None], tangent], axis=1)
    n, d, _ = axes.shape
    g = np.zeros((n, d, len(radius), 6))
    rows = np.arange(n)
    for body, sign in ((np.asarray(body_i), 1.0), (np.asarray(body_j), -1.0)):
        moves = body >= 0
        k, b = rows[moves], body[moves]
        arm = -sign * radius[b, None, None] * normal[k, None]
        g[k, :, b, :3] = sign * axes[k]
        g[k, :, b, 3:] = sign * np.cross(arm, axes[k])  # e.(omega x arm) = omega.(arm x e)
    return g.reshape(n * d, -1)


def inverse_masses(mass: Any, radius: Any, kappa: float = SPHERE) -> Array:
    """Return the diagonal of M^-1 for (v, omega) of each body, (6 m,); I = kappa m r^2."""
    mass, radius = np.asarray(mass, dtype=float), np.asarray(radius, dtype=float)
    return np.column_stack([1 / mass] * 3 + [1 / (kappa * mass * radius**2)] * 3).ravel()


def near_pairs(x: Any, radius: Any, reach: float) -> tuple[Array, Array, Array]:
    """Return body_i, body_j and normals of the spheres whose gap is below the reach, m."""
    x, radius = np.asarray(x, dtype=float), np.asarray(radius, dtype=float)
    i, j = np.tril_indices(len(x), -1)
    apart = x[i] - x[j]
    distance = np.linalg.norm(apart, axis=1)
    near = distance < radius[i] + radius[j] + reach
    return i[near], j[near], apart[near] / distance[near, None]
