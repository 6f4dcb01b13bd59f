# SPDX-License-Identifier: GPL-2.0-or-later
"""Steps with friction that have no single answer: what sweeps return, what ends a step, and what is said of it."""

from __future__ import annotations

import warnings
from typing import Any

import contact_parts
import coulomb
import numpy as np
import pytest
from scenes import FLOOR, GRAVITY, box_walls, cloud, grains, harden, per_atom, start, state

import nscd_lmp

WIDTH = 5e-3  # m, of the box
DT = 2e-4
SWEEPS = (3, 10, 17, 30, 64, 100, 170, 300, 560, 1000, 1700, 3000)
FRICTIONS = (0.3, 0.5, 0.8, 1.0)


def falling(n: int = 150, **options: Any) -> tuple[Any, nscd_lmp.Attached]:
    """Return grains of 0.25 to 0.5 mm that fall into a box, and what moves them."""
    balls = cloud(n, (0.25e-3, 0.5e-3), WIDTH)
    height = float(balls.x[:, 2].max()) + 1e-3
    lmp = start(balls, DT, gravity=GRAVITY, vmax=1.0, box=[(-1e-4, WIDTH + 1e-4)] * 2 + [(-1e-4, height)])
    return lmp, harden(lmp, walls=box_walls(WIDTH), **options)


@pytest.fixture(scope="module", params=FRICTIONS)
def hard(request: pytest.FixtureRequest) -> list[tuple[nscd_lmp.ContactProblem, Any]]:
    """Return problems of a bed at the end of its fall, and impulses to start from: slow for every solver by sweeps."""
    found = {}

    def solver(system: nscd_lmp.ContactSystem) -> Any:
        problem, given = system.problem(), np.array(system.start)
        found[int(lmp.extract_global("ntimestep"))] = problem, given
        return nscd_lmp.solve(problem, "apgs", tol=1e-3, maxiter=300, warmstart=given, unconverged="ignore").impulse

    lmp, _ = falling(friction=request.param, solver=solver, unconverged="ignore")
    lmp.command("run 320")
    lmp.close()
    return [found[step] for step in (200, 240, 280, 320)]


@pytest.mark.parametrize("solver", ["apgs", "pdas", "ebp", "auto"])
def test_more_sweeps_never_leave_a_larger_residual(hard: Any, solver: str) -> None:
    # auto hands over by how many sweeps are left: with 1700 and with 3000 it goes other ways
    sweeps = [k for k in SWEEPS if solver != "auto" or k <= 1000]
    for problem, given in hard:
        options = {"tol": 1e-12, "warmstart": given, "unconverged": "ignore"}
        left = [nscd_lmp.solve(problem, solver, maxiter=k, **options).residual for k in sweeps]
        # velocities are formed anew from the impulses that are returned
        assert (np.diff(left) <= 1e-9 * np.array(left[:-1]) + 1e-13).all(), left
        assert left[-1] < left[0]


def test_impulses_that_are_returned_are_within_the_cone(hard: Any) -> None:
    for problem, given in hard:
        p = nscd_lmp.solve(problem, "apgs", tol=1e-12, maxiter=170, warmstart=given, unconverged="ignore").impulse
        assert (np.linalg.norm(p[:, 1:], axis=1) <= problem.mu * p[:, 0] * (1 + 1e-12) + 1e-18).all()


def test_solutions_say_what_they_are(hard: Any) -> None:
    problem, given = hard[0]
    solved = nscd_lmp.solve(problem, tol=1e-2, warmstart=given)
    assert solved.status == "solved" and solved.converged
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        accepted = nscd_lmp.solve(problem, tol=1e-6, budget=solved.iterations + 100, warmstart=given, maxiter=100_000)
    assert accepted.status in ("accepted", "solved")
    assert accepted.converged == (accepted.residual < 1e-6)
    assert accepted.residual < 30e-6
    with pytest.warns(UserWarning, match="raise maxiter"):
        stalled = nscd_lmp.solve(problem, "apgs", tol=1e-12, maxiter=3)
    assert stalled.status == "stalled" and not stalled.converged


def test_budget_is_refused_where_it_means_nothing(hard: Any) -> None:
    problem, _ = hard[0]
    for budget, criterion, words in ((-1, "natural", "at least 0"), (0.5, "natural", "whole"), (5, "paper", "natural")):
        with pytest.raises(nscd_lmp.NscdError, match=words):
            nscd_lmp.solve(problem, budget=budget, criterion=criterion)


@pytest.mark.parametrize("friction", FRICTIONS)
@pytest.mark.parametrize("dt", [DT, 5e-4, 1e-3])
def test_beds_with_friction_end_within_their_bounds(friction: float, dt: float) -> None:
    lmp, bed = falling(friction=friction)
    lmp.command(f"timestep {dt}")
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # accepted steps need no warning
        lmp.command(f"run {round(0.08 / dt)}")
    stats = bed.stats
    assert stats["unconverged_steps"][-1] == 0
    assert stats["largest_overlap_ratio"].max() <= 5e-4
    assert stats["relative_residual"].max() <= 0.03
    assert stats["worst_residual"].max() <= 1
    assert stats["iterations"].mean() < 200
    assert np.diff(stats["accepted_steps"]).min() >= 0
    lmp.close()


def test_steps_are_accepted_at_their_budget_and_counted() -> None:
    accepted = {}
    for budget in (0, 10, 1000):
        lmp, bed = falling(friction=0.5, budget=budget, maxiter=3000, unconverged="ignore")
        lmp.command("run 300")
        over = np.diff(bed.stats["accepted_steps"], prepend=0) > 0
        accepted[budget] = int(over.sum())
        assert (bed.stats["relative_residual"][~over] < 1e-3).all() or bed.stats["unconverged_steps"][-1] > 0
        assert (bed.stats["iterations"][over] >= budget).all()
        lmp.close()
    assert accepted[0] == 0
    assert accepted[10] > accepted[1000]


@pytest.mark.parametrize("solver", ["apgs", "pdas"])
def test_what_is_good_enough_at_maxiter_is_accepted(solver: str) -> None:
    # The budget of so few contacts is more than maxiter. A third of the steps were given up. Sweeps are not there after
    # 1000 in a step or two, in which of them hangs on the processor's last bit. 60 grains have no hard step at times.
    given_up = 2
    lmp, bed = falling(70, friction=0.8, accuracy="tight", solver=solver)
    lmp.commands_list(["timestep 5e-4", "run 200"])
    stats = bed.stats
    assert stats["unconverged_steps"][-1] <= given_up
    assert stats["accepted_steps"][-1] > 0
    assert (stats["relative_residual"] <= 30e-4).sum() >= len(stats["relative_residual"]) - given_up
    assert stats["largest_overlap_ratio"].max() <= 1.02e-4  # overlaps round
    lmp.close()


@pytest.mark.parametrize("solver", ["pdas", "sal"])
def test_local_laws_end_within_the_bound_on_overlaps(solver: str) -> None:
    lmp, bed = falling(friction=0.5, solver=solver)
    lmp.commands_list(["timestep 5e-4", "run 150"])
    assert bed.stats["unconverged_steps"][-1] == 0
    assert bed.stats["largest_overlap_ratio"].max() <= 1.02 * 5e-4  # overlaps round
    lmp.close()


def test_accepted_steps_that_would_make_energy_keep_their_bound_on_overlaps() -> None:
    # grains that a force drives down a wall onto the floor, beside a bed; blends with no impulses left 2e-3 in step 182
    r, mu, away = 4e-4, 0.5, 40e-3
    bed, n = cloud(1500, (0.25e-3, 0.5e-3), 16e-3), 30
    column = [(away - r, 8e-3, 5e-3 + 2 * r * k) for k in range(n)]
    balls = grains(np.vstack([column, bed.x]), np.concatenate([np.full(n, r), bed.radius]))
    lmp = start(balls, DT, gravity=GRAVITY, box=[(-1e-4, away + 1e-4), (-1e-4, 16.1e-3), (-1e-3, 35e-3)])
    press = 1.01 * float(balls.mass[0]) * GRAVITY / mu
    lmp.commands_list([f"group column id <= {n}", f"fix press column addforce {press!r} 0 0"])
    sides = [((0, 0, 0), (1, 0, 0)), ((away, 0, 0), (-1, 0, 0)), ((0, 0, 0), (0, 1, 0)), ((0, 16e-3, 0), (0, -1, 0))]
    walls = [FLOOR, *(nscd_lmp.Plane(point, normal) for point, normal in sides)]
    hard = harden(lmp, friction=mu, accuracy="loose", walls=walls)
    lmp.command("run 240")
    assert hard.stats["unconverged_steps"][-1] == 0
    assert hard.stats["accepted_steps"][-1] > 0
    assert hard.stats["largest_overlap_ratio"].max() <= 1.02e-3  # overlaps round
    lmp.close()


def test_accepted_steps_make_no_energy() -> None:
    lmp, bed = falling(friction=0.8, budget=1)
    energies = []
    masses = lmp.numpy.extract_atom("rmass")[:150].copy()
    radii = lmp.numpy.extract_atom("radius")[:150].copy()
    ids = np.argsort(lmp.numpy.extract_atom("id")[:150])
    masses, radii = masses[ids], radii[ids]
    accepted = 0
    for _ in range(300):
        lmp.command("run 1 post no")
        (x, v), omega = state(lmp), per_atom(lmp, "omega")
        turning = 0.2 * radii**2 * (omega**2).sum(1)
        energies.append((masses * (0.5 * (v**2).sum(1) + turning + GRAVITY * x[:, 2])).sum())
        accepted += bed.stats["accepted_steps"][-1]
    assert accepted > 20
    # what gives back overlaps lifts grains by a share of a radius
    assert max(np.diff(energies)) <= 1e-4 * (energies[0] - energies[-1])
    lmp.close()


@pytest.mark.parametrize(
    ("word", "tol", "overlap"), [("loose", 1e-2, 1e-3), ("normal", 1e-3, 5e-4), ("tight", 1e-4, 1e-4)]
)
def test_an_accuracy_bounds_what_steps_leave(word: str, tol: float, overlap: float) -> None:
    lmp, bed = falling(friction=0.3, accuracy=word, unconverged="error")
    lmp.command("run 300")
    assert f"tol {tol:g}" in bed.description
    # overlaps round
    assert bed.stats["largest_overlap_ratio"].max() <= 1.02 * overlap
    assert bed.stats["relative_residual"].max() <= min(30 * tol, 0.1)
    lmp.close()


def test_grains_that_grow_part_in_accepted_steps_too() -> None:
    # what gives overlaps back does work, which is not taken for energy that a step must not make
    balls = cloud(12, (0.5e-3, 0.5e-3), 1.9e-3)
    balls.x[:] = [(1e-3 * k - 1e-9 * k, 0, 1e-3) for k in range(12)]
    lmp = start(balls, 1e-3, vmax=0.1, box=[(-2e-3, 14e-3), (-2e-3, 2e-3), (-2e-3, 4e-3)])
    bed = harden(lmp, friction=0.3, criterion="natural", tol=1e-12, budget=1)
    lmp.commands_list(["run 1", "set group all diameter 1.001e-3"])
    lmp.command("run 1")
    assert bed.stats["energy_limited_steps"][-1] == 0
    assert np.ptp(state(lmp)[1][:, 0]) > 1e-6
    lmp.close()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"accuracy": "best"}, "choose one of loose, normal, tight"),
        ({"accuracy": "tight", "paper": True}, "accuracy goes with criterion natural"),
        ({"budget": -1}, "at least 0"),
        ({"budget": 5, "criterion": "paper"}, "budget goes with criterion natural"),
    ],
)
def test_bad_accuracies_and_budgets_are_refused(options: dict[str, Any], words: str) -> None:
    with pytest.raises(nscd_lmp.NscdError, match=words):
        falling(8, friction=0.5, **options)


def test_a_solution_can_lead_every_sweep_away() -> None:
    """Five discs, nine contacts, friction 0.8: one eigenvalue of what a sweep does to an error is 1.2.

    Where contacts slip, friction goes with the normal impulse, and more of both makes contacts approach faster. This is
    why some beds are never solved to 1e-3 (docs/friction_accuracy.md). Fails if sweeps find the solution, or hide that
    they do not.
    """
    discs = contact_parts.random_assembly("rolling_discs", 321, bodies=5, contacts=9).problem()
    slide = np.arange(len(discs.w)).reshape(-1, 3)[:, :2].ravel()
    given = coulomb.problem(discs.w[np.ix_(slide, slide)], discs.q[:, :2] - [1, 0], 0.8, 2)
    problem = nscd_lmp.ContactProblem(given.w, given.q, given.mu, dim=2)
    solution = nscd_lmp.solve(problem, "interior_point", tol=1e-11, maxiter=100).impulse
    assert coulomb.error(given, solution) < 1e-9
    beside, left = solution * (1 + 1e-7), []
    for _ in range(60):
        sweep = nscd_lmp.solve(problem, "pdas", tol=1e-14, maxiter=1, warmstart=beside, unconverged="ignore")
        beside = sweep.impulse
        left.append(sweep.residual)
    assert left[-1] > 1e3 * min(left)
    for solver in ("sbp", "sal", "ebp", "eal", "pdas", "apgs"):
        answer = nscd_lmp.solve(problem, solver, tol=1e-8, maxiter=20_000, unconverged="ignore")
        assert answer.status == "stalled" and answer.residual > 1e-3
    assert nscd_lmp.solve(problem, "auto", tol=1e-8, maxiter=20_000).status == "solved"
