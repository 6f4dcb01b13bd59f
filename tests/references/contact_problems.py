# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact problems without LAMMPS: random couplings, piles of spheres, and references for them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import contact_matrices
import coulomb
import numpy as np
from numpy.typing import NDArray
from scipy import optimize

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


@dataclass(frozen=True)
class Pile:
    """Spheres without friction: contacts (n,), body_j is -1 at an obstacle; inverse_mass (m,) may be 0; v (m, 3)."""

    body_i: NDArray[np.int64]
    body_j: NDArray[np.int64]
    normal: Array
    inverse_mass: Array
    v: Array

    def doors(self) -> dict[str, ContactProblem]:
        """Return the problem in the two ways to pose it."""
        matrix = self.bodies().problem()
        spheres = ContactProblem.from_spheres(self.body_i, self.body_j, self.inverse_mass, self.normal, matrix.q)
        return {"spheres": spheres, "matrix": matrix}

    def bodies(self) -> Bodies:
        """Return the problem on degrees of freedom of mass 1: G = H^T M^-1/2 and M^1/2 v."""
        root = np.sqrt(self.inverse_mass)
        n, moves = len(self.body_i), root > 0
        g = np.zeros((n, len(root), 3))
        g[np.arange(n), self.body_i] = self.normal * root[self.body_i, None]
        pair = np.flatnonzero(self.body_j >= 0)
        g[pair, self.body_j[pair]] -= self.normal[pair] * root[self.body_j[pair], None]
        v = np.zeros_like(self.v)
        v[moves] = self.v[moves] / root[moves, None]
        return Bodies(g.reshape(n, -1), v.ravel(), 1)

    def doubled(self) -> Pile:
        """Return the pile with every contact twice."""
        twice = (np.repeat(each, 2, axis=0) for each in (self.body_i, self.body_j, self.normal))
        return Pile(*twice, self.inverse_mass, self.v)

    def with_rows_of_zeros(self) -> Pile:
        """Return the pile with contacts that no impulse can move in front, in the middle and at the end."""
        still = len(self.inverse_mass)
        places = np.array([0, len(self.body_i) // 2, len(self.body_i)])
        return Pile(
            np.insert(self.body_i, places, still),
            np.insert(self.body_j, places, -1),
            np.insert(self.normal, places, [0.0, 0.0, 1.0], axis=0),
            np.append(self.inverse_mass, 0.0),
            np.vstack([self.v, np.zeros(3)]),
        )


def pile_of(x: Array, mass: Array, v: Array, reach: tuple[float, float], height: float) -> Pile:
    """Return spheres of radius 0.5 m in the corner of a floor and two walls, under a lid at the height.

    Contacts are wherever gaps are below the reach, of pairs and with walls.
    """
    i, j, normal = contact_matrices.near_pairs(x, np.full(len(x), 0.5), reach[0])
    sides = [(x[:, axis], np.eye(3)[axis]) for axis in range(3)] + [(height - x[:, 2], np.array([0.0, 0.0, -1.0]))]
    walls = [(np.flatnonzero(distance < 0.5 + reach[1]), inward) for distance, inward in sides]
    return Pile(
        np.concatenate([i, *(touching for touching, _ in walls)]),
        np.concatenate([j, np.full(sum(len(touching) for touching, _ in walls), -1)]),
        np.concatenate([normal, *(np.tile(inward, (len(touching), 1)) for touching, inward in walls)]),
        1 / mass,
        v,
    )


def random_bed(count: int, seed: int, shaken: bool) -> Pile:
    """Return spheres at random, which push each other with 1 m/s, or fall for a step under gravity."""
    random = np.random.default_rng(seed)
    x = 0.5 + random.uniform(0, 0.9 * count ** (1 / 3), (count, 3))
    fall = np.tile([0.0, 0.0, -1e-2], (count, 1))
    v = random.normal(size=(count, 3)) if shaken else fall
    return pile_of(x, random.uniform(0.5, 2.0, count), v, (0.05, 0.5), np.inf)


def lattice(side: int, seed: int) -> Pile:
    """Return a cubic lattice of spheres of unequal masses between floor, lid and two walls: hyperstatic."""
    random = np.random.default_rng(seed)
    x = 0.5 + np.stack(np.meshgrid(*[np.arange(float(side))] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    v = random.normal(size=x.shape)
    return pile_of(x, random.uniform(0.5, 5.0, len(x)), v, (1e-9, 1e-9), float(side))


def column(masses: Any, speed: float = 1e-2) -> Pile:
    """Return spheres on top of each other that fall at one speed, the lowest first: p_k = speed sum_{l >= k} m_l."""
    masses = np.asarray(masses, dtype=float)
    n = len(masses)
    up = np.tile([0.0, 0.0, 1.0], (n, 1))
    return Pile(np.arange(n), np.arange(n) - 1, up, 1 / masses, -speed * up)


@dataclass(frozen=True)
class Answer:
    """What `nearest` found: impulses, velocities, and how far others may be off."""

    p: Array
    u: Array
    growth: float  # a solver that leaves velocities e on shut contacts leaves G_open G_shut^+ e on the others: its norm
    round_off: float  # of W p + q, as a share of |q|


def nearest(given: Bodies) -> Answer:
    """Return the solution of the quadratic program by non-negative least squares, without W; check its optimality.

    u = G r, r = G^T p + v, where p >= 0 makes |r| smallest. The impulses are scaled to unit rows of G for that, and
    found again with least squares on the contacts that push, so that only round-off is left.
    """
    size = np.linalg.norm(given.g, axis=1)
    size[size == 0] = 1
    g = given.g / size[:, None]
    y, _ = optimize.nnls(g.T, -given.v, maxiter=100 * len(g))
    shut = y > 0
    y[shut] = np.linalg.lstsq(g[shut].T, -given.v, rcond=1e-13)[0]
    r = g.T @ y + given.v
    cancelling = np.maximum(np.abs(given.v), np.abs(g.T) @ np.abs(y)).max()
    assert y.min(initial=0) >= -1e-12 * y.max(initial=0)
    assert (g @ r).min(initial=0) >= -1e-14 * cancelling
    assert np.abs(g[shut] @ r).max(initial=0) <= 1e-14 * cancelling
    growth = given.g[~shut] @ np.linalg.pinv(given.g[shut], rcond=1e-13)
    sizes = np.abs(given.w) @ np.abs(y / size) + np.abs(given.q)
    return Answer(
        y / size,
        given.g @ r,
        float(np.linalg.norm(growth, 2)) if growth.size else 0.0,
        float(np.finfo(float).eps * np.linalg.norm(sizes) / np.linalg.norm(given.q)),
    )


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
