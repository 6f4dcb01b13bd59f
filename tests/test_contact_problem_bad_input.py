# SPDX-License-Identifier: GPL-2.0-or-later
"""What `nscd_lmp.ContactProblem` and `nscd_lmp.solve` refuse, and that they say where and why."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from nscd_lmp import ContactProblem, NscdError, solve

pytestmark = pytest.mark.fast

Array = NDArray[np.float64]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"solver": "newton?"}, r"unknown solver 'newton\?': choose one of .*pdas"),
        ({"solver": "pdas", "rho": 1.0}, r"rho is not a parameter of solver pdas, which takes gamma"),
        ({"solver": "pdas", "gamma": 0.0}, r"gamma = 0.0 must be > 0"),
        ({"tol": 0.0}, r"tol = 0.0 must be > 0"),
        ({"tol": 0.2}, r"tol = 0.2 must be <= 0.1 with criterion natural"),
        ({"maxiter": 0}, r"maxiter = 0 must be at least 1"),
        ({"criterion": "energy"}, r"unknown criterion 'energy': choose one of natural, paper"),
        ({"unconverged": "stop"}, r"unknown unconverged 'stop': choose one of warn, ignore, error"),
        ({"warmstart": np.zeros(3)}, r"warmstart has the shape \(3,\) and must be \(20,\)"),
        ({"warmstart": np.full(20, np.nan)}, r"warmstart\[0\] = nan must be finite \(19 more like it\)"),
    ],
)
def test_solve_refuses(words: dict[str, Any], message: str) -> None:
    with pytest.raises(NscdError, match=message):
        solve(ContactProblem(np.eye(20), np.ones(20)), **words)


@pytest.mark.parametrize("speed", [1e155, 1e-165])
def test_velocities_whose_squares_are_no_numbers_are_refused(speed: float) -> None:
    """Their norm would be infinity or 0, and any residual over it as good as none."""
    with pytest.raises(NscdError, match=r"the largest of q is 1e[-+]1\d5 m/s: it must be between 1e-130 and 1e\+130"):
        ContactProblem([[2, 1], [1, 2]], [-speed, -speed])


@pytest.mark.parametrize("speed", [1e120, 1e-120, 0.0])
@pytest.mark.parametrize("solver", ["auto", "pdas", "active_set"])
def test_velocities_of_any_other_size_are_solved(speed: float, solver: str) -> None:
    found = solve(ContactProblem([[2, 1], [1, 2]], [-speed, -speed]), solver, tol=1e-10)
    np.testing.assert_allclose(found.impulse, [speed / 3, speed / 3], rtol=1e-9)


@pytest.mark.parametrize("dim", [2, 3])
def test_solvers_without_friction_refuse_tangents(dim: int) -> None:
    # mu = 0 too: they have no tangents at all, so nothing depends on the values of mu
    for mu in (0.3, 0.0):
        problem = ContactProblem(np.eye(2 * dim), np.ones(2 * dim), mu, dim)
        with pytest.raises(NscdError, match="solver active_set is for contacts without friction: choose another"):
            solve(problem, "active_set")


def changed(w: Any, entries: dict[tuple[int, int], float]) -> Array:
    """Return a copy of w with other entries."""
    out = np.array(w, dtype=float)
    for place, value in entries.items():
        out[place] = value
    return out


NONE, NAN, INF = np.zeros(4), np.nan, np.inf
REFUSED = [
    ((np.eye(4), NONE, 0.1, 4), "dim = 4 must be 1 .*, 2 .* or 3"),
    ((np.ones((2, 3)), NONE), r"W has the shape \(2, 3\) and must be square"),
    ((np.eye(4), NONE, 0.1, 3), "W has 4 rows, not a multiple of dim = 3: a contact has rows N, T1, T2"),
    ((np.eye(4) * 1j, NONE), "W has the type complex128 and must hold real numbers"),
    ((np.eye(4), np.zeros(3)), r"q has the shape \(3,\), but W has 4 rows: it must be \(4,\) or \(4, 1\)"),
    ((np.eye(4), np.zeros((4, 1)), 0, 2), r"q has the shape \(4, 1\), but W has 4 rows: it must be .* or \(2, 2\)"),
    ((changed(np.eye(4), {(3, 2): NAN}), NONE, 0, 2), r"W\[3, 2\] = nan \(contacts 1 and 1\) must be finite"),
    ((changed(np.eye(4), {(1, 3): INF}), NONE), r"W\[1, 3\] = inf \(contacts 1 and 3\) must be finite"),
    ((np.eye(4), [0, 0, NAN, 0]), r"q\[2\] = nan must be finite"),
    ((np.eye(4), [[0, 0], [0, -INF]], 0, 2), r"q\[1, 1\] = -inf must be finite"),
    ((np.eye(4), NONE, None, 2), "mu is missing, which dim = 2 needs"),
    ((np.eye(4), NONE, 0.1), "mu = 0.1 with dim = 1, which has no tangents"),
    ((np.eye(4), NONE, [0.1, -0.1], 2), "contact 1: mu = -0.1 must be from 0 to 1e.06, or infinite"),
    ((np.eye(4), NONE, NAN, 2), r"contact 0: mu = nan must be .* \(1 more like it\)"),
    ((np.eye(4), NONE, 1e7, 2), "contact 0: mu = 1e.07 must be"),
    ((np.eye(4), NONE, [0.1] * 3, 2), r"mu has the shape \(3,\) and must be a number or an array of shape \(2,\)"),
    ((np.diag([1.0, -2, 1, -3]), NONE), r"contact 1: W\[1, 1\] = -2 must be >= 0.*\(1 more like it\)"),
    ((np.diag([1.0, 1, 1, -2]), NONE, 0, 2), r"contact 1: W\[3, 3\] = -2 must be >= 0"),
    ((np.diag([1.0, 0, 1, 1]), [0, -1, 0, 0]), "contact 1: no impulse can move it, W_nn = 0, but q_n = -1 m/s < 0"),
    ((changed(np.diag([1, 0, 1, 1]), {(1, 2): 0.5, (2, 1): 0.5}), NONE), r"contacts 1 and 2: W\[1, 2\] = 0.5 stands"),
    ((changed(np.diag([1, 0, 1, 1]), {(2, 1): 0.5}), NONE), r"contacts 2 and 1: W\[2, 1\] = 0.5 stands in a row or"),
    ((changed(np.eye(4), {(0, 3): 2, (3, 0): 2}), NONE), r"contacts 0 and 3: W\[0, 3\] = 2 is larger than sqrt"),
    ((changed(np.eye(4), {(0, 3): 0.5, (3, 0): 0.4}), NONE), r"0.5 and W\[3, 0\] = 0.4 differ by more than 5%"),
    ((np.triu(np.full((4, 4), 0.5)), NONE), r"W\[1, 0\] = 0 differ by more than 5% .* one triangle alone"),
    ((np.diag([1.0, 1, 1, 0]), NONE, 0.3, 2), "contact 1 with mu = 0.3: the smallest eigenvalue .* is 0"),
    ((np.kron(np.diag([1, 0]), np.eye(3)) + changed(np.zeros((6, 6)), {(3, 3): 1}), np.zeros(6), INF, 3),
     "contact 1 with mu = inf: the smallest eigenvalue"),
    ((changed(np.eye(3), {(1, 2): 1, (2, 1): 1}), np.zeros(3), 0.3, 3), "contact 0 with mu = 0.3: the smallest"),
]  # fmt: skip


@pytest.mark.parametrize(("arguments", "message"), REFUSED)
def test_problem_refuses(arguments: Any, message: str) -> None:
    with pytest.raises(NscdError, match=message):
        ContactProblem(*arguments)


PAIR: dict[str, Any] = {"body_i": [0], "body_j": [1], "inverse_mass": [1, 1], "normal": [[1, 0, 0]], "velocity": [-1]}
RUBBING = PAIR | {"friction": 0.3, "tangents": [[[0, 1, 0]]], "slip": [[1]], "spin_response": 2.0}
REFUSED_SPHERES = [
    (PAIR | {"body_i": [2]}, "contact 0: body_i = 2 must be an index into the 2 inverse masses, or -1"),
    (PAIR | {"body_j": [-2]}, "contact 0: body_j = -2 must be"),
    (PAIR | {"body_j": [0]}, "contact 0: body 0 touches itself"),
    (PAIR | {"body_i": [0.5]}, r"body_i, float64 of shape \(1,\), must be integers of shape \(1,\)"),
    (PAIR | {"inverse_mass": [1, -1]}, "inverse_mass, .* must be .* numbers >= 0"),
    (PAIR | {"inverse_mass": [0, 0]}, "contact 0: no impulse can move it"),
    (PAIR | {"normal": [[2, 0, 0]]}, "contact 0: normal and tangents have the scalar products .* must be unit vectors"),
    (PAIR | {"normal": [[1, 0]]}, r"normal has the shape \(1, 2\) and must be \(1, 3\)"),
    (PAIR | {"velocity": [NAN]}, r"velocity\[0\] = nan must be finite"),
    (PAIR | {"velocity": [[1]]}, r"velocity has the shape \(1, 1\) and must be \(n,\)"),
    (PAIR | {"friction": 0.3}, "tangents and slip and spin_response missing: friction needs"),
    (RUBBING | {"friction": -1}, "contact 0: mu = -1 must be from 0"),
    (RUBBING | {"tangents": [[[0.8, 0.6, 0]]]}, "contact 0: normal and tangents have the scalar products"),
    (RUBBING | {"tangents": [[[0, 0, 1]]]}, "contact 0: normal or tangent leaves the x-y plane"),
    (RUBBING | {"slip": [[1, 2]]}, r"slip has the shape \(1, 2\) and must be \(1, 1\) or \(1,\)"),
    (RUBBING | {"spin_response": -1.0}, "spin_response = -1.0 must be >= 0"),
]


@pytest.mark.parametrize(("arrays", "message"), REFUSED_SPHERES)
def test_spheres_are_refused(arrays: dict[str, Any], message: str) -> None:
    ContactProblem.from_spheres(**(RUBBING if "slip" in arrays else PAIR))
    with pytest.raises(NscdError, match=message):
        ContactProblem.from_spheres(**arrays)


def test_a_start_is_looked_at_even_where_nothing_drives_the_contacts():
    still = ContactProblem(np.eye(3), np.zeros(3))
    with pytest.raises(NscdError, match=r"warmstart has the shape \(2,\) and must be \(3,\)"):
        solve(still, warmstart=[1.0, 1.0])
    assert (solve(still, warmstart=np.ones(3)).impulse == 0).all()
