# SPDX-License-Identifier: GPL-2.0-or-later
"""A LAMMPS dump of spheres as an MDAnalysis Universe with float64 arrays per frame.

Write the dump with::

    dump d all custom 1000 FILE id type x y z vx vy vz omegax omegay omegaz radius mass
    dump_modify d sort id format float %.17g

Needed: ``id x y z radius`` (``xu yu zu`` will do for ``x y z``); the others as an analysis asks.
``%.17g`` gives back every bit of a float64 (``%20.16g`` is off by up to 5e-16 of the value).
LAMMPS' own default, ``%g``, keeps 6 digits: overlaps below 1e-4 of a radius are then rounding.

What MDAnalysis 2.11 does with such a file, and what is done about it here:

- ``positions`` and ``velocities`` are float32, and positions are shifted by (xlo, ylo, zlo) in
  every frame. A column that is listed in ``additional_columns``, x and vx too, is float64 and
  unshifted: every array here comes from there.
- The box is float32 lengths, without origin and boundary letters: `read_headers` keeps them.
- Masses are 1 unless the dump has a ``mass`` column; the radius is known only as a column.
- ``dt`` is the time step of LAMMPS, not the time between frames: time = step * dt.
- The atom count must stay constant; ``dump_modify units yes`` or ``time yes`` cannot be read.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import MDAnalysis
import numpy as np
from dump_header import DUMP_COMMAND, FrameHeader, read_headers
from numpy.typing import NDArray

Array = NDArray[np.float64]

_VECTORS = {
    "v": ("vx", "vy", "vz"),
    "omega": ("omegax", "omegay", "omegaz"),
}
_NAMES = {"x": "positions", "radius": "radii", "v": "velocities", "omega": "angular velocities", "mass": "masses"}


@dataclass(frozen=True)
class Frame:
    """Grains of one frame, ordered by id; units are those of the dump (m, kg, s for ``units si``).

    Attributes
    ----------
    step : int
        LAMMPS time step.
    time : float
        ``step * dt``; the step itself if no dt was given.
    x : ndarray, (n, 3), float64
        Positions, in the coordinates of LAMMPS (not shifted).
    radius : ndarray, (n,), float64
        Radii.
    v, omega : ndarray, (n, 3), float64, or None
        Velocities and angular velocities; None if the dump lacks the columns.
    mass : ndarray, (n,), float64, or None
        Masses; None if the dump lacks the column.
    bounds : ndarray, (3, 2), float64
        Lower and upper box faces.
    boundary : tuple of str
        LAMMPS' boundary letters per axis, such as ``("pp", "pp", "ff")``.
    """

    step: int
    time: float
    x: Array
    radius: Array
    v: Array | None
    omega: Array | None
    mass: Array | None
    bounds: Array
    boundary: tuple[str, str, str]

    @property
    def periodic(self) -> NDArray[np.bool_]:
        """Which axes are periodic, (3,)."""
        return np.array([letters == "pp" for letters in self.boundary])


class Packing:
    """A dump of spheres, read frame by frame.

    Parameters
    ----------
    path : str or Path
        Text dump of LAMMPS (``dump custom``), plain or gzipped.
    dt : float, optional
        Time step of the LAMMPS run. Without it `Frame.time` counts steps.

    Attributes
    ----------
    universe : MDAnalysis.Universe
        With masses and radii of the first frame as topology attributes.
    headers : list of FrameHeader
        One for each complete frame.

    Raises
    ------
    FileNotFoundError
        There is no such file.
    ValueError
        A needed column is missing, or `read_headers` refuses the file.
    """

    def __init__(self, path: str | Path, dt: float | None = None) -> None:
        self.path = Path(path)
        self.dt = dt
        self.headers: list[FrameHeader] = read_headers(path)
        self.columns = self.headers[0].columns
        self._position = next(
            (names for names in (("x", "y", "z"), ("xu", "yu", "zu")) if self.has(*names)),
            ("x", "y", "z"),
        )
        self.require("id", *self._position, "radius")
        try:
            self.universe = self._load()
        except (ValueError, IndexError, EOFError) as error:
            raise ValueError(f"'{self.path}' is damaged in frame 0 (step {self.headers[0].step}): {error}") from error

    def _load(self) -> MDAnalysis.Universe:
        wanted = [*self._position, "radius", "mass", *_VECTORS["v"], *_VECTORS["omega"]]
        with warnings.catch_warnings():
            # "Guessed all Masses to 1.0": Frame.mass is None then, so nobody is misled.
            warnings.filterwarnings("ignore", message="Guessed all Masses")
            universe = MDAnalysis.Universe(
                str(self.path),
                topology_format="LAMMPSDUMP",
                format="LAMMPSDUMP",
                dt=1.0 if self.dt is None else self.dt,
                additional_columns=[name for name in wanted if name in self.columns],
                to_guess=(),
            )
        universe.add_TopologyAttr("radii", universe.trajectory.ts.data["radius"])
        return universe

    def __len__(self) -> int:
        return len(self.headers)

    def __iter__(self) -> Iterator[Frame]:
        return (self.frame(number) for number in range(len(self)))

    @property
    def n_grains(self) -> int:
        """Number of grains, the same in each frame."""
        return self.headers[0].n_grains

    def has(self, *names: str) -> bool:
        """Whether the dump has all these columns."""
        return all(name in self.columns for name in names)

    def require(self, *names: str) -> None:
        """Raise ValueError, with the dump command to use, unless the dump has these columns."""
        missing = [name for name in names if name not in self.columns]
        if missing:
            raise ValueError(
                f"'{self.path}' lacks the columns {' '.join(missing)}; it has"
                f" {' '.join(self.columns)}. Write the dump with:\n{DUMP_COMMAND}"
            )

    def frame(self, number: int) -> Frame:
        """Read one frame.

        Parameters
        ----------
        number : int
            From 0; negative numbers count from the end, -1 is the last complete frame.

        Raises
        ------
        ValueError
            There is no such frame; it cannot be read, or has values that are not finite numbers, as of a
            run that exploded.
        """
        count = len(self)
        if not -count <= number < count:
            raise ValueError(
                f"frame {number} asked for, '{self.path}' has frames 0 to {count - 1} (or -1 for the last)"
            )
        header = self.headers[number]
        try:
            data = self.universe.trajectory[number % count].data
        except (ValueError, IndexError, KeyError, EOFError) as error:
            raise ValueError(
                f"'{self.path}' is damaged in frame {number % count} (step {header.step}): {error}"
            ) from error
        frame = Frame(
            step=header.step,
            time=float(header.step if self.dt is None else header.step * self.dt),
            x=np.column_stack([data[name] for name in self._position]),
            radius=data["radius"].copy(),
            v=self._vector("v", data),
            omega=self._vector("omega", data),
            mass=data["mass"].copy() if self.has("mass") else None,
            bounds=header.bounds,
            boundary=header.boundary,
        )
        self._require_finite(frame, number % count)
        return frame

    def _require_finite(self, frame: Frame, number: int) -> None:
        """Refuse values by which every number of an analysis would be wrong without a word."""
        for name in ("x", "radius", "v", "omega", "mass"):
            values = getattr(frame, name)
            if values is None:
                continue
            wrong = np.count_nonzero(~np.isfinite(values.reshape(self.n_grains, -1)).all(axis=1))
            if wrong:
                raise ValueError(
                    f"'{self.path}': frame {number} (step {frame.step}) has {_NAMES[name]} of {wrong} of"
                    f" {self.n_grains} grains that are not finite numbers: the run exploded before. Look at"
                    " frames before it (--frame), or at a dump that ends there"
                )

    def _vector(self, name: str, data: dict[str, Array]) -> Array | None:
        columns = _VECTORS[name]
        return np.column_stack([data[c] for c in columns]) if self.has(*columns) else None


def position_digits(x: Array) -> int:
    """Count the significant decimal digits that the positions carry, from 6 to 17.

    6 tells of a dump written without ``dump_modify format float %.17g``.

    Parameters
    ----------
    x : ndarray, (n, 3), float64
        Positions as read.
    """
    values = x[x != 0.0]
    scale = 10.0 ** np.floor(np.log10(np.abs(values)))
    mantissa = values / scale
    for digits in range(6, 17):
        rest = np.abs(mantissa - np.round(mantissa, digits - 1))
        if np.all(rest < 4e-15):
            return digits
    return 17
