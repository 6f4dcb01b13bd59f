# SPDX-License-Identifier: GPL-2.0-or-later
"""Rows of contacts: fresh wherever they are read, whole, in the units of LAMMPS, and kept."""

from __future__ import annotations

import resource

import numpy as np
import pytest
from meeting_balls import DT, balls
from scenes import DOORS, GRAVITY, harden

import nscd_lmp

BOTH = pytest.mark.parametrize("door", DOORS)
WALL = nscd_lmp.Plane((1, 0, 0), (-1, 0, 0))
FALL = f"velocity all set 0 0 0\nfix gravity all gravity {GRAVITY} vector 1 0 0\n"
SUM = "compute sum all reduce sum f_nscd[10] inputs local\nvariable sum equal c_sum\n"
__all__ = ["balls"]  # a fixture


def test_rows_are_those_of_the_step_for_variables_that_fixes_print(balls, tmp_path):
    lmp = balls(after=FALL)
    harden(lmp, "script", walls=[WALL], tol=1e-12)
    lmp.commands_string(SUM + "variable px equal xcm(all,x)\nvariable p equal vcm(all,x)*mass(all)\nthermo 1000")
    lmp.command(f"fix print all print 1 '$(step) $(v_sum:%.17g) $(v_p:%.17g)' file {tmp_path / 'sums'} screen no")
    lmp.command("run 45")
    _, sums, p = np.loadtxt(tmp_path / "sums").T
    # All impulses together: the wall's, which take what gravity gives, and the pair's, as large as what the ball
    # without the wall gives away.
    given = 2 * GRAVITY * DT - np.diff(p)
    pressed = sums[1:] > 0
    assert pressed.sum() > 20 and len(set(sums[-20:])) > 1
    assert (sums[1:][pressed] >= given[pressed] - 1e-9).all()
    assert np.abs(np.diff(sums[1:])[:20]).max() > 0.1  # they change from step to step
    first = np.flatnonzero(np.abs(given) > 1e-6)[0]
    assert sums[1:][first] == pytest.approx(given[first], rel=1e-9)  # the wall alone is met


def test_fix_halt_sees_the_impulse_of_the_step_that_it_stops(balls):
    lmp = balls(after=FALL)
    harden(lmp, "script", walls=[WALL], tol=1e-12)
    lmp.commands_string(SUM + "thermo 1000\nfix halt all halt 1 v_sum > 0.5 error continue")
    lmp.command("run 100")
    assert lmp.extract_global("ntimestep") < 30
    assert lmp.numpy.extract_fix("nscd", 2, 2)[:, 9].sum() > 0.5


def test_rows_are_fresh_between_the_pieces_of_a_run(balls, tmp_path):
    lmp = balls(after=FALL)
    harden(lmp, "script", walls=[WALL], tol=1e-12)
    lmp.command("thermo 1000")
    path = tmp_path / "rows"
    lmp.command(f'run 40 every 1 "write_dump all local {path}.* index f_nscd[10] modify format float %.17g"')
    totals = [
        np.loadtxt(f"{path}.{step}", skiprows=9, ndmin=2).reshape(-1, 2)[:, 1].sum() if step else 0
        for step in range(41)
    ]
    assert len(set(totals[20:40])) > 10


@pytest.mark.parametrize(("friction", "columns"), [(0.0, 10), (0.5, 13)])
def test_dump_local_of_all_columns_has_all_columns(balls, tmp_path, friction, columns):
    lmp = balls(after=FALL)
    harden(lmp, "script", friction=friction, walls=[WALL])
    lmp.command(f"dump rows all local 30 {tmp_path / 'rows'} index f_nscd[*]")
    lmp.command("run 30")
    header, *rows = (tmp_path / "rows").read_text().split("ITEM: ENTRIES ")[-1].splitlines()
    assert header.split() == ["index", *(f"f_nscd[{k}]" for k in range(1, columns + 1))]
    assert {len(row.split()) for row in rows} == {columns + 1}
    assert lmp.extract_fix("nscd", 0, 2, 0, 0) == 30  # totals are where they were


UNITS = ("si", "lj", "cgs", "real", "metal", "electron", "micro", "nano")


@BOTH
@pytest.mark.parametrize("units", UNITS)
def test_energy_and_impulses_are_in_the_units_of_lammps(balls, door, units):
    lmp = balls(units=units, speed=0.1, after="compute ke all ke")
    attached = harden(lmp, door, restitution=0.5, law="moreau", tol=1e-12)
    lmp.command("run 0")
    before = lmp.extract_compute("ke", 0, 0)
    lmp.command("run 120")
    taken = before - lmp.extract_compute("ke", 0, 0)
    assert taken == pytest.approx(0.75 * before, rel=1e-9)  # 1 - e^2
    if attached:
        assert attached.stats["dissipated_energy"][-1] == pytest.approx(taken, rel=1e-9)
    else:
        assert lmp.extract_fix("nscd", 0, 1, 8) == pytest.approx(taken, rel=1e-9)
        assert lmp.extract_fix("nscd", 0, 2, 0, 7) == pytest.approx(taken, rel=1e-9)


@BOTH
@pytest.mark.parametrize("units", UNITS)
def test_impulse_over_dt_is_the_force_in_every_unit(balls, door, units):
    lmp = balls(units=units, speed=0.1)
    attached = harden(lmp, door, tol=1e-12)
    for _ in range(120):
        lmp.command("run 1")
        rows = attached.contacts["impulse"] if attached else lmp.numpy.extract_fix("nscd", 2, 2)[:, 9]
        if len(rows) and rows[0] > 0:
            break
    force = abs(lmp.numpy.extract_atom("f")[0, 0])
    assert force > 0
    assert rows[0] / DT == pytest.approx(force, rel=1e-12)


def test_contacts_keep_their_tags_whatever_lammps_does_then(balls):
    lmp = balls(after=FALL)
    attached = harden(lmp, "python", walls=[WALL])
    lmp.command("run 60")
    kept = attached.contacts
    assert sorted(zip(kept["tag_i"], kept["tag_j"], strict=True)) in ([(1, 2), (2, -1)], [(2, -1), (2, 1)])
    lmp.commands_list(["delete_atoms group one compress no", "run 0"])
    for name, column in attached.contacts.items():
        np.testing.assert_array_equal(column, kept[name])
    lmp.command("clear")
    for name, column in attached.contacts.items():
        np.testing.assert_array_equal(column, kept[name])


def test_contacts_after_a_refused_step_are_those_of_the_last_good_one(balls):
    refuse = False

    def solver(system):
        if refuse:
            raise ZeroDivisionError
        impulses = np.zeros(len(system))
        for _ in range(50):
            W = system.delassus()
            for c in range(len(system)):
                impulses[c] = max(0.0, impulses[c] - (W[c] @ impulses + system.velocity[c]) / W[c, c])
        return impulses

    lmp = balls(after=FALL)
    attached = nscd_lmp.attach(lmp, solver=solver, walls=[WALL])
    lmp.command("run 60")
    kept, refuse = attached.contacts, True
    assert len(kept["gap"]) == 2
    with pytest.raises(ZeroDivisionError):
        lmp.command("run 5")
    for name, column in attached.contacts.items():
        np.testing.assert_array_equal(column, kept[name])


def test_full_folder_for_temporary_files_is_an_error(balls):
    lmp = balls()
    harden(lmp, "python")
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, hard))
    try:
        with pytest.raises(nscd_lmp.NscdError, match=r"could not write .* is it full\?.*TMPDIR"):
            lmp.command("run 1")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    lmp.command("run 1")
