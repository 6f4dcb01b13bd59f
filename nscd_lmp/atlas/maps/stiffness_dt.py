# SPDX-License-Identifier: GPL-2.0-or-later
"""LAMMPS' penalty contacts, by stiffness and time step."""

import math
from typing import Any

import numpy as np

from nscd_lmp.atlas.grid import Axis, Cell
from nscd_lmp.atlas.scenes import GRAVITY, Grains, grains, sides
from nscd_lmp.atlas.trial import Look, row, soft, tiny

ORDER = 90
TITLE = "Stiffness x dt: LAMMPS' penalty contacts, 27 grains of 1 mm fall 3 mm into a box, 0.05 s"
PANELS = {"hooke": "pair_style gran/hooke/history", "hertz": "pair_style gran/hertz/history"}
X = Axis("dt", "time step (s)", (1e-6, 2e-6, 5e-6, 1e-5, 2e-5, 3e-5, 5e-5, 1e-4, 2e-4, 5e-4), (2e-5, 1e-4))
Y = Axis("stiffness", "stiffness of a contact (N/m)", (1.0, 10.0, 100.0, 1e3, 1e4, 1e5), (10.0, 1e3))
SHOWN = "largest overlap over radius; Hertz: stiffness at an overlap of 1 % of the radius"
MECHANISM = (
    "A spring k between grains of mass m makes an impact of speed v overlap by v sqrt(m / 2k), and is stable up "
    "to a step of 2 / omega, sqrt(2 m / k) for a pair and less where several contacts push one grain: small "
    "overlap needs small steps. Beyond the limit each contact hands out energy, until atoms are lost."
)
REMEDY = (
    "a step below a tenth of sqrt(m / k) and k from the overlap that is wanted; or rigid contacts, where neither is"
    " chosen."
)
UNSEEN = {
    "penetrated": "overlap is what a spring is for; LAMMPS cannot know how much of it is too much.",
    "energy grew": "LAMMPS integrates what it is given; energy that grows is no error to it until atoms are lost.",
    "lost atoms": "LAMMPS looks for lost atoms only when it prints thermo output.",
}
RADIUS, WIDTH, DROP, TIME = 0.5e-3, 3.2e-3, 3e-3, 0.05  # m, m, m, s


def run(panel: str, cell: Cell) -> dict[str, Any]:
    """Let soft grains fall."""
    balls = falling()
    walls = sides(WIDTH)
    scale = 1.0 if panel == "hooke" else math.sqrt(0.01 * RADIUS * RADIUS / 2)  # sqrt(overlap R_eff) of Hertz' force
    k, mass = cell["stiffness"], float(balls.mass[0])
    words = f"{k / scale!r} NULL {damping(k, mass) / scale!r} NULL 0.0 0"
    planes = {"floor": "zplane 0 NULL", "x": f"xplane 0 {WIDTH}", "y": f"yplane 0 {WIDTH}"}
    commands = [
        f"pair_style gran/{panel}/history {words}",
        "pair_coeff * *",
        "fix move all nve/sphere",
        *(f"fix {name} all wall/gran {panel}/history {words} {plane}" for name, plane in planes.items()),
        "thermo 100",
    ]
    look = Look(100, GRAVITY * (DROP + RADIUS) * float(balls.mass.sum()), stores=True)
    seen = soft(balls, cell["dt"], round(TIME / cell["dt"]), walls, look, commands, reach=0.0)
    return row(seen, tiny(seen.overlap) if not seen.lost and not seen.error else "")


def falling() -> Grains:
    """Return the grains, 3 mm above the floor."""
    corner = np.stack(np.meshgrid(*[np.arange(3)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    shift = np.random.default_rng(1).uniform(-1, 1, (27, 3))
    return grains(1.05e-3 * corner + (5.5e-4, 5.5e-4, 5.5e-4 + DROP) + 2e-5 * shift, RADIUS)


def damping(k: float, mass: float) -> float:
    """Return gamma_n (1/s) of pairs that bounce with a restitution of 0.5; k in N/m, mass in kg."""
    beta = math.log(2) / math.hypot(math.pi, math.log(2))
    return 2 * beta * math.sqrt(2 * k / mass)
