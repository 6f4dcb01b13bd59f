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
    outlines: Sequence[Array] | None = None,
) -> None:
    """Draw a rendered bed, the outline of its box or of walls, edge lengths and a colour bar.

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
    outlines : sequence of ndarray, (n, 3), optional
        Lines of `wall_outlines.compute_wall_outlines`, instead of the outline of the box.
    """
    ax.imshow(pixels, interpolation="lanczos", aspect="equal")
    if outlines is None:
        _plot_box(ax, view, depth, bounds)
    else:
        plot_outlines(ax, view, depth, bounds, outlines)
    for axis, text in enumerate(lengths):
        if text:
            _plot_length(ax, view, bounds, axis, text)
    _finish(ax, pixels, scale, ends, label)


def _plot_box(ax: Axes, view: View, depth: Array, bounds: Array) -> None:
    """Draw the edges of the box."""
    corners = np.array(list(product(*bounds)))
    nearest = int(np.argmin(np.linalg.norm(corners - view.eye, axis=1)))
    for first, second in product(range(8), repeat=2):
        if first < second and np.sum(corners[first] != corners[second]) == 1:
            faint = nearest in (first, second)  # these three edges run across the bed
            _plot_edge(ax, view, depth, corners[first], corners[second], 0.35 if faint else 1.0)


def _finish(ax: Axes, pixels: Array, scale: Normalize | None, ends: str, label: str) -> None:
    """Frame the picture, and draw the colour bar where there is a scale."""
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
    path, free, _ = _look(view, depth, points)
    pieces = [path[run] for run in _runs(free) if free[run[0]]]
    ax.add_collection(LineCollection(pieces, colors=OUTLINE, linewidths=1.1, alpha=alpha))


def _look(
    view: View, depth: Array, points: Array, bottom: float = -np.inf
) -> tuple[Array, NDArray[np.bool_], NDArray[np.bool_]]:
    """Places (n, 2) of points in the picture, whether they are seen, and whether grains are behind them."""
    column, row, distance = view.project(points)
    rows = np.clip(np.rint(row), 0, depth.shape[0] - 1).astype(int)
    columns = np.clip(np.rint(column), 0, depth.shape[1] - 1).astype(int)
    met = depth[rows, columns]
    share = np.where(np.isfinite(met), met, 0.0) / distance
    height = np.where(np.isfinite(met), view.eye[2] + share * (points[:, 2] - view.eye[2]), -np.inf)
    path = np.column_stack([column - 0.5, row - 0.5]) / 2.0  # the view has 2 x 2 rays per pixel
    return path, distance <= met * (1.0 + 1e-3), height > bottom + 1e-6 * distance


def _runs(values: NDArray[Any]) -> list[NDArray[np.intp]]:
    """Indices of stretches of equal values."""
    return np.split(np.arange(len(values)), np.flatnonzero(np.diff(values.astype(int))) + 1)


def plot_outlines(ax: Axes, view: View, depth: Array, bounds: Array, outlines: Sequence[Array]) -> None:
    """Draw those pieces of lines (n, 3) that no grain hides, faint where they run across grains."""
    pieces: dict[float, list[Array]] = {1.0: [], 0.35: []}
    for line in outlines:
        column, row, _ = view.project(line)
        way = np.append(0.0, np.cumsum(np.hypot(np.diff(column), np.diff(row))))
        at = np.linspace(0.0, way[-1], 2 + int(way[-1]))
        path, seen, ahead = _look(view, depth, np.column_stack([np.interp(at, way, c) for c in line.T]), bounds[2, 0])
        kind = np.where(seen, 1 + ahead, 0)
        for run in _runs(kind):
            if kind[run[0]]:
                run = np.append(run, run[-1] + 1) if run[-1] + 1 < len(path) else run
                pieces[0.35 if kind[run[0]] == 2 else 1.0].append(path[run])
    for alpha, paths in pieces.items():
        ax.add_collection(LineCollection(paths, colors=OUTLINE, linewidths=1.1, alpha=alpha, capstyle="butt"))


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


def plot_scale_bar(ax: Axes, view: View, bounds: Array, factor: float, unit: str) -> None:
    """Draw a bar of a round length below the picture; it is true at the middle of the bounds."""
    rows, columns = (side / 2.0 for side in view.shape)
    distance = float((bounds.mean(axis=1) - view.eye) @ view.axes[2])
    pixel = 2.0 * view.pixel * distance * factor
    most = 0.3 * columns * pixel
    length = max(step * 10.0 ** np.floor(np.log10(most / step)) for step in (1.0, 2.0, 5.0))
    ends, row = (0.0, length / pixel), 1.03 * rows + 0.02 * columns
    ax.plot(ends, (row, row), color=OUTLINE, linewidth=2.5, solid_capstyle="butt")
    ax.annotate(
        f"{length:g} {unit}", (ends[1], row), (6.0, 0.0), textcoords="offset points", color=OUTLINE, va="center"
    )
    ax.set_ylim(row + 0.02 * columns, ax.get_ylim()[1])


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
    from wall_scene import WallScene
    from wall_words import add_wall_option, read_walls

    parser = new_parser(__doc__, "bed_picture.png")
    parser.add_argument("--color", choices=COLORS, default="height", help="[height]")
    parser.add_argument("--azimuth", type=float, help="of the camera, degrees [-62; -90 if planar]")
    parser.add_argument("--elevation", type=float, help="of the camera, degrees [24; 90 if planar]")
    parser.add_argument("--size", type=positive_int, default=1100, help="pixels of the longer side [1100]")
    parser.add_argument("--whole-box", action="store_true", help="show its empty part too")
    add_wall_option(parser)
    arguments = parser.parse_args(words)
    walls = read_walls(arguments.walls)
    frame = Packing(arguments.dump).frame(arguments.frame)
    unit = choose_length_unit(arguments.length_unit, frame.radius)
    values, label = _choose_values(frame, arguments.color, unit.factor, unit.name)
    rgb, scale, ends = compute_colors(values)
    planar = np.ptp(frame.x[:, 2]) == 0.0
    azimuth, elevation = (-90.0, 90.0) if planar else (-62.0, 24.0)
    camera = (
        azimuth if arguments.azimuth is None else arguments.azimuth,
        elevation if arguments.elevation is None else arguments.elevation,
        arguments.size,
    )
    shown, cut = compute_shown_bounds(frame.x, frame.radius, frame.bounds, arguments.whole_box)
    scene = WallScene(walls, frame, arguments.whole_box, camera[:2]) if walls else None
    if scene:
        shown = scene.shown
        pixels, view, depth = render_bed(
            frame.x, frame.radius, rgb, shown, *camera, ground=scene.is_ground, held=scene.held
        )
    else:
        pixels, view, depth = render_bed(frame.x, frame.radius, rgb, shown, *camera)
    sides = [f"{side * unit.factor:.4g} {unit.name}" for side in np.ptp(shown, axis=1)]
    if cut or planar:
        sides[2] = ""
    rows, columns = pixels.shape[:2]
    inches = 7.0 / max(rows, columns)
    figure, ax = new_figure(1.2 + inches * columns, 0.3 + max(inches * rows, 2.5))
    if scene:
        plot_bed_picture(ax, pixels, view, depth, shown, scale, ends, label, outlines=scene.outlines(view.eye))
        plot_scale_bar(ax, view, shown, unit.factor, unit.name)
    else:
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
