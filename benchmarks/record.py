# SPDX-License-Identifier: GPL-2.0-or-later
"""Results of a benchmark: rows of a CSV file that say where they come from, and tables on the screen."""

from __future__ import annotations

import csv
import platform
import subprocess
from collections.abc import Sequence
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

import nscd_lmp

ROOT = Path(__file__).resolve().parent.parent
PROVENANCE = ("benchmark", "commit", "cpu", "date", "version")


def commit() -> str:
    """Return the short hash of the commit, with ``-dirty`` for local changes; ``unknown`` outside git.

    It is the commit of this folder: install the package from it before measuring.
    """
    hash_ = _git("rev-parse", "--short", "HEAD")
    if hash_ is None:
        return "unknown"
    return hash_ + ("-dirty" if _git("status", "--porcelain") else "")


def _git(*words: str) -> str | None:
    try:
        done = subprocess.run(["git", "-C", str(ROOT), *words], capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return done.stdout.strip()


def cpu() -> str:
    """Return the model of the processor."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    for line in lines:
        name, _, value = line.partition(":")
        if name.strip() == "model name":
            return value.strip()
    return platform.processor() or platform.machine()


class Record:
    """The rows of one CSV file.

    Parameters
    ----------
    benchmark : str
        First column of every row, followed by commit, cpu, date (UTC) and version of the package.
    """

    def __init__(self, benchmark: str) -> None:
        now = datetime.now(timezone.utc).isoformat(timespec="seconds")
        self.provenance = dict(zip(PROVENANCE, (benchmark, commit(), cpu(), now, nscd_lmp.__version__), strict=True))
        self.rows: list[dict[str, Any]] = []

    def add(self, **values: Any) -> None:
        """Append a row of parameters and results."""
        self.rows.append({**self.provenance, **values})

    def write(self, path: Path) -> None:
        """Write all rows; a value that a row does not have is left empty. Makes the folder."""
        columns = list(dict.fromkeys(name for row in self.rows for name in row))
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, columns)
            writer.writeheader()
            writer.writerows(self.rows)
        print(f"wrote {path}")

    def print_origin(self) -> None:
        """Print where the numbers come from."""
        print(", ".join(f"{name} {value}" for name, value in self.provenance.items()))


def print_table(title: str, columns: Sequence[str], rows: Sequence[Sequence[Any]], note: str = "") -> None:
    """Print a table; numbers with four digits, None as a dash."""
    console = Console()
    if not console.is_terminal:
        console = Console(width=180)  # a file has room
    console.print(f"\n{title}", style="bold", highlight=False)
    table = Table()
    for k, name in enumerate(columns):
        table.add_column(name, justify="left" if k == 0 else "right")
    for row in rows:
        table.add_row(*(_cell(value) for value in row))
    console.print(table)
    if note:
        console.print(note, highlight=False)


def _cell(value: Any) -> str:
    if value is None:
        return "-"
    return f"{value:.4g}" if isinstance(value, float) else str(value)
