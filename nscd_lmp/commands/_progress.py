# SPDX-License-Identifier: GPL-2.0-or-later
"""How far a run is: the numbers that fix nscd publishes, and ways to show them while LAMMPS runs."""

import ctypes
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from nscd_lmp_plugin import plugin_folder
from rich.console import Console, RenderableType
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.text import Text

from nscd_lmp import _core

SECONDS_BETWEEN_LINES = 10.0


# of the run that is on, or the last one
RUN = ("first_step", "last_step", "step", "time", "step_contacts", "step_iterations")


class Counts(ctypes.Structure):
    """What ``fix nscd`` publishes; plugin/progress.hpp has the same numbers in the same order.

    Memory of the plugin that outlives every fix and may be read at any time. LAMMPS' C interface does not
    serve here: a second thread could meet a fix, or all of LAMMPS, as ``unfix`` or ``clear`` takes it apart.
    """

    _fields_ = tuple((name, ctypes.c_double) for name in (*_core.TOTALS_COLUMNS, *RUN))


def zeroed_counts() -> Counts:
    """Return the numbers of the plugin, live, after setting them to 0; LAMMPS must have loaded it."""
    plugin = ctypes.CDLL(str(Path(plugin_folder()) / "nscdplugin.so"))
    counts = Counts.in_dll(plugin, "nscd_progress")
    ctypes.memset(ctypes.byref(counts), 0, ctypes.sizeof(counts))
    return counts


class NoWatch:
    """Shows nothing; base of those that do."""

    @contextmanager
    def on(self, console: Console) -> Iterator[None]:
        """Show on the console inside the ``with`` block."""
        self.console = console
        yield

    def show(self, counts: Counts) -> None:
        """Bring what is shown up to date."""


class RunBar(NoWatch):
    """One bar on a terminal: steps of the run that is on, and a line of numbers below it."""

    @contextmanager
    def on(self, console: Console) -> Iterator[None]:
        self.span = (0.0, 0.0)
        self.bar = _BarWithLine(
            BarColumn(bar_width=None),
            MofNCompleteColumn(),
            TextColumn("steps"),
            TimeRemainingColumn(),
            console=console,
            expand=True,
        )
        self.task = self.bar.add_task("", total=None)
        with self.bar:
            yield

    def show(self, counts: Counts) -> None:
        span = (counts.first_step, counts.last_step)
        done = counts.step - counts.first_step
        if span == (0, 0):
            return
        if span != self.span or done < self.bar.tasks[0].completed:
            self.span = span
            self.bar.reset(self.task, total=int(span[1] - span[0]))
        self.bar.update(self.task, completed=int(done))
        self.bar.line = " · ".join(_numbers(counts, self.bar.tasks[0].speed))


class _BarWithLine(Progress):
    """A progress bar with a line of text below."""

    line = "no step by fix nscd yet"

    def get_renderables(self) -> Iterable[RenderableType]:
        yield self.make_tasks_table(self.tasks)
        yield Text(self.line, style="dim", no_wrap=True, overflow="ellipsis")


class RunLines(NoWatch):
    """A plain line now and then, where the output is no terminal."""

    @contextmanager
    def on(self, console: Console) -> Iterator[None]:
        self.console = console
        self.shown_at = time.monotonic()
        self.shown_steps = 0.0
        yield

    def show(self, counts: Counts) -> None:
        elapsed = time.monotonic() - self.shown_at
        if elapsed < SECONDS_BETWEEN_LINES or counts.steps == self.shown_steps:
            return
        speed = (counts.steps - self.shown_steps) / elapsed
        self.shown_at += elapsed
        self.shown_steps = counts.steps
        place = f"step {counts.step:.0f} of {counts.last_step:.0f}"
        self.console.print(", ".join([place, *_numbers(counts, speed)]), soft_wrap=True)


def format_speed(speed: float) -> str:
    """Return steps per second, to three digits at least, without an exponent."""
    return f"{speed:.3g} steps/s" if speed < 100 else f"{speed:.0f} steps/s"


def _numbers(counts: Counts, speed: float | None) -> list[str]:
    return [
        f"time {counts.time:.4g}",
        *([format_speed(speed)] if speed else []),
        f"{counts.step_contacts:.0f} contacts",
        f"{counts.step_iterations:.0f} iterations",
    ]
