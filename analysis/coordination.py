# SPDX-License-Identifier: GPL-2.0-or-later
"""Coordination number: contacts per grain, with and without rattlers.

Two grains touch if their gap is at most TOLERANCE times the mean radius of the pair; a grain and a
wall, if it is at most TOLERANCE times the grain's radius. Rattlers are grains with too few contacts
to be held in place (4 in space and 3 in a plane without friction; with friction, give
--rattler-below 2); they are removed again and
again, since removing one may free another.

    python coordination.py bed.dump --plane 0 0 0 0 0 1 --output coordination.png
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from contact_pairs import Contacts, find_grain_contacts, find_wall_contacts, is_planar
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Coordination:
    """Contacts per grain.

    Attributes
    ----------
    contacts : ndarray, (n,), intp
        Contacts of each grain with grains and walls.
    rattler : ndarray, (n,), bool
        Grains without enough contacts.
    mean : float
        Mean of `contacts`.
    mean_backbone : float
        Mean over the grains that are no rattlers, of contacts among these and with walls; nan if
        all are rattlers.
    n_grain_contacts, n_wall_contacts : int
        Contacts between grains, each counted once, and with walls.
    """

    contacts: NDArray[np.intp]
    rattler: NDArray[np.bool_]
    mean: float
    mean_backbone: float
    n_grain_contacts: int
    n_wall_contacts: int


def compute_coordination(
    x: Array,
    radius: Array,
    bounds: Array,
    periodic: NDArray[np.bool_],
    planes: ArrayLike | None = None,
    tolerance: float = 1e-3,
    rattler_below: int | None = None,
) -> Coordination:
    """Count contacts.

    Parameters
    ----------
    x : ndarray, (n, 3), float64
        Positions.
    radius : ndarray, (n,), float64
        Radii.
    bounds : ndarray, (3, 2), float64
        Lower and upper box faces.
    periodic : ndarray, (3,), bool
        Periodic axes.
    planes : array_like, (k, 6), optional
        Walls as rows ``x y z nx ny nz``, the normal pointing to the grains.
    tolerance : float
        Largest gap that counts as a contact, relative to the mean radius of the pair.
    rattler_below : int, optional
        A grain with fewer contacts is a rattler. Default 4, or 3 if all grains have the same z.
    """
    if rattler_below is None:
        rattler_below = 3 if is_planar(x) else 4
    grains = find_grain_contacts(x, radius, bounds, periodic, tolerance)
    walls = find_wall_contacts(x, radius, planes, tolerance)
    together = grains.joined(walls)
    contacts = _count(together, np.ones(len(x), dtype=bool))
    alive = np.ones(len(x), dtype=bool)
    while True:
        backbone = _count(together, alive)
        freed = alive & (backbone < rattler_below)
        if not freed.any():
            break
        alive &= ~freed
    return Coordination(
        contacts=contacts,
        rattler=~alive,
        mean=float(contacts.mean()),
        mean_backbone=float(backbone[alive].mean()) if alive.any() else float("nan"),
        n_grain_contacts=len(grains.i),
        n_wall_contacts=len(walls.i),
    )


def _count(contacts: Contacts, alive: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Contacts of each grain among the grains that are alive, and with walls."""
    wall = contacts.j < 0
    held = alive[contacts.i] & (wall | alive[np.where(wall, 0, contacts.j)])
    number = np.bincount(contacts.i[held], minlength=len(alive))
    return number + np.bincount(contacts.j[held & ~wall], minlength=len(alive))


def plot_coordination(ax: Axes, coordination: Coordination) -> None:
    """Draw the histogram of contacts per grain, rattlers apart, and the two means."""
    bins = np.arange(coordination.contacts.max() + 2) - 0.5
    held = coordination.contacts[~coordination.rattler]
    loose = coordination.contacts[coordination.rattler]
    ax.hist(
        [held, loose],
        bins=list(bins),
        stacked=True,
        rwidth=0.82,
        color=["C0", "#aab7b8"],
        label=["held grains", f"rattlers ({len(loose)} of {len(coordination.contacts)})"],
    )
    ax.axvline(coordination.mean, color="C1", linestyle="--", label=f"mean {coordination.mean:.2f}")
    if len(held):
        ax.axvline(
            coordination.mean_backbone,
            color="C1",
            label=f"mean without rattlers {coordination.mean_backbone:.2f}",
        )
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False)
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    ax.set_xlim(bins[0] - 0.2, bins[-1] + 0.2)
    ax.grid(axis="x", visible=False)
    ax.set_xlabel("contacts per grain")
    ax.set_ylabel("number of grains")


def main(words: Sequence[str]) -> None:
    """Command line."""
    from chart import new_figure, save_figure
    from command_line import add_plane_option, new_parser, print_table
    from packing import Packing

    parser = new_parser(__doc__, "coordination.png")
    parser.add_argument("--tolerance", type=float, default=1e-3, help="gap over mean radius [1e-3]")
    parser.add_argument(
        "--rattler-below",
        type=int,
        metavar="N",
        help="rattlers have fewer contacts than N [4 or 3]",
    )
    add_plane_option(parser, "wall")
    arguments = parser.parse_args(words)
    frame = Packing(arguments.dump).frame(arguments.frame)
    coordination = compute_coordination(
        frame.x,
        frame.radius,
        frame.bounds,
        frame.periodic,
        arguments.planes,
        arguments.tolerance,
        arguments.rattler_below,
    )
    print_table(
        f"Coordination, step {frame.step}, gap <= {arguments.tolerance:g} r",
        [
            ("grains", str(len(coordination.contacts))),
            ("contacts between grains", str(coordination.n_grain_contacts)),
            ("contacts with walls", str(coordination.n_wall_contacts)),
            ("rattlers", str(int(coordination.rattler.sum()))),
            ("mean contacts per grain", f"{coordination.mean:.3f}"),
            ("mean without rattlers", f"{coordination.mean_backbone:.3f}"),
            ("most contacts of a grain", str(int(coordination.contacts.max()))),
        ],
    )
    if coordination.rattler.all():
        print("all grains are rattlers; with friction, give --rattler-below 2")
    figure, ax = new_figure()
    plot_coordination(ax, coordination)
    save_figure(figure, arguments.output)


if __name__ == "__main__":
    from command_line import run

    raise SystemExit(run(main))
