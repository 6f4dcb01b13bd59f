# SPDX-License-Identifier: GPL-2.0-or-later
"""Overlap of grains over the radius: distribution in one frame, largest and mean over all frames.

The overlap is related to the smaller radius of the pair (to the grain's own radius at a wall). It
is computed from float64 positions; a dump that was written with LAMMPS' default format has 6 digits
and gets a warning, since its overlaps are rounding.

    python overlap.py bed.dump --plane 0 0 0 0 0 1 --dt 1e-4 --output overlap.png
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from contact_pairs import find_grain_contacts, find_wall_contacts
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from packing import Frame

Array = NDArray[np.float64]


@dataclass(frozen=True)
class OverlapHistory:
    """Overlaps over frames, relative to the radius.

    Attributes
    ----------
    time : ndarray, (f,), float64
        Time of each frame (or its step).
    largest, mean : ndarray, (f,), float64
        Over the overlapping pairs and walls of the frame; 0 if none overlap.
    count : ndarray, (f,), intp
        Number of overlapping pairs and walls.
    """

    time: Array
    largest: Array
    mean: Array
    count: NDArray[np.intp]


def compute_overlaps(
    x: Array,
    radius: Array,
    bounds: Array,
    periodic: NDArray[np.bool_],
    planes: ArrayLike | None = None,
) -> Array:
    """Overlap / radius of each overlapping pair and wall contact, (m,), all positive.

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
    """
    grains = find_grain_contacts(x, radius, bounds, periodic)
    walls = find_wall_contacts(x, radius, planes)
    pairs = -grains.gap / np.minimum(radius[grains.i], radius[grains.j])
    relative = np.concatenate([pairs, -walls.gap / radius[walls.i]])
    return relative[relative > 0.0]


def compute_resolution(x: Array, radius: Array, digits: int = 17) -> float:
    """Smallest overlap / radius that these positions can tell from rounding.

    Parameters
    ----------
    x, radius : ndarray
        Positions (n, 3) and radii (n,).
    digits : int
        Significant decimal digits of the positions in the file.
    """
    relative = max(10.0 ** (1 - digits), 2.0 * float(np.finfo(np.float64).eps))
    return float(relative * np.abs(x).max() / radius.min())


def compute_overlap_history(frames: Sequence[Frame] | Any, planes: ArrayLike | None = None) -> OverlapHistory:
    """Largest and mean overlap of each frame; takes any iterable of `Frame`."""
    time, largest, mean, count = [], [], [], []
    for frame in frames:
        overlaps = compute_overlaps(frame.x, frame.radius, frame.bounds, frame.periodic, planes)
        time.append(frame.time)
        largest.append(overlaps.max(initial=0.0))
        mean.append(overlaps.mean() if len(overlaps) else 0.0)
        count.append(len(overlaps))
    return OverlapHistory(np.array(time), np.array(largest), np.array(mean), np.array(count, dtype=np.intp))


def plot_overlap_distribution(ax: Axes, overlaps: Array) -> None:
    """Draw the histogram of overlap / radius on a logarithmic axis."""
    ax.set_xlabel("overlap / radius")
    ax.set_ylabel("number of contacts")
    if not len(overlaps):
        ax.text(0.5, 0.5, "no overlap in this frame", transform=ax.transAxes, ha="center")
        return
    low = np.floor(np.log10(np.quantile(overlaps, 0.01)))
    high = np.ceil(np.log10(overlaps.max() * 1.0001))
    bins = np.logspace(low, high, int(8 * (high - low)) + 1)
    ax.hist(np.maximum(overlaps, bins[0]), bins=list(bins), color="C0", rwidth=0.92)
    ax.set_xscale("log")
    ax.axvline(overlaps.mean(), color="C1", linestyle="--", label=f"mean {overlaps.mean():.1e}")
    ax.axvline(overlaps.max(), color="C1", label=f"largest {overlaps.max():.1e}")
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False)


def plot_overlap_history(ax: Axes, history: OverlapHistory, time_label: str = "time (s)") -> None:
    """Draw largest and mean overlap / radius against time; frames without overlap are left out."""
    for values, line, name in ((history.largest, "-", "largest"), (history.mean, "--", "mean")):
        ax.plot(history.time, np.where(values > 0.0, values, np.nan), "C1" + line, label=name)
    ax.set_yscale("log")
    ax.set_xlabel(time_label)
    ax.set_ylabel("overlap / radius")
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False)


def main(words: Sequence[str]) -> None:
    """Command line."""
    from chart import new_figure, save_figure
    from command_line import add_plane_option, add_time_options, new_parser, print_table
    from packing import Packing, position_digits

    parser = new_parser(__doc__, "overlap.png", "frame of the distribution")
    add_time_options(parser)
    add_plane_option(parser, "wall")
    arguments = parser.parse_args(words)
    packing = Packing(arguments.dump, dt=arguments.dt)
    frame = packing.frame(arguments.frame)
    overlaps = compute_overlaps(frame.x, frame.radius, frame.bounds, frame.periodic, arguments.planes)
    chosen = (packing.frame(k) for k in range(0, len(packing), arguments.every))
    history = compute_overlap_history(chosen, arguments.planes)
    digits = position_digits(frame.x)
    resolution = compute_resolution(frame.x, frame.radius, digits)
    worst = int(np.argmax(history.largest))
    rows = [
        ("overlapping contacts", str(len(overlaps))),
        ("largest overlap / radius", f"{overlaps.max(initial=0.0):.3e}"),
        ("mean overlap / radius", f"{overlaps.mean() if len(overlaps) else 0.0:.3e}"),
        (f"largest in {len(history.time)} frames", f"{history.largest[worst]:.3e}"),
        ("  at " + ("step" if packing.dt is None else "time (s)"), f"{history.time[worst]:g}"),
        ("resolution of the dump", f"{resolution:.0e}"),
    ]
    print_table(f"Overlap, step {frame.step}", rows)
    if digits < 12:
        print(
            f"warning: no position has more than {digits} digits; overlaps below the resolution"
            " are rounding. Write the dump with dump_modify ID format float %.17g"
        )
    several = len(history.time) > 1
    figure, axes = new_figure(9.6 if several else 5.4, 4.2, 2 if several else 1)
    plot_overlap_distribution(axes[0] if several else axes, overlaps)
    if several:
        label = "step" if packing.dt is None else "time (s)"
        plot_overlap_history(axes[1], history, label)
    save_figure(figure, arguments.output)


if __name__ == "__main__":
    from command_line import run

    raise SystemExit(run(main))
