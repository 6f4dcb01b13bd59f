# SPDX-License-Identifier: GPL-2.0-or-later
"""What this machine can do at most, measured beside what is compared with it: one thread."""

from __future__ import annotations

import os
import subprocess
import sys
import time

import numpy as np

ROUNDS = 7


def seconds_per_byte_updated(size: int) -> float:
    """Return what it takes to read and write back a byte of an array of so many bytes, s."""
    array = np.zeros(max(size // 8, 64))
    repeats = max(1, 20_000_000 // size)
    best = float("inf")
    for _ in range(ROUNDS):
        start = time.perf_counter()
        for _ in range(repeats):
            np.add(array, 1.0, out=array)
        best = min(best, (time.perf_counter() - start) / repeats)
    return best / array.nbytes


def seconds_per_flop() -> float:
    """Return what a floating-point operation takes at best, by a product of matrices, s.

    In a process of its own: how many threads numpy's library takes is settled when it is loaded.
    """
    one_thread = dict.fromkeys(("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"), "1")
    done = subprocess.run(
        [sys.executable, __file__], env={**os.environ, **one_thread}, capture_output=True, text=True, check=True
    )
    return float(done.stdout)


def _multiply_matrices() -> float:
    n = 384
    a = np.ones((n, n))
    out = np.empty_like(a)
    best = float("inf")
    for _ in range(ROUNDS):
        start = time.perf_counter()
        np.matmul(a, a, out=out)
        best = min(best, time.perf_counter() - start)
    return best / (2 * n**3)


if __name__ == "__main__":
    print(_multiply_matrices())
