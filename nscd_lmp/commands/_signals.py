# SPDX-License-Identifier: GPL-2.0-or-later
"""Signals that end a command in order: Ctrl-C, and what batch systems send before they kill."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NoReturn


@contextmanager
def signals_heard() -> Iterator[None]:
    """Have SIGINT and SIGTERM raise ``KeyboardInterrupt(number)`` inside the ``with`` block.

    Also in a process that was started with SIGINT ignored, as a script's shell starts what it puts into the
    background: a run there would be deaf to everything but a kill, which leaves no table and no last commands.
    """
    if threading.current_thread() is not threading.main_thread():  # Python lets others set no handlers
        yield
        return
    before = {number: signal.signal(number, _interrupt) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def exit_code(interrupt: KeyboardInterrupt) -> int:
    """Return the exit code of a command that was ended so, as shells have it."""
    return 128 + (interrupt.args[0] if interrupt.args else signal.SIGINT)


def _interrupt(number: int, _: object) -> NoReturn:
    raise KeyboardInterrupt(number)
