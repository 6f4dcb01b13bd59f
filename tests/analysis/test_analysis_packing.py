# SPDX-License-Identifier: GPL-2.0-or-later
"""Reading dumps: float64, box origin, order, and errors that name the remedy."""

from __future__ import annotations

import gzip

import numpy as np
import pytest
from packing import Packing, position_digits

pytestmark = pytest.mark.fast

X = np.array([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6 + 1e-12]])
FRAME = {"x": X, "radius": [0.05, 0.06]}


def test_positions_are_float64_and_not_shifted_by_the_box_origin(write_dump):
    bounds = ((-7.0, 3.0), (-1.0, 1.0), (0.25, 2.0))
    packing = Packing(write_dump(FRAME, bounds=bounds, boundary="pp pp fs"))
    frame = packing.frame(-1)
    assert frame.x.dtype == np.float64
    np.testing.assert_array_equal(frame.x, X)  # %.17g gives back each bit
    np.testing.assert_array_equal(frame.bounds, bounds)
    assert frame.boundary == ("pp", "pp", "fs")
    assert frame.periodic.tolist() == [True, True, False]
    # The trap that this guards against: MDAnalysis' own positions are shifted float32.
    assert packing.universe.atoms.positions.dtype == np.float32
    assert packing.universe.atoms.positions[0, 0] == pytest.approx(7.1)


def test_unsorted_dump_is_ordered_by_id(write_dump):
    path = write_dump(FRAME)
    lines = path.read_text().splitlines()
    path.write_text("\n".join([*lines[:-2], lines[-1], lines[-2]]) + "\n")
    np.testing.assert_array_equal(Packing(path).frame(0).x, X)


def test_frames_are_copies_that_later_reads_leave_alone(write_dump):
    packing = Packing(write_dump(FRAME, {"x": X + 1.0, "radius": [0.05, 0.06]}))
    first, second = list(packing)
    np.testing.assert_array_equal(first.x, X)
    np.testing.assert_array_equal(second.x, X + 1.0)


def test_time_is_step_times_dt(write_dump):
    path = write_dump(FRAME, FRAME, steps=[0, 500])
    assert Packing(path, dt=1e-3).frame(1).time == pytest.approx(0.5)
    assert Packing(path).frame(1).time == 500.0


def test_optional_columns_are_none_or_float64(write_dump):
    frame = Packing(write_dump(FRAME)).frame(0)
    assert frame.v is None and frame.omega is None and frame.mass is None
    v = X / 3.0
    full = {**FRAME, "v": v, "omega": 2 * v, "mass": [1 / 3, 2 / 3]}
    packing = Packing(write_dump(full))
    frame = packing.frame(0)
    assert frame.v is not None and frame.omega is not None and frame.mass is not None
    np.testing.assert_array_equal(frame.v, v)
    np.testing.assert_array_equal(frame.omega, 2 * v)
    np.testing.assert_array_equal(frame.mass, [1 / 3, 2 / 3])
    np.testing.assert_array_equal(packing.universe.atoms.radii, [0.05, 0.06])


def test_unwrapped_positions_serve_as_positions(write_dump):
    columns = {"xu": X[:, 0], "yu": X[:, 1], "zu": X[:, 2], "radius": [0.05, 0.06]}
    np.testing.assert_array_equal(Packing(write_dump(columns)).frame(0).x, X)


def test_missing_radius_is_an_error_with_the_dump_command(write_dump):
    with pytest.raises(ValueError, match=r"lacks the columns radius.*\ndump d all custom"):
        Packing(write_dump({"x": X}))


def test_scaled_positions_are_an_error(write_dump):
    columns = {"xs": X[:, 0], "ys": X[:, 1], "zs": X[:, 2], "radius": [0.05, 0.06]}
    with pytest.raises(ValueError, match="lacks the columns x y z"):
        Packing(write_dump(columns))


def test_changing_atom_count_is_an_error(write_dump):
    fewer = {"x": X[:1], "radius": [0.05]}
    with pytest.raises(ValueError, match=r"has 1 grains, frame 0 has 2.*last grain is inserted"):
        Packing(write_dump(FRAME, fewer))


def test_frame_cut_short_is_left_out(write_dump):
    path = write_dump(FRAME, FRAME)
    path.write_text(path.read_text()[:-30])
    assert len(Packing(path)) == 1
    path.write_text(path.read_text()[:60])
    with pytest.raises(ValueError, match="0 complete frames"):
        Packing(path)


@pytest.mark.parametrize("column", ["x", "radius", "v", "omega", "mass"])
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_values_of_a_run_that_exploded_are_an_error(write_dump, column, value):
    good = {**FRAME, "v": X, "omega": X, "mass": [1.0, 1.0]}
    bad = {**good, column: np.array(good[column])}
    bad[column][1] = value
    packing = Packing(write_dump(good, bad, steps=[0, 700]))
    np.testing.assert_array_equal(packing.frame(0).x, X)
    with pytest.raises(ValueError, match=r"frame 1 \(step 700\) has .* of 1 of 2 grains that are not finite numbers"):
        packing.frame(-1)


def test_box_of_a_run_that_exploded_is_an_error(write_dump):
    with pytest.raises(ValueError, match="the box of step 0 is not of finite numbers"):
        Packing(write_dump(FRAME, bounds=((0, 1), (0, 1), (0, np.nan))))


def test_damaged_dumps_are_errors_that_say_so(write_dump):
    path = write_dump(FRAME, FRAME, FRAME)
    text = path.read_text()
    middle = text.index("ITEM: TIMESTEP", 10)
    for wrong in (
        text[: middle - 30] + text[middle:],  # a killed run, and another that went on
        text[: middle + 40] + text[2 * middle :],
        text.replace("ITEM: ATOMS", "ITEM:ATOMS"),
        text.replace("\n0\n", "\nzero\n"),
        text.replace(" 0.40000000000000002 ", " 0.4 0.5 "),
        text[:middle] + "\nstray\n" + text[middle:],
    ):
        path.write_text(wrong)
        with pytest.raises(ValueError, match=r"is damaged|unknown lines|tilted"):
            Packing(path)
    path.write_text(text.replace(" 0.40000000000000002 ", " 0.4x "))
    with pytest.raises(ValueError, match=r"is damaged in frame 0 \(step 0\)"):
        Packing(path)
    path.write_text(text[:middle] + text[middle:].replace(" 0.40000000000000002 ", " 0.4x "))
    with pytest.raises(ValueError, match=r"is damaged in frame 1 \(step 1\)"):
        Packing(path).frame(1)
    path.write_bytes(text.encode()[:200] + bytes(range(256)))
    with pytest.raises(ValueError, match=r"is damaged, or no text dump"):
        Packing(path)
    packed = path.with_suffix(".gz")
    packed.write_bytes(gzip.compress(text.encode())[:-60])
    with pytest.raises(ValueError, match=r"is damaged, or no text dump"):
        Packing(packed)


def test_units_line_is_an_error_with_the_remedy(write_dump):
    path = write_dump(FRAME)
    path.write_text("ITEM: UNITS\nsi\n" + path.read_text())
    with pytest.raises(ValueError, match="dump_modify ID units no time no"):
        Packing(path)


def test_tilted_box_is_an_error(write_dump):
    with pytest.raises(ValueError, match="only orthogonal"):
        Packing(write_dump(FRAME, boundary="xy xz yz pp pp pp"))


def test_frame_out_of_range_is_an_error(write_dump):
    with pytest.raises(ValueError, match=r"frame 3 asked for.*frames 0 to 0"):
        Packing(write_dump(FRAME)).frame(3)


def test_missing_file_is_an_error(tmp_path):
    with pytest.raises(FileNotFoundError, match="no dump file"):
        Packing(tmp_path / "none.dump")


def test_position_digits_tell_a_default_dump_from_a_full_one(write_dump):
    x = np.random.default_rng(3).random((50, 3))
    columns = {"x": x, "radius": np.full(50, 0.1)}
    assert position_digits(Packing(write_dump(columns, number="%g")).frame(0).x) == 6
    assert position_digits(Packing(write_dump(columns)).frame(0).x) >= 15
