# SPDX-License-Identifier: GPL-2.0-or-later
"""How far a sweep is: a bar on a terminal, elsewhere a line for each case."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager

from rich.console import Console, RenderableType
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.text import Text

from nscd_lmp.sweeps.record import OK
from nscd_lmp.sweeps.table import Row


class Watch:
    """Shows the cases that end; on standard error, so that output stays the caller's."""

    def __init__(self, cases: int, earlier: Sequence[Row], *, quiet: bool) -> None:
        self.console = console = Console(stderr=True, quiet=quiet, highlight=False)
        self.cases = cases
        self.done = self.before = len(earlier)
        self.failed = sum(row["status"] != OK for row in earlier)
        self.bar = _BarWithLine(
            BarColumn(bar_width=None),
            MofNCompleteColumn(),
            TextColumn("cases"),
            TimeRemainingColumn(),
            console=console,
            expand=True,
            disable=not console.is_terminal,
        )

    @contextmanager
    def on(self) -> Iterator[None]:
        """Show inside the ``with`` block."""
        if self.before and not self.console.is_terminal:
            self.console.print(f"{self.before} of {self.cases} cases are there already", soft_wrap=True)
        self.task = self.bar.add_task("", total=self.cases, completed=self.before)
        with self.bar:
            yield

    def ended(self, name: str, row: Row) -> None:
        """Tell that a case has ended."""
        self.done += 1
        self.failed += row["status"] != OK
        self.bar.update(self.task, completed=self.done)
        told = f"{name}: {row['status']}, {row['seconds']:.3g} s" + (f", {row['message']}" if row["message"] else "")
        self.bar.line = f"{self.failed} failed · {told}" if self.failed else told
        if not self.console.is_terminal:
            line = f"[{self.done}/{self.cases}] {told}"
            self.console.print(line, markup=False, soft_wrap=True)


class _BarWithLine(Progress):
    """A progress bar with a line of text below."""

    line = ""

    def get_renderables(self) -> Iterable[RenderableType]:
        yield self.make_tasks_table(self.tasks)
        yield Text(self.line, style="dim", no_wrap=True, overflow="ellipsis")
