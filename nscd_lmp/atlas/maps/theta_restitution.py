# SPDX-License-Identifier: GPL-2.0-or-later
"""Energy of bouncing balls under law moreau, by theta and restitution."""

from typing import Any

import numpy as np

from nscd_lmp.atlas.grid import Axis, Cell
from nscd_lmp.atlas.outcomes import BUDGET, Seen
from nscd_lmp.atlas.scenes import FLOOR, GRAVITY, grains, sides
from nscd_lmp.atlas.trial import Look, hard, row, tiny

ORDER = 60
TITLE = "theta x restitution: energy under law moreau, 1000 steps"
PANELS = {"one": "one ball on a floor", "box": "27 balls in a box", "spring": "a ball on a spring, omega dt = 0.1"}
X = Axis("restitution", "restitution", (0.0, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95, 1.0), (0.0, 1.0))
Y = Axis("theta", "theta", (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0), (0.3, 0.5))
SHOWN = "largest rise of the energy, in % of that at the start, where it is above 0.05 %"
MECHANISM = (
    "In free flight a step changes the energy by (1/2 - theta) m g^2 dt^2, and a bounce by (theta - 1/2) m g dt "
    "v: with theta other than 1/2 both take turns and the energy wavers. Forces that depend on the position are "
    "those of the start of the step: with them a step multiplies the energy of an oscillation by 1 + (1 - theta) "
    "(omega dt)^2, which only restitution below 1 can outdo. Law gap, the default, moves grains as theta 1/2 "
    "does."
)
REMEDY = (
    "theta 1/2 under gravity; with springs and other forces of the position law moreau with theta 1, which keeps the"
    " energy of an oscillation, or steps so small that (omega dt)^2 times their number is small."
)
UNSEEN = {
    "energy grew": "theta is a choice, and a step does not know the potential of the forces that it is given: work done"
    " on the grains by a motor looks the same.",
}
RADIUS, DROP, DT, STEPS = 0.01, 0.1, 2e-3, 1000  # m, m, s
OMEGA = 0.1 / DT
SPEED = 0.5  # m/s, of the ball on the spring


def run(panel: str, cell: Cell) -> dict[str, Any]:
    """Let the balls bounce."""
    options = {"solver": "pdas", "law": "moreau", "theta": cell["theta"], "restitution": cell["restitution"]}
    options |= {"criterion": "natural", "tol": 1e-5, "maxiter": BUDGET}
    seen = tied(options) if panel == "spring" else dropped(panel, options)
    seen.overlap = 0.0  # the law's own, of dt v: a map of its own
    return row(seen, rise(100 * seen.energy_rise) if seen.energy_rise > 5e-4 else "")


def rise(percent: float) -> str:
    """Return a percentage in few characters."""
    return tiny(percent) if percent >= 99.5 else f"{percent:.1f}" if percent < 9.95 else f"{percent:.0f}"


def dropped(panel: str, options: dict[str, Any]) -> Seen:
    """Run balls that fall."""
    if panel == "one":
        balls, walls = grains([(0, 0, RADIUS + DROP)], RADIUS), [FLOOR]
    else:
        corner = np.stack(np.meshgrid(*[np.arange(3)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
        random = np.random.default_rng(1).uniform(-1, 1, (27, 3))
        balls = grains(0.021 * corner + (0.011, 0.011, 0.011 + DROP) + 4e-4 * random, RADIUS)
        walls = sides(0.064)
    scale = GRAVITY * DROP * float(balls.mass.sum())
    # elastic balls can gather so much in one that it leaves the others far below
    return hard(balls, DT, STEPS, walls, Look(50, scale), reach=0.02, room=1.0, **options)


def tied(options: dict[str, Any]) -> Seen:
    """Run a ball on a spring that touches the floor at rest; its kinetic energy is looked at."""
    balls = grains([(0, 0, RADIUS)], RADIUS, v=[(0, 0, SPEED)])
    spring = f"fix spring all spring/self {float(balls.mass[0]) * OMEGA**2!r}"
    return hard(
        balls, DT, STEPS, [FLOOR], Look(100, stores=True, kinetic=True), gravity=0.0, reach=1.0, room=1e6,
        commands=[spring], **options,
    )  # fmt: skip
