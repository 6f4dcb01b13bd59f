"""Grains from arrays, all of them or none, with the masses and radii that were meant."""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nscd_lmp._core import NscdError

MASS = "rmass"  # LAMMPS' name


def create_grains(
    lmp: Any,
    x: ArrayLike,
    radius: ArrayLike,
    *,
    mass: ArrayLike | None = None,
    density: ArrayLike | None = None,
    v: ArrayLike = 0.0,
    omega: ArrayLike = 0.0,
    type: int = 1,
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
    type : int
        Atom type of all.

    Returns
    -------
    ndarray, (n,), int
        Atom IDs in the order of `x`.

    Raises
    ------
    NscdError
        Neither mass nor density, or both; numbers that are not finite, radii or masses that are not above 0; grains
        that are not inside the box. No grain has been made then.
    """
    place = np.array(x, dtype=float).reshape(-1, 3)
    n = len(place)
    size = np.array(np.broadcast_to(np.asarray(radius, dtype=float), n))
    if (mass is None) == (density is None):
        raise NscdError("give the mass of the grains, or their density: one of the two")
    weight = np.array(mass, dtype=float) if density is None else np.array(density) * (4 / 3 * math.pi) * size**3
    values = {"radius": size, MASS: np.array(np.broadcast_to(weight, n))}
    values |= {
        name: np.array(np.broadcast_to(np.asarray(rates, dtype=float), (n, 3)))
        for name, rates in (("v", v), ("omega", omega))
    }
    _check(place, values)
    if lmp.extract_setting("radius_flag") != 1:
        raise NscdError("atoms have no radius: use atom_style sphere")
    comm = lmp.get_mpi_comm() if lmp.extract_setting("world_size") > 1 else None
    first = 1 + max(comm.allgather(_last(lmp)) if comm else [_last(lmp)])
    ids = np.arange(first, first + n)
    lmp.create_atoms(n, ids.tolist(), [type] * n, place.ravel().tolist(), shrinkexceed=True)
    owned = lmp.extract_setting("nlocal")
    tags = lmp.numpy.extract_atom("id")[:owned] if owned else np.zeros(0, int)
    here = np.flatnonzero(tags >= first)
    row = np.array(tags[here] - first)
    _refuse_missing(lmp, place, ids, comm.allgather(row) if comm else [row])
    for name, given in values.items():
        if len(here):
            lmp.numpy.extract_atom(name)[here] = given[row]
    return ids


def _check(x: NDArray[np.float64], values: dict[str, NDArray[np.float64]]) -> None:
    for name, numbers in {"x": x, **values}.items():
        wrong = ~np.isfinite(numbers.reshape(len(x), -1)).all(axis=1)
        if name in ("radius", MASS):
            wrong |= ~(numbers > 0)
        if wrong.any():
            k = int(np.argmax(wrong))
            shown = "mass" if name == MASS else name
            above = " above 0" if name in ("radius", MASS) else ""
            raise NscdError(f"grain {k} has {shown} = {numbers[k]}: it must be of finite numbers{above}")


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
