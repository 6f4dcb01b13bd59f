# SPDX-License-Identifier: GPL-2.0-or-later
"""The program of a case's own process: ``python worker.py FOLDER PARENT``, and ``python worker.py FOLDER`` as a rank.

FOLDER has the file case.json, which says what to run; the answer goes to result.json beside it. The process dies with
the sweep that has started it, however that ends.
"""

import json
import os
import sys


def main() -> None:
    """Run a case, or become the program that starts its ranks."""
    folder = sys.argv[1]
    with open(os.path.join(folder, "case.json"), encoding="utf-8") as file:
        spec = json.load(file)
    sys.path[:] = spec["path"]  # that of the sweep's process, without the folder of this file
    ranks = spec["mpiexec"]
    parent = int(sys.argv[2]) if len(sys.argv) > 2 else None
    import signal

    if parent is not None and ranks:
        # mpiexec takes its ranks with it if it is asked to end.
        _die_with(parent, signal.SIGTERM)
        os.execv(ranks[0], [*ranks, sys.executable, os.path.abspath(__file__), folder])
    _die_with(parent, signal.SIGKILL)
    import faulthandler

    faulthandler.enable()
    from nscd_lmp.sweeps.work import work

    work(folder, spec)


def _die_with(parent: int | None, number: int) -> None:
    """Have the kernel send a signal to this process, or the program it becomes, when its parent ends."""
    import ctypes

    before = os.getppid()
    set_parent_death_signal = 1
    ctypes.CDLL(None).prctl(set_parent_death_signal, ctypes.c_ulong(number), 0, 0, 0)
    if os.getppid() != (before if parent is None else parent):
        os._exit(1)


if __name__ == "__main__":
    main()
