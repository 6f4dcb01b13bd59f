"""The contact problem of one step, as a Python solver is handed it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class ContactSystem:
    """Find impulses p with v = W p + velocity >= 0, p >= 0 and v p = 0 for every contact.

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
    start : (n,) float, N s
        Impulses of the warm start, 0 without.
    velocity : (n,) float, m/s
        Normal relative velocity without impulses, plus bias.
    """

    body_i: NDArray[np.int32]
    body_j: NDArray[np.int32]
    inverse_mass: NDArray[np.float64]
    normal: NDArray[np.float64]
    gap: NDArray[np.float64]
    bias: NDArray[np.float64]
    start: NDArray[np.float64]
    velocity: NDArray[np.float64]

    def __len__(self) -> int:
        """Return the number of contacts."""
        return len(self.gap)

    def delassus(self) -> NDArray[np.float64]:
        """Return the dense (n, n) Delassus matrix W = H^T M^-1 H of the normal directions, 1/kg."""
        bodies = len(self.inverse_mass)
        h = np.zeros((3 * bodies, len(self)))
        columns = np.arange(len(self))
        for body, sign in ((self.body_i, 1.0), (self.body_j, -1.0)):
            moves = body >= 0
            for d in range(3):
                h[3 * body[moves] + d, columns[moves]] += sign * self.normal[moves, d]
        return h.T @ (np.repeat(self.inverse_mass, 3)[:, None] * h)
