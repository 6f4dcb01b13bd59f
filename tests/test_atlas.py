# SPDX-License-Identifier: GPL-2.0-or-later
"""The atlas: maps, rules, tables, pictures and command; what single cells show is in test_atlas_maps.py."""

from __future__ import annotations

import csv
import re
from pathlib import Path
from typing import Any

import pytest

import nscd_lmp
from nscd_lmp.atlas import find_maps, make
from nscd_lmp.atlas.atlas import fingerprint
from nscd_lmp.atlas.draw import label
from nscd_lmp.atlas.grid import Axis, Size, cells_of
from nscd_lmp.atlas.outcomes import GOOD, MEANING, OUTCOMES, Seen, is_silent, outcome
from nscd_lmp.atlas.trial import count, tiny
from nscd_lmp.cli import main

MAPS = find_maps()
PAGE = Path(__file__).parent.parent / "docs" / "atlas.md"
CHEAP = "gamma_mass"
# What a message has to say besides that something is wrong.
REMEDY = re.compile(
    r"raise|use criterion|use law|start without|take another|closer to|remove one|smaller step|start it|https://docs.lammps.org/err",
    re.I,
)


def plain(text: str) -> str:
    """Return text on one line."""
    return " ".join(text.split())


def test_maps_are_those_of_the_issue_in_their_order() -> None:
    assert list(MAPS) == [
        *("rho_mass", "gamma_mass", "column_tolerance", "mass_order", "impact_dt", "theta_restitution"),
        *("friction_rank", "overlap_recovery", "stiffness_dt", "polydispersity"),
    ]
    assert set(MAPS["rho_mass"].PANELS) == {name for name, one in nscd_lmp.SOLVERS.items() if one.parameter == "rho"}
    for name in ("mass_order", "polydispersity"):
        assert set(MAPS[name].Y.values) == set(nscd_lmp.SOLVERS)


@pytest.mark.parametrize("name", MAPS)
def test_a_map_says_what_fails_and_why(name: str) -> None:
    one = MAPS[name]
    assert one.MECHANISM.endswith(".") and one.REMEDY.endswith(".") and not one.SHOWN.endswith(".")
    assert set(one.UNSEEN) <= set(OUTCOMES) - set(GOOD)
    for axis in (one.X, one.Y):
        assert set(axis.quick) <= set(axis.values) and len(set(axis.values)) == len(axis.values)
    assert 30 <= len(one.X.values) * len(one.Y.values) <= 80
    assert len(one.PANELS) * len(cells_of(one.X, one.Y, Size.QUICK)) <= 24


@pytest.mark.parametrize("name", MAPS)
def test_no_cell_fails_without_a_word_but_for_the_reasons_given(name: str) -> None:
    one = MAPS[name]
    for panel in one.PANELS:
        for cell in cells_of(one.X, one.Y, Size.QUICK):
            found = one.run(panel, cell)
            if found is None:
                continue
            silent = is_silent(found["outcome"], found["told"])
            assert not silent or found["outcome"] in one.UNSEEN, (panel, cell, found)
            assert silent or found["outcome"] in GOOD or REMEDY.search(found["told"]), (panel, cell, found)


@pytest.mark.parametrize(
    ("seen", "expected"),
    [
        (Seen(iterations=1000), "converged"),
        (Seen(iterations=1001), "slow"),
        (Seen(iterations=20000, unconverged=1, residual=0.5), "stalled"),
        (Seen(iterations=5, velocity_error=0.11), "stalled"),
        (Seen(velocity_error=float("nan")), "stalled"),
        (Seen(unconverged=1, residual=1.5), "diverged"),
        (Seen(unconverged=1, residual=float("nan")), "diverged"),
        (Seen(error="solver sbp diverged: the criterion is not a number"), "diverged"),
        (Seen(energy_rise=0.011, overlap=0.5), "energy grew"),
        (Seen(overlap=0.011, unconverged=1, residual=0.1), "penetrated"),
        (Seen(passed=True), "penetrated"),
        (Seen(error="grains 1 and 2 overlap by 0.1, more than the smaller radius 0.05"), "penetrated"),
        (Seen(error="contacts could be missed: two grains can be nearer"), "stalled"),
        (Seen(error="ERROR: Lost atoms: original 2 current 1", energy_rise=10.0), "lost atoms"),
        (Seen(lost=True), "lost atoms"),
    ],
)
def test_rules_name_the_worst_that_applies(seen: Seen, expected: str) -> None:
    assert outcome(seen) == expected


def test_an_error_that_no_rule_knows_is_not_given_a_name() -> None:
    with pytest.raises(ValueError, match="no outcome is known"):
        outcome(Seen(error="unknown solver 'x'"))


def test_told_is_the_error_or_the_first_warning() -> None:
    assert Seen(error="a", warnings=["b"]).told == "error: a"
    assert Seen(warnings=["b", "c"]).told == "warning: b"
    assert Seen().told == ""
    assert is_silent("stalled", "") and not is_silent("stalled", "warning: b") and not is_silent("slow", "")
    assert list(MEANING) == list(OUTCOMES)


def test_a_map_is_made_from_a_sweep_and_gone_on_with(tmp_path: Path) -> None:
    made = make(CHEAP, tmp_path, Size.QUICK, progress=False)
    one = MAPS[CHEAP]
    assert not made.failures and [path.name for path in made.pictures] == [f"{CHEAP}.png", f"{CHEAP}.svg"]
    assert made.pictures[0].read_bytes()[:4] == b"\x89PNG" and b"</svg>" in made.pictures[1].read_bytes()
    with open(made.table, newline="") as file:
        rows = list(csv.DictReader(file))
    expected = [(panel, str(c["mass_ratio"]), str(c["gamma"])) for panel in one.PANELS for c in quick_cells(one)]
    assert [(row["panel"], row["mass_ratio"], row["gamma"]) for row in rows] == expected
    assert {row["outcome"] for row in rows} <= set(OUTCOMES)
    results = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("result.json")}
    assert len(results) == 1
    again = make(CHEAP, tmp_path, Size.QUICK, progress=False)
    assert again.cells == made.cells
    assert {path: path.stat().st_mtime_ns for path in tmp_path.rglob("result.json")} == results


def quick_cells(one: Any) -> list[Any]:
    """Return the quick cells of a panel."""
    return cells_of(one.X, one.Y, Size.QUICK)


def test_a_map_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(nscd_lmp.NscdError, match=r"there is no map 'nosuch': choose one of rho_mass"):
        make("nosuch", tmp_path)
    assert main(["atlas", "nosuch", "--folder", str(tmp_path)]) == 1


def test_a_change_of_a_map_is_a_change_of_its_cases() -> None:
    assert len({fingerprint(one) for one in MAPS.values()}) == len(MAPS)


def test_the_command_lists_the_maps(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["atlas", "--list"]) == 0
    printed = capsys.readouterr().out
    assert all(name in printed for name in MAPS)


def test_cells_go_row_by_row() -> None:
    axes = Axis("a", "", (1.0, 2.0, 3.0), (1.0, 3.0)), Axis("b", "", ("p", "q"), ("q",))
    assert cells_of(*axes, Size.QUICK) == [{"a": 1.0, "b": "q"}, {"a": 3.0, "b": "q"}]
    assert len(cells_of(*axes, Size.FULL)) == 6


def test_numbers_are_short() -> None:
    assert [count(n) for n in (7, 999, 1000, 9940, 9960, 20000)] == ["7", "999", "1.0k", "9.9k", "10k", "20k"]
    assert [tiny(n) for n in (3e-5, 0.02, 0.13, 1.6)] == ["3e-5", "0.02", "0.13", "1.6"]
    ticks = [label(v) for v in (0.0, 4 / 9, 20.0, 1e3, 1e-6, 3e-5, "stick")]
    assert ticks == ["0", "0.444", "20", "$10^3$", "$10^{-6}$", r"$3\cdot10^{-5}$", "stick"]


@pytest.mark.parametrize("name", MAPS)
def test_the_page_has_the_map_and_its_explanation(name: str) -> None:
    text, one = plain(PAGE.read_text()), MAPS[name]
    assert (PAGE.parent / "pictures" / f"atlas_{name}.png").is_file() and f"pictures/atlas_{name}.png" in text
    assert plain(one.MECHANISM) in text and plain(one.REMEDY) in text
    assert all(plain(why) in text for why in one.UNSEEN.values())
