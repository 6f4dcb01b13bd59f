# SPDX-License-Identifier: GPL-2.0-or-later
"""One run of a scene, watched from outside: overlaps and energies from positions, and all that the software says."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from nscd_lmp.atlas.outcomes import Seen, outcome
from nscd_lmp.atlas.scenes import GRAVITY, Array, Grains, overlaps, start, state
from nscd_lmp.door.attach import attach
from nscd_lmp.door.walls import Plane

SPIN = 0.4  # moment of inertia of a sphere over m r^2


@dataclass(frozen=True)
class Look:
    """What is measured of a run, and how often.

    Attributes
    ----------
    times : int
        Overlaps and energy are measured so many times, after equal parts of the run.
    scale : float, J, optional
        Energy that the scene turns over; kinetic energy at the start and m g r unless given.
    answer : (n, 3) float, optional
        Known velocities at the end, m/s.
    stores : bool
        Contacts store energy, as springs do: a rise counts from the start, not from the lowest energy so far.
    kinetic : bool
        Height does not count as energy.
    in_order : bool
        Grains stay in their order along x.
    """

    times: int = 1
    scale: float | None = None
    answer: Any = None
    stores: bool = False
    kinetic: bool = False
    in_order: bool = False


AT_REST = Look(answer=0.0)


def hard(
    balls: Grains,
    dt: float,
    steps: int,
    walls: Sequence[Plane],
    look: Look = AT_REST,
    *,
    gravity: float = GRAVITY,
    reach: float = 0.0,
    room: float = 0.0,
    commands: Sequence[str] = (),
    **options: Any,
) -> Seen:
    """Run rigid grains and return what was seen.

    Parameters
    ----------
    balls : Grains
    dt : float, s
    steps : int
    walls : sequence of Plane
    look : Look
    gravity : float, m/s^2
    reach : float
        Metres that the pair cutoff exceeds the largest diameter by.
    room : float
        Metres that the box extends further than 20 of the largest radii round the grains.
    commands : sequence of str
        For LAMMPS, before the grains are made rigid.
    **options
        Of :func:`nscd_lmp.attach`.
    """
    seen = Seen()

    def run(lmp: Any) -> None:
        lmp.commands_list(list(commands))
        attached = attach(lmp, walls=walls, **options)
        watch(lmp, Watched(balls, walls, gravity, dt), seen, steps, look, lambda: _count(attached, seen))

    _listen(start(balls, dt, gravity=gravity, reach=reach, room=room), seen, run)
    return seen


def last_velocities(balls: Grains, dt: float, walls: Sequence[Plane], **options: Any) -> Array:
    """Return the velocities (n, 3) after one step, m/s; options are those of :func:`nscd_lmp.attach`."""
    lmp = start(balls, dt)
    attach(lmp, walls=walls, **options)
    lmp.command("run 1 post no")
    v = state(lmp)[1]
    lmp.close()
    return v


def soft(
    balls: Grains, dt: float, steps: int, walls: Sequence[Plane], look: Look, commands: Sequence[str], reach: float
) -> Seen:
    """Run soft grains, which these commands define, and return what was seen; the rest as in :func:`hard`."""
    seen = Seen()

    def run(lmp: Any) -> None:
        lmp.commands_list(list(commands))
        watch(lmp, Watched(balls, walls, GRAVITY, dt), seen, steps, look, lambda: None)

    _listen(start(balls, dt, reach=reach), seen, run)
    return seen


def _listen(lmp: Any, seen: Seen, run: Callable[[Any], None]) -> None:
    """Run, and keep what the software says."""
    try:
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            try:
                run(lmp)
            except Exception as error:  # of the package or of LAMMPS: what it says is what we are here for
                seen.error = _plain(error)
        seen.warnings = [_plain(one.message) for one in said]
    finally:
        lmp.close()


def _count(attached: Any, seen: Seen) -> None:
    """Take over what the package counted in the run that has ended."""
    stats = attached.stats
    seen.iterations = int(stats["iterations"].max())
    seen.unconverged += int(stats["unconverged_steps"][-1])
    seen.residual = float(stats["relative_residual"].max())


@dataclass(frozen=True)
class Watched:
    """A scene, as one has to know it to look at it."""

    balls: Grains
    walls: Sequence[Plane]
    gravity: float
    dt: float


def watch(lmp: Any, scene: Watched, seen: Seen, steps: int, look: Look, after_run: Callable[[], None]) -> None:
    """Run the steps in as many parts as there are looks; keep the worst overlap and rise of energy."""
    balls, weight = scene.balls, 0.0 if look.kinetic else scene.gravity
    lowest = energy(balls, *state(lmp), weight)
    scale = look.scale
    if scale is None:
        scale = 0.5 * float((balls.mass[:, None] * balls.v**2).sum()) + scene.gravity * float(balls.mass @ balls.radius)
    for number in range(look.times):
        part = steps * (number + 1) // look.times - steps * number // look.times
        lmp.command(f"run {part} post no")
        after_run()
        x, v, omega = state(lmp)
        if len(x) != len(balls) or not np.isfinite([x, v]).all():
            seen.lost = True
            return
        now = energy(balls, x, v, omega, weight)
        seen.energy_rise = max(seen.energy_rise, (now - lowest) / scale)
        lowest = lowest if look.stores else min(lowest, now)
        seen.overlap_left = max(0.0, float(overlaps(x, balls.radius, scene.walls).max()))
        seen.overlap = max(seen.overlap, seen.overlap_left)
        seen.passed |= look.in_order and bool((np.diff(x[:, 0]) <= 0).any())
    if look.answer is not None:
        seen.velocity_error = float(np.abs(v - look.answer).max() / (scene.gravity * scene.dt))


def energy(balls: Grains, x: Array, v: Array, omega: Array, gravity: float) -> float:
    """Return kinetic (spins included) plus potential energy, J."""
    moving = 0.5 * (balls.mass[:, None] * v**2).sum()
    turning = 0.5 * SPIN * ((balls.mass * balls.radius**2)[:, None] * omega**2).sum()
    return float(moving + turning + gravity * (balls.mass * x[:, 2]).sum())


def row(seen: Seen, shown: str = "", **more: Any) -> dict[str, Any]:
    """Return what was seen as columns of a map's table; `shown` is printed in the cell."""
    return {
        "outcome": outcome(seen),
        "shown": shown,
        "iterations": seen.iterations,
        "unconverged_steps": seen.unconverged,
        "relative_residual": seen.residual,
        "velocity_error": seen.velocity_error,
        "overlap_ratio": seen.overlap,
        "energy_rise": seen.energy_rise,
        **more,
        "told": seen.told,
    }


def count(number: float) -> str:
    """Return a count of iterations in four characters or fewer."""
    if number < 1000:
        return str(int(number))
    thousands = number / 1000
    return f"{thousands:.1f}k" if thousands < 9.95 else f"{thousands:.0f}k"


def tiny(number: float) -> str:
    """Return a positive number in few characters: 0.13, 3e-5."""
    if not 0.0095 <= abs(number) < 99.5:
        return re.sub(r"e([+-])0*(\d)", lambda found: f"e{found[1].strip('+')}{found[2]}", f"{number:.0e}")
    return f"{number:.1g}" if abs(number) < 0.095 else f"{number:.2g}"


def _plain(message: Any) -> str:
    """Return a message on one line, without the colours and source lines of LAMMPS."""
    text = re.sub(r"\x1b\[[0-9;]*m", "", str(message))
    return " ".join(re.sub(r"\(\S*\.cpp:\d+\)", "", text).split())
