# SPDX-License-Identifier: GPL-2.0-or-later
"""Which rank owns the grain of every image: found from the tags, by messages between neighbours.

LAMMPS' C interface does not tell. So every rank asks those whose part of the box an image's place lies in, brought
back into the box: at a build of the list every grain lies in the part of its owner.
"""

from __future__ import annotations

import ctypes
import weakref
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nscd_lmp.door.ranks import Ranks

MARGIN = 1e-9  # of the box' edge: round-off at the faces between two parts

Find = Callable[[NDArray[np.float64], NDArray[np.int32], NDArray[np.int32]], NDArray[np.int32]]


def finder(lmp: Any, ranks: Ranks) -> Find:
    """Return a function that finds the owners of images, on all ranks together.

    Parameters
    ----------
    lmp : lammps.lammps
    ranks : Ranks

    Returns
    -------
    callable
        Takes the places of images (n, 3), their tags (n) and the tags of the grains that this rank owns (m);
        returns the ranks that own the images (n), -1 for an image without a grain.
    """

    # The fix holds the function and the LAMMPS object the fix: a reference back would keep both for ever.
    instance = weakref.ref(lmp)

    def find(x: NDArray[np.float64], tags: NDArray[np.int32], owned: NDArray[np.int32]) -> NDArray[np.int32]:
        lmp = instance()
        homes = np.where(np.isin(tags, owned), np.int32(ranks.rank), np.int32(-1))
        remote = np.flatnonzero(homes < 0)
        lows, highs = _parts(lmp, ranks)
        places = _places(lmp, x[remote])
        asked = {
            rank: remote[np.all(_above(lmp, places, lows[rank]) <= highs[rank] - lows[rank] + 2 * MARGIN, axis=1)]
            for rank in _near(lmp, places, lows, highs)
            if rank != ranks.rank
        }
        questions = [(rank, tags[k].astype(float)) for rank, k in asked.items() if len(k)]
        answers = [(rank, np.isin(asking, owned).astype(float)) for rank, asking in ranks.deliver(questions)]
        for rank, known in ranks.deliver(answers):
            homes[asked[rank][known > 0]] = rank
        return homes

    return find


def _global(lmp: Any, name: str, of: Any, count: int) -> NDArray[Any]:
    """Return a global quantity of LAMMPS, whose getters in Python differ between releases."""
    function = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_void_p, ctypes.c_char_p)
    extract = ctypes.cast(lmp.lib.lammps_extract_global, function)
    address = extract(lmp.lmp, name.encode())
    return np.ctypeslib.as_array(ctypes.cast(address, ctypes.POINTER(of)), (count,))


def _box(lmp: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the lowest corner of the box (3) and the matrix (3, 3) of its edges in columns."""
    low, high = (_global(lmp, name, ctypes.c_double, 3) for name in ("boxlo", "boxhi"))
    edges = np.diag(high - low)
    if _global(lmp, "triclinic", ctypes.c_int, 1)[0]:
        for name, place in (("xy", (0, 1)), ("xz", (0, 2)), ("yz", (1, 2))):
            edges[place] = _global(lmp, name, ctypes.c_double, 1)[0]
    return low.copy(), edges


def _parts(lmp: Any, ranks: Ranks) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the corners (P, 3) of the ranks' parts of the box, in units of its edges."""
    if _global(lmp, "triclinic", ctypes.c_int, 1)[0]:
        own = np.concatenate([_global(lmp, name, ctypes.c_double, 3) for name in ("sublo_lambda", "subhi_lambda")])
    else:
        low, edges = _box(lmp)
        sides = np.diag(edges)
        own = np.concatenate([(_global(lmp, name, ctypes.c_double, 3) - low) / sides for name in ("sublo", "subhi")])
    parts = np.empty((ranks.count, 6))
    ranks.comm.Allgather(np.ascontiguousarray(own), parts)
    return parts[:, :3], parts[:, 3:]


def _periodic(lmp: Any) -> NDArray[np.bool_]:
    return _global(lmp, "periodicity", ctypes.c_int, 3) != 0


def _places(lmp: Any, x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return places in units of the box' edges, clipped to its faces where it is not periodic."""
    low, edges = _box(lmp)
    places = np.linalg.solve(edges, (x - low).T).T
    return np.where(_periodic(lmp), places, np.clip(places, 0, 1))


def _near(lmp: Any, places: NDArray[np.float64], lows: NDArray[np.float64], highs: NDArray[np.float64]) -> list[int]:
    """Return the ranks whose parts can hold one of the places: those that the box round the places meets."""
    if len(places) == 0:
        return []
    low, high = places.min(axis=0), places.max(axis=0)
    whole = _periodic(lmp) & (high - low + 2 * MARGIN >= 1)
    # of part and places, whichever begins first in the direction round the box
    ahead = _above(lmp, np.broadcast_to(low, lows.shape), lows) <= highs - lows + 2 * MARGIN
    behind = _above(lmp, lows, low) <= high - low + 2 * MARGIN
    return np.flatnonzero(np.all(whole | ahead | behind, axis=1)).tolist()


def _above(lmp: Any, places: NDArray[np.float64], low: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how far places are above a part's low corner, less the margin; 0 to 1 where the box is periodic.

    Places below a corner in a direction that is not periodic are infinitely far.
    """
    above = places - low + MARGIN
    return np.where(_periodic(lmp), above - np.floor(above), np.where(above < 0, np.inf, above))
