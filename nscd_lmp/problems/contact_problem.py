# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact problems without LAMMPS: what :func:`nscd_lmp.solve` takes."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nscd_lmp._core import NscdError
from nscd_lmp.problems import checks
from nscd_lmp.problems.checks import BlockRows, Floats


@dataclass(frozen=True)
class Spheres:
    """W of spheres or discs by what makes it, as in :meth:`ContactProblem.from_spheres`; no tangents are (n, 0, 3)."""

    body_i: NDArray[np.int32]
    body_j: NDArray[np.int32]
    inverse_mass: Floats
    normal: Floats
    tangents: Floats
    spin_response: float

    def normal_response(self) -> Floats:
        """Return W_nn, (n,) in 1/kg."""
        mobility = np.append(self.inverse_mass, 0.0)  # the last is the obstacles'
        return mobility[self.body_i] + mobility[self.body_j]

    def matrix(self) -> Any:
        """Return W = H^T M^-1 H as scipy.sparse.bsr_array, H^T M^-1/2 being sparse itself."""
        from scipy import sparse

        n, bodies = len(self.normal), len(self.inverse_mass)
        axes = np.concatenate([self.normal[:, None, :], self.tangents], axis=1)
        turned = np.cross(self.normal[:, None, :], self.tangents)
        d, width = axes.shape[1], 3 if axes.shape[1] == 1 else 6
        body = np.stack([self.body_i, self.body_j], axis=1)
        h = np.zeros((n, 2, d, width))
        h[:, 0, :, :3], h[:, 1, :, :3] = axes, -axes
        if d > 1:  # surface velocities r omega of both grains add up
            h[:, :, 1:, 3:] = -np.sqrt(self.spin_response) * turned[:, None]
        moves = body >= 0
        h = h[moves] * np.sqrt(self.inverse_mass[body[moves]])[:, None, None]
        row_start = np.append(0, np.cumsum(moves.sum(axis=1)))
        root = sparse.bsr_array((h, body[moves], row_start), shape=(n * d, bodies * width), blocksize=(d, width))
        w = sparse.bsr_array(root @ root.T, blocksize=(d, d))
        w.sort_indices()
        return w


class ContactProblem:
    """Find impulses p and velocities u = W p + q that obey Signorini's and Coulomb's laws at every contact.

    0 <= u_n, p_n >= 0 and u_n p_n = 0; with friction \\|p_t\\| <= mu p_n, u_t = 0 where it is less, and p_t against u_t
    where it is equal. Vectors and rows of W stand contact by contact, along N in dim 1, N, T1 in dim 2 and N, T1, T2
    in dim 3.

    Parameters
    ----------
    W : scipy.sparse array or matrix of any format, or (n dim, n dim) array_like, 1/kg
        The Delassus matrix H^T M^-1 H. It may be rank-deficient. It may be slightly unsymmetric, \\|W_ij - W_ji\\| up
        to 5 % of sqrt(W_ii W_jj): velocities and residuals are those of W as it is given, so an answer that
        :func:`solve` calls converged solves it, but a solver that rests on symmetry may not get there. Copied.
    q : (n dim,) or (n, dim) array_like, m/s
        Velocities without impulses. Copied.
    mu : float or (n,) array_like, optional
        Coulomb's coefficients, >= 0; infinite for contacts that do not slip. Needed in dim 2 and 3; in dim 1 None or 0.
    dim : int
        Unknowns per contact, 1 to 3.

    Raises
    ------
    NscdError
        For W that is not square, whose size is not that of q or no multiple of dim, which has a negative diagonal, an
        entry beyond sqrt(W_ii W_jj), or more asymmetry than is said above; for NaN or infinity in W or q; for mu that
        is negative, NaN, above 1e6 yet finite, missing, or given in dim 1; for a contact with W_nn = 0 and q_n < 0, or
        with friction and a tangential block that is not positive.
        A contact with W_nn = 0 and q_n >= 0 is accepted and gets no impulse.
    """

    dim: int
    q: Floats  # (n,) in dim 1, else (n, dim); m/s; read-only
    mu: Floats | None  # (n,), None in dim 1; read-only
    blocks: BlockRows | None  # W by block rows, or
    spheres: Spheres | None  # by what makes it

    def __init__(self, W: Any, q: ArrayLike, mu: ArrayLike | None = None, dim: int = 1) -> None:
        if dim not in (1, 2, 3):
            raise NscdError(f"dim = {dim!r} must be 1 (without friction), 2 (planar) or 3 (in space)")
        dim = int(dim)
        blocks = checks.block_rows(W, dim)
        velocities = checks.floats("q", q)
        n = len(blocks)
        if velocities.shape not in ((n * dim,), (n, dim)):
            raise NscdError(
                f"q has the shape {velocities.shape}, but W has {n * dim} rows: it must be ({n * dim},) or ({n}, {dim})"
            )
        velocities = velocities.reshape(n, dim)
        friction = checks.coefficients(mu, n, dim)
        checks.check_matrix(blocks)
        checks.check_speeds(velocities)
        checks.check_contacts(blocks.diagonal_blocks(), velocities, friction)
        self._set(dim, velocities, friction, blocks, None)

    @classmethod
    def from_spheres(
        cls,
        body_i: ArrayLike,
        body_j: ArrayLike,
        inverse_mass: ArrayLike,
        normal: ArrayLike,
        velocity: ArrayLike,
        friction: ArrayLike | None = None,
        tangents: ArrayLike | None = None,
        slip: ArrayLike | None = None,
        spin_response: float | None = None,
    ) -> "ContactProblem":
        """Return the problem of spheres or discs that touch, whose W is never assembled unless a solver needs it.

        Parameters
        ----------
        body_i, body_j : (n,) int
            Indices into `inverse_mass`; -1 for an obstacle, which does not move.
        inverse_mass : (m,), 1/kg
            0 for a body that does not move.
        normal : (n, 3)
            Unit vectors from j to i.
        velocity : (n,), m/s
            Relative velocities along the normals without impulses, i minus j, plus whatever the contact law adds.
        friction : float or (n,), optional
            Coulomb's coefficients, as `mu` of :class:`ContactProblem`. None: dim 1, and the rest is None too.
        tangents : (n, 3), (n, 1, 3) or (n, 2, 3), optional
            Unit vectors at right angles to the normal: one in a planar scene (then they lie in the x-y plane), two in
            space.
        slip : (n,), (n, 1) or (n, 2), m/s, optional
            Relative velocities of the contact points along the tangents, spins included, without impulses.
        spin_response : float, optional
            m r^2 / I: 5/2 for spheres, 2 for discs.

        Raises
        ------
        NscdError
            For arrays of other shapes, values that are not finite, an index that is no body's, a body that touches
            itself, a negative inverse mass, vectors that are not unit vectors at right angles, mu as above, a contact
            that cannot move with velocity < 0, and for some but not all of the arguments of friction.
        """
        q_n = checks.floats("velocity", velocity)
        if q_n.ndim != 1:
            raise NscdError(f"velocity has the shape {q_n.shape} and must be (n,): one normal velocity per contact")
        n = len(q_n)
        i, j = _indices("body_i", body_i, n), _indices("body_j", body_j, n)
        masses = checks.floats("inverse_mass", inverse_mass)
        if masses.ndim != 1 or (masses < 0).any():
            raise NscdError(
                f"inverse_mass, of shape {masses.shape}, must be (m,) numbers >= 0: 0 for bodies that do not move"
            )
        checks.check_bodies(i, j, len(masses))
        axes, q_t, response = _friction_arrays(n, friction, tangents, slip, spin_response)
        normals = _shaped("normal", normal, (n, 3))
        checks.check_frames(normals, axes)
        normals, axes = _orthonormal(normals, axes)
        spheres = Spheres(i, j, masses, normals, axes, response)
        checks.check_movable(spheres.normal_response(), q_n)
        dim = 1 + axes.shape[1]
        problem = cls.__new__(cls)
        mu = checks.coefficients(friction, n, dim)
        q = np.column_stack([q_n, q_t])
        checks.check_speeds(q)
        problem._set(dim, q, mu, None, spheres)
        return problem

    def _set(self, dim: int, q: Floats, mu: Floats | None, blocks: BlockRows | None, spheres: Spheres | None) -> None:
        self.dim, self.mu, self.blocks, self.spheres = dim, mu, blocks, spheres
        self.q = np.ascontiguousarray(q[:, 0] if dim == 1 else q)
        for array in (self.q, mu):
            if array is not None:
                array.flags.writeable = False

    def __len__(self) -> int:
        """Return the number of contacts."""
        return len(self.q)

    def __repr__(self) -> str:
        """Return what there is to solve."""
        kind = "a matrix" if self.spheres is None else f"{len(self.spheres.inverse_mass)} spheres"
        return f"<ContactProblem of {kind}: {len(self)} contacts, dim {self.dim}>"

    def delassus(self) -> Any:
        """Return W (n dim, n dim), 1/kg, as a new scipy.sparse.bsr_array with blocks of (dim, dim)."""
        if self.spheres is not None:
            return self.spheres.matrix()
        assert self.blocks is not None
        return self.blocks.matrix()


def _shaped(name: str, values: ArrayLike, *shapes: tuple[int, ...]) -> Floats:
    """Return the values as floats of the first of these shapes, if theirs is one of them."""
    array = checks.floats(name, values)
    if array.shape not in shapes:
        raise NscdError(f"{name} has the shape {array.shape} and must be {' or '.join(map(str, shapes))}")
    return array.reshape(shapes[0])


def _indices(name: str, values: ArrayLike, contacts: int) -> NDArray[np.int32]:
    """Return the indices of the contacts' bodies."""
    array = np.asarray(values)
    if array.shape != (contacts,) or (contacts and array.dtype.kind not in "iu"):
        raise NscdError(f"{name}, {array.dtype} of shape {array.shape}, must be integers of shape ({contacts},)")
    limits = np.iinfo(np.int32)
    return np.clip(array, limits.min, limits.max).astype(np.int32)


def _orthonormal(normals: Floats, axes: Floats) -> tuple[Floats, Floats]:
    """Return frames that are orthonormal to round-off; given are ones that nearly are, in single precision say."""
    normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    exact: list[Floats] = []
    for a in range(axes.shape[1]):
        axis = axes[:, a]
        for other in (normals, *exact):
            axis = axis - other * np.einsum("ij,ij->i", axis, other)[:, None]
        exact.append(axis / np.linalg.norm(axis, axis=1, keepdims=True))
    return normals, np.stack(exact, axis=1) if exact else axes


def _friction_arrays(
    n: int, friction: Any, tangents: Any, slip: Any, spin_response: float | None
) -> tuple[Floats, Floats, float]:
    """Return tangents (n, d - 1, 3), slip (n, d - 1) and the spin response, empty and 0 without friction."""
    given = {"friction": friction, "tangents": tangents, "slip": slip, "spin_response": spin_response}
    missing = [name for name, value in given.items() if value is None]
    if len(missing) == len(given):
        return np.zeros((n, 0, 3)), np.zeros((n, 0)), 0.0
    if missing:
        raise NscdError(f"{' and '.join(missing)} missing: friction needs friction, tangents, slip and spin_response")
    axes = checks.floats("tangents", tangents)
    planar = axes.shape in ((n, 3), (n, 1, 3))
    axes = _shaped("tangents", axes, (n, 1, 3), (n, 3)) if planar else _shaped("tangents", axes, (n, 2, 3))
    q_t = _shaped("slip", slip, (n, 1), (n,)) if planar else _shaped("slip", slip, (n, 2))
    response = float(spin_response) if spin_response is not None else 0.0
    if not (response >= 0 and np.isfinite(response)):
        raise NscdError(f"spin_response = {response} must be >= 0: m r^2 / I, 5/2 for spheres, 2 for discs")
    return axes, q_t, response
