# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact problems in the files of FCLIB, the field's collection: HDF5, group ``fclib_local``.

Source: Acary, Bremond, Koziara & Perignon (2014), FCLIB: a collection of discrete 3D frictional contact problems,
INRIA RT-0444, and the header of its library, https://github.com/FrictionalContactLibrary/fclib. Layout:

    /fclib_local/spacedim                   2 or 3
    /fclib_local/W/{m, n, nzmax, nz, p, i, x}   nz >= 0: triplets (rows p, columns i); -1: compressed columns; -2: rows
    /fclib_local/vectors/{q, mu}            u = W r + q contact by contact, N first
    /fclib_local/info/{title, description, math_info}
    /solution/{u, r}, /guesses/number_of_guesses, /guesses/1/{u, r}, ...

Whole numbers are data sets of one 32-bit integer, texts null-terminated strings of fixed length.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nscd_lmp._core import NscdError
from nscd_lmp.problems.checks import Floats
from nscd_lmp.problems.contact_problem import ContactProblem
from nscd_lmp.problems.solve import Solution

AnyPath = str | os.PathLike[str]
LARGEST_INDEX = 2**31 - 1


def read_fclib(path: AnyPath) -> ContactProblem:
    """Return the problem in a file of FCLIB, of dim 2 or 3.

    Raises
    ------
    NscdError
        Without h5py; for a file that is not HDF5 or damaged, without ``fclib_local`` or one of its data sets; for a
        global problem (M, H) or one with equality constraints (V, R); for what :class:`ContactProblem` refuses.
    """
    with _opened(path) as file:
        group = _local(path, file)
        for name in ("V", "R"):
            if name in group and _integer(path, group, f"{name}/n") > 0:
                raise NscdError(
                    f"{path}: the problem has equality constraints (fclib_local/{name}), which ContactProblem does not"
                    " know: eliminate them, W - V R^-1 V^T"
                )
        dim = _integer(path, group, "spacedim")
        matrix = _matrix(path, group)
        q, mu = _array(path, group, "vectors/q"), _array(path, group, "vectors/mu")
        try:
            return ContactProblem(matrix, q, mu, dim)
        except NscdError as error:
            raise NscdError(f"{path}: {error}") from error


def read_fclib_solution(path: AnyPath, guess: int | None = None) -> tuple[Floats, Floats]:
    """Return the impulses r and velocities u, (n, dim), that a file of FCLIB holds beside its problem.

    Parameters
    ----------
    guess : int, optional
        Read this one of the initial guesses, counted from 1, instead of the solution.

    Raises
    ------
    NscdError
        As :func:`read_fclib`; for a file without solution, or without this guess.
    """
    with _opened(path) as file:
        group = _local(path, file)
        dim = _integer(path, group, "spacedim")
        place = "solution" if guess is None else f"guesses/{guess}"
        if place not in file:
            count = _integer(path, file, "guesses/number_of_guesses") if "guesses" in file else 0
            have = "a solution" if "solution" in file else "no solution"
            raise NscdError(f"{path}: there is no /{place}: the file has {have} and {count} guesses")
        arrays = [_array(path, file, f"{place}/{name}") for name in ("r", "u")]
        size = _integer(path, group, "W/m")
        if dim < 1 or any(array.shape != (size,) for array in arrays):
            raise NscdError(
                f"{path}: /{place}/r and u have the shapes {arrays[0].shape} and {arrays[1].shape} and must be"
                f" ({size},), as the problem beside them"
            )
        return arrays[0].reshape(-1, dim), arrays[1].reshape(-1, dim)


def write_fclib(
    path: AnyPath,
    problem: ContactProblem,
    solution: Solution | None = None,
    title: str | None = None,
    description: str | None = None,
    math_info: str | None = None,
) -> None:
    """Write the problem, and its solution if given, into a new file that FCLIB's tools read.

    W is assembled, and stored by compressed rows. FCLIB has no problems without tangents: one of dim 1 is written as
    the planar one with mu = 0, whose tangential rows are W_nn on the diagonal and whose tangential velocities are 0;
    it has the same solution. Texts that are None are empty.

    Raises
    ------
    NscdError
        Without h5py; if the file exists; for infinite mu, which FCLIB does not know; for a solution of another shape;
        for a text that is no string; for more than 2^31 - 1 entries of W.
    """
    h5py = _h5py()
    if Path(path).exists():
        raise NscdError(f"{path} exists: choose another path, or remove the file")
    texts = {"title": title or "", "description": description or "", "math_info": math_info or ""}
    for name, text in texts.items():
        if not isinstance(text, str):
            raise NscdError(f"{name} is of type {type(text).__name__} and must be a string")
    n = len(problem)
    w, q, mu = problem.delassus().tocsr(), problem.q.reshape(n, problem.dim), problem.mu
    if mu is None:
        w, mu = _with_tangents(w), np.zeros(n)
        q = _beside_zeros(q)
    if np.isinf(mu).any():
        raise NscdError(
            f"contact {int(np.argmax(np.isinf(mu)))}: mu is infinite, which FCLIB does not know: give a large number"
        )
    w.eliminate_zeros()
    if max(w.nnz, *w.shape) > LARGEST_INDEX:
        raise NscdError(f"W has {w.nnz} entries, FCLIB's 32-bit indices reach {LARGEST_INDEX}: write a smaller problem")
    answers = {}
    if solution is not None:
        for name, values in (("u", solution.velocity), ("r", solution.impulse)):
            if values.shape != problem.q.shape:
                raise NscdError(f"the solution's arrays have the shape {values.shape}, the problem's {problem.q.shape}")
            answers[name] = values if problem.dim > 1 else _beside_zeros(values.reshape(n, 1))
    with h5py.File(path, "x") as file:
        group = file.create_group("fclib_local")
        group["spacedim"] = _whole(q.shape[1])
        _write_matrix(group.create_group("W"), w)
        group["vectors/q"], group["vectors/mu"] = q.ravel(), mu
        info = group.create_group("info")
        for name, text in texts.items():
            _write_text(h5py, info, name, text)
        for name, values in answers.items():
            file[f"solution/{name}"] = values.ravel()


def _h5py() -> Any:
    """Return h5py, which only these files need."""
    try:
        import h5py
    except ImportError as error:
        raise NscdError("files of FCLIB need h5py: pip install nscd_lmp[fclib]") from error
    return h5py


@contextmanager
def _opened(path: AnyPath) -> Iterator[Any]:
    """Open the file to be read; what HDF5 says of a damaged one becomes one error."""
    h5py = _h5py()
    if not Path(path).is_file():
        raise NscdError(f"{path}: there is no such file")
    if not h5py.is_hdf5(path):
        raise NscdError(f"{path} is not an HDF5 file, which FCLIB's problems are")
    try:
        with h5py.File(path, "r") as file:
            yield file
    except NscdError:
        raise
    except Exception as error:  # h5py raises almost any type, with the words of HDF5
        raise NscdError(f"{path} is damaged, HDF5 cannot read all of it: get the file again ({error})") from error


def _local(path: AnyPath, file: Any) -> Any:
    """Return the group of the local problem."""
    if "fclib_local" in file:
        return file["fclib_local"]
    for name in ("fclib_global", "fclib_global_rolling"):
        if name in file:
            raise NscdError(
                f"{path} holds a global problem ({name}), and only fclib_local is read: condense it, W = H^T M^-1 H and"
                " q = w + H^T M^-1 f, or write it as a local one with FCLIB's tools"
            )
    raise NscdError(f"{path}: there is no group fclib_local: it is not a file of FCLIB")


def _data(path: AnyPath, group: Any, name: str) -> NDArray[Any]:
    """Return what the data set holds."""
    if name not in group:
        raise NscdError(f"{path}: the data set {group.name.rstrip('/')}/{name} is missing")
    return np.asarray(group[name][()])


def _integer(path: AnyPath, group: Any, name: str) -> int:
    """Return a whole number, which may stand in an array of one."""
    data = _data(path, group, name)
    if data.size != 1 or data.dtype.kind not in "iu":
        raise NscdError(f"{path}: {name} has the shape {data.shape} and type {data.dtype}, it must be one whole number")
    return int(data.reshape(-1)[0])


def _array(path: AnyPath, group: Any, name: str) -> Floats:
    """Return a vector of numbers."""
    data = _data(path, group, name)
    if data.dtype.kind not in "fiu":
        raise NscdError(f"{path}: {name} has the type {data.dtype}, it must hold numbers")
    return data.astype(np.float64).ravel()


def _matrix(path: AnyPath, group: Any) -> Any:
    """Return W in the format of scipy that its storage is."""
    from scipy import sparse

    m, n, nz = (_integer(path, group, f"W/{name}") for name in ("m", "n", "nz"))
    if nz < -2:
        raise NscdError(
            f"{path}: W/nz = {nz} must be -2 (compressed rows), -1 (compressed columns) or a count of triplets"
        )
    p, i = (_data(path, group, f"W/{name}").ravel().astype(np.int64) for name in ("p", "i"))
    x = _array(path, group, "W/x")
    try:
        if nz >= 0:
            return sparse.coo_array((x[:nz], (p[:nz], i[:nz])), shape=(m, n))
        used = int(p[-1])  # nzmax may leave room behind the entries
        compressed = sparse.csc_array if nz == -1 else sparse.csr_array
        w = compressed((x[:used], i[:used], p), shape=(m, n))
        w.check_format(full_check=True)
    except (ValueError, IndexError) as error:
        raise NscdError(f"{path}: p, i and x of W are no sparse matrix of {m} rows and {n} columns: {error}") from error
    return w


def _with_tangents(w: Any) -> Any:
    """Return W of a planar problem, whose tangents move on their own and as easily as the normals."""
    from scipy import sparse

    normal, tangent = np.diag([1.0, 0.0]), np.diag([0.0, 1.0])
    return sparse.csr_array(sparse.kron(w, normal) + sparse.kron(sparse.diags_array(w.diagonal()), tangent))


def _beside_zeros(values: Floats) -> Floats:
    """Return normal components (n, 1) with tangential ones of 0, (n, 2)."""
    return np.hstack([values, np.zeros_like(values)])


def _whole(value: int) -> NDArray[np.int32]:
    """Return the number as FCLIB stores it."""
    return np.array([value], dtype=np.int32)


def _write_matrix(group: Any, w: Any) -> None:
    """Write W by compressed rows."""
    w.sort_indices()
    for name, value in (("m", w.shape[0]), ("n", w.shape[1]), ("nzmax", w.nnz), ("nz", -2)):
        group[name] = _whole(value)
    group["p"], group["i"] = w.indptr.astype(np.int32), w.indices.astype(np.int32)
    group["x"] = w.data


def _write_text(h5py: Any, group: Any, name: str, text: str) -> None:
    """Write a string that ends with a null, as C reads it; h5py's own strings of fixed length do not."""
    data = text.encode()
    kind = h5py.h5t.C_S1.copy()
    kind.set_size(len(data) + 1)
    kind.set_cset(h5py.h5t.CSET_ASCII if text.isascii() else h5py.h5t.CSET_UTF8)
    place = h5py.h5d.create(group.id, name.encode(), kind, h5py.h5s.create(h5py.h5s.SCALAR))
    place.write(h5py.h5s.ALL, h5py.h5s.ALL, np.array(data, dtype=f"S{len(data) + 1}"), mtype=kind)
