# SPDX-License-Identifier: GPL-2.0-or-later
"""nscd-lmp convert: restitution and friction are what LAMMPS' springs and dashpots do."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from nscd_lmp._core import NscdError
from soft_scripts import PAIRS, SCENE, SPEED, TAIL, D, converted, new_lines, pair_lines, restitution_in, run_lammps

from nscd_lmp.conversion.convert import Known
from nscd_lmp.conversion.restitution import of_ratio

pytestmark = pytest.mark.fast


@pytest.mark.parametrize("name", PAIRS)
def test_restitution_of_pairs_is_that_of_lammps(name: str, tmp_path: Path) -> None:
    """Two grains, one bounce. 2e-3: steps of 2e-7 s are some thousandths of a contact, and e has three digits."""
    lines = pair_lines(PAIRS[name])
    ours = restitution_in(converted(SCENE + lines + TAIL, tmp_path), "pair_coeff")
    approach = f"group a id 1\nvelocity a set 0 0 {SPEED / 2}\ngroup b id 2\nvelocity b set 0 0 {-SPEED / 2}\n"
    move = "fix move all nve/sphere\ntimestep 2e-7\nrun 30000\n"
    v = run_lammps(SCENE + lines + "\n" + approach + move)["v"]
    assert ours == pytest.approx((v[1, 2] - v[0, 2]) / SPEED, abs=2e-3)


WALLS = {
    "hooke": "hooke 1e4 NULL 2e3 NULL 0.5 1",
    "hooke, limited": "hooke/history 1e4 NULL 5e3 NULL 0.5 1 limit_damping",
    "hertz": "hertz/history 1e6 NULL 1e6 NULL 0.5 1",
    "granular": "granular hooke 1e4 2e3 tangential linear_nohistory 1 0.5 damping mass_velocity",
    "granular hertz/material": "granular hertz/material 1e6 1e6 0.3 tangential linear_nohistory 1 0.5",
    "granular tsuji": "granular hertz/material 1e6 0.3 0.3 tangential linear_nohistory 1 0 damping tsuji limit_damping",
}


@pytest.mark.parametrize("name", WALLS)
def test_restitution_of_walls_is_that_of_lammps(name: str, tmp_path: Path) -> None:
    """At a wall the effective mass is that of the grain. Steps as above."""
    one = SCENE.replace("boundary p p p", "boundary p p f")
    one = re.sub(r"create_atoms .*\ncreate_atoms .*", f"create_atoms 1 single 0.05 0.05 {D / 2 * 1.00001}", one)
    pair = "pair_style gran/hooke 1e4 NULL 5e2 NULL 0.5 1\npair_coeff * *\n"
    wall = f"fix floor all wall/gran {WALLS[name]} zplane 0 NULL\n"
    ours = restitution_in(converted(one + pair + wall + TAIL, tmp_path), "fix floor all wall/nscd zplane 0 NULL")
    move = f"velocity all set 0 0 {-SPEED}\nfix move all nve/sphere\n{wall}timestep 2e-7\nrun 30000\n"
    assert ours == pytest.approx(run_lammps(one + pair + move)["v"][0, 2] / SPEED, abs=2e-3)


def test_limited_contacts_bounce_at_any_damping() -> None:
    """Without limit_damping a critically damped contact holds on; with it e is exp(-2), and falls as 1/(2 z)^2."""
    assert of_ratio(1.0, limited=False) == of_ratio(7.0, limited=False) == 0
    assert of_ratio(1.0, limited=True) == pytest.approx(0.1353, abs=1e-4)
    assert of_ratio(1 - 1e-7, limited=True) == pytest.approx(of_ratio(1 + 1e-7, limited=True), rel=1e-5)
    assert of_ratio(100.0, limited=True) == pytest.approx(1 / 200**2, rel=1e-3)  # next term 1/z^2 ln z


@pytest.mark.parametrize(("flag", "friction"), [(0, "0"), (1, "0.5")])
def test_friction_without_history_needs_damping(flag: int, friction: str, tmp_path: Path) -> None:
    """Of gran/hooke with dampflag 0 LAMMPS has no friction at all, whatever xmu."""
    lines = f"pair_style gran/hooke 1e4 NULL 5e2 NULL 0.5 {flag}\npair_coeff * *"
    conversion = converted(SCENE + lines + TAIL, tmp_path)
    assert f"pair_coeff * * friction {friction} restitution" in " ".join(new_lines(conversion))
    assert ("no friction" in conversion.listing) == (flag == 0)
    motion = "group a id 1\nvelocity a set 0.2 0 0.5\nfix move all nve/sphere\ntimestep 2e-7\nrun 30000\n"
    spins = run_lammps(SCENE + lines + "\n" + motion)["omega"]
    assert (abs(spins).max() > 1) == (flag == 1)


def test_restitution_of_hertz_depends_on_the_speed(tmp_path: Path) -> None:
    lines = SCENE + pair_lines(PAIRS["hertz"]) + TAIL
    slow, fast = (
        restitution_in(converted(lines, tmp_path, Known(speed=speed)), "pair_coeff") for speed in (0.01, 10.0)
    )
    assert slow > fast + 0.1
    falls = lines.replace("timestep", "fix g all gravity 9.81 vector 0 0 -1\ntimestep")
    guessed = converted(falls, tmp_path, Known())
    assert "impacts of 0.198: it depends on the speed" in guessed.listing  # sqrt(9.81 * 4e-3)
    with pytest.raises(NscdError, match=r"line 12: restitution of this contact model depends.* --speed V"):
        converted(lines, tmp_path, Known())


def test_spread_of_sizes_is_told(tmp_path: Path) -> None:
    text = SCENE.replace("set group all", "set type 2 diameter 8e-3\nset group all")
    said = converted(text + PAIRS["hooke, strong"] + TAIL, tmp_path).listing
    assert re.search(r"two of the smallest 0\.\d+, of the largest 0\.\d+", said)
