# SPDX-License-Identifier: GPL-2.0-or-later
"""The ranks of a LAMMPS run, by mpi4py: what the core needs of them in the Python door."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
Letter = tuple[int, Numbers]


class Ranks:
    """Sums, maxima and messages over the ranks of a communicator; core/parallel/ranks.hpp says what each does.

    Parameters
    ----------
    world : mpi4py.MPI.Comm
        That of the LAMMPS instance; messages go by a copy of it.
    """

    def __init__(self, world: MPI.Comm) -> None:
        self.comm = world.Dup()
        self.rank = self.comm.rank
        self.count = self.comm.size
        self.parity = 0
        machine = world.Split_type(MPI.COMM_TYPE_SHARED)
        self.on_this_machine = machine.size
        cores = {core for own in machine.allgather(os.sched_getaffinity(0)) for core in own}
        # MPI that waits keeps its core: with more ranks than cores those that wait let the others work. All ranks must
        # know the same: they choose their calls by it.
        self.crowded = self.comm.allreduce(machine.size > len(cores), MPI.LOR)
        machine.Free()

    def sum(self, numbers: Numbers) -> None:
        """Replace the numbers by their sums over all ranks."""
        self._reduce(numbers, MPI.SUM)

    def max(self, numbers: Numbers) -> None:
        """Replace the numbers by the largest of all ranks."""
        self._reduce(numbers, MPI.MAX)

    def exchange(self, out: list[Letter], into: list[Letter]) -> None:
        """Send numbers to neighbours and fill those that come from them; the lengths are known on both sides."""
        requests = [self.comm.Irecv(numbers, rank, 0) for rank, numbers in into]
        requests += [self.comm.Isend(numbers, rank, 0) for rank, numbers in out]
        self._wait(requests)

    def deliver(self, out: list[Letter]) -> list[Letter]:
        """Send letters to ranks that do not expect them; return those that came, by rank.

        Nonblocking consensus (Hoefler, Siebert & Lumsdaine 2010), as in plugin/mpi_ranks.cpp.
        """
        self.parity ^= 1
        tag = 1 + self.parity
        sends = [self.comm.Issend(numbers, rank, tag) for rank, numbers in out]
        came: list[Letter] = []
        barrier: Any = None
        while True:
            status = MPI.Status()
            message = self.comm.Improbe(MPI.ANY_SOURCE, tag, status)
            if message is not None:
                numbers = np.empty(status.Get_count(MPI.DOUBLE))
                message.Recv(numbers)
                came.append((status.Get_source(), numbers))
            elif self.crowded:
                os.sched_yield()
            if barrier is not None and barrier.Test():
                return sorted(came, key=lambda letter: letter[0])
            if barrier is None and MPI.Request.Testall(sends):
                barrier = self.comm.Ibarrier()

    def _reduce(self, numbers: Numbers, operation: MPI.Op) -> None:
        # As plugin/mpi_ranks.cpp does it, so that both doors sum in the same order.
        if self.crowded:
            self._wait([self.comm.Iallreduce(MPI.IN_PLACE, numbers, operation)])
        else:
            self.comm.Allreduce(MPI.IN_PLACE, numbers, operation)

    def _wait(self, requests: list[MPI.Request]) -> None:
        if self.crowded:
            while not MPI.Request.Testall(requests):
                os.sched_yield()
        else:
            MPI.Request.Waitall(requests)
