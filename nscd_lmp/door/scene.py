# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene from arrays: a LAMMPS instance with grains, a box, and neighbor lists that reach far enough."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nscd_lmp._core import NscdError
from nscd_lmp.door.create import check_numbers, create_grains, grain_types, per_grain_rows
from nscd_lmp.door.walls import Wall, check_walls

Array = NDArray[np.float64]

SILENT = ("-screen", "none", "-log", "none", "-nocite")
AXES = "xyz"
REGION = "nscd_scene"  # of the box
WALLS_IN_WORDS = "nscd_walls"  # LAMMPS' variable
WALLS = "_nscd_walls"  # the attribute of a LAMMPS object that keeps the walls of its scene
FEW = 300  # grains; up to there all pairs are looked at faster than bins are kept


def scene(
    x: ArrayLike,
    radius: ArrayLike,
    *,
    dt: float,
    density: ArrayLike | None = None,
    mass: ArrayLike | None = None,
    v: ArrayLike = 0.0,
    omega: ArrayLike = 0.0,
    type: ArrayLike = 1,
    box: ArrayLike | None = None,
    periodic: str = "",
    walls: Sequence[Wall] = (),
    gravity: ArrayLike = 0.0,
    dimension: int = 3,
    speed: float | None = None,
    skin: float | None = None,
    setup: Sequence[str] = (),
    cmdargs: Sequence[str] = SILENT,
    comm: Any = None,
) -> Any:
    """Return a LAMMPS instance with these grains, ready for :func:`nscd_lmp.attach` or ``fix nscd``.

    It has what both need: ``atom_style sphere``, SI units, the masses that were meant, atom IDs from 1 in the order of
    `x`, ``pair_style zero`` with a cutoff and a skin for the time step, and gravity. No integrator is there yet.

    Parameters
    ----------
    x : array_like, (n, 3), m
        Centres; in dimension 2 also (n, 2).
    radius : array_like, (n,) or a number, m
    dt : float, s
        Time step.
    density, mass : array_like, (n,) or a number, kg/m^3 and kg
        One of the two. The density is that of a solid sphere, also in dimension 2.
    v : array_like, (n, 3) or three numbers, m/s
        Velocities; in dimension 2 also (n, 2).
    omega : array_like, (n, 3) or three numbers, rad/s
    type : array_like, (n,) or a number
        Atom types, from 1.
    box : array_like, (3, 2), m
        Lower and upper bound along each axis; in dimension 2 also (2, 2). A grain that leaves through a face that is
        not periodic stops the run. None: the box grows with the grains, and nothing leaves it.
    periodic : str
        Axes along which the box repeats, such as ``"xy"``; they need `box`. In dimension 2 z always does.
    walls : sequence of Wall
        :func:`nscd_lmp.attach` takes them for this instance, unless it is given others. LAMMPS itself has no walls:
        with ``fix nscd`` append ``${nscd_walls}``, a variable that has them in words. Without, it warns. Walls that
        move are for `attach`; ``fix nscd`` refuses them, and names ``fix wall/nscd``.
    gravity : float or three numbers, m/s^2
        A number points along -z, in dimension 2 along -y.
    dimension : int
        2 or 3.
    speed : float, optional, m/s
        The fastest that grains get, for the cutoff: the largest diameter plus what two of them approach each other by
        in a step. None: twice the largest of `v`, and what gravity adds on the way down to the walls, or through the
        box. Lists that turn out to be too short stop the run.
    skin : float, optional, m
        Of the neighbor list. None: half the largest radius.
    setup : sequence of str
        LAMMPS commands to give before the box is made, such as ``"processors * * 1"`` or ``"atom_style sphere 1"``.
    cmdargs : sequence of str
        Of the LAMMPS instance. By default it prints nothing and writes no log.
    comm : mpi4py.MPI.Comm, optional
        Its ranks make the instance together, all by the same call. None: all ranks there are.

    Returns
    -------
    lammps.lammps
        Yours to close.

    Raises
    ------
    NscdError
        Shapes that do not match; numbers that are not finite; radii, masses or `dt` that are not above 0; grains
        outside the box, a box without room, periodic axes without a box. No instance is left then.
    """
    check_walls(walls)
    if isinstance(setup, str):
        raise NscdError(f"setup = {setup!r} must be a list of LAMMPS commands: [{setup!r}]")
    planar = _is_planar(dimension)
    places = _vectors("x", x, planar)
    n = len(places)
    rates, sizes, types = _vectors("v", v, planar, n), per_grain_rows("radius", radius, n), grain_types(type, n)
    check_numbers(places, {"radius": sizes, "v": rates})
    largest, pull = float(sizes.max()), _pull(gravity, planar)
    bounds = _bounds(box, periodic, planar, largest)
    fastest = _fastest(places, rates, pull, walls, bounds) if speed is None else _at_least_0("speed", speed)
    cutoff = 2 * largest + 2 * _above_0("dt", dt, "s") * fastest
    skin = 0.5 * largest if skin is None else _above_0("skin", skin, "m")
    binned = _binned(places, bounds, cutoff + skin)

    lmp = open_box(
        _around(places, largest) if bounds is None else bounds,
        _boundary(bounds, periodic, planar),
        types=int(types.max()),
        sort=binned,
        setup=["dimension 2", *setup] if planar else setup,
        cmdargs=cmdargs,
        comm=comm,
    )
    try:
        create_grains(lmp, places, sizes, mass=mass, density=density, v=rates, omega=omega, type=types)
        lmp.commands_list(
            [
                *(f"pair_style zero {cutoff!r}", "pair_coeff * *", f"neighbor {skin!r} {'bin' if binned else 'nsq'}"),
                *("neigh_modify every 1 delay 0 check yes", f"timestep {float(dt)!r}"),
            ]
        )
        if pull.any():
            lmp.command(gravity_fix(gravity, planar))
        if walls:  # for `fix nscd`, which warns where it has none
            words = " ".join(word for wall in walls for word in wall.keywords())
            lmp.command(f'variable {WALLS_IN_WORDS} string "{words}"')
    except BaseException:
        lmp.close()
        raise
    setattr(lmp, WALLS, tuple(walls))
    return lmp


def open_box(
    bounds: ArrayLike,
    boundary: str,
    *,
    types: int = 1,
    sort: bool = True,
    setup: Sequence[str] = (),
    cmdargs: Sequence[str] = SILENT,
    comm: Any = None,
) -> Any:
    """Return a LAMMPS instance in SI units with an empty box (m, (3, 2)) for spheres; ``boundary`` is LAMMPS'."""
    from lammps import lammps

    sides = " ".join(f"{float(value)!r}" for value in np.ravel(bounds))
    commands = ["units si", "atom_style sphere", f"boundary {boundary}", *setup]
    if not sort:  # bins for sorting cost a lot where a few grains are spread over a wide box
        commands.append("atom_modify sort 0 0")
    commands += [f"region {REGION} block {sides}", f"create_box {types} {REGION}", "comm_modify vel yes"]
    lmp = lammps(cmdargs=list(cmdargs), comm=comm)
    try:
        lmp.commands_list(commands)
    except BaseException:
        lmp.close()
        raise
    return lmp


def gravity_fix(gravity: ArrayLike, planar: bool = False) -> str:
    """Return LAMMPS' command for a gravity (m/s^2) downwards, or along three numbers."""
    if np.ndim(gravity) == 0:
        return f"fix gravity all gravity {float(np.asarray(gravity))!r} vector {'0 -1 0' if planar else '0 0 -1'}"
    along = [float(part) for part in np.asarray(gravity)]
    return f"fix gravity all gravity {math.hypot(*along)!r} vector {' '.join(map(repr, along))}"


def walls_of(lmp: Any) -> tuple[Wall, ...]:
    """Return the walls of the scene that an instance was made with; none after LAMMPS' ``clear``."""
    return getattr(lmp, WALLS, ()) if hasattr(lmp, WALLS) and lmp.has_id("region", REGION) else ()


def _is_planar(dimension: int) -> bool:
    if dimension not in (2, 3):
        raise NscdError(f"dimension = {dimension!r} must be 2 or 3")
    return dimension == 2


def _vectors(name: str, given: ArrayLike, planar: bool, n: int | None = None) -> Array:
    """Return the rows of x or v in space; `n` rows, or as many as there are."""
    rows = np.array(given, dtype=float)
    if rows.ndim == 0 and rows:
        raise NscdError(f"{name} = {given!r} must be three numbers, or a row for each grain")
    if n is None or rows.ndim == 2:
        if rows.ndim != 2 or rows.shape[1] not in ((2, 3) if planar else (3,)):
            width = "(n, 2) or (n, 3)" if planar else "(n, 3)"
            raise NscdError(f"{name} has the shape {rows.shape}: it must be {width}")
        if rows.shape[1] == 2:
            rows = np.column_stack([rows, np.zeros(len(rows))])
    if n is None and not len(rows):
        raise NscdError(f"{name} has no row: a scene needs a grain at least")
    rows = per_grain_rows(name, rows, len(rows) if n is None else n, 3)
    if planar and rows[:, 2].any():
        k = int(np.argmax(rows[:, 2] != 0))
        raise NscdError(f"grain {k} has {name} = {rows[k].tolist()}: in dimension 2 the third number must be 0")
    return rows


def _pull(gravity: ArrayLike, planar: bool) -> Array:
    """Return gravity as a vector."""
    given = np.array(gravity, dtype=float)
    if given.shape not in ((), (3,)) or not np.isfinite(given).all():
        raise NscdError(f"gravity = {gravity!r} must be a finite number, downwards, or three, in m/s^2")
    if not given.ndim and given < 0:
        up = "(0, g, 0)" if planar else "(0, 0, g)"
        raise NscdError(f"gravity = {gravity!r}: a number points downwards, {-float(given)!r} here; {up} is upwards")
    return given if given.ndim else -given * np.eye(3)[1 if planar else 2]


def _bounds(box: ArrayLike | None, periodic: str, planar: bool, largest: float) -> Array | None:
    """Return the box, (3, 2); None for one that grows with the grains."""
    if set(periodic) - set(AXES) or len(set(periodic)) < len(periodic):
        raise NscdError(f"periodic = {periodic!r} must name axes, each once, such as 'xy'")
    if box is None:
        if set(periodic) - ({"z"} if planar else set()):
            raise NscdError(f"periodic = {periodic!r} needs the lengths that repeat: give box, (3, 2) in m")
        return None
    bounds = np.array(box, dtype=float)
    if planar and bounds.shape == (2, 2):
        bounds = np.vstack([bounds, [-largest, largest]])
    if bounds.shape != (3, 2) or not np.isfinite(bounds).all() or (bounds[:, 0] >= bounds[:, 1]).any():
        raise NscdError(f"box = {np.array(box).tolist()} must be three pairs of finite numbers, low below high, in m")
    return bounds


def _boundary(bounds: Array | None, periodic: str, planar: bool) -> str:
    """Return the words of LAMMPS' command: periodic, fixed, or shrink-wrapped round the grains."""
    repeats = set(periodic) | ({"z"} if planar else set())
    return " ".join("p" if axis in repeats else "s" if bounds is None else "f" for axis in AXES)


def _around(x: Array, margin: float) -> Array:
    """Return a box round the grains."""
    return np.column_stack([x.min(axis=0) - margin, x.max(axis=0) + margin])


def _fastest(x: Array, v: Array, pull: Array, walls: Sequence[Wall], bounds: Array | None) -> float:
    """Return the speed to count on: in a collision a grain may get twice that of the other, and falls add to it."""
    known = [wall for wall in walls if isinstance(wall, Wall)]
    pushed = [motion.fastest(x) for wall in known for motion in wall.motions()]
    begin = 2 * max(float(np.linalg.norm(v, axis=1).max()), *pushed, 0.0)
    strength = float(np.linalg.norm(pull))
    if not strength:
        return begin
    up = -pull / strength
    drop = np.full(len(x), np.ptp(x @ up) if bounds is None else np.abs(up) @ np.ptp(bounds, axis=1))
    for point, normal in (plane for wall in known for plane in wall.half_spaces(up)):
        facing = float(normal @ up)
        if facing > 1e-6 * float(np.linalg.norm(normal)):  # grains fall on it
            height = (x - point) @ normal / facing
            drop = np.maximum(height, 0) if bounds is None else np.minimum(np.maximum(height, 0), drop)
    return math.sqrt(begin**2 + 2 * strength * float(drop.max()))


def _binned(x: Array, bounds: Array | None, reach: float) -> bool:
    """Return whether bins find neighbors faster than a look at all pairs: few grains in a wide box have more bins."""
    lengths = np.ptp(x, axis=0) if bounds is None else np.ptp(bounds, axis=1)
    bins = float(np.prod(np.maximum(lengths / (0.5 * reach), 1.0)))
    return len(x) >= FEW and bins < 0.5 * len(x) ** 2


def _above_0(name: str, value: float, unit: str) -> float:
    if not (math.isfinite(value) and value > 0):
        raise NscdError(f"{name} = {value!r} {unit} must be a finite number above 0")
    return float(value)


def _at_least_0(name: str, value: float) -> float:
    if not (math.isfinite(value) and value >= 0):
        raise NscdError(f"{name} = {value!r} m/s must be a finite number, 0 or more")
    return float(value)
