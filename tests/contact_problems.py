"""Contact problems without LAMMPS: random couplings, heaps of spheres, and references for them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import contact_matrices
import coulomb
import numpy as np
from numpy.typing import NDArray

from nscd_lmp import ContactProblem

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Bodies:
    """W = G G^T, q = G v: contacts on degrees of freedom that have mass 1, so that a solution exists for every rank."""

    g: Array
    v: Array
    dim: int

    @property
    def w(self) -> Array:
        return self.g @ self.g.T

    @property
    def q(self) -> Array:
        return self.g @ self.v

    def problem(self, mu: Any = None) -> ContactProblem:
        return ContactProblem(self.w, self.q, mu, self.dim)


def bodies(n: int, dim: int, freedoms: int, seed: int) -> Bodies:
    """Return dense random couplings; freedoms < n dim makes W rank-deficient."""
    random = np.random.default_rng(seed)
    g = random.normal(size=(n * dim, freedoms)) / np.sqrt(freedoms)
    return Bodies(g, random.normal(size=freedoms), dim)


class AnyBlock(coulomb.Problem):
    """The reference's problem, with one scale for both tangents: its projections onto a disc need that."""

    def diagonal(self) -> Array:
        diagonal = super().diagonal().copy()
        diagonal[:, 1:] = diagonal[:, 1:].max(axis=1, keepdims=True)
        return diagonal


def reference(w: Any, q: Any, mu: Any, dim: int) -> tuple[AnyBlock, Array]:
    """Return the problem as the reference sees it and its impulses."""
    plain = coulomb.problem(w, q, mu, dim)
    given = AnyBlock(plain.w, plain.q, plain.mu)
    for accuracy in (1e-8, 1e-10, 1e-12):
        p = coulomb.polish(given, coulomb.split(given, accuracy))
        if p is not None:
            return given, p
    raise ArithmeticError("no solution found")


def heap(dim: int, random: np.random.Generator) -> dict[str, Any]:
    """Return arrays of spheres or discs in a box, some on a floor, contacts with the floor given from both sides."""
    x = random.uniform(0, 3.2, (14, 3))
    if dim == 2:
        x[:, 2] = 0
    i, j, normal = contact_matrices.near_pairs(x, np.full(14, 0.5), 0.2)
    low = np.flatnonzero(x[:, 1] < 1.0)
    up = np.tile([0.0, 1.0, 0.0], (len(low), 1))
    half = len(low) // 2
    arrays: dict[str, Any] = {
        "body_i": np.concatenate([i, low[:half], np.full(len(low) - half, -1)]),
        "body_j": np.concatenate([j, np.full(half, -1), low[half:]]),
        "inverse_mass": random.uniform(0.5, 2.0, 14),
        "normal": np.concatenate([normal, up[:half], -up[half:]]),
    }
    n = len(arrays["body_i"])
    arrays["velocity"] = random.normal(size=n)
    if dim > 1:
        arrays |= {"friction": random.choice([0.0, 0.2, 0.4], n), "spin_response": 2.5 if dim == 3 else 2.0}
        arrays |= {
            "tangents": contact_matrices.tangents(arrays["normal"], dim),
            "slip": random.normal(size=(n, dim - 1)),
        }
    return arrays


def assembled(arrays: dict[str, Any]) -> Array:
    """Return W of the heap by another route: lever arms and a dense Jacobian."""
    n, radius = len(arrays["velocity"]), np.full(14, 0.5)
    first, second, normal = (arrays[name].copy() for name in ("body_i", "body_j", "normal"))
    tangent = np.array(arrays.get("tangents", np.zeros((n, 0, 3))))
    turned = first < 0  # that route wants the grain first
    first[turned], second[turned] = second[turned], -1
    normal[turned] *= -1
    tangent[turned] *= -1
    g = contact_matrices.jacobian(first, second, normal, tangent, radius)
    kappa = 1 / arrays.get("spin_response", 2.5)
    return (g * contact_matrices.inverse_masses(1 / arrays["inverse_mass"], radius, kappa)) @ g.T
