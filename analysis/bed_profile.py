# SPDX-License-Identifier: GPL-2.0-or-later
"""Bed height and packing fraction profile phi(z) of a bed of spheres.

The solid volume in each slab is the exact sphere-slab intersection, so the profile sums up to the
volume of the grains whatever the slab thickness. (Where grains overlap, the lens counts twice.)
In a planar run (all grains at one z) grains are discs, and phi is the covered share of the area.

    python bed_profile.py bed.dump --plane 0 0 0 0 0 1 --output bed_profile.png
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
AXES = "xyz"


@dataclass(frozen=True)
class Container:
    """The room of a bed.

    Attributes
    ----------
    area : float
        Cross-section; its width if planar.
    floor, ceiling : float
        Along the height axis, in dump coordinates.
    planar : bool
        Grains are discs.
    """

    area: float
    floor: float
    ceiling: float
    planar: bool = False

    def solid_below(self, height: Array, radius: Array, level: float) -> float:
        """Solid volume (area, if planar) below a level, from the exact caps of the cut grains."""
        depth = np.clip(level - (height - radius), 0.0, 2.0 * radius)
        if not self.planar:
            return float(np.sum(np.pi * depth**2 * (radius - depth / 3.0)))
        chord = np.sqrt(depth * (2.0 * radius - depth))
        angle = np.arccos(1.0 - depth / radius)
        return float(np.sum(radius**2 * angle - (radius - depth) * chord))


@dataclass(frozen=True)
class Profile:
    """Packing fraction per slab.

    Attributes
    ----------
    edges : ndarray, (s + 1,), float64
        Slab faces along the height axis, in dump coordinates.
    fraction : ndarray, (s,), float64
        Solid volume over slab volume.
    """

    edges: Array
    fraction: Array


@dataclass(frozen=True)
class BedHeight:
    """Heights above the floor, three ways, and the fraction of the inner bed.

    Attributes
    ----------
    top : float
        Top of the highest grain.
    volume_99 : float
        Level below which 99 % of the solid volume lies; one stray grain does not move it.
    centroid : float
        Twice the height of the centre of mass, exact for a uniform bed.
    fraction : float
        Packing fraction between 20 % and 80 % of `volume_99`, away from floor and surface.
    """

    top: float
    volume_99: float
    centroid: float
    fraction: float


def compute_container(
    bounds: Array,
    boundary: Sequence[str],
    planes: ArrayLike | None = None,
    axis: int = 2,
    planar: bool = False,
) -> Container:
    """Find cross-section, floor and ceiling: faces of the box, unless planes stand for them.

    Parameters
    ----------
    bounds : ndarray, (3, 2), float64
        Lower and upper box faces.
    boundary : sequence of 3 str
        LAMMPS' boundary letters, such as ``("pp", "pp", "ff")``.
    planes : array_like, (k, 6), optional
        Rows ``x y z nx ny nz`` with normals along an axis, pointing to the grains.
    axis : int
        Height axis.
    planar : bool
        Grains are discs, the cross-section is a width.

    Raises
    ------
    ValueError
        Height axis z in a planar run; an oblique plane; a side of the container that is only a
        shrink-wrapped box face.
    """
    if planar and axis == 2:
        raise ValueError("all grains have the same z, a profile along z is empty; give --axis y")
    faces = np.array(bounds, dtype=np.float64)
    given = np.zeros((3, 2), dtype=bool)
    for row in np.asarray([] if planes is None else planes, dtype=np.float64).reshape(-1, 6):
        along = np.flatnonzero(row[3:])
        if len(along) != 1:
            raise ValueError(f"plane normal {row[3:]} is oblique, a profile needs normals along x, y or z")
        side = int(row[3 + along[0]] < 0.0)
        faces[along[0], side] = row[along[0]]
        given[along[0], side] = True
    for c in range(3):
        wrapped = [s for s in (0, 1) if boundary[c][s] in "sm" and not given[c, s]]
        if wrapped and c != axis and not (planar and c == 2):
            raise ValueError(
                f"box face {AXES[c]}{('lo', 'hi')[wrapped[0]]} is shrink-wrapped, so it is no wall;"
                " give the walls with --plane x y z nx ny nz"
            )
    sides = np.delete(faces[:, 1] - faces[:, 0], [axis, 2] if planar else axis)
    floor, ceiling = (float(face) for face in faces[axis])
    return Container(float(np.prod(sides)), floor, ceiling, planar)


def compute_profile(
    height: Array,
    radius: Array,
    container: Container,
    n_slabs: int | None = None,
    periodic: bool = False,
) -> Profile:
    """Packing fraction in equal slabs from the floor to the highest grain.

    Parameters
    ----------
    height : ndarray, (n,), float64
        Positions along the height axis.
    radius : ndarray, (n,), float64
        Radii.
    container : Container
        Cross-section, floor and ceiling.
    n_slabs : int, optional
        Number of slabs. By default each is a third of the mean radius, but there are at most 300.
    periodic : bool
        The height axis is periodic: the slabs fill the box, and images of the grains count.

    Raises
    ------
    ValueError
        Less than one slab; no grain above the floor.
    """
    top = container.ceiling if periodic else float(np.max(height + radius))
    if n_slabs is None:
        n_slabs = int(np.clip(3.0 * (top - container.floor) / radius.mean(), 1, 300))
    if n_slabs < 1 or top <= container.floor:
        raise ValueError(
            f"{n_slabs} slabs from the floor at {container.floor:g} to the highest grain at"
            f" {top:g}: at least 1 slab and a floor below the grains are needed (--plane)"
        )
    edges = np.linspace(container.floor, top, n_slabs + 1)
    if periodic:
        length = container.ceiling - container.floor
        home = height - length * np.floor((height - container.floor) / length)
        height = np.concatenate([home - length, home, home + length])
        radius = np.tile(radius, 3)
    solid = np.diff([container.solid_below(height, radius, edge) for edge in edges])
    return Profile(edges, solid / (container.area * np.diff(edges)))


def compute_bed_height(height: Array, radius: Array, container: Container) -> BedHeight:
    """Measure the bed; parameters as in `compute_profile`."""
    volume = np.pi * radius**2 if container.planar else 4.0 / 3.0 * np.pi * radius**3
    low, high = container.floor, float(np.max(height + radius))
    top = high
    for _ in range(60):  # bisection: the volume below a level grows with the level
        middle = 0.5 * (low + high)
        below = container.solid_below(height, radius, middle)
        low, high = (middle, high) if below < 0.99 * volume.sum() else (low, middle)
    volume_99 = high - container.floor
    inner = container.floor + volume_99 * np.array([0.2, 0.8])
    below, above = (container.solid_below(height, radius, level) for level in inner)
    return BedHeight(
        top=top - container.floor,
        volume_99=volume_99,
        centroid=float(2.0 * (np.average(height, weights=volume) - container.floor)),
        fraction=(above - below) / (container.area * 0.6 * volume_99),
    )


def plot_bed_profile(
    ax: Axes, profile: Profile, bed: BedHeight | None = None, scale: float = 1.0, unit: str = "m"
) -> None:
    """Draw phi against the height above the floor; heights are multiplied by `scale`."""
    above = (profile.edges - profile.edges[0]) * scale
    ax.stairs(profile.fraction, above, orientation="horizontal", fill=True, color="C0", alpha=0.25)
    ax.stairs(profile.fraction, above, orientation="horizontal", color="C0", linewidth=1.6)
    if bed is not None:
        level = bed.volume_99 * scale
        ax.axhline(level, color="C1", linewidth=1.4, label=f"99 % of volume: {level:.3g} {unit}")
        ax.plot(
            [bed.fraction] * 2,
            [0.2 * level, 0.8 * level],
            color="C1",
            linestyle="--",
            linewidth=1.6,
            label=f"inner bed: $\\phi$ = {bed.fraction:.3f}",
        )
        # Above the axes: the profile fills them from edge to edge.
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False)
    ax.set_xlabel(r"packing fraction $\phi$")
    ax.set_ylabel(f"height above the floor ({unit})")
    ax.set_xlim(0.0, max(0.75, 1.05 * float(profile.fraction.max())))
    top = above[-1] if bed is None else min(above[-1], 1.3 * bed.volume_99 * scale)
    ax.set_ylim(0.0, 1.04 * top)


def main(words: Sequence[str]) -> None:
    """Command line."""
    from chart import choose_length_unit, new_figure, save_figure
    from command_line import add_plane_option, new_parser, positive_int, print_table
    from packing import Packing

    parser = new_parser(__doc__, "bed_profile.png")
    parser.add_argument("--axis", choices=AXES, default="z", help="height axis [z]")
    parser.add_argument("--slabs", type=positive_int, help="number of slabs [a third of a radius each]")
    add_plane_option(parser, "floor or side wall, where it is not the box face")
    arguments = parser.parse_args(words)
    frame = Packing(arguments.dump).frame(arguments.frame)
    axis = AXES.index(arguments.axis)
    height = frame.x[:, axis]
    planar = bool(np.ptp(frame.x[:, 2]) == 0.0) and len(height) > 1
    container = compute_container(frame.bounds, frame.boundary, arguments.planes, axis, planar)
    cyclic = bool(frame.periodic[axis])
    profile = compute_profile(height, frame.radius, container, arguments.slabs, cyclic)
    bed = None if cyclic else compute_bed_height(height, frame.radius, container)
    unit = choose_length_unit(arguments.length_unit, frame.radius)
    rows = [
        ("grains", str(len(height))),
        ("mean phi in the slabs", f"{profile.fraction.mean():.4f}"),
    ]
    if bed is not None:
        rows[1:] = [
            (f"top of the highest grain ({unit.name})", f"{bed.top * unit.factor:.4g}"),
            (f"99 % of the volume below ({unit.name})", f"{bed.volume_99 * unit.factor:.4g}"),
            (f"twice the centre of mass ({unit.name})", f"{bed.centroid * unit.factor:.4g}"),
            ("phi of the inner bed (20 to 80 %)", f"{bed.fraction:.4f}"),
        ]
    print_table(f"Bed profile, step {frame.step}", rows)
    figure, ax = new_figure(5.4, 5.0)
    plot_bed_profile(ax, profile, bed, unit.factor, unit.name)
    save_figure(figure, arguments.output)


if __name__ == "__main__":
    from command_line import run

    raise SystemExit(run(main))
