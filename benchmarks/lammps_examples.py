# SPDX-License-Identifier: GPL-2.0-or-later
"""LAMMPS' own granular examples: the scripts of inputs/lammps beside their twins with LAMMPS' springs, in turns.

Each runs as it stands, both for the same simulated time. Seconds are processor time of the whole script. The overlap of
rigid grains is the largest of all steps, walls included; that of springs is the largest of pairs in the frames of the
dump, some 50 a part of a run. `result` is the last value of the column of the script that `quantity` names.

    python benchmarks/lammps_examples.py
    python benchmarks/lammps_examples.py --examples pour pour.2d --share 0.5
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import lammps
import numpy as np
from analysis_scripts import compute_overlaps
from record import ROOT, Record, print_table

from nscd_lmp import _core  # loads MPI too, which the LAMMPS library needs

SCRIPTS = ROOT / "inputs" / "lammps"
BENCH_DATA = Path(lammps.__file__).parent / "share/lammps/bench/data.chute"

# the quantity that is shown, and the share of the script's time that is run
EXAMPLES: dict[str, tuple[str, float]] = {
    "chute": ("flow", 0.4),
    "pour.drum": ("height", 1.0),
    "pour.flatwall": ("height", 1.0),
    "pour.granular": ("spread", 1.0),
    "restitution": ("e", 1.0),
    "pour.heat": ("height", 1.0),
    "granregion.box": ("height", 1.0),
    "granregion.funnel": ("out", 1.0),
    "granregion.mixer": ("height", 1.0),
    "pour": ("flow", 1.0),
    "pour.2d": ("height", 1.0),
}
QUICK = ("restitution", "pour.2d")
WORST = _core.TOTALS_COLUMNS.index("worst_overlap_ratio")
GIVEN_UP = _core.TOTALS_COLUMNS.index("unconverged_steps")
COLUMNS = (
    "example", "grains", "simulated", "cpu_per_time", "springs_cpu_per_time", "ratio", "overlap_ratio",
    "springs_overlap_ratio", "given_up_steps", "quantity", "result", "springs_result", "kinetic_energy",
    "springs_kinetic_energy",
)  # fmt: skip


def default(script: Path, name: str) -> str:
    """Return what the script gives an index variable."""
    words = [line.split() for line in script.read_text(encoding="utf-8").splitlines()]
    (found,) = (line[3] for line in words if line[:3] == ["variable", name, "index"])
    return found


def run(script: Path, variables: dict[str, str], quantity: str) -> dict[str, Any]:
    """Run a script in the present folder and return what it took and left."""
    words = [word for name, value in variables.items() for word in ("-var", name, value)]
    began = time.thread_time()
    lmp = lammps.lammps(cmdargs=["-log", "none", "-screen", "none", "-nocite", *words])
    lmp.file(str(script))
    seconds = time.thread_time() - began
    found = {
        "grains": lmp.get_natoms(),
        "simulated": lmp.extract_global("atime")
        + (lmp.extract_global("ntimestep") - lmp.extract_global("atimestep")) * lmp.extract_global("dt"),
        "cpu_seconds": seconds,
        "result": lmp.extract_variable(quantity),
        "kinetic_energy": lmp.get_thermo("ke"),
    }
    if lmp.has_id("fix", "nscd"):
        for name, column in (("overlap_ratio", WORST), ("given_up_steps", GIVEN_UP)):
            found[name] = lmp.extract_fix("nscd", lammps.LMP_STYLE_GLOBAL, lammps.LMP_TYPE_ARRAY, 0, column)
    lmp.close()
    return found


def largest_overlap(dump: Path) -> float:
    """Return the largest overlap over the smaller radius of pairs in all frames of a dump."""
    worst = 0.0
    for frame in dump.read_text(encoding="utf-8").split("ITEM: TIMESTEP")[1:]:
        lines = frame.splitlines()
        if int(lines[3]) == 0:
            continue
        periodic = np.array([word[0] == "p" for word in lines[4].split()[-3:]])
        bounds = np.array([line.split() for line in lines[5:8]], dtype=float)
        rows = np.array([line.split() for line in lines[9:]], dtype=float)
        columns = lines[8].split()[2:]
        x, radius = rows[:, [columns.index(name) for name in "xyz"]], rows[:, columns.index("radius")]
        worst = max(worst, float(compute_overlaps(x, radius, bounds, periodic).max(initial=0.0)))
    return worst


def measure(name: str, share: float) -> dict[str, Any]:
    """Return the row of an example: rigid grains, then springs, for the same share of its time."""
    quantity, own = EXAMPLES[name]
    soft, hard = SCRIPTS / f"in.{name}.springs", SCRIPTS / f"in.{name}"
    variables = {"time": f"{float(default(hard, 'time')) * own * share:.9g}"}
    if name == "chute":
        variables["data"] = str(BENCH_DATA)
    rigid = run(hard, variables | {"dump": "none"}, quantity)
    springs = run(soft, variables | {"dump": "dump.springs"}, quantity)
    row = {"example": name, "quantity": quantity, **rigid}
    row["given_up_steps"] = int(rigid["given_up_steps"])
    row["cpu_per_time"] = rigid["cpu_seconds"] / rigid["simulated"]
    row["springs_cpu_seconds"] = springs["cpu_seconds"]
    row["springs_cpu_per_time"] = springs["cpu_seconds"] / springs["simulated"]
    row["ratio"] = row["cpu_per_time"] / row["springs_cpu_per_time"]
    row["springs_overlap_ratio"] = largest_overlap(Path("dump.springs"))
    for value in ("grains", "result", "kinetic_energy"):
        row[f"springs_{value}"] = springs[value]
    return row


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--examples", nargs="+", choices=list(EXAMPLES), default=list(EXAMPLES))
    parser.add_argument("--share", type=float, default=1.0, help="of the time of each example [%(default)s]")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="two short examples, only to see that everything runs")
    given = parser.parse_args(words)
    if given.quick:
        given.examples = QUICK
        given.share = 0.1
    record = Record("lammps_examples")
    record.print_origin()
    output, home = given.output.resolve(), Path.cwd()
    for name in given.examples:
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                row = measure(name, given.share)
            finally:
                os.chdir(home)
        record.add(**row)
        shown = (f"{key} {value:.5g}" if isinstance(value, float) else f"{key} {value}" for key, value in row.items())
        print(", ".join(shown), flush=True)
        record.write(output / "lammps_examples.csv")
    print_table("LAMMPS' examples", COLUMNS, [[row.get(name) for name in COLUMNS] for row in record.rows])


if __name__ == "__main__":
    main()
