# SPDX-License-Identifier: GPL-2.0-or-later
"""The contact problem of one step, as a Python solver is handed it."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nscd_lmp.problems.contact_problem import ContactProblem


@dataclass(frozen=True)
class ContactSystem:
    """Find impulses p with v = W p + velocity >= 0, p >= 0 and v p = 0 for every contact.

    With friction p has normal components p_n and tangential ones p_t, for which Coulomb's law asks besides:
    \\|p_t\\| <= friction p_n; slip = 0 where it is less; p_t against the slip where it is equal.

    Attributes
    ----------
    body_i, body_j : (n,) int
        Indices into `inverse_mass` of the two grains; -1 for a wall or an obstacle. The normal points from j to i.
    inverse_mass : (m,) float, 1/kg
    normal : (n, 3) float
        Unit normals.
    gap : (n,) float, m
        At detection; negative when overlapping.
    bias : (n,) float, m/s
        What the contact law adds to the relative velocity (restitution, gap/dt); contained in `velocity`.
    start : (n,) or (n, d) float, N s
        Impulses of the warm start, 0 without; with friction along N, T1[, T2].
    velocity : (n,) float, m/s
        Normal relative velocity without impulses, plus bias.
    friction : (n,) float or None
        Coulomb's coefficient, infinite for contacts that stick. None, as the rest, in a frictionless scene.
    tangents : (n, d - 1, 3) float or None
        Unit vectors T1[, T2]; with the normal a right-handed frame.
    slip : (n, d - 1) float or None, m/s
        Tangential relative velocity of the contact points without impulses, plus bias.
    spin_response : float or None
        m r^2 / I: 5/2 for spheres, 2 for discs.
    """

    body_i: NDArray[np.int32]
    body_j: NDArray[np.int32]
    inverse_mass: NDArray[np.float64]
    normal: NDArray[np.float64]
    gap: NDArray[np.float64]
    bias: NDArray[np.float64]
    start: NDArray[np.float64]
    velocity: NDArray[np.float64]
    friction: NDArray[np.float64] | None = None
    tangents: NDArray[np.float64] | None = None
    slip: NDArray[np.float64] | None = None
    spin_response: float | None = None

    @classmethod
    def of_core(cls, arrays: dict[str, Any]) -> "ContactSystem":
        """Return the system from the arrays that the compiled core hands out."""
        if "tangents" in arrays:
            arrays["tangents"] = arrays["tangents"].reshape(len(arrays["gap"]), -1, 3)
        return cls(**arrays)

    def __len__(self) -> int:
        """Return the number of contacts."""
        return len(self.gap)

    @property
    def dimension(self) -> int:
        """Return the unknowns per contact: 1 without friction, 2 in a planar scene, 3 in space."""
        return 1 if self.slip is None else 1 + self.slip.shape[1]

    def problem(self) -> ContactProblem:
        """Return what this asks for as a problem for :func:`nscd_lmp.solve`, without W."""
        return ContactProblem.from_spheres(
            self.body_i, self.body_j, self.inverse_mass, self.normal, self.velocity,
            self.friction, self.tangents, self.slip, self.spin_response,
        )  # fmt: skip

    def delassus(self) -> NDArray[np.float64]:
        """Return the dense (n d, n d) Delassus matrix W = H^T M^-1 H, 1/kg; `problem().delassus()` is a sparse one.

        Contact by contact, along N, T1[, T2]. Without friction d = 1.
        """
        return self.problem().delassus().toarray()
