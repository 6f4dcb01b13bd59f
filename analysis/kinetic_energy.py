# SPDX-License-Identifier: GPL-2.0-or-later
"""Kinetic energy of the grains against time, on a logarithmic axis.

Masses come from the column ``mass``, or from --density and the radii of spheres. The energy of
rotation is added where the dump has ``omegax omegay omegaz``: 1/2 I omega^2 with I = 2/5 m r^2 of
spheres, or 1/2 m r^2 of discs. Discs are what fix nscd makes of grains with friction in `dimension
2`: by default they are taken for discs where all are at one z, and the table says so; --inertia
chooses.

    python kinetic_energy.py bed.dump --dt 1e-4 --output kinetic_energy.png
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from packing import Packing

Array = NDArray[np.float64]

INERTIA = {"sphere": 2 / 5, "disc": 1 / 2}  # over m r^2


@dataclass(frozen=True)
class EnergyHistory:
    """Kinetic energy per frame.

    Attributes
    ----------
    time : ndarray, (f,), float64
        Time of each frame (or its step).
    translational : ndarray, (f,), float64
        Sum of 1/2 m v^2.
    rotational : ndarray, (f,), float64, or None
        Sum of 1/2 I omega^2; None if the dump has no omega.
    inertia : str
        A name of `INERTIA`: what the grains were taken for.
    """

    time: Array
    translational: Array
    rotational: Array | None
    inertia: str = "sphere"


def compute_translational_energy(v: Array, mass: Array) -> float:
    """Sum of 1/2 m v^2 over the grains; v (n, 3), mass (n,)."""
    return float(0.5 * np.sum(mass * np.einsum("nc,nc->n", v, v)))


def compute_rotational_energy(omega: Array, mass: Array, radius: Array, inertia: str = "sphere") -> float:
    """Sum of 1/2 I omega^2 over the grains, I by a name of `INERTIA`; omega (n, 3), mass and radius (n,)."""
    return float(0.5 * INERTIA[inertia] * np.sum(mass * radius**2 * np.einsum("nc,nc->n", omega, omega)))


def compute_mass(radius: Array, density: float) -> Array:
    """Mass of solid spheres, (n,)."""
    return np.asarray(density * 4.0 / 3.0 * np.pi * radius**3, dtype=np.float64)


def compute_energy_history(
    packing: Packing, density: float | None = None, every: int = 1, inertia: str = "auto"
) -> EnergyHistory:
    """Kinetic energy of each `every`-th frame of a dump.

    Parameters
    ----------
    packing : Packing
        The dump.
    density : float, optional
        For dumps without a mass column; it takes precedence over the column.
    every : int
        Stride over frames.
    inertia : str
        A name of `INERTIA`, or ``"auto"``: discs where all grains of the first frame are at one z.

    Raises
    ------
    ValueError
        No velocities in the dump; neither masses nor a density.
    """
    packing.require("vx", "vy", "vz")
    if density is None and not packing.has("mass"):
        raise ValueError(f"'{packing.path}' has no column mass: add it to the dump command, or give --density")
    if inertia == "auto":
        z = packing.frame(0).x[:, 2]
        inertia = "disc" if len(z) > 1 and np.ptp(z) == 0.0 else "sphere"
    time, translational, rotational = [], [], []
    for number in range(0, len(packing), every):
        frame = packing.frame(number)
        mass = frame.mass if density is None else compute_mass(frame.radius, density)
        assert frame.v is not None and mass is not None  # required above
        time.append(frame.time)
        translational.append(compute_translational_energy(frame.v, mass))
        if frame.omega is not None:
            rotational.append(compute_rotational_energy(frame.omega, mass, frame.radius, inertia))
    turning = np.array(rotational) if rotational else None
    return EnergyHistory(np.array(time), np.array(translational), turning, inertia)


def plot_kinetic_energy(
    ax: Axes,
    time: Array,
    translational: Array,
    rotational: Array | None = None,
    time_label: str = "time (s)",
    energy_unit: str = "J",
) -> None:
    """Draw energies against time; zeros, which a logarithmic axis lacks, are left out."""
    curves = [("translational", translational, "C0")]
    if rotational is not None and np.any(rotational > 0.0):
        curves.append(("rotational", rotational, "C1"))
    for name, values, color in curves:
        positive = np.where(values > 0.0, values, np.nan)
        ax.plot(time, positive, color=color, label=name, marker="." if len(time) < 30 else "")
    if all(np.any(values > 0.0) for _, values, _ in curves):
        ax.set_yscale("log")
    if len(curves) > 1:
        ax.legend(loc="best", frameon=False)
    ax.set_xlabel(time_label)
    ax.set_ylabel(f"kinetic energy ({energy_unit})")


def main(words: Sequence[str]) -> None:
    """Command line."""
    from chart import new_figure, save_figure
    from command_line import add_time_options, new_parser, print_table
    from packing import Packing

    parser = new_parser(__doc__, "kinetic_energy.png", "frame shown in the table")
    add_time_options(parser)
    parser.add_argument("--density", type=float, help="density of the grains in kg/m^3")
    parser.add_argument(
        "--inertia", choices=["auto", *INERTIA], default="auto", help="2/5 m r^2, or 1/2 m r^2; see above [auto]"
    )
    parser.add_argument("--energy-unit", default="J", help="unit of m v^2 in the dump [J]")
    arguments = parser.parse_args(words)
    packing = Packing(arguments.dump, dt=arguments.dt)
    frame = packing.frame(arguments.frame)
    history = compute_energy_history(packing, arguments.density, arguments.every, arguments.inertia)
    shown = int(np.argmin(np.abs(history.time - frame.time)))
    peak = int(np.argmax(history.translational))
    unit = "step" if packing.dt is None else "time (s)"
    rows = [
        ("grains", str(packing.n_grains)),
        ("frames", str(len(history.time))),
        (f"translational ({arguments.energy_unit})", f"{history.translational[shown]:.6e}"),
    ]
    if history.rotational is not None:
        rows.append((f"rotational ({arguments.energy_unit})", f"{history.rotational[shown]:.6e}"))
        rows.append(("  of", f"{history.inertia}s"))
    rows += [
        (f"largest translational ({arguments.energy_unit})", f"{history.translational[peak]:.6e}"),
        (f"  at {unit}", f"{history.time[peak]:g}"),
    ]
    print_table(f"Kinetic energy, step {frame.step}", rows)
    figure, ax = new_figure()
    plot_kinetic_energy(ax, history.time, history.translational, history.rotational, unit, arguments.energy_unit)
    save_figure(figure, arguments.output)


if __name__ == "__main__":
    from command_line import run

    raise SystemExit(run(main))
