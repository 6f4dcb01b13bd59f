# SPDX-License-Identifier: GPL-2.0-or-later
"""A shaded picture of a bed of spheres in its box, coloured by height, speed or radius.

python bed_picture.py bed.dump --color height --output bed_picture.png
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from packing import Frame
    from sphere_rendering import View

Array = NDArray[np.floating[Any]]
OUTLINE = "#4d5656"
COLORS = ("height", "speed", "radius")


def bed_colormap() -> LinearSegmentedColormap:
    """Viridis without its darkest fifth, which would hide the shading."""
    viridis = matplotlib.colormaps["viridis"](np.linspace(0.18, 1.0, 256))
    return LinearSegmentedColormap.from_list("bed", viridis)


def compute_shown_bounds(x: Array, radius: Array, bounds: Array, whole_box: bool = False) -> tuple[Array, bool]:
    """Box to draw, (3, 2), and whether its empty upper part was cut off.

    A box that is more than a quarter higher than the bed would shrink the bed to a crust; it is
    drawn up to the highest grain unless `whole_box`.
    """
    shown = np.array(bounds, dtype=np.float64)
    top = float(np.max(x[:, 2] + radius))
    cut = not whole_box and shown[2, 1] - shown[2, 0] > 1.25 * (top - shown[2, 0]) > 0.0
    if cut:
        shown[2, 1] = top
    return shown, cut


def compute_colors(values: Array) -> tuple[Array, Normalize, str]:
    """Colours (n, 3) of the grains, the scale of the colour bar, and its ends for matplotlib.

    The scale leaves out the outer 0.5 % of the grains at both ends, or one stray grain would take
    all colours; the ends (``neither``, ``min``, ``max``, ``both``) tell where that is visible.
    """
    low, high = (float(bound) for bound in np.quantile(values, [0.005, 0.995]))
    scale = Normalize(low, high if high > low else low + 1.0)
    slack = 0.05 * (high - low)
    ends = {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}[
        int(values.min() < low - slack), int(values.max() > high + slack)
    ]
    return np.asarray(bed_colormap()(scale(values)))[:, :3], scale, ends


def plot_bed_picture(
    ax: Axes,
    pixels: Array,
    view: View,
    depth: Array,
    bounds: Array,
    scale: Normalize | None = None,
    ends: str = "neither",
    label: str = "",
    lengths: Sequence[str] = ("", "", ""),
) -> None:
    """Draw a rendered bed, the outline of its box, edge lengths and a colour bar.

    Parameters
    ----------
    ax : Axes
        Where to draw; its frame is switched off.
    pixels, view, depth
        What `sphere_rendering.render_bed` returned.
    bounds : ndarray, (3, 2), float64
        Box to outline.
    scale, ends : Normalize and str, optional
        Colour scale and its ends from `compute_colors`; without it there is no colour bar.
    label : str
        Title of the colour bar, with unit.
    lengths : sequence of 3 str
        Text at an edge along x, y and z; empty for none.
    """
    ax.imshow(pixels, interpolation="lanczos", aspect="equal")
    corners = np.array(list(product(*bounds)))
    nearest = int(np.argmin(np.linalg.norm(corners - view.eye, axis=1)))
    for first, second in product(range(8), repeat=2):
        if first < second and np.sum(corners[first] != corners[second]) == 1:
            faint = nearest in (first, second)  # these three edges run across the bed
            _plot_edge(ax, view, depth, corners[first], corners[second], 0.35 if faint else 1.0)
    for axis, text in enumerate(lengths):
        if text:
            _plot_length(ax, view, bounds, axis, text)
    ax.set_axis_off()
    margin = 0.02 * pixels.shape[1]
    ax.set_xlim(-margin, pixels.shape[1] + margin)
    ax.set_ylim(pixels.shape[0] + margin, -margin)
    if scale is not None:
        bar = ax.figure.colorbar(
            ScalarMappable(scale, bed_colormap()),
            ax=ax,
            shrink=0.7,
            aspect=24,
            pad=0.03,
            extend=ends,
        )
        bar.set_label(label)
        bar.outline.set_visible(False)


def _plot_edge(ax: Axes, view: View, depth: Array, start: Array, end: Array, alpha: float) -> None:
    """Draw those pieces of an edge that no grain hides."""
    points = start + np.linspace(0.0, 1.0, 600)[:, None] * (end - start)
    column, row, distance = view.project(points)
    rows = np.clip(np.rint(row), 0, depth.shape[0] - 1).astype(int)
    columns = np.clip(np.rint(column), 0, depth.shape[1] - 1).astype(int)
    free = distance <= depth[rows, columns] * (1.0 + 1e-3)
    path = np.column_stack([column - 0.5, row - 0.5]) / 2.0  # the view has 2 x 2 rays per pixel
    breaks = np.flatnonzero(np.diff(free.astype(int))) + 1
    pieces = [run for run in np.split(np.arange(len(path)), breaks) if free[run[0]]]
    ax.add_collection(LineCollection([path[run] for run in pieces], colors=OUTLINE, linewidths=1.1, alpha=alpha))


def _plot_length(ax: Axes, view: View, bounds: Array, axis: int, text: str) -> None:
    """Write a length beside an edge along `axis`: the lowest in the picture, or leftmost for z."""
    others = [c for c in range(3) if c != axis]
    best, place = -np.inf, np.zeros(2)
    centre = np.column_stack(view.project(bounds.mean(axis=1)[None]))[0, :2]
    for sides in product((0, 1), repeat=2):
        middle = bounds.mean(axis=1)
        middle[others] = [bounds[c, s] for c, s in zip(others, sides, strict=True)]
        column, row, _ = (float(value[0]) for value in view.project(middle[None]))
        score = -column if axis == 2 else row
        if score > best:
            best, place = score, np.array([column, row])
    outward = (place - centre) / np.linalg.norm(place - centre)
    ax.annotate(
        text,
        (float(place[0] - 0.5) / 2.0, float(place[1] - 0.5) / 2.0),
        xytext=(18.0 * outward[0], -18.0 * outward[1]),
        textcoords="offset points",
        ha="right" if outward[0] < -0.7 else "left" if outward[0] > 0.7 else "center",
        va="center",
        color=OUTLINE,
        path_effects=[withStroke(linewidth=3.0, foreground="white")],  # grains may poke out there
    )


def _choose_values(frame: Frame, name: str, factor: float, unit: str) -> tuple[Array, str]:
    """Values (n,) to colour by, and the title of the colour bar."""
    if name == "height":
        axis = 2 if np.ptp(frame.x[:, 2]) > 0.0 else 1  # a planar run: y is up
        return (frame.x[:, axis] - frame.bounds[axis, 0]) * factor, f"height of the centre ({unit})"
    if name == "radius":
        return frame.radius * factor, f"radius ({unit})"
    if frame.v is None:
        raise ValueError("--color speed needs the columns vx vy vz, add them to the dump command")
    return np.linalg.norm(frame.v, axis=1), "speed (m/s)" if unit != "dump units" else "speed"


def main(words: Sequence[str]) -> None:
    """Command line."""
    from chart import choose_length_unit, new_figure, save_figure
    from command_line import new_parser, positive_int, print_table
    from packing import Packing
    from sphere_rendering import render_bed

    parser = new_parser(__doc__, "bed_picture.png")
    parser.add_argument("--color", choices=COLORS, default="height", help="[height]")
    parser.add_argument("--azimuth", type=float, help="of the camera, degrees [-62; -90 if planar]")
    parser.add_argument("--elevation", type=float, help="of the camera, degrees [24; 90 if planar]")
    parser.add_argument("--size", type=positive_int, default=1100, help="pixels of the longer side [1100]")
    parser.add_argument("--whole-box", action="store_true", help="show its empty part too")
    arguments = parser.parse_args(words)
    frame = Packing(arguments.dump).frame(arguments.frame)
    unit = choose_length_unit(arguments.length_unit, frame.radius)
    values, label = _choose_values(frame, arguments.color, unit.factor, unit.name)
    rgb, scale, ends = compute_colors(values)
    shown, cut = compute_shown_bounds(frame.x, frame.radius, frame.bounds, arguments.whole_box)
    planar = np.ptp(frame.x[:, 2]) == 0.0
    azimuth, elevation = (-90.0, 90.0) if planar else (-62.0, 24.0)
    pixels, view, depth = render_bed(
        frame.x,
        frame.radius,
        rgb,
        shown,
        azimuth if arguments.azimuth is None else arguments.azimuth,
        elevation if arguments.elevation is None else arguments.elevation,
        arguments.size,
    )
    sides = [f"{side * unit.factor:.4g} {unit.name}" for side in np.ptp(shown, axis=1)]
    if cut or planar:
        sides[2] = ""
    rows, columns = pixels.shape[:2]
    inches = 7.0 / max(rows, columns)
    figure, ax = new_figure(1.2 + inches * columns, 0.3 + max(inches * rows, 2.5))
    plot_bed_picture(ax, pixels, view, depth, shown, scale, ends, label, sides)
    save_figure(figure, arguments.output)
    print_table(
        f"Bed picture, step {frame.step}",
        [
            ("grains", str(len(frame.radius))),
            (label, f"{values.min():.4g} to {values.max():.4g}"),
            ("picture", arguments.output),
        ],
    )


if __name__ == "__main__":
    from command_line import run

    raise SystemExit(run(main))
