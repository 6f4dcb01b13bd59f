# SPDX-License-Identifier: GPL-2.0-or-later
"""LAMMPS' command ``quit`` ends the process by C's exit(): what is left to do has to be left with C."""

import ctypes
from collections.abc import Callable, Iterator
from contextlib import contextmanager

_Callback = ctypes.CFUNCTYPE(None, ctypes.c_void_p)


@contextmanager
def at_quit(function: Callable[[], None]) -> Iterator[None]:
    """Have `function` called if the process ends inside the ``with`` block."""
    libc = ctypes.CDLL(None)
    inside = True

    def call(_: object) -> None:
        if inside:
            function()

    callback = _Callback(call)
    key = ctypes.c_int()  # by its address C finds the callback again
    libc["__cxa_atexit"](callback, None, ctypes.byref(key))
    try:
        yield
    finally:
        inside = False
        # Calls it, in vain, and forgets it: later, at exit, Python may be gone.
        libc["__cxa_finalize"](ctypes.byref(key))
