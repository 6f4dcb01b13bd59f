# SPDX-License-Identifier: GPL-2.0-or-later
"""Positions, velocities and spins of a LAMMPS scene, kept to start again from."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

ARRAYS = ("x", "v", "omega")


@dataclass(frozen=True)
class SavedState:
    """Positions x (n, 3) in m, velocities v in m/s, angular velocities omega in rad/s, in the order of the tags."""

    x: NDArray[np.float64]
    v: NDArray[np.float64]
    omega: NDArray[np.float64]

    @classmethod
    def of(cls, lmp: Any) -> SavedState:
        """Copy the state out of LAMMPS."""
        order = _order(lmp)
        return cls(*(lmp.numpy.extract_atom(name)[: len(order)][order] for name in ARRAYS))

    def put_back(self, lmp: Any) -> None:
        """Write the state into LAMMPS, where the same grains must live."""
        order = _order(lmp)
        for name in ARRAYS:
            lmp.numpy.extract_atom(name)[order] = getattr(self, name)

    def save(self, path: Path) -> None:
        """Write the state to a file, making its folder if needed."""
        path.parent.mkdir(parents=True, exist_ok=True)
        np.savez(path, **{name: getattr(self, name) for name in ARRAYS})

    @classmethod
    def load(cls, path: Path) -> SavedState:
        """Read what `save` has written."""
        with np.load(path) as file:
            return cls(*(file[name] if name in file else np.zeros_like(file["x"]) for name in ARRAYS))


def _order(lmp: Any) -> NDArray[np.intp]:
    return np.argsort(lmp.numpy.extract_atom("id")[: lmp.extract_global("nlocal")])
