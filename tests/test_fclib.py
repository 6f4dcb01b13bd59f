# SPDX-License-Identifier: GPL-2.0-or-later
"""Files of FCLIB: what is written is what its C library reads, and what that writes is read."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import contact_problems
import numpy as np
import pytest
from scipy import sparse

from nscd_lmp import ContactProblem, NscdError, read_fclib, read_fclib_solution, solve, write_fclib

pytestmark = pytest.mark.fast

h5py = pytest.importorskip("h5py")

GIVEN = contact_problems.bodies(4, 3, 30, 1)
MU = np.array([0.1, 0.2, 0.3, 0.0])
TRIPLETS, COLUMNS, ROWS = 12 * 12, -1, -2  # nz


def by_hand(path: Path, nz: int = ROWS, spare: int = 0, w: Any = None, dim: int = 3) -> Path:
    """Write a file as fclib_write_local, fclib_write_solution and fclib_write_guesses do.

    `spare`: how much larger than its entries the arrays of a compressed matrix are.
    """
    w = GIVEN.w if w is None else w
    if nz >= 0:
        stored = sparse.coo_array(w)
        p, i, x, nz = stored.row, stored.col, stored.data, stored.nnz
    else:
        stored = sparse.csc_array(w) if nz == COLUMNS else sparse.csr_array(w)
        p, i, x = stored.indptr, stored.indices, stored.data
        i, x = np.append(i, np.zeros(spare, dtype=np.int32)), np.append(x, np.full(spare, np.nan))
    with h5py.File(path, "w") as file:
        group = file.create_group("fclib_local")
        integer(group, "spacedim", dim)
        matrix = group.create_group("W")
        for name, value in (("nzmax", len(x)), ("m", w.shape[0]), ("n", w.shape[1]), ("nz", nz)):
            integer(matrix, name, value)
        for name, indices in (("p", p), ("i", i)):
            matrix.create_dataset(name, data=indices, dtype=h5py.h5t.NATIVE_INT32)
        matrix.create_dataset("x", data=x, dtype=h5py.h5t.NATIVE_DOUBLE)
        matrix.create_dataset("conditioning", data=[30.0])
        integer(matrix, "rank", 12)
        group["vectors/q"], group["vectors/mu"] = GIVEN.q, MU
        group["info/title"] = np.bytes_("by hand\0")
        file["solution/u"], file["solution/r"] = np.arange(12.0), np.arange(12.0) + 1
        integer(file, "guesses/number_of_guesses", 2)
        for guess in ("1", "2"):
            file[f"guesses/{guess}/u"], file[f"guesses/{guess}/r"] = np.full(12, float(guess)), np.zeros(12)
    return path


def integer(group: Any, name: str, value: int) -> None:
    """Write what H5LTmake_dataset_int writes with one element."""
    group.create_dataset(name, data=[value], dtype=h5py.h5t.NATIVE_INT32)


@pytest.mark.parametrize("nz", [TRIPLETS, COLUMNS, ROWS])
@pytest.mark.parametrize("spare", [0, 5])
def test_every_storage_of_a_matrix_is_read(tmp_path: Path, nz: int, spare: int) -> None:
    random = np.random.default_rng(0).normal(size=GIVEN.w.shape)
    uneven = GIVEN.w + 1e-3 * (random - random.T)  # rows and columns must not be taken for each other
    problem = read_fclib(by_hand(tmp_path / "a.hdf5", nz, spare, uneven))
    assert (len(problem), problem.dim) == (4, 3)
    np.testing.assert_array_equal(problem.delassus().toarray(), uneven)
    np.testing.assert_array_equal(problem.q.ravel(), GIVEN.q)
    np.testing.assert_array_equal(problem.mu, MU)


def test_solution_and_guesses_are_read(tmp_path: Path) -> None:
    path = str(by_hand(tmp_path / "a.hdf5"))
    impulse, velocity = read_fclib_solution(path)
    np.testing.assert_array_equal(velocity, np.arange(12.0).reshape(4, 3))
    np.testing.assert_array_equal(impulse, velocity + 1)
    np.testing.assert_array_equal(read_fclib_solution(path, guess=2)[1], np.full((4, 3), 2.0))
    with pytest.raises(NscdError, match=r"there is no /guesses/3: the file has a solution and 2 guesses"):
        read_fclib_solution(path, guess=3)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("spheres", [False, True])
def test_what_is_written_is_read_again(tmp_path: Path, dim: int, spheres: bool) -> None:
    problem = contact_problems.bodies(6, dim, 24, 0).problem(0.3)
    if spheres:
        problem = ContactProblem.from_spheres(**contact_problems.heap(dim, np.random.default_rng(3)))
    solution = solve(problem, tol=1e-10)
    write_fclib(tmp_path / "a.hdf5", problem, solution)
    again = read_fclib(tmp_path / "a.hdf5")
    np.testing.assert_array_equal(again.delassus().toarray(), problem.delassus().toarray())
    np.testing.assert_array_equal(again.q, problem.q)
    np.testing.assert_array_equal(again.mu, problem.mu)
    impulse, velocity = read_fclib_solution(tmp_path / "a.hdf5")
    np.testing.assert_array_equal(impulse, solution.impulse)
    np.testing.assert_array_equal(velocity, solution.velocity)
    assert solve(again, tol=1e-9, warmstart=impulse).iterations == 1


def test_frictionless_problem_is_written_as_a_planar_one(tmp_path: Path) -> None:
    problem = contact_problems.bodies(8, 1, 16, 2).problem()
    solution = solve(problem, tol=1e-12)
    write_fclib(tmp_path / "a.hdf5", problem, solution)
    again = read_fclib(tmp_path / "a.hdf5")
    assert again.dim == 2 and again.mu is not None and not again.mu.any()
    np.testing.assert_array_equal(again.delassus().toarray()[::2, ::2], problem.delassus().toarray())
    found = solve(again, tol=1e-12)
    np.testing.assert_allclose(found.velocity[:, 0], solution.velocity, rtol=0, atol=1e-10)
    assert not found.velocity[:, 1].any() and not found.impulse[:, 1].any()
    np.testing.assert_array_equal(read_fclib_solution(tmp_path / "a.hdf5")[0][:, 0], solution.impulse)


def test_types_of_what_is_written_are_those_of_the_c_library(tmp_path: Path) -> None:
    problem = GIVEN.problem(0.3)
    texts = {"title": "heap", "description": "four contacts, \u00b5 = 0.3", "math_info": ""}
    write_fclib(tmp_path / "a.hdf5", problem, solve(problem), **texts)
    with h5py.File(tmp_path / "a.hdf5") as file:
        for name in ("spacedim", "W/m", "W/n", "W/nz", "W/nzmax"):
            assert file["fclib_local"][name].shape == (1,)
        for name in ("spacedim", "W/m", "W/n", "W/nz", "W/nzmax", "W/p", "W/i"):
            assert file["fclib_local"][name].id.get_type().equal(h5py.h5t.NATIVE_INT32), name
        for name in ("fclib_local/W/x", "fclib_local/vectors/q", "fclib_local/vectors/mu", "solution/u", "solution/r"):
            assert file[name].id.get_type().equal(h5py.h5t.NATIVE_DOUBLE) and file[name].ndim == 1, name
        assert file["fclib_local/W/nz"][0] == ROWS
        for name, text in texts.items():
            kind = file["fclib_local/info"][name].id.get_type()
            assert kind.get_strpad() == h5py.h5t.STR_NULLTERM and not kind.is_variable_str()
            assert kind.get_size() == len(text.encode()) + 1
            assert file["fclib_local/info"][name][()].decode() == text


def test_empty_problem_is_written_and_read(tmp_path: Path) -> None:
    write_fclib(tmp_path / "a.hdf5", ContactProblem(np.zeros((0, 0)), [], 0.3, 3))
    assert len(read_fclib(tmp_path / "a.hdf5")) == 0


def test_write_refuses(tmp_path: Path) -> None:
    problem, path = GIVEN.problem(MU), tmp_path / "a.hdf5"
    with pytest.raises(NscdError, match="contact 1: mu is infinite, which FCLIB does not know: give a large number"):
        write_fclib(path, GIVEN.problem([0, np.inf, 0, 0]))
    with pytest.raises(NscdError, match=r"the solution's arrays have the shape \(0,\), the problem's \(4, 3\)"):
        write_fclib(path, problem, solve(ContactProblem(np.zeros((0, 0)), [])))
    assert not path.exists()
    write_fclib(path, problem)
    with pytest.raises(NscdError, match=r"a\.hdf5 exists: choose another path, or remove the file"):
        write_fclib(path, problem)
    with pytest.raises(NscdError, match=r"there is no /solution: the file has no solution and 0 guesses"):
        read_fclib_solution(path)


def constrained(file: Any) -> None:
    """Add equality constraints."""
    for name in ("V", "R"):
        integer(file, f"fclib_local/{name}/n", 2)


def rename(old: str, new: str) -> Any:
    """Return what gives a group or data set another name."""
    return lambda file: file.move(old, new)


def put(name: str, value: Any) -> Any:
    """Return what gives a data set another value."""

    def change(file: Any) -> None:
        del file[name]
        file[name] = value

    return change


REFUSED = [
    (constrained, r"equality constraints \(fclib_local/V\)"),
    (rename("fclib_local", "fclib_global"), r"holds a global problem \(fclib_global\), and only fclib_local is read"),
    (rename("fclib_local", "else"), "there is no group fclib_local"),
    (rename("fclib_local/vectors/mu", "mu"), "the data set /fclib_local/vectors/mu is missing"),
    (put("fclib_local/W/nz", [-3]), r"W/nz = -3 must be -2 \(compressed rows\), -1"),
    (put("fclib_local/W/nz", [1, 2]), r"W/nz has the shape \(2,\) and type int64, it must be one whole number"),
    (put("fclib_local/W/i", np.full(144, 12)), "p, i and x of W are no sparse matrix of 12 rows and 12 columns"),
    (put("fclib_local/W/p", np.arange(5)), "p, i and x of W are no sparse matrix"),
    (put("fclib_local/W/p", []), "p, i and x of W are no sparse matrix"),
    (put("fclib_local/W/x", np.full(144, np.nan)), r"a\.hdf5: W\[0, 0\] = nan \(contacts 0 and 0\) must be finite"),
    (put("fclib_local/vectors/q", [b"a"]), "vectors/q has the type .* it must hold numbers"),
    (put("fclib_local/vectors/q", np.zeros(3)), r"a\.hdf5: q has the shape \(3,\), but W has 12 rows"),
    (put("fclib_local/spacedim", [5]), r"a\.hdf5: dim = 5 must be"),
]


@pytest.mark.parametrize(("change", "message"), REFUSED)
def test_read_refuses(tmp_path: Path, change: Any, message: str) -> None:
    path = by_hand(tmp_path / "a.hdf5")
    with h5py.File(path, "r+") as file:
        change(file)
    with pytest.raises(NscdError, match=message):
        read_fclib(path)


def test_solution_of_another_size_is_refused(tmp_path: Path) -> None:
    path = by_hand(tmp_path / "a.hdf5")
    with h5py.File(path, "r+") as file:
        put("solution/r", np.zeros(3))(file)
    with pytest.raises(NscdError, match=r"/solution/r and u have the shapes \(3,\) and \(12,\) and must be \(12,\)"):
        read_fclib_solution(path)


def test_other_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(NscdError, match="none: there is no such file"):
        read_fclib(tmp_path / "none")
    (tmp_path / "text").write_text("W")
    with pytest.raises(NscdError, match="text is not an HDF5 file"):
        read_fclib(tmp_path / "text")


def test_damaged_files_are_refused(tmp_path: Path) -> None:
    good = by_hand(tmp_path / "good.hdf5").read_bytes()
    bad = tmp_path / "bad.hdf5"
    random = np.random.default_rng(1)
    damaged = [good[:size] for size in range(600, len(good), 997)]
    for _ in range(200):  # a bit turned; most are in numbers, or in room that nothing uses
        place = int(random.integers(len(good)))
        damaged.append(good[:place] + bytes([good[place] ^ 1 << int(random.integers(8))]) + good[place + 1 :])
    told = 0
    for content in damaged:
        bad.write_bytes(content)
        for read in (read_fclib, read_fclib_solution):
            try:
                read(bad)
            except NscdError as error:
                told += "is damaged, HDF5 cannot read all of it" in str(error)
    assert told > 20


def test_texts_may_be_none_and_must_be_strings(tmp_path: Path) -> None:
    write_fclib(tmp_path / "a.hdf5", GIVEN.problem(0.3), title=None)
    with h5py.File(tmp_path / "a.hdf5") as file:
        assert file["fclib_local/info/title"][()] == b""
    with pytest.raises(NscdError, match="title is of type int and must be a string"):
        write_fclib(tmp_path / "b.hdf5", GIVEN.problem(0.3), title=5)  # type: ignore[arg-type]
    assert not (tmp_path / "b.hdf5").exists()


def test_without_h5py_the_extra_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = by_hand(tmp_path / "a.hdf5")
    monkeypatch.setitem(sys.modules, "h5py", None)
    with pytest.raises(NscdError, match=r"need h5py: pip install nscd_lmp\[fclib\]"):
        read_fclib(path)
    with pytest.raises(NscdError, match=r"need h5py"):
        write_fclib(tmp_path / "b.hdf5", GIVEN.problem(0.3))
