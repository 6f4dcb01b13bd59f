# SPDX-License-Identifier: GPL-2.0-or-later
"""Cells of the atlas whose numbers or outcomes are known."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import nscd_lmp
from nscd_lmp.atlas import find_maps
from nscd_lmp.atlas.maps import friction_rank, polydispersity, stiffness_dt
from nscd_lmp.atlas.maps._carried import carried, stacked
from nscd_lmp.atlas.outcomes import GOOD, outcome
from nscd_lmp.atlas.scenes import FLOOR, grains, pile, sides, start
from nscd_lmp.atlas.trial import AT_REST, Look, hard

MAPS = find_maps()


def cell(name: str, panel: str, x: Any, y: Any) -> dict[str, Any]:
    """Return the columns of a cell."""
    one = MAPS[name]
    found = one.run(panel, {one.X.name: x, one.Y.name: y})
    assert found is not None
    return found


@pytest.mark.parametrize("solver", ["sbp", "sal", "ebp", "eal"])
def test_laws_with_a_rho_carry_equal_balls_at_their_default_and_rest(solver: str) -> None:
    found = cell("rho_mass", solver, 1.0, nscd_lmp.SOLVERS[solver].default)
    assert found["outcome"] == "converged" and found["velocity_error"] < 1e-4


@pytest.mark.fast
@pytest.mark.parametrize("solver", ["sbp", "sal"])
def test_a_rho_far_too_large_is_an_error_that_names_the_remedy(solver: str) -> None:
    found = cell("rho_mass", solver, 1.0, 100.0)
    assert found["outcome"] == "diverged"
    assert "error:" in found["told"] and "rho or gamma closer to its default" in found["told"]


@pytest.mark.parametrize("solver", ["ebp", "eal"])
def test_enhanced_laws_do_not_mind_rho(solver: str) -> None:
    sweeps = [cell("rho_mass", solver, 1.0, rho)["iterations"] for rho in (0.01, 1.0, 100.0)]
    assert max(sweeps) <= min(sweeps) + 4


def test_gamma_far_above_one_drops_contacts_that_push() -> None:
    assert cell("gamma_mass", "yes", 1.0, 1.0)["outcome"] == "converged"
    dropped = cell("gamma_mass", "yes", 1.0, 100.0)
    assert dropped["outcome"] not in GOOD and dropped["unconverged_steps"] == 1


def test_the_shaken_pile_moves_as_the_active_set_says() -> None:
    found = cell("gamma_mass", "no", 10.0, 1.0)
    assert found["outcome"] in GOOD and found["velocity_error"] < 1e-3


@pytest.mark.parametrize("n", [5, 20])
def test_a_column_stands_by_the_natural_criterion(n: int) -> None:
    for solver in ("pdas", "apgs", "auto"):
        found = cell("column_tolerance", f"{solver}_natural", float(n), 1e-4)
        # the residual bounds velocities up to the smallest eigenvalue of the chain
        assert found["outcome"] in GOOD and found["velocity_error"] < 1e-4 * n**2


@pytest.mark.parametrize("ratio", [10.0, 100.0])
def test_sweeps_grow_with_the_mass_ratio_only_where_heavy_lies_on_light(ratio: float) -> None:
    # two grains: a sweep leaves R / (R + 1) of the fall, 2.3 R sweeps a decade
    rates = [stacked([1, ratio], solver="pdas", tol=tol).iterations for tol in (1e-4, 1e-6)]
    assert (rates[1] - rates[0]) / 2 == pytest.approx(math.log(10) / math.log(1 + 1 / ratio), rel=0.05, abs=1)
    equal, below = (stacked([r] + [1] * 9, solver="pdas").iterations for r in (1, ratio))
    assert below < equal


@pytest.mark.fast
@pytest.mark.parametrize("order", ["heavy_on_light", "light_on_heavy", "in_turn"])
def test_factorisations_do_not_mind_the_mass_ratio(order: str) -> None:
    for solver in ("active_set", "auto"):
        found = cell("mass_order", order, 1e6, solver)
        assert found["outcome"] == "converged" and found["velocity_error"] < 0.1


@pytest.mark.fast
@pytest.mark.parametrize(("speed", "dt"), [(1.0, 1e-3), (10.0, 1e-3), (100.0, 1e-1)])
def test_law_gap_lets_nothing_pass_at_any_step(speed: float, dt: float) -> None:
    found = cell("impact_dt", "gap", speed, dt)
    assert found["outcome"] == "converged" and found["overlap_ratio"] < 1e-9


@pytest.mark.parametrize(("speed", "dt"), [(1.0, 1e-3), (3.0, 1e-4), (10.0, 3e-4)])
def test_overlap_under_law_moreau_is_that_of_the_first_step_that_sees_it(speed: float, dt: float) -> None:
    found = cell("impact_dt", "moreau", speed, dt)
    radius, gap, move = 5e-3, 0.0237 - 0.01, speed * dt
    halves = math.ceil(gap / move - 0.5) + 0.5  # moves at which the midpoint lies in the other ball
    # from the midpoint on both balls move alike
    assert found["overlap_ratio"] == pytest.approx((halves * move - gap) / radius, abs=1e-6)
    assert found["outcome"] == "penetrated"


def test_a_ball_passes_another_under_law_moreau() -> None:
    found = cell("impact_dt", "moreau", 100.0, 1e-2)
    assert found["outcome"] == "penetrated" and found["shown"] == "passed"


def test_a_list_that_is_too_short_misses_no_ball() -> None:
    found = cell("impact_dt", "short", 100.0, 1e-2)
    assert found["outcome"] == "converged" and found["overlap_ratio"] < 1e-6


def test_theta_one_half_keeps_the_energy_of_a_bouncing_ball() -> None:
    assert cell("theta_restitution", "one", 1.0, 0.5)["energy_rise"] < 1e-9
    assert cell("theta_restitution", "one", 1.0, 0.0)["outcome"] == "energy grew"


@pytest.mark.parametrize("theta", [0.0, 0.5, 1.0])
def test_a_spring_gains_energy_by_the_step_as_the_mechanism_says(theta: float) -> None:
    dt, omega, speed = 2e-3, 20.0, 0.5
    steps = round(13 * math.pi / (omega * dt))  # ends where the kinetic energy is largest
    balls = grains([(0, 0, 1)], 0.01, v=[(0, 0, speed)])
    spring = f"fix spring all spring/self {float(balls.mass[0]) * omega**2!r}"
    look = Look(steps // 5, stores=True, kinetic=True)
    options: dict[str, Any] = {"gravity": 0.0, "commands": [spring], "law": "moreau", "theta": theta}
    seen = hard(balls, dt, steps, [FLOOR], look, **options, reach=1.0, room=1e3)
    growth = (1 + (1 - theta) * (omega * dt) ** 2) ** steps  # determinant of the step
    assert 1 + seen.energy_rise == pytest.approx(growth, rel=0.05)


def test_law_gap_moves_a_ball_on_a_spring_as_theta_one_half_does() -> None:
    balls = grains([(0, 0, 1)], 0.01, v=[(0, 0, 0.5)])
    commands = [f"fix spring all spring/self {float(balls.mass[0]) * 400!r}"]
    look = Look(20, stores=True, kinetic=True)
    rises = [
        hard(balls, 2e-3, 2000, [FLOOR], look, gravity=0.0, commands=commands, law=law, reach=1.0).energy_rise
        for law in ("moreau", "gap")
    ]
    assert rises[0] > 0.5 and rises[0] == pytest.approx(rises[1], rel=1e-6)


@pytest.mark.parametrize(("name", "layers"), friction_rank.PILES.items())
def test_rank_deficiencies_are_those_of_the_labels(name: str, layers: int) -> None:
    shares = []

    def solve(system: nscd_lmp.ContactSystem) -> Any:
        w = system.delassus()
        shares.append(1 - np.linalg.matrix_rank(w, tol=1e-9 * w.max(), hermitian=True) / len(w))
        return system.start

    balls = pile(layers)
    lmp = start(balls, 1e-4)
    nscd_lmp.attach(lmp, solver=solve, friction=0.5, walls=[FLOOR], unconverged="ignore")
    lmp.command("run 1 post no")
    lmp.close()
    assert name == f"{len(balls)} balls, {shares[0]:.0%}".replace("%", " %")


def test_piles_that_friction_cannot_hold_slide_and_others_rest() -> None:
    # a ball of no weight between floor and upper ball needs tan(17.6 degrees) = 0.32; one of the same weight less
    assert carried(1e3, solver="auto", friction=0.33).velocity_error < 1e-3
    assert carried(1e3, solver="auto", friction=0.30).velocity_error > 1e-2


def test_overlap_is_given_back_no_faster_than_a_tenth_of_gravity_and_nothing_flies_apart() -> None:
    found = cell("overlap_recovery", "column", 0.9, 0.2)
    assert found["outcome"] == "converged"
    # grain k of five rises with k times 0.1 g dt; the scale is m g r
    fastest = np.mean(np.arange(1, 6) ** 2) * (0.1 * 9.81 * 1e-3) ** 2 / 2 / (9.81 * 0.5e-3)
    assert found["energy_rise"] == pytest.approx(fastest, rel=0.05)
    assert cell("overlap_recovery", "column", 0.3, 0.0)["overlap_ratio"] == pytest.approx(0.3, abs=1e-4)


def test_an_overlap_beyond_the_radius_is_an_error_that_names_the_remedy() -> None:
    found = cell("overlap_recovery", "column", 1.1, 0.2)
    assert found["outcome"] == "penetrated" and "remove one of them" in found["told"]


def test_a_wedged_column_is_not_called_solved() -> None:
    found = cell("overlap_recovery", "wedged", 0.1, 0.2)
    assert found["outcome"] not in GOOD and found["unconverged_steps"] > 0


def test_penalty_overlap_falls_with_the_root_of_the_stiffness() -> None:
    soft, stiff = (cell("stiffness_dt", "hooke", 1e-5, k)["overlap_ratio"] for k in (10.0, 1e3))
    assert soft / stiff == pytest.approx(10, rel=0.3)


@pytest.mark.fast
def test_penalty_loses_atoms_beyond_its_step() -> None:
    mass, k = float(grains([(0, 0, 0)], 0.5e-3).mass[0]), 1e4
    assert 5e-5 > 2 * math.sqrt(2 * mass / k)
    assert cell("stiffness_dt", "hooke", 5e-5, k)["outcome"] in ("lost atoms", "energy grew")


def test_law_gap_needs_no_small_step_where_penalty_does() -> None:
    balls = stiffness_dt.falling()
    seen = hard(
        balls, 5e-4, 100, sides(stiffness_dt.WIDTH), Look(50), reach=2e-3, law="gap", criterion="natural", tol=1e-6
    )
    assert outcome(seen) == "converged" and seen.overlap_left < 1e-6 and seen.energy_rise < 1e-4
    # planes half-way through a step may be nearer than the surface by half of `overlap`; this is given back
    assert seen.overlap < 2.5e-4


def test_a_large_ball_rests_on_small_ones() -> None:
    found = cell("polydispersity", "large", 20.0, "active_set")
    assert found["outcome"] == "converged" and found["velocity_error"] < 1e-3
    balls = polydispersity.carpet(20.0)
    gap = np.linalg.norm(balls.x[:-1] - balls.x[-1], axis=1) - balls.radius[:-1] - balls.radius[-1]
    assert np.sum(np.abs(gap) < 1e-12) == 4 and gap.min() > -1e-12


@pytest.mark.fast
def test_scenes_of_rest_are_at_rest_by_the_active_set() -> None:
    for masses in ([1, 100, 1], [1] * 5):
        assert stacked(masses, solver="active_set").velocity_error < 1e-6
    assert AT_REST.answer == 0.0
