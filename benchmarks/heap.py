# SPDX-License-Identifier: GPL-2.0-or-later
"""The memory that compiled code holds, as the C library counts it."""

from __future__ import annotations

import ctypes
import gc
from collections.abc import Callable


class _Mallinfo2(ctypes.Structure):
    """``struct mallinfo2`` of glibc; used here: uordblks (from the heap) and hblkhd (mapped), in bytes."""

    _fields_ = tuple(
        (name, ctypes.c_size_t)
        for name in "arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks fordblks keepcost".split()
    )


def allocated_bytes() -> int | None:
    """Return the bytes that are allocated now; None where the C library does not tell (glibc 2.33 does)."""
    try:
        mallinfo2 = ctypes.CDLL(None).mallinfo2
    except (AttributeError, OSError):
        return None
    mallinfo2.restype = _Mallinfo2
    info = mallinfo2()
    return int(info.uordblks + info.hblkhd)


def held_bytes(drop: Callable[[], object]) -> int | None:
    """Return how many bytes `drop` gives back, or None if that cannot be told."""
    gc.collect()
    before = allocated_bytes()
    drop()
    gc.collect()
    after = allocated_bytes()
    return None if before is None or after is None else before - after
