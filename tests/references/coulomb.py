# SPDX-License-Identifier: GPL-2.0-or-later
"""A reference for contact problems with Coulomb friction, which shares no code and no method with the package.

Given the Delassus matrix W, the velocities q without impulses and a coefficient mu of each contact, find p with
    u = W p + q,   0 <= u_n _|_ p_n >= 0,   |p_t| <= mu p_n,   p_t = -mu p_n u_t / |u_t| where u_t != 0.
Rows come contact by contact, (N, T1) in the plane and (N, T1, T2) in space; q holds whatever biases there are.

With s = mu |u_t| added to u_n (de Saxce & Feng 1998), this is: p in the cone K, u + s n in its dual and orthogonal
to p; for a given s a convex program, least p W p / 2 + (q + s n) p over K. Two ways to a solution near 1e-6:

`split`: the alternating direction method of multipliers with s renewed in every step (Tasora, Mangoni, Benatti &
Garziera 2021, Solving variational inequalities and cone complementarity problems in nonsmooth dynamics using the
alternating direction method of multipliers).
`fixed_point`: one convex program after another (Acary, Cadoux, Lemarechal & Malick 2011, A formulation of the linear
discrete Coulomb friction problem via convex optimization), each by an interior point method (cone_program.py).

Newton's method on the projection equations (Alart & Curnier 1991), all contacts at once and with least squares steps
because W may be singular, takes the end to round-off. The answer is judged by `residual` alone.

A solution need not be the only one, even in velocities: see test_coulomb.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import cone_program
import numpy as np
from cone_program import norms
from numpy.typing import NDArray
from scipy import linalg

Array = NDArray[np.float64]
ACCURACY = 1e-11  # of the accepted answer, as a share of the largest velocity (at least 1 m/s)


@dataclass
class Problem:
    """The contact problem: w (n d, n d) in 1/kg, q (n, d) in m/s and mu (n,), which may be 0 or infinite.

    Contacts may have more parts whose impulses are bounded by p_n: `more` has the columns of each, and its coefficients
    (n,). Only `residual` and `error` know of these.
    """

    w: Array
    q: Array
    mu: Array
    more: tuple[tuple[slice, Array], ...] = ()

    def velocity(self, p: Array) -> Array:
        """Return W p + q, (n, d)."""
        return (self.w @ p.ravel()).reshape(self.q.shape) + self.q

    def diagonal(self) -> Array:
        """Return W_nn, W_tt[, W_tt] of every contact, (n, d)."""
        return self.w.diagonal().reshape(self.q.shape)


def problem(w: Any, q: Any, mu: Any, dim: int) -> Problem:
    """Return the problem of a dense or sparse w, with mu spread over all contacts; dim 2 is planar."""
    w = np.asarray(w.toarray() if hasattr(w, "toarray") else w, dtype=float)
    q = np.asarray(q, dtype=float).reshape(-1, dim)
    return Problem(w, q, np.array(np.broadcast_to(mu, len(q)), dtype=float))


def onto_disc(vectors: Array, radius: Array) -> Array:
    """Return the points nearest to the vectors (n, d - 1) in discs about 0; an infinite radius holds everything."""
    length = norms(vectors)
    outside = length > radius
    scale = np.divide(radius, length, out=np.ones_like(length), where=outside)
    return vectors * scale[:, None]


def radii(mu: Array, normal: Array) -> Array:
    """Return mu p_n of the friction discs, 0 of open contacts even if mu is infinite."""
    push = np.maximum(normal, 0)
    return np.multiply(mu, push, out=np.zeros_like(push), where=push > 0)


def residual(given: Problem, p: Array, u: Array | None = None) -> Array:
    """Return the natural maps in m/s, (n, d): 0 exactly for a solution.

    min(u_n, W_nn p_n), and W_tt (p_t - the point of the friction disc nearest to p_t - u_t / W_tt).
    """
    u = given.velocity(p) if u is None else u
    diagonal = given.diagonal()
    out = np.empty_like(u)
    out[:, 0] = np.minimum(u[:, 0], diagonal[:, 0] * p[:, 0])
    first = given.more[0][0].start if given.more else None
    for columns, mu in ((slice(1, first), given.mu), *given.more):
        scale = diagonal[:, columns].max(axis=1, keepdims=True)
        goal = onto_disc(p[:, columns] - u[:, columns] / scale, radii(mu, p[:, 0]))
        out[:, columns] = scale * (p[:, columns] - goal)
    return out


def error(given: Problem, p: Array) -> float:
    """Return the largest natural map, m/s."""
    return float(np.abs(residual(given, p)).max(initial=0.0))


def solve(given: Problem, method: Callable[[Problem, float], Array] | None = None) -> Array:
    """Return the impulses (n, d) of a solution by splitting (or another method), then Newton steps.

    Infinite mu is replaced by ever larger ones, until Newton's steps find nothing left that slips.
    Raises ArithmeticError if no solution is found to `ACCURACY`.
    """
    sticks = np.isinf(given.mu)
    finite = Problem(given.w, given.q, given.mu.copy())
    for bound in (1.0, 3.0, 10.0, 30.0) if sticks.any() else (0.0,):
        finite.mu[sticks] = bound
        for accuracy in (1e-8, 1e-10, 1e-12):  # Newton's steps fail where contacts are about to change what they do
            p = polish(given, (method or split)(finite, accuracy))
            if p is not None:
                return p
    raise ArithmeticError("no solution found")


def polish(given: Problem, p: Array) -> Array | None:
    """Return the impulses after Newton steps, None if they leave an error or change the velocities much."""
    scale = max(1.0, float(np.abs(given.q).max(initial=0.0)))
    polished = newton(given, p)
    moved = np.abs(given.velocity(polished) - given.velocity(p)).max(initial=0.0)
    return polished if error(given, polished) <= ACCURACY * scale and moved <= 1e-3 * scale else None


def split(given: Problem, accuracy: float, steps: int = 30000) -> Array:
    """Return the impulses (n, d) by the alternating direction method of multipliers, W factorised once; mu finite."""
    shape, unit = given.q.shape, 1 / np.sqrt(given.diagonal()[:, :1])
    w = unit.repeat(shape[1]) * given.w * unit.repeat(shape[1])[:, None]
    rho = 0.3  # of W_nn: by trial, 0.1 to 1 serve
    inverse = linalg.inv(w + rho * np.eye(len(w)), check_finite=False)
    c, y, xi = unit * given.q, np.zeros(shape), np.zeros(shape)
    for k in range(steps):
        right = rho * y - xi - c
        right[:, 0] -= given.mu * norms(xi[:, 1:])  # s: at the end -xi is u + s n
        p = (inverse @ right.ravel()).reshape(shape)
        y = onto_cone(p + xi / rho, given.mu)
        xi += rho * (p - y)
        if k % 50 == 49 and error(given, unit * y) <= accuracy:
            break
    return unit * y


def onto_cone(vectors: Array, mu: Array) -> Array:
    """Return the points nearest to the vectors (n, d) in the cones |p_t| <= mu p_n."""
    length = norms(vectors[:, 1:])
    height = np.maximum(0, vectors[:, 0] + mu * length) / (1 + mu**2)
    out = vectors.copy()
    outside = length > mu * vectors[:, 0]
    out[outside, 0] = height[outside]
    scale = np.divide(mu * height, length, out=np.zeros_like(length), where=length > 0)
    out[outside, 1:] *= scale[outside, None]
    return out


def fixed_point(given: Problem, accuracy: float, rounds: int = 100) -> Array:
    """Return the impulses (n, d) by convex programs, each with s from the one before; mu finite."""
    s = given.mu * norms(given.q[:, 1:])
    for _ in range(rounds):
        p = relaxed(given, s)
        before, s = s, given.mu * norms(given.velocity(p)[:, 1:])
        if np.abs(s - before).max(initial=0.0) <= accuracy:
            break
    return p


def relaxed(given: Problem, s: Array) -> Array:
    """Return the impulses (n, d) of the convex problem at a fixed s: p in K, u + s n in its dual, orthogonal.

    The cone is scaled to the second-order cone |x_t| <= x_0 by p_n = x_0 / m, p_t = mu x_t / m, m = max(1, mu), all
    over sqrt(W_nn), so mu = 0 needs no case of its own.
    """
    unit = 1 / np.sqrt(given.diagonal()[:, 0]) / np.maximum(1, given.mu)
    d = np.column_stack([unit, *[unit * given.mu] * (given.q.shape[1] - 1)])
    c = d * given.q
    c[:, 0] += d[:, 0] * s
    # the last term keeps impulses that W does not feel from growing without bound; `newton` takes its effect away
    m = d.ravel()[:, None] * given.w * d.ravel() + 1e-9 * np.eye(d.size)
    return d * cone_program.minimum(m, c)


def newton(given: Problem, p: Array, steps: int = 30) -> Array:
    """Return the best impulses met in full Newton steps on `equations`, which need not come nearer to 0 each time."""
    best, least, since = p, error(given, p), 0
    for _ in range(steps):
        if least <= 1e-14 or since == 6 or not np.isfinite(p).all():
            break
        values, slope = equations(given, p)
        p = p - linalg.lstsq(slope, values.ravel(), cond=1e-12, lapack_driver="gelsy")[0].reshape(p.shape)
        p[p[:, 0] <= 1e-14 * p[:, 0].max(initial=0.0)] = 0  # else infinite mu makes much of 1e-30 N s
        now, since = error(given, p), since + 1
        if now < least:
            best, least, since = p, now, 0
    return best


def equations(given: Problem, p: Array) -> tuple[Array, Array]:
    """Return Alart & Curnier's equations in m/s, (n, d), 0 for a solution, and their slope (n d, n d)."""
    u, diagonal, (n, d) = given.velocity(p), given.diagonal(), p.shape
    tau = p - u / diagonal
    d_tau = np.eye(n * d).reshape(n, d, n * d) - given.w.reshape(n, d, n * d) / diagonal[:, :, None]
    goal, d_goal = np.zeros_like(p), np.zeros((n, d, n * d))
    shut = tau[:, 0] > 0
    goal[shut, 0], d_goal[shut, 0] = tau[shut, 0], d_tau[shut, 0]
    radius = radii(given.mu, tau[:, 0])
    goal[:, 1:] = onto_disc(tau[:, 1:], radius)
    length = norms(tau[:, 1:])
    stick = shut & (length <= radius)
    d_goal[stick, 1:] = d_tau[stick, 1:]
    slip = shut & ~stick
    along = tau[slip, 1:] / length[slip, None]
    turn = (radius[slip] / length[slip])[:, None, None] * (np.eye(d - 1) - along[:, :, None] * along[:, None, :])
    d_goal[slip, 1:] = turn @ d_tau[slip, 1:] + given.mu[slip, None, None] * along[:, :, None] * d_tau[slip, :1]
    slope = diagonal[:, :, None] * (np.eye(n * d).reshape(n, d, n * d) - d_goal)
    return diagonal * (p - goal), slope.reshape(n * d, n * d)
