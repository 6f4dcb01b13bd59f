# SPDX-License-Identifier: GPL-2.0-or-later
"""What could be left out of a step: contacts without impulse, grains at rest, islands that could sleep.

A bed settles under law gap. At times are printed: the share of contacts that end without impulse, of grains slower
than a hundredth of g dt, the number of islands (grains that contacts connect; walls connect nothing) and the share of
contacts in the largest one. An island may sleep when all of its grains rest: the last column is the share of contacts
in such islands.

    python benchmarks/rest.py --grains 500
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from record import Record, print_table
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from settled_bed import open_balls

import nscd_lmp

DT = 5e-4  # s
GRAVITY = 9.81  # m/s^2
AT_REST = 0.01  # of g dt


def islands(pairs: NDArray[np.int64], grains: int) -> NDArray[np.int32]:
    """Return the island of every grain; `pairs` (n, 2) are tags, negative for walls."""
    inner = pairs[(pairs > 0).all(axis=1)] - 1
    graph = coo_array((np.ones(len(inner)), (inner[:, 0], inner[:, 1])), shape=(grains, grains))
    return connected_components(graph, directed=False)[1]


def look(lmp: Any, attached: nscd_lmp.Attached, step: int) -> dict[str, float]:
    """Return the columns of the table at this moment."""
    contacts = attached.contacts
    pairs = np.column_stack([contacts["tag_i"], contacts["tag_j"]]).astype(np.int64)
    tags = lmp.numpy.extract_atom("id")[: lmp.extract_global("nlocal")]
    speed = np.zeros(len(tags))
    speed[tags - 1] = np.linalg.norm(lmp.numpy.extract_atom("v")[: len(tags)], axis=1)
    moves = speed > AT_REST * GRAVITY * DT
    label = islands(pairs, len(tags))
    awake = np.zeros(label.max() + 1, dtype=bool)
    awake[label[moves]] = True
    of_contact = label[np.maximum(pairs.max(axis=1), 1) - 1]
    counts = np.bincount(of_contact, minlength=len(awake))
    total = max(len(pairs), 1)
    return {
        "step": step,
        "contacts": len(pairs),
        "without_impulse": float((contacts["impulse"] == 0).mean()) if len(pairs) else 0.0,
        "grains_at_rest": float(1 - moves.mean()),
        "islands_with_contacts": int((counts > 0).sum()),
        "largest_island": float(counts.max() / total),
        "contacts_that_could_sleep": float((~awake[of_contact]).sum() / total),
    }


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--grains", type=int, default=500, help="[%(default)s]")
    parser.add_argument("--friction", type=float, default=0.0, help="[%(default)s]")
    parser.add_argument("--every", type=int, default=50, help="steps between two rows [%(default)s]")
    parser.add_argument("--rows", type=int, default=10, help="[%(default)s]")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="a small bed, only to see that everything runs")
    given = parser.parse_args(words)
    grains, every, rows = (60, 5, 3) if given.quick else (given.grains, given.every, given.rows)
    record = Record("rest")
    record.print_origin()
    lmp, walls = open_balls(grains, DT)
    attached = nscd_lmp.attach(
        lmp,
        law="gap",
        solver="apgs",
        criterion="paper",
        tol=1e-6,
        walls=walls,
        friction=given.friction,
        unconverged="ignore",
    )
    table = []
    for row in range(rows):
        lmp.command(f"run {every} post no")
        seen = look(lmp, attached, (row + 1) * every)
        record.add(grains=grains, friction=given.friction, dt=DT, **seen)
        table.append(list(seen.values()))
    lmp.close()
    columns = [name.replace("_", "\n", 1) for name in seen]
    print_table(f"{grains} grains, friction {given.friction}", columns, table)
    record.write(given.output / "rest.csv")


if __name__ == "__main__":
    main()
