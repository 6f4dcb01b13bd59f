"""Positions and velocities of a LAMMPS scene, kept to start again from."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class SavedState:
    """Positions x (n, 3) in m and velocities v (n, 3) in m/s, in the order of the tags."""

    x: NDArray[np.float64]
    v: NDArray[np.float64]

    @classmethod
    def of(cls, lmp: Any) -> SavedState:
        """Copy the state out of LAMMPS."""
        order = _order(lmp)
        return cls(*(lmp.numpy.extract_atom(name)[: len(order)][order] for name in ("x", "v")))

    def put_back(self, lmp: Any) -> None:
        """Write the state into LAMMPS, where the same grains must live."""
        order = _order(lmp)
        for name, values in (("x", self.x), ("v", self.v)):
            lmp.numpy.extract_atom(name)[order] = values

    def save(self, path: Path) -> None:
        """Write the state to a file, making its folder if needed."""
        path.parent.mkdir(parents=True, exist_ok=True)
        np.savez(path, x=self.x, v=self.v)

    @classmethod
    def load(cls, path: Path) -> SavedState:
        """Read what `save` has written."""
        with np.load(path) as file:
            return cls(file["x"], file["v"])


def _order(lmp: Any) -> NDArray[np.intp]:
    return np.argsort(lmp.numpy.extract_atom("id")[: lmp.extract_global("nlocal")])
