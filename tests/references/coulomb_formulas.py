# SPDX-License-Identifier: GPL-2.0-or-later
"""The formulas of docs/friction.md for one contact, in numpy: laws, generalised Newton matrices, closed-form visits.

Vectors are in the basis (n, t1, t2), and v = v_free + W p with W = diag(W_nn, W_tt, W_tt), given as its diagonal w.
The laws are named as in the registry; rho is a mass (kg), gamma a multiple of the inverse of W's diagonal.
"""

from __future__ import annotations

import numpy as np

Vector = np.ndarray
EYE = np.eye(3)


def disc(tau_t: Vector, radius: float) -> Vector:
    """Project on the disc B(0, radius)."""
    size = np.linalg.norm(tau_t)
    return tau_t if size <= radius else tau_t * (radius / size)


def half_cylinder(tau: Vector, mu: float) -> Vector:
    """Project on R+ x B(0, mu tau_n), the set of SAL and EAL."""
    normal = max(0.0, tau[0])
    return np.array([normal, *disc(tau[1:], mu * normal)])


def cone(tau: Vector, mu: float) -> Vector:
    """Project on K_mu, the set of SBP and EBP."""
    size = np.linalg.norm(tau[1:])
    if size <= mu * tau[0]:
        return tau
    if mu * size <= -tau[0]:
        return np.zeros(3)
    a = (tau[0] + mu * size) / (1 + mu**2)
    return np.array([a, *(a * mu / size * tau[1:])])


def augmented(law: str, p: Vector, v: Vector, mu: float, rho: float) -> Vector:
    """Return tau; EBP adds de Saxce's correction to the velocity."""
    correction = mu * np.linalg.norm(v[1:]) if law == "ebp" else 0.0
    return p - rho * (v + correction * EYE[0])


def error(law: str, p: Vector, v: Vector, mu: float, rho: float) -> Vector:
    """Return Z = p - proj(tau), equations (26) and (32)."""
    return p - {"ebp": cone, "eal": half_cylinder}[law](augmented(law, p, v, mu, rho), mu)


def status(law: str, tau: Vector, mu: float) -> str:
    size = np.linalg.norm(tau[1:])
    if (mu * size <= -tau[0]) if law == "ebp" else (tau[0] <= 0):
        return "open"
    return "stick" if size <= mu * tau[0] else "slip"


def frame(tau: Vector) -> tuple[Vector, Vector]:
    """Return t, the direction of tau_t, and b, across it."""
    t = np.array([0.0, *(tau[1:] / np.linalg.norm(tau[1:]))])
    return t, np.array([0.0, -t[2], t[1]])


def slip_of(v: Vector, t: Vector) -> Vector:
    """Return h, the direction of the carried slip velocity, or -t, which the subdifferential holds where it is 0."""
    size = np.linalg.norm(v[1:])
    return np.array([0.0, *(v[1:] / size)]) if size > 0 else -t


def matrices(law: str, p: Vector, v: Vector, mu: float, rho: float) -> tuple[Vector, Vector]:
    """Return A_c = dZ/dp and B_c = dZ/dv, written in (n, t, b) and turned to (n, t1, t2)."""
    tau = augmented(law, p, v, mu, rho)
    state = status(law, tau, mu)
    if state == "open":
        return EYE, 0 * EYE
    if state == "stick":
        slip = slip_of(v, np.zeros(3)) if law == "ebp" else np.zeros(3)
        return 0 * EYE, rho * (EYE + mu * np.outer(EYE[0], slip))
    t, b = frame(tau)
    size, q = np.linalg.norm(tau[1:]), np.column_stack([EYE[0], t, b])
    if law == "eal":
        m = mu * tau[0] / size
        a_c = np.array([[0, 0, 0], [-mu, 1, 0], [0, 0, 1 - m]])
        b_c = rho * np.array([[1, 0, 0], [mu, 0, 0], [0, 0, m]])
    else:
        c, h = 1 / (1 + mu**2), slip_of(v, t)
        m = c * mu * (tau[0] + mu * size) / size
        row = c * np.array([1, mu * (1 + h @ t), mu * (h @ b)])
        a_c = np.array([[c * mu**2, -c * mu, 0], [-c * mu, c, 0], [0, 0, 1 - m]])
        b_c = rho * np.array([row, mu * row, [0, 0, m]])
    return q @ a_c @ q.T, q @ b_c @ q.T


def newton_step(law: str, p: Vector, v: Vector, v_m: Vector, w: Vector, mu: float, rho: float) -> tuple[Vector, Vector]:
    """Solve (33), the 6x6 system [[-W, I], [A_c, B_c]] (Dp, Dv) = -(v - v_m, Z)."""
    a_c, b_c = matrices(law, p, v, mu, rho)
    change = np.linalg.solve(
        np.block([[-np.diag(w), EYE], [a_c, b_c]]), -np.concatenate([v - v_m, error(law, p, v, mu, rho)])
    )
    return p + change[:3], v + change[3:]


def visit(law: str, p: Vector, v: Vector, v_m: Vector, w: Vector, mu: float, rho: float) -> tuple[Vector, Vector]:
    """The same step, eliminated by hand: p and v~ after it."""
    tau = augmented(law, p, v, mu, rho)
    state = status(law, tau, mu)
    if state == "open":
        return np.zeros(3), v_m - w * p
    if state == "stick":
        return p - v_m / w, np.zeros(3)
    t, b = frame(tau)
    size = np.linalg.norm(tau[1:])
    m = mu * (tau[0] if law == "eal" else (tau[0] + mu * size) / (1 + mu**2)) / size
    dp_b = (-(1 - m) * (p @ b) - m * rho * (v_m @ b)) / (1 - m + m * rho * w[1])
    # EAL is the case without the slip term: the normal velocity is 0, not -mu (h + t).u_t.
    g = mu * (slip_of(v, t) + t) if law == "ebp" else 0 * t
    rest = v_m[0] + g @ v_m + w[1] * ((g @ t) * (mu * p[0] - p @ t) + (g @ b) * dp_b)
    p_n = p[0] - rest / (w[0] + mu * w[1] * (g @ t))
    new = p_n * (EYE[0] + mu * t) + (p @ b + dp_b) * b
    return new, v_m + w * (new - p)


def checked_visit(
    law: str, p: Vector, v: Vector, v_m: Vector, w: Vector, mu: float, rho: float
) -> tuple[Vector, Vector]:
    """A visit whose slip is checked: friction that would drive the slip along t makes the contact stick instead."""
    new, v_new = visit(law, p, v, v_m, w, mu, rho)
    tau = augmented(law, p, v, mu, rho)
    if status(law, tau, mu) == "slip" and v_new[1:] @ tau[1:] > 0:
        return p - v_m / w, np.zeros(3)
    return new, v_new


def pdas_visit(p: Vector, v_m: Vector, w: Vector, mu: float, gamma: float) -> Vector:
    if p[0] - gamma * v_m[0] / w[0] < 0:
        return np.zeros(3)
    exact = p - v_m / w
    limit = mu * exact[0]
    tau_t = np.array([0.0, *(p[1:] - gamma * v_m[1:] / w[1:])])
    size = np.linalg.norm(tau_t)
    if size <= limit:
        return exact
    t, b = frame(tau_t)
    m = limit / size
    return exact[0] * EYE[0] + limit * t + (p @ b) * (1 - 1 / (1 - m + m * gamma)) * b


def solution(v_free: Vector, w: Vector, mu: float) -> Vector:
    """The one solution of Coulomb's problem for one contact, whose W is diagonal."""
    normal = max(0.0, -v_free[0] / w[0])
    return np.array([normal, *disc(-v_free[1:] / w[1:], mu * normal)])


def sbp_visit(p: Vector, v_m: Vector, mu: float, rho: float) -> Vector:
    return cone(augmented("ebp", p, v_m, mu, rho), mu)


def sal_visit(p: Vector, v_m: Vector, mu: float, rho: float) -> Vector:
    """Project on the half-cylinder whose radius is the new mu p_n."""
    return half_cylinder(augmented("eal", p, v_m, mu, rho), mu)


def turned(tangential: Vector, old: Vector, new: Vector) -> Vector:
    """Turn a vector perpendicular to the unit normal `old` by the smallest rotation that takes it to `new`."""
    return tangential - (tangential @ new) / (1 + old @ new) * (old + new)
