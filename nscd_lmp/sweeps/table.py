# SPDX-License-Identifier: GPL-2.0-or-later
"""The table of a sweep: a row for every case."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nscd_lmp._core import NscdError
from nscd_lmp.sweeps.cases import OWN_COLUMNS
from nscd_lmp.sweeps.record import OK, write_text

Row = dict[str, Any]


class SweepTable:
    """Rows of a sweep in the order of its cases, and their columns as arrays.

    Attributes
    ----------
    rows : list of dict
        Variables, results, ``status``, ``seconds``, ``message``, ``warnings`` and ``folder`` of each case; None where a
        case has no such result.
    columns : list of str
        The keys that all rows have.
    path : Path
        The same as a CSV file: None is an empty cell, numbers have all digits.
    """

    def __init__(self, rows: Sequence[Row], path: Path) -> None:
        self.columns = _columns(rows)
        self.rows: list[Row] = [{name: row.get(name) for name in self.columns} for row in rows]
        self.path = path

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[Row]:
        return iter(self.rows)

    def __getitem__(self, column: str) -> NDArray[Any]:
        """Return a column.

        Returns
        -------
        ndarray, shape (cases,)
            int64 or bool if all cases have such a value, float64 with NaN for None if numbers, otherwise objects.

        Raises
        ------
        NscdError
            There is no such column.
        """
        if column not in self.columns:
            raise NscdError(f"the table has no column '{column}': it has {', '.join(self.columns)}")
        values = [row[column] for row in self.rows]
        if all(isinstance(value, bool) for value in values):
            return np.array(values, dtype=bool)
        if all(isinstance(value, int) and not isinstance(value, bool) for value in values):
            return np.array(values)
        if all(value is None or (isinstance(value, int | float) and not isinstance(value, bool)) for value in values):
            return np.array([np.nan if value is None else value for value in values], dtype=np.float64)
        return np.array(values, dtype=object)

    @property
    def failures(self) -> list[Row]:
        """The rows whose status is not ``ok``."""
        return [row for row in self.rows if row["status"] != OK]

    def write(self, more: Sequence[Row] = ()) -> None:
        """Write the CSV file, all of it or nothing; `more` are rows below those of the table."""
        text = io.StringIO()
        writer = csv.DictWriter(text, _columns([*self.rows, *more]), lineterminator="\n")
        writer.writeheader()
        writer.writerows([*self.rows, *more])
        write_text(self.path, text.getvalue())


def _columns(rows: Sequence[Row]) -> list[str]:
    """Return the names of all columns, those that every sweep has last."""
    names = dict.fromkeys(name for row in rows for name in row)
    return [*(name for name in names if name not in OWN_COLUMNS), *OWN_COLUMNS]
