# SPDX-License-Identifier: GPL-2.0-or-later
"""Grains from arrays, all of them or none, with the masses and radii that were meant."""

import math
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nscd_lmp._core import NscdError

MASS = "rmass"  # LAMMPS' name
ABOVE_0 = ("radius", "mass", "density")


def create_grains(
    lmp: Any,
    x: ArrayLike,
    radius: ArrayLike,
    *,
    mass: ArrayLike | None = None,
    density: ArrayLike | None = None,
    v: ArrayLike = 0.0,
    omega: ArrayLike = 0.0,
    type: ArrayLike = 1,
) -> NDArray[np.int64]:
    """Create spheres in a LAMMPS instance that has a box.

    LAMMPS' own ``create_atoms`` leaves out what is not inside the box, gives all the mass of a sphere of diameter 1 and
    density 1, and keeps atoms in an order of its own; arrays set by hand then belong to other grains.

    Parameters
    ----------
    lmp : lammps.lammps
        With ``atom_style sphere``; on several ranks all make the same call.
    x : array_like, (n, 3)
        Centres.
    radius, mass, density : array_like, (n,) or a number
        Give mass or density, that of a solid sphere.
    v, omega : array_like, (n, 3), or a number
        Velocities, and angular velocities in rad/s.
    type : array_like, (n,) or a number
        Atom types; the box must have them.

    Returns
    -------
    ndarray, (n,), int
        Atom IDs in the order of `x`.

    Raises
    ------
    NscdError
        Neither mass nor density, or both; shapes that do not match; numbers that are not finite, radii, masses or
        densities that are not above 0; types that are no whole numbers from 1; grains that are not inside the box. No
        grain has been made then.
    """
    place = np.array(x, dtype=float).reshape(-1, 3)
    n = len(place)
    size = per_grain_rows("radius", radius, n)
    if (mass is None) == (density is None):
        raise NscdError("give the mass of the grains, or their density: one of the two")
    heavy = {"mass": mass} if mass is not None else {"density": density}
    values = {name: per_grain_rows(name, cast(ArrayLike, given), n) for name, given in heavy.items()} | {"radius": size}
    values |= {name: per_grain_rows(name, rates, n, 3) for name, rates in (("v", v), ("omega", omega))}
    check_numbers(place, values)
    values[MASS] = values.pop("mass") if mass is not None else values.pop("density") * (4 / 3 * math.pi) * size**3
    types = grain_types(type, n).tolist()
    if lmp.extract_setting("radius_flag") != 1:
        raise NscdError("atoms have no radius: use atom_style sphere")
    comm = lmp.get_mpi_comm() if lmp.extract_setting("world_size") > 1 else None
    first = 1 + max(comm.allgather(_last(lmp)) if comm else [_last(lmp)])
    ids = np.arange(first, first + n)
    lmp.create_atoms(n, ids.tolist(), types, place.ravel().tolist(), shrinkexceed=True)
    owned = lmp.extract_setting("nlocal")
    tags = lmp.numpy.extract_atom("id")[:owned] if owned else np.zeros(0, int)
    here = np.flatnonzero(tags >= first)
    row = np.array(tags[here] - first)
    _refuse_missing(lmp, place, ids, comm.allgather(row) if comm else [row])
    for name, given in values.items():
        if len(here):
            lmp.numpy.extract_atom(name)[here] = given[row]
    return ids


def per_grain_rows(name: str, given: ArrayLike, n: int, width: int | None = None) -> NDArray[np.float64]:
    """Return what was given as a row for each grain, (n,) or (n, width); a number or one row is that of all."""
    values = np.array(given, dtype=float)
    shape = (n,) if width is None else (n, width)
    try:
        return np.array(np.broadcast_to(values, shape))
    except ValueError:
        one = "a number" if width is None else f"{width} numbers"
        raise NscdError(f"{name} has the shape {values.shape} for {n} grains: it must be {shape}, or {one}") from None


def grain_types(given: ArrayLike, n: int) -> NDArray[np.int32]:
    """Return the types of grains, (n,); raise for what is no whole number from 1."""
    types = per_grain_rows("type", given, n)
    if (types != np.round(types)).any() or (types < 1).any():
        raise NscdError(f"type = {given!r} must be of whole numbers from 1")
    return types.astype(np.int32)


def check_numbers(x: NDArray[np.float64], values: dict[str, NDArray[np.float64]]) -> None:
    """Raise for numbers of a grain that are not finite, radii and masses that are not above 0."""
    for name, numbers in {"x": x, **values}.items():
        wrong = ~np.isfinite(numbers.reshape(len(x), -1)).all(axis=1)
        if name in ABOVE_0:
            wrong |= ~(numbers > 0)
        if wrong.any():
            k = int(np.argmax(wrong))
            above = " above 0" if name in ABOVE_0 else ""
            raise NscdError(f"grain {k} has {name} = {numbers[k]}: it must be of finite numbers{above}")


def _last(lmp: Any) -> int:
    """Return the largest atom ID of this rank, 0 without atoms."""
    owned = lmp.extract_setting("nlocal")
    return int(lmp.numpy.extract_atom("id")[:owned].max()) if owned else 0


def _refuse_missing(lmp: Any, x: NDArray[np.float64], ids: NDArray[np.int64], rows: list[NDArray[np.int64]]) -> None:
    """Raise, with the grains removed again, if LAMMPS has left some out; `rows` are those made, of each rank."""
    made = np.zeros(len(x), bool)
    made[np.concatenate(rows)] = True
    if made.all():
        return
    if made.any():
        lmp.command(f"group nscd_created id {ids[0]}:{ids[-1]}")
        lmp.commands_list(["delete_atoms group nscd_created compress no", "group nscd_created delete"])
    k = int(np.argmin(made))
    low, high = lmp.extract_box()[:2]
    raise NscdError(
        f"{np.count_nonzero(~made)} of {len(x)} grains are not inside the box, the first is number {k} at"
        f" {x[k].tolist()}: the box goes from {low} to {high}. Make it larger, or move them"
    )
