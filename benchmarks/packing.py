# SPDX-License-Identifier: GPL-2.0-or-later
"""How much of a layer grains fill."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def volume_fraction(z: Array, radii: Array, area: float, low: float, high: float) -> float:
    """Return the share of the layer between two heights (m) that spheres at heights z fill, cut where it ends."""

    def below(height: float) -> float:
        deep = np.clip(height - (z - radii), 0, 2 * radii)
        return float((np.pi * deep**2 * (3 * radii - deep) / 3).sum())

    return (below(high) - below(low)) / (area * (high - low))
