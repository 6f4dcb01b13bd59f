# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs of random scenes, and what no step of them may break."""

from __future__ import annotations

import re
import warnings
from dataclasses import dataclass, field
from typing import Any

import all_pairs
import numpy as np
import random_scenes
import scenes
import watched_runs
from numpy.typing import NDArray
from random_scenes import Scene
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

Array = NDArray[np.float64]
# "Lost atoms" is LAMMPS' own word for grains that were out of the box when a run began
REMEDY = re.compile(
    r"\b(raise|use|take|turn|start|remove|close|look|give|lower|make|another|larger|smaller|a wall plane|Lost atoms)\b"
)
KINDS = (
    "not a number",
    "overlap hidden",
    "overlap exaggerated",
    "overlap unbounded",
    "overlap with what moves",
    "momentum",
    "energy of the scene",
    "energy of the scene, unsolved",
    "energy of an island",
    "energy of an island, unsolved",
)


class Broken(AssertionError):
    """A step broke an invariant; `kind` names it."""

    def __init__(self, kind: str, step: int, text: str) -> None:
        super().__init__(f"{kind}, step {step}: {text}")
        self.kind = kind


@dataclass
class State:
    """What a step starts from or leaves, in the order of the tags."""

    x: Array
    v: Array
    omega: Array


@dataclass
class Record:
    """A run: its states, and the message that ended it early."""

    states: list[State] = field(default_factory=list)
    refused: str = ""


@dataclass
class Step:
    """One step of a scene, from `before` to `after`."""

    scene: Scene
    placed: random_scenes.Placed
    force: Array  # (n, 3), N, without contacts; 0 for obstacles
    before: State
    after: State
    rows: dict[str, Array]
    number: int
    solved: bool

    def __post_init__(self) -> None:
        balls = self.placed.grains
        self.moving = len(balls) - min(self.scene.obstacles, len(balls) - 1)
        self.mass = balls.mass[: self.moving]
        inertia = 0.4 * self.mass * balls.radius[: self.moving] ** 2
        self.inertia = inertia if self.scene.mu else 0 * inertia

    def kinetic(self, v: Array, omega: Array) -> Array:
        """Return the kinetic energy of each moving grain, J."""
        m = self.moving
        return 0.5 * (self.mass * (v[:m] ** 2).sum(axis=1) + self.inertia * (omega[:m] ** 2).sum(axis=1))

    @property
    def kick(self) -> Array:
        """Velocity that forces add in the step, m/s, (moving, 3)."""
        return self.scene.dt * self.force[: self.moving] / self.mass[:, None]

    def islands(self) -> NDArray[np.int64]:
        """Return the number of the island of each moving grain: grains that contacts connect, not through obstacles."""
        i, j = self.rows["tag_i"].astype(int) - 1, self.rows["tag_j"].astype(int) - 1
        pair = (j >= 0) & (j < self.moving) & (i < self.moving)
        graph = coo_array((np.ones(pair.sum()), (i[pair], j[pair])), shape=(self.moving, self.moving))
        return connected_components(graph, directed=False)[1]


def forces_of(scene: Scene, placed: random_scenes.Placed) -> Array:
    """Return the forces on the grains that `build` defines, N."""
    balls = placed.grains
    moving = len(balls) - scene.obstacles
    force = np.zeros((len(balls), 3))
    if scene.gravity:
        force[:moving, 2] -= balls.mass[:moving] * random_scenes.GRAVITY
    for push in scene.pushes:
        if push.grain < moving:
            along = np.array(push.direction) / np.linalg.norm(push.direction)
            force[push.grain] += push.weights * random_scenes.GRAVITY * along
    return force


def state(lmp: Any) -> State:
    """Return a copy of the state."""
    return State(*(scenes.per_atom(lmp, name) for name in ("x", "v", "omega")))


def run(scene: Scene, door: str = "python", but: tuple[str, ...] = ()) -> Record:
    """Run the scene through a door; raise Broken for an invariant that a step breaks (Python door), `but` for some."""
    placed = random_scenes.place(scene)
    scene = random_scenes.sensible(random_scenes.replace(scene, n=len(placed.grains)))
    record = Record()
    lmp = random_scenes.build(scene, placed)
    try:
        with watched_runs.unasked(), warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            _run(lmp, scene, placed, door, record, but)
    finally:
        lmp.close()
    return record


def _run(lmp: Any, scene: Scene, placed: random_scenes.Placed, door: str, record: Record, but: Any) -> None:
    """Take the steps."""
    record.states.append(state(lmp))
    unsolved, left = 0.0, _true(lmp, placed).ratio
    try:
        attached = harden(lmp, scene, placed, door)
        whole = f"post no start 0 stop {scene.steps}"  # to fix deform it is one run
        lmp.command(f"run 0 {whole}")
        for number in range(1, scene.steps + 1):
            lmp.command(f"run 1 pre no {whole}")
            record.states.append(state(lmp))
            if attached is None:
                continue
            stats = attached.stats[-1]
            solved, unsolved = stats["unconverged_steps"] == unsolved, stats["unconverged_steps"]
            force = forces_of(scene, placed)
            step = Step(scene, placed, force, *record.states[-2:], attached.contacts, number, bool(solved))
            now = _true(lmp, placed)
            judge(step, left, now, stats, but)
            left = left if solved else max(left, now.ratio)
    except Exception as error:
        require_remedy(error)
        record.refused = str(error)


def harden(lmp: Any, scene: Scene, placed: random_scenes.Placed, door: str) -> Any:
    """Give the scene's grains to contact dynamics."""
    return scenes.harden(lmp, door, "grains", walls=placed.walls, **random_scenes.options(scene))


def change(lmp: Any, scene: Scene, commands: list[str], grain: int, number: float) -> None:
    """Change something between two runs, if the grain is still there: one of its size, or a share of something."""
    tags = scenes.per_atom(lmp, "id")
    if "{grain}" in commands[0] and grain not in tags:
        return
    if "timestep" in commands[0] and not scene.still:  # fix move does not allow it
        return
    fill = {
        "grain": grain,
        "new": max(tags, default=0) + 1,
        "number": number,
        "seed": int(number * 1e6),
        "least": 2 * random_scenes.LARGEST,  # so a new grain overlaps nothing; or it finds no place
        "speed": number * scene.speed,
        "diameter": 2 * random_scenes.LARGEST * number,
        "step": scene.dt * number,
    }
    lmp.commands_list([command.format(**fill) for command in commands])


def require_remedy(error: Exception) -> None:
    """Let errors pass that say what to do; raise for others."""
    if isinstance(error, AssertionError):
        raise error
    if not REMEDY.search(str(error)) and "for create_atoms" not in str(error):  # LAMMPS' own, in a box that shrinks
        raise Broken("error without a remedy", -1, repr(error)) from error


def _true(lmp: Any, placed: random_scenes.Placed) -> all_pairs.Overlaps:
    """Return the true overlaps as the scene is now."""
    walls = [(wall.point, wall.normal) for wall in placed.walls]
    return all_pairs.largest_overlap(all_pairs.of_lammps(lmp, "grains", walls))


def judge(step: Step, left: float, now: all_pairs.Overlaps, stats: Any, but: tuple[str, ...]) -> None:
    """Raise Broken if the step has broken something, `but` for kinds that may be."""
    for ask in (
        lambda: _judge_numbers(step),
        lambda: _judge_reported(step, now, stats),
        lambda: _judge_overlap(step, left, now),
        lambda: _judge_momentum(step),
        lambda: _judge_energy(step),
    ):
        try:
            ask()
        except Broken as broken:
            if broken.kind not in but:
                raise


def _judge_numbers(step: Step) -> None:
    """Everything is a number."""
    for values in (step.after.x, step.after.v, step.after.omega):
        if not np.isfinite(values).all():
            raise Broken("not a number", step.number, str(values))


def _judge_reported(step: Step, now: all_pairs.Overlaps, stats: Any) -> None:
    """The overlap that is reported is the true one."""
    # law moreau does not see pairs beyond the list that meet late in a step, and tells of grains that move so far
    moved = step.scene.dt * float(np.linalg.norm([step.before.v, step.after.v], axis=2).max())
    if step.scene.law == "moreau" and moved > step.placed.grains.radius.min():
        return
    said = {name: float(stats[name]) for name in watched_runs.COLUMNS}
    round_off = 1e-12 * random_scenes.LARGEST + 4e-16 * float(np.abs(step.after.x).max())
    smallest = float(step.placed.grains.radius.min())
    grown = step.scene.grows * step.scene.dt / smallest  # the ratio is to radii of within the step
    if step.scene.deforms:  # after the step, at a rate that is not known at first
        strain = random_scenes.STRAIN_RATE * step.scene.dt
        jumps = step.number < 3 or step.scene.deforms == "x"  # a box that carries grains carries them after the step
        round_off += float(np.abs(step.placed.edges).sum()) * (strain if jumps else 3 * strain**2)
    for name, true, slack in (
        ("largest_overlap", now.largest, round_off),
        ("largest_overlap_ratio", now.ratio, round_off / smallest + grown * now.ratio),
    ):
        if abs(said[name] - true) > slack + 1e-9 * true:
            how = "hidden" if said[name] < true else "exaggerated"
            raise Broken(f"overlap {how}", step.number, f"{name} {said[name]:.6g}, truly {true:.6g} ({now.where})")


def _judge_overlap(step: Step, left: float, now: all_pairs.Overlaps) -> None:
    """Under law gap a solved step leaves what the start or unsolved steps left, and 5e-4 of a pair's smaller radius.

    Obstacles that `fix move` accelerates, and grains that grow, may add what is of second order, or one step's growth.
    """
    if step.scene.law != "gap" or not step.solved:
        return
    smallest = float(step.placed.grains.radius.min())
    allowed = left + 5e-4 * (1 + 1e-6) + random_scenes.unforeseen(step.scene, step.placed) / smallest
    if now.ratio > allowed + 1e-12 * random_scenes.LARGEST / smallest:
        text = f"{now.ratio:.4g} of the smaller radius, allowed {allowed:.4g} ({now.where})"
        raise Broken("overlap unbounded" if step.scene.still else "overlap with what moves", step.number, text)


def _judge_momentum(step: Step) -> None:
    """Contacts between grains add no momentum to their island."""
    if step.scene.deforms == "v":  # LAMMPS changes velocities where grains leave the box
        return
    island, m = step.islands(), step.moving
    outside = _touch_outside(step)
    gained = step.mass[:, None] * (step.after.v[:m] - step.before.v[:m] - step.kick)
    size = step.mass * (np.abs(step.after.v[:m]) + np.abs(step.before.v[:m]) + np.abs(step.kick)).max(axis=1)
    for number in np.unique(island):
        grains = island == number
        if outside[grains].any():
            continue
        off = np.abs(gained[grains].sum(axis=0)).max()
        # round-off, also of faster motion on the way to the solution
        least = 1e-15 * step.mass[grains].max() * float(np.abs(step.before.v).max())
        if off > 1e-12 * (size[grains].sum() + step.rows["impulse"].sum()) + least:
            raise Broken("momentum", step.number, f"{off:.4g} N s made in an island of {grains.sum()} grains")


def _touch_outside(step: Step) -> NDArray[np.bool_]:
    """Return which grains have contacts with walls or obstacles."""
    touch = np.zeros(len(step.placed.grains), dtype=bool)
    i, j = step.rows["tag_i"].astype(int) - 1, step.rows["tag_j"].astype(int) - 1
    touch[i[(j < 0) | (j >= step.moving)]] = True
    touch[j[(i >= step.moving) & (j >= 0)]] = True
    return touch[: step.moving]


def _judge_energy(step: Step) -> None:
    """Neither the scene nor an island has more kinetic energy than forces alone give it, or, with e > 0, than before.

    Where p >= 0 is complementary to the velocity with its bias, contacts take energy from the free motion, but for
    what recovery gives back: the impulse times its cap, a tenth of what forces change in the step.
    """
    if not step.scene.still:
        return
    island = step.islands()
    _judge_energy_of(step, np.ones(step.moving, dtype=bool), "the scene")
    for number in np.unique(island):
        _judge_energy_of(step, island == number, "an island")


def _judge_energy_of(step: Step, grains: NDArray[np.bool_], what: str) -> None:
    """Raise Broken if these grains have too much energy."""
    m = step.moving
    after = step.kinetic(step.after.v, step.after.omega)[grains].sum()
    own = step.kinetic(step.before.v[:m] + step.kick, step.before.omega)[grains].sum()
    before = step.kinetic(step.before.v, step.before.omega)[grains].sum()
    i, j = step.rows["tag_i"].astype(int) - 1, step.rows["tag_j"].astype(int) - 1
    pressed = float(step.rows["impulse"][np.isin(np.where(i < m, i, j), np.flatnonzero(grains))].sum())
    speed = np.linalg.norm(step.kick, axis=1)[grains]
    if step.scene.e > 0:  # forces work along the way that impacts make
        moved = np.linalg.norm(step.after.v[:m] - step.before.v[:m] - step.kick, axis=1)[grains]
        own = max(own, before) + 0.5 * (step.mass[grains] * speed * moved).sum()
    recovery = pressed * (0.1 * speed.max() + 1e-5 * float(np.abs(step.before.v[:m][grains]).max()))
    share = (1e-6 if step.scene.tight else 2e-2) if step.solved else 1.0
    round_off = 1e-18 + 1e-13 * float(step.mass.sum()) * step.scene.speed**2
    allowed = own * (1 + share) + recovery * (1 + share) + round_off
    if after > allowed:
        text = f"{after:.6g} J, allowed {allowed:.6g}, before {before:.6g}, {grains.sum()} grains"
        raise Broken(f"energy of {what}" + ("" if step.solved else ", unsolved"), step.number, text)
