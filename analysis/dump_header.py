# SPDX-License-Identifier: GPL-2.0-or-later
"""The headers of a LAMMPS text dump: step, atom count, box and column names of each frame.

MDAnalysis keeps a box as three float32 lengths and drops its origin and its boundary letters, and
it trusts that every frame has the layout and the atom count of the first. This scan keeps what is
dropped in float64, and turns each broken promise into an error that names the remedy.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

import numpy as np
from MDAnalysis.lib.util import anyopen
from numpy.typing import NDArray

DUMP_COMMAND = (
    "dump d all custom 1000 FILE id type x y z vx vy vz omegax omegay omegaz radius mass\n"
    "dump_modify d sort id format float %.17g"
)


@dataclass(frozen=True)
class FrameHeader:
    """What stands above the atoms of one frame.

    Attributes
    ----------
    step : int
        LAMMPS time step.
    n_grains : int
        Number of atoms.
    bounds : ndarray, (3, 2), float64
        Lower and upper box face along x, y, z, in the length unit of the dump.
    boundary : tuple of str
        LAMMPS' letters for the lower and upper face of each axis, such as ``("pp", "pp", "fs")``.
    columns : tuple of str
        Names of the per-atom columns.
    """

    step: int
    n_grains: int
    bounds: NDArray[np.float64]
    boundary: tuple[str, str, str]
    columns: tuple[str, ...]


def read_headers(path: str | Path) -> list[FrameHeader]:
    """Read the header of every complete frame.

    A last frame that is cut short (a run still going, or killed) is left out.

    Raises
    ------
    FileNotFoundError
        There is no such file.
    ValueError
        No complete frame; a header that MDAnalysis cannot read (``ITEM: UNITS``, ``ITEM: TIME``);
        a tilted box; an atom count that changes from frame to frame; a file that is damaged, such as
        one that a killed run left and another went on with.
    """
    if not Path(path).is_file():
        raise FileNotFoundError(f"no dump file at '{path}'; write one with:\n{DUMP_COMMAND}")
    try:
        with anyopen(str(path), "rt") as stream:
            headers = list(_complete_frames(stream, path))
    except (UnicodeDecodeError, EOFError, zlib.error) as error:
        raise ValueError(f"'{path}' is damaged, or no text dump ({error}); write it or get it again") from error
    if not headers:
        raise ValueError(f"'{path}' holds 0 complete frames, at least 1 is needed; let the run end")
    first = headers[0]
    for number, header in enumerate(headers):
        if header.n_grains != first.n_grains:
            raise ValueError(
                f"'{path}': frame {number} (step {header.step}) has {header.n_grains} grains, frame"
                f" 0 has {first.n_grains}; MDAnalysis needs one count. Start the dump after the"
                " last grain is inserted, and see that none is lost"
            )
        if header.columns != first.columns:
            raise ValueError(
                f"'{path}': frame {number} has columns {' '.join(header.columns)}, frame 0 has"
                f" {' '.join(first.columns)}; write each dump to a file of its own"
            )
    return headers


def _complete_frames(stream: TextIO, path: str | Path) -> Iterator[FrameHeader]:
    while line := stream.readline():
        if not line.startswith("ITEM:"):
            raise _damaged(path, f"'{line.strip()[:40]}' stands where a frame should start")
        if not line.startswith("ITEM: TIMESTEP"):
            raise ValueError(
                f"'{path}': a frame starts with '{line.strip()[:40]}' instead of 'ITEM: TIMESTEP'."
                " MDAnalysis reads text dumps without units and time:"
                " dump_modify ID units no time no"
            )
        head = [stream.readline() for _ in range(8)]
        if not head[-1].endswith("\n"):
            return
        header = _parse_header(head, path)
        last = head[-1]
        for number in range(header.n_grains):
            last = stream.readline()
            if last.endswith("\n") and len(last.split()) != len(header.columns):
                raise _damaged(
                    path,
                    f"line {number + 1} of the {header.n_grains} grains of step {header.step} is"
                    f" '{last.strip()[:40]}', not {len(header.columns)} numbers",
                )
        if not last.endswith("\n"):
            return
        yield header


def _parse_header(head: list[str], path: str | Path) -> FrameHeader:
    """Parse the eight lines that follow ``ITEM: TIMESTEP``."""
    boundary = head[3].split()[3:]
    if len(boundary) != 3:
        raise ValueError(
            f"'{path}': box line '{head[3].strip()}' is of a tilted box, only orthogonal ones are"
            " handled; use region block (not prism) in create_box"
        )
    if head[1].split() != ["ITEM:", "NUMBER", "OF", "ATOMS"] or head[7].split()[:1] != ["ITEM:"]:
        raise ValueError(
            f"'{path}': the header of step {head[0].strip()} has unknown lines"
            f" ('{head[1].strip()}'); write it with dump custom and dump_modify units no time no"
        )
    try:
        step, n_grains = int(head[0]), int(head[2])
        bounds = np.array([[float(word) for word in line.split()] for line in head[4:7]])
    except ValueError as error:
        raise _damaged(path, f"in the header of step {head[0].strip()[:40]}: {error}") from error
    if bounds.shape != (3, 2) or n_grains < 0:
        raise _damaged(path, f"the header of step {step} has no box of 3 x 2 numbers, or {n_grains} grains")
    if not np.isfinite(bounds).all():
        raise ValueError(
            f"'{path}': the box of step {step} is not of finite numbers: the run exploded before; take the dump up to"
            " there"
        )
    return FrameHeader(
        step=step,
        n_grains=n_grains,
        bounds=bounds,
        boundary=(boundary[0], boundary[1], boundary[2]),
        columns=tuple(head[7].split()[2:]),
    )


def _damaged(path: str | Path, what: str) -> ValueError:
    return ValueError(
        f"'{path}' is damaged: {what}. Two runs may have written it, one after the other was killed: cut it there, and"
        " write each dump to a file of its own"
    )
