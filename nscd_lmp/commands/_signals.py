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

    What the process was started to ignore stays ignored: a shell has what a script puts into the background ignore
    SIGINT, so that Ctrl-C ends what is in front. SIGTERM ends a command there, in order.
    """
    if threading.current_thread() is not threading.main_thread():  # Python lets others set no handlers
        yield
        return
    heard = [n for n in (signal.SIGINT, signal.SIGTERM) if signal.getsignal(n) is not signal.SIG_IGN]
    before = {number: signal.signal(number, _interrupt) for number in heard}
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
