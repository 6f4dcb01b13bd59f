# SPDX-License-Identifier: GPL-2.0-or-later
"""Charts: methods of both families on one ball, penalty springs, Pareto fronts, series, pictures and the command."""

from __future__ import annotations

import csv
import math
from types import SimpleNamespace

import numpy as np
import pytest
from scenes import FLOOR

import nscd_lmp
from nscd_lmp.charts import chart, draw, methods, pareto, penalty, report, scenes, series
from nscd_lmp.charts.cases import penalty_cases, rigid_cases
from nscd_lmp.charts.grains import open_lammps, per_grain
from nscd_lmp.charts.methods import METHODS, PENALTY, RIGID
from nscd_lmp.charts.overlap import Overlaps, largest_overlap
from nscd_lmp.charts.size import Size
from nscd_lmp.cli import main

RADIUS, MASS, STIFFNESS = 0.01, 0.0105, 1e6
NORMAL_ERROR = {RIGID: 1e-9, PENALTY: 0.012}  # penalty with 1/50 of a contact: the impact ends between two steps
SLIP_ERROR = {RIGID: 1e-9, PENALTY: 0.04}
WALLS = {
    "floor": [FLOOR],
    "corner": [FLOOR, nscd_lmp.Plane((-0.5, 0, 0), (1, 0, 0))],
    "tilted": [FLOOR, nscd_lmp.Plane((-0.5, 0, 0), (1, 1, 0))],
}
EVERY_METHOD = pytest.mark.parametrize("method", METHODS)
FRICTIONAL = pytest.mark.parametrize("method", [name for name, method in METHODS.items() if method.friction])


@pytest.fixture
def impact(tmp_path):
    """Return a function that throws a ball at the floor and returns its velocity along, from it, and r omega."""

    def run(method, along=0.0, walls="floor", **contact):
        box = [(-1, 1)] * 3
        lmp = open_lammps(tmp_path, [0, 0, RADIUS * 1.01], RADIUS, MASS, [along, 0, -1.0], box=box)
        dt = 1e-4 if METHODS[method].family == RIGID else penalty.contact_duration(STIFFNESS, MASS) / 50
        case = {"dt": dt, "tol": 1e-11, "stiffness": STIFFNESS}
        contacts = methods.start(lmp, method, case, WALLS[walls], **contact)
        assert contacts.run(round(1.2e-3 / dt)) > 0
        v, omega = per_grain(lmp, "v")[0], per_grain(lmp, "omega")[0]
        found = v[0], v[2], RADIUS * omega[1], contacts
        lmp.close()
        return found

    return run


@pytest.mark.fast
@pytest.mark.parametrize("restitution", [0.2, 0.9])
@EVERY_METHOD
def test_every_method_has_the_wanted_restitution(impact, method, restitution):
    _, v_n, _, _ = impact(method, restitution=restitution)
    assert v_n == pytest.approx(restitution, abs=NORMAL_ERROR[METHODS[method].family])


@FRICTIONAL
def test_every_method_slides_and_sticks_by_coulomb(impact, method):
    mu, e, family = 0.1, 0.9, METHODS[method].family
    slides, _, turns, _ = impact(method, 2.0, restitution=e, friction=mu)
    assert slides == pytest.approx(2 - mu * (1 + e), abs=NORMAL_ERROR[family])
    assert turns == pytest.approx(2.5 * mu * (1 + e), abs=3 * NORMAL_ERROR[family])
    for e_t in (0.0, 0.5):
        v_t, _, turns, _ = impact(method, 0.1, restitution=e, friction=0.5, e_t=e_t)
        assert v_t - turns == pytest.approx(-0.1 * e_t, abs=SLIP_ERROR[family] * 0.5)


@pytest.mark.parametrize("walls", ["corner", "tilted"])
@pytest.mark.parametrize("method", ["gap/pdas", "granular/hooke", "granular/hertz", "gran/hooke/history"])
def test_walls_together_are_each_what_they_are_alone(impact, method, walls):
    alone = impact(method, 0.3, "floor", restitution=0.5, friction=0.3)
    together = impact(method, 0.3, walls, restitution=0.5, friction=0.3)
    np.testing.assert_allclose(together[:3], alone[:3], rtol=0, atol=1e-9)


def test_one_fix_does_all_walls_that_it_can():
    planes = [FLOOR, nscd_lmp.Plane((0, 0, 3), (0, 0, -1)), nscd_lmp.Plane((-1, 0, 0), (1, 0, 0))]
    spring = penalty.Spring("granular", "hooke", 1e4, 0.5, None, MASS, RADIUS, 1.0)
    assert [words.split()[-3:] for words in spring.walls(planes[:2], 0)] == [["zplane", "0.0", "3.0"]]
    region, fix = spring.walls(planes, 0)
    assert "block -1.0 INF INF INF 0.0 3.0 open 2 open 3 open 4" in region and "wall/gran/region" in fix
    own = [FLOOR, nscd_lmp.Plane((-1, 0, 0), (1, 0, 0), friction=0.7)]
    assert [words.split()[3] for words in spring.walls(own, 0.2)] == ["wall/gran", "wall/gran"]


def test_solver_without_friction_refuses_it(impact):
    with pytest.raises(nscd_lmp.NscdError, match="active_set cannot take friction"):
        impact("gap/active_set", friction=0.1)


@pytest.mark.fast
def test_methods_are_those_of_the_registries():
    assert set(methods.rigid_methods()) == {f"{law}/{solver}" for law in nscd_lmp.LAWS for solver in nscd_lmp.SOLVERS}
    frictional = {name.partition("/")[2] for name in methods.rigid_methods(friction=True, laws=["gap"])}
    assert frictional == set(nscd_lmp.FRICTIONAL_SOLVERS)
    assert methods.penalty_methods() == ["granular/hooke", "granular/hertz", "gran/hooke/history"]


@pytest.mark.parametrize("restitution", [0.14, 0.3, 0.6, 0.95, 1.0])
def test_damping_ratio_gives_the_restitution_of_contacts_that_do_not_attract(restitution):
    z = penalty.damping_ratio(restitution)
    d, v, dt = 0.0, 1.0, 1e-5
    while d + 2 * z * v > 0:
        v -= (d + 2 * z * v) * dt
        d += v * dt
    assert -v == pytest.approx(restitution, abs=1e-4)
    assert penalty._hertz_impact(z, 0.0)[0] == pytest.approx(restitution, abs=1e-5)


@pytest.mark.fast
def test_hertz_is_as_soft_as_hooke(tmp_path):
    depths = []
    for method in ("granular/hooke", "granular/hertz"):
        x = [[0, 0, 0], [0.0201, 0, 0]]
        lmp = open_lammps(tmp_path, x, RADIUS, MASS, [[0.5, 0, 0], [-0.5, 0, 0]], box=[(-1, 1)] * 3)
        case = {"dt": 1e-6, "stiffness": STIFFNESS}
        contacts = methods.start(lmp, method, case, restitution=1.0, speed=1.0)
        depths.append(largest_overlap(contacts, [], 300) * RADIUS)
        lmp.close()
    np.testing.assert_allclose(depths, math.sqrt(MASS / 2 / STIFFNESS), rtol=1e-3)


@pytest.mark.fast
def test_overlaps_are_those_of_all_pairs_and_walls():
    random = np.random.default_rng(1)
    x, radius = random.uniform(0, 0.1, (60, 3)), random.uniform(0.005, 0.01, 60)
    look = Overlaps(radius, [nscd_lmp.Plane((0, 0, 0), (0, 0, 2.0))])
    for _ in range(5):
        x += random.uniform(-1e-3, 1e-3, x.shape)
        i, j = np.triu_indices(60, 1)
        pairs = radius[i] + radius[j] - np.linalg.norm(x[i] - x[j], axis=1)
        walls = radius - x[:, 2]
        expected = np.concatenate([pairs[pairs > 0], walls[walls > 0]])
        np.testing.assert_allclose(np.sort(look.look(x)[0]), np.sort(expected))
    assert look.largest_ratio(x) >= expected.max() / 0.01


def test_cases_cover_methods_steps_and_stiffnesses():
    made = rigid_cases(["gap/pdas", "moreau/sbp"], [1e-3, 1e-4], [1e-6], grains=5)
    assert len(made) == 4 and made[0] == {"method": "gap/pdas", "tol": 1e-6, "dt": 1e-3, "grains": 5}
    made = penalty_cases(["granular/hooke"], [1e3, 1e5], 0.01)
    expected = [fraction * math.pi * math.sqrt(0.01 / (2 * k)) for k in (1e3, 1e5) for fraction in (0.1, 0.05, 0.02)]
    np.testing.assert_allclose([case["dt"] for case in made], expected, rtol=5e-3)


def row(method, cost, error, **more):
    return {"method": method, "seconds_per_second": cost, "error": error, "status": "ok", "dt": 1.0} | more


@pytest.mark.fast
def test_pareto_front_and_comparison():
    assert pareto.front([1, 2, 3, 4, 2.5], [5, 3, 4, 1, np.nan]).tolist() == [0, 1, 3]
    rows = [
        row("gap/pdas", 1.0, 1e-2),
        row("gap/pdas", 5.0, 1e-4),
        row("granular/hooke", 0.5, 1e-1),
        row("granular/hooke", 50.0, 1e-3),
        row("gap/apgs", 0.1, 1e-9, unconverged_steps=3.0),
        row("gap/sbp", None, None, status="failed"),
    ]
    found = pareto.compare(rows, "error", [1e-1, 1e-2, 1e-3, 1e-6])
    assert [one["faster"] for one in found[:3]] == [0.5, 50.0, 10.0]
    assert found[3]["rigid"] is None and math.isnan(found[3]["faster"])
    assert pareto.cheapest(rows, "error", 1.0)["seconds_per_second"] == 0.5
    assert report.levels(rows, "error", 1e-14) == [1e-1, 1e-2, 1e-3, 1e-4]


def test_methods_that_do_the_same_are_one_line():
    solvers = list(nscd_lmp.SOLVERS)
    rows = [
        row(f"gap/{solver}", cost * (1 + 0.01 * k), error if solver != "apgs" else 10 * error, dt=dt)
        for k, solver in enumerate(solvers)
        for dt, cost, error in ((1e-3, 1.0, 1e-2), (1e-4, 10.0, 1e-16 * k))
    ]
    made = series.make_series(rows, ["error"], 1e-14)
    assert [[method.solver for method in one.methods] for one in made] == [
        [name for name in solvers if name != "apgs"],
        ["apgs"],
    ]
    names = [f"gap/{solver}" for solver in solvers]
    assert [series.label(one, names) for one in made] == [f"the {len(solvers) - 1} other solvers", "APGS"]


def test_picture_of_zeros_failures_and_published_points(tmp_path):
    rows = [
        row("gap/pdas", 1.0, 0.0),
        row("moreau/pdas", 1.0, 1e-2, unconverged_steps=1.0),
        row("moreau/sbp", None, None, status="failed"),
        row("granular/hooke", 10.0, 1e-3),
    ]
    references = [("an engine", 3.0, {"error": 1e-1}, "a paper")]
    scene = SimpleNamespace(TITLE="a title", ERRORS={"error": "an error"}, REFERENCES=references)
    pictures = draw.draw(scene, rows, tmp_path / "name")
    assert [picture.name for picture in pictures] == ["name.png", "name.svg"]
    words = (tmp_path / "name.svg").read_text()
    for comment in ("an engine", "rigid, law moreau (1 of 2 runs failed)", "hollow: steps left above tol", "penalty"):
        assert f"<!-- {comment} -->" in words
    panel = draw.ErrorRow(rows, "error", ["error"], 1e-14, references)
    assert panel.exact and panel.y(0.0) == pytest.approx(1e-4) and panel.y(1e-3) == 1e-3


@pytest.mark.fast
@pytest.mark.parametrize("name", scenes.names())
def test_every_scene_says_what_it_is(name):
    scene = chart.find_scene(name)
    assert isinstance(scene.ORDER, int) and scene.TITLE and scene.NOTES and scene.ERRORS
    quick, full = scene.cases(Size.QUICK), scene.cases(Size.FULL)
    assert 0 < len(quick) < len(full)
    assert {case["method"] for case in [*quick, *full]} <= METHODS.keys()
    assert all(case["dt"] > 0 for case in [*quick, *full])


@pytest.mark.fast
@pytest.mark.parametrize("name", ["sliding_ball", "bouncing_ball", "oblique_impact", "slide_to_roll"])
def test_closed_forms_are_run_by_every_method(name):
    found = {case["method"] for case in chart.find_scene(name).cases(Size.FULL)}
    friction = name != "bouncing_ball"
    assert found == {*methods.rigid_methods(friction=friction), *methods.penalty_methods()}


def test_command_makes_a_chart_and_goes_on(tmp_path, capfd):
    words = ["chart", "slide_to_roll", "--quick", "--folder", str(tmp_path), "--processes", "2"]
    assert main(words) == 0
    rows = chart.read(tmp_path / "slide_to_roll.csv")
    assert len(rows) == len(chart.find_scene("slide_to_roll").cases(Size.QUICK))
    for one in rows:
        assert one["status"] == "ok"
        assert one["seconds_per_second"] == pytest.approx(one["solve_seconds"] / one["simulated"])
        assert one["distance_error"] < 0.01
        assert one["speed_error"] < 1e-8 and (METHODS[one["method"]].family == PENALTY or one["overlap"] < 1e-14)
    table = (tmp_path / "slide_to_roll.csv").read_text()
    (tmp_path / "slide_to_roll.png").unlink()
    assert main(words) == 0  # runs nothing: the seconds are the same
    assert (tmp_path / "slide_to_roll.csv").read_text() == table
    (tmp_path / "slide_to_roll.png").unlink()
    assert main(["chart", "slide_to_roll", "--draw-only", "--folder", str(tmp_path)]) == 0
    assert (tmp_path / "slide_to_roll.png").stat().st_size > 20_000
    assert "rigid is faster by" in " ".join(capfd.readouterr().out.split())
    with open(tmp_path / "slide_to_roll.csv", newline="") as file:
        assert next(csv.DictReader(file))["chart"] == "slide_to_roll"


def test_command_lists_charts_and_refuses_unknown_ones(tmp_path, capfd):
    assert main(["chart", "--list"]) == 0
    assert "sliding_ball" in capfd.readouterr().out
    assert main(["chart", "nosuch"]) == 1
    assert "there is no chart 'nosuch': choose one of" in capfd.readouterr().err
    assert main(["chart"]) == 1
    assert main(["chart", "sliding_ball", "--draw-only", "--folder", str(tmp_path)]) == 1
    assert "make the chart first" in capfd.readouterr().err
