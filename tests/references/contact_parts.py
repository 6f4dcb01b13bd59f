# SPDX-License-Identifier: GPL-2.0-or-later
"""Random contact problems whose contacts resist rolling, or whose bodies are no spheres, assembled from the mechanics.

All that `tests/core/parts` solves: its bodies and contacts as text, and the Delassus matrix W = G M^-1 G^T of them,
with rows along N, T1, T2 and, with rolling, R1, R2 of every contact, and, with twisting, the moment about N.
"""

from __future__ import annotations

from dataclasses import dataclass

import coulomb
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
KINDS = ("rolling_spheres", "rolling_discs", "rigid_bodies", "rolling_bodies", "twisting_spheres", "twisting_bodies")
TWISTING = ("twisting_spheres", "twisting_bodies")
ROLLING = ("rolling_spheres", "rolling_discs", "rolling_bodies", *TWISTING)
SPHERES = ("rolling_spheres", "rolling_discs", "twisting_spheres")
ARMS = ("rigid_bodies", "rolling_bodies", "twisting_bodies")


@dataclass
class Assembly:
    """Bodies (b,), the last one fixed, and contacts (n,) between two of them."""

    kind: str
    inverse_mass: Array
    inverse_inertia: Array  # (b, 3, 3); of spheres and discs k / m on the diagonal, for spins r omega
    velocity: Array  # (b, 3)
    spin: Array  # (b, 3); omega, r omega of spheres and discs
    i: NDArray[np.int64]
    j: NDArray[np.int64]
    normal: Array  # (n, 3) from j to i
    arm_i: Array  # (n, 3)
    arm_j: Array
    mu: Array  # (n,)
    mu_r: Array
    weight_i: Array  # of rolling and twisting
    weight_j: Array
    mu_w: Array  # of twisting

    @property
    def planar(self) -> bool:
        return self.kind == "rolling_discs"

    @property
    def rolls(self) -> bool:
        return self.kind in ROLLING

    @property
    def twists(self) -> bool:
        return self.kind in TWISTING

    def text(self) -> str:
        """Return what ``solve_parts`` reads."""
        rows = [[len(self.inverse_mass), len(self.i)]]
        for b in range(len(self.inverse_mass)):
            rows.append([self.inverse_mass[b], *self.inverse_inertia[b].ravel(), *self.velocity[b], *self.spin[b]])
        for k in range(len(self.i)):
            arms = [*self.normal[k], *self.arm_i[k], *self.arm_j[k]]
            rows.append(
                [
                    self.i[k],
                    self.j[k],
                    *arms,
                    self.mu[k],
                    self.mu_r[k],
                    self.weight_i[k],
                    self.weight_j[k],
                    self.mu_w[k],
                ],
            )
        return "\n".join(" ".join(repr(x.item() if hasattr(x, "item") else x) for x in row) for row in rows)

    def frames(self, k: int) -> tuple[Array, Array]:
        """Return unit vectors along which contact k slides, and about which it rolls: (1 or 2, 3) each."""
        n = self.normal[k]
        if self.planar:
            return np.array([[-n[1], n[0], 0.0]]), np.array([[0.0, 0.0, 1.0]])
        first = np.cross(n, np.eye(3)[np.abs(n).argmin()])
        first /= np.linalg.norm(first)
        both = np.array([first, np.cross(n, first)])
        return both, both

    def row(self, k: int, force: Array, roll: Array) -> Array:
        """Return (b, 6): what body velocities and spins give along a force at contact k, or along a rolling moment."""
        g = np.zeros((len(self.inverse_mass), 6))
        i, j = self.i[k], self.j[k]
        g[i, :3] += force
        g[j, :3] -= force
        if self.kind in SPHERES:
            turn = np.cross(self.normal[k], force)  # the arms are -r_i n and r_j n, and the spins r omega
            g[i, 3:] -= turn
            g[j, 3:] -= turn
        else:
            g[i, 3:] += np.cross(self.arm_i[k], force)
            g[j, 3:] -= np.cross(self.arm_j[k], force)
        g[i, 3:] += self.weight_i[k] * roll
        g[j, 3:] -= self.weight_j[k] * roll
        return g

    def directions(self, k: int) -> list[tuple[Array, Array]]:
        """Return force and rolling moment of a unit impulse along each axis of contact k."""
        none = np.zeros(3)
        slide, roll = self.frames(k)
        forces = [(self.normal[k], none), *((t, none) for t in slide)]
        moments = [*roll] * self.rolls + [self.normal[k]] * self.twists
        return forces + [(none, m) for m in moments]

    def problem(self) -> coulomb.Problem:
        """Return W, q and coefficients as the reference has them."""
        g = np.array([self.row(k, *along) for k in range(len(self.i)) for along in self.directions(k)])
        respond = g.copy()
        respond[:, :, :3] *= self.inverse_mass[:, None]
        respond[:, :, 3:] = np.einsum("bxy,rby->rbx", self.inverse_inertia, g[:, :, 3:])
        state = np.concatenate([self.velocity, self.spin], axis=1)
        width = len(g) // len(self.i)
        w, q = np.einsum("rbx,sbx->rs", g, respond), np.einsum("rbx,bx->r", g, state)
        first = 2 if self.planar else 3
        more: tuple[tuple[slice, Array], ...] = ()
        if self.rolls:
            more = ((slice(first, 2 * first - 1), self.mu_r),)
        if self.twists:
            more = (*more, (slice(2 * first - 1, None), self.mu_w))
        return coulomb.Problem(w, q.reshape(-1, width), self.mu, more)

    def along_axes(self, impulses: Array) -> Array:
        """Return impulses (n, 8) in space, p_n, p_t, p_r and p_w, as (n, d) along the axes of the problem."""
        rows = []
        for k, p in enumerate(impulses):
            slide, roll = self.frames(k)
            rows.append([p[0], *slide @ p[1:4], *(roll @ p[4:7] if self.rolls else []), *([p[7]] * self.twists)])
        return np.array(rows)


def random_assembly(kind: str, seed: int, bodies: int = 8, contacts: int = 14) -> Assembly:
    """Return bodies that fall on each other and on a fixed one, with random places of their contacts."""
    random = np.random.default_rng([seed, KINDS.index(kind)])
    planar, b, n = kind == "rolling_discs", bodies + 1, contacts
    radius = random.uniform(0.3, 1.0, b)
    inverse_mass = random.uniform(0.3, 3.0, b)
    inverse_mass[-1] = 0
    inverse_inertia = inverse_mass[:, None, None] * np.eye(3) * (2.0 if planar else 2.5)
    if kind in ARMS:
        for k in range(bodies):
            axes, _ = np.linalg.qr(random.normal(size=(3, 3)))
            inverse_inertia[k] = axes @ np.diag(inverse_mass[k] / random.uniform(0.1, 1.0, 3)) @ axes.T
    velocity, spin = random.normal(size=(b, 3)), random.normal(size=(b, 3))
    velocity[-1] = spin[-1] = 0
    i = np.arange(n) % bodies
    j = np.array([random.choice([x for x in range(b) if x != i[k]]) for k in range(n)])
    normal = random.normal(size=(n, 3))
    if planar:
        velocity[:, 2] = spin[:, 0] = spin[:, 1] = normal[:, 2] = 0
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    arm_i, arm_j = -radius[i, None] * normal, radius[j, None] * normal
    if kind in ARMS:
        arm_i, arm_j = random.normal(size=(2, n, 3))
    effective = radius[i] * radius[j] / (radius[i] + radius[j])
    effective[j == bodies] = radius[i][j == bodies]  # the fixed one is flat
    spheres = kind in SPHERES
    weight_i = effective / radius[i] if spheres else effective
    weight_j = np.where(j == bodies, 0, effective / radius[j]) if spheres else effective
    mu, mu_r = random.uniform(0, 0.6, n), random.uniform(0, 0.4, n)
    mu[::5], mu_r[1::6] = 0, 0
    mu[2::5], mu_r[::4] = 1, 3  # some stick
    mu_w = random.uniform(0, 0.3, n)
    mu_w[2::7], mu_w[::3] = 0, 3
    return Assembly(
        kind,
        inverse_mass,
        inverse_inertia,
        velocity,
        spin,
        i,
        j,
        normal,
        arm_i,
        arm_j,
        mu,
        mu_r,
        weight_i,
        weight_j,
        mu_w,
    )
