# SPDX-License-Identifier: GPL-2.0-or-later
"""What is measured on slabs, in processes of their own: started by `measure`, run by ``python slab_job.py JOB``.

A job is a dict of plain values; so is what comes back, from the first rank.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

DT = 1e-4  # s
# Shared memory alone, with a speed of its own: UCX refuses networks without one, as virtual machines have them.
MPI_ON_ONE_HOST = {"UCX_TLS": "self,sysv", "UCX_SYSV_BW": "10000MBs"}
# Through UCX only. Ranks then seem to be alone on their machine, and do not yield their core when they wait.
MPI_ON_OWN_CORES = {"MPIR_CVAR_NOLOCAL": "1"}

Job = dict[str, Any]


def measure(job: Job, ranks: int = 1) -> Any:
    """Run a job on so many ranks."""
    beside = Path(sys.executable).parent / "mpiexec"
    mpiexec = str(beside) if beside.is_file() else shutil.which("mpiexec")
    if mpiexec is None:
        raise SystemExit("no mpiexec: it comes with the package mpich")
    own_cores = ranks <= len(os.sched_getaffinity(0))
    environment = os.environ | MPI_ON_ONE_HOST | (MPI_ON_OWN_CORES if own_cores else {})
    done = subprocess.run(
        [mpiexec, "-n", str(ranks), sys.executable, __file__, json.dumps(job)],
        env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False,
    )  # fmt: skip
    if done.returncode != 0:
        raise SystemExit(f"job {job} on {ranks} ranks: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return json.loads(done.stdout.splitlines()[-1])


def _open(job: Job, comm: Any = None) -> Any:
    from slab import Cell, open_slab

    placed: Job = {key: job[key] for key in ("sort", "processors", "dt", "cutoff") if key in job}
    cell = Cell.load(Path(job["cell"]))
    return open_slab(cell, tuple(job.get("copies", (1, 1))), **({"dt": DT} | placed | {"comm": comm}))


def _attach(lmp: Any, way: Job) -> Any:
    from slab import FLOOR

    import nscd_lmp

    fixed: Job = {"law": "gap", "walls": [FLOOR], "unconverged": "ignore", "criterion": "paper"}
    return nscd_lmp.attach(lmp, **(fixed | way))


def times(job: Job) -> list[Job]:
    """Take turns between the ways to attach; per way and repeat what `steps` steps took, the longest of the ranks.

    With `apart` every rank has a slab of its own, and all run at the same time.
    """
    from mpi4py import MPI

    lmp = _open(job, MPI.COMM_SELF if job.get("apart") else None)
    rows = []
    for repeat in range(job["repeats"]):
        for k, way in enumerate(job["ways"]):
            attached = _attach(lmp, way)
            lmp.command("run 1 post no")
            MPI.COMM_WORLD.Barrier()
            wall, cpu = time.perf_counter(), time.thread_time()
            lmp.command(f"run {job['steps']} pre no post no")
            wall, cpu = time.perf_counter() - wall, time.thread_time() - cpu
            stats = attached.stats[1:]
            attached.detach()
            seconds = {"wall": wall, "solver": stats["seconds_solver"].sum(), "ours": stats["seconds_contacts"].sum()}
            row: Job = {name: MPI.COMM_WORLD.allreduce(float(s), MPI.MAX) for name, s in seconds.items()}
            row |= {"way": k, "repeat": repeat, "cpu_share": cpu / wall, "grains": lmp.get_natoms()}
            row |= {"contacts": float(stats["contacts"].mean()), "iterations": float(stats["iterations"].mean())}
            row["visits"] = float((stats["contacts"] * stats["iterations"]).sum())
            rows.append(row)
    lmp.close()
    return rows


def _peak() -> int:
    """Return the most bytes of memory that this process has had."""
    lines = Path("/proc/self/status").read_text(encoding="utf-8").splitlines()
    return next(1024 * int(line.split()[1]) for line in lines if line.startswith("VmHWM"))


def memory(job: Job) -> Job:
    """Return the growth of the peak, by LAMMPS and with fix nscd, and what the fix gives back; bytes."""
    from heap import held_bytes
    from lammps import LMP_STYLE_GLOBAL, LMP_TYPE_VECTOR, lammps

    import nscd_lmp  # noqa: F401  (loads the plugin)

    first = lammps(cmdargs=["-screen", "none", "-log", "none", "-nocite"])
    first.commands_list(["units si", "region box block 0 1 0 1 0 1", "create_box 1 box"])
    first.close()
    empty = _peak()
    lmp = _open(job)
    lmp.command("fix move all nve/sphere")
    lmp.command("run 0 post no")
    lammps_peak = _peak()
    lmp.command("unfix move")
    words = " ".join(f"{key} {value}" for key, value in job["ways"][0].items())
    lmp.command(f"fix nscd all nscd {words} unconverged ignore wall plane 0 0 0 0 0 1")
    lmp.command("run 2 post no")
    peak = _peak()
    contacts = lmp.extract_fix("nscd", LMP_STYLE_GLOBAL, LMP_TYPE_VECTOR, 0)
    grains = lmp.get_natoms()
    held = held_bytes(lambda: lmp.command("unfix nscd"))
    return {"grains": grains, "contacts": contacts, "empty": empty, "lammps": lammps_peak, "all": peak, "held": held}


def traffic(job: Job) -> list[Job]:
    """Return for every way what a rank sends in a step: means and maxima over the ranks; and who has whose images."""
    from mpi4py import MPI

    lmp = _open(job)
    comm = MPI.COMM_WORLD
    rows = []
    for way in job["ways"]:
        attached = _attach(lmp, way)
        lmp.command("run 1 post no")
        before = attached.traffic
        lmp.command(f"run {job['steps']} pre no post no")
        sent = {name: (count - before[name]) / job["steps"] for name, count in attached.traffic.items()}
        stats = attached.stats[1:]
        row: Job = {"grains": lmp.get_natoms(), "contacts": float(stats["contacts"].mean())}
        row["iterations"] = float(stats["iterations"].mean())
        for name, count in (sent | {"ghosts": lmp.extract_setting("nghost")}).items():
            row[name] = comm.allreduce(count) / comm.size
            row[f"most_{name}"] = comm.allreduce(count, MPI.MAX)
        attached.detach()
        rows.append(row)
    lmp.close()
    return rows


def sweeps(job: Job) -> list[Job]:
    """Return for every way the iterations of a step from the cell's state: cold, and warm after a step like it."""
    rows = []
    for way in job["ways"]:
        row: Job = {}
        for start, steps in (("cold", 1), ("warm", 2)):
            lmp = _open(job)
            first = _attach(lmp, {"solver": "apgs", "tol": 1e-9, "maxiter": 50000})
            lmp.command("run 1 post no")  # the cell has settled to a looser tolerance
            first.detach()
            attached = _attach(lmp, way | {"warmstart": start == "warm"})
            lmp.command(f"run {steps} post no")
            stats = attached.stats[-1]
            row |= {"grains": lmp.get_natoms(), "contacts": float(stats["contacts"])}
            row[f"seconds_{start}"] = float(stats["seconds_solver"])
            row[start] = float(stats["iterations"]) if stats["unconverged_steps"] == 0 else None
            lmp.close()
        rows.append(row)
    return rows


if __name__ == "__main__":
    from mpi4py import MPI

    given = json.loads(sys.argv[1])
    answer = {"times": times, "memory": memory, "traffic": traffic, "sweeps": sweeps}[given["what"]](given)
    if MPI.COMM_WORLD.rank == 0:
        print(json.dumps(answer, default=float))
