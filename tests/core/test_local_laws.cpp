// SPDX-License-Identifier: GPL-2.0-or-later
// Every local law of the registry on one contact, where all can be worked out by hand.
#include "check.hpp"
#include "solver/solver.hpp"

#include <cmath>

using nscd::Body;
using nscd::Contact;

constexpr double tol = 1e-7;

// Bodies i and j meet along z; `bias` as Newton's impact law sets it: e times the approach velocity.
struct OneContact {
  nscd::AlignedVector<Body> bodies;
  std::vector<Contact> contacts;
  nscd::Workspace workspace;
  double e;
  nscd::SolverReport report;

  OneContact(double mi, double vi, double mj, double vj, double restitution = 0, double start = 0) : e(restitution)
  {
    const double wi = 1 / mi, wj = std::isinf(mj) ? 0 : 1 / mj;
    bodies = {Body{1, 2, vi, wi}, Body{3, 4, vj, wj}};
    contacts = {{Body{0, 0, 1, 0}, e * (vi - vj), 1 / (wi + wj), start, 0, 1}};
    nscd::apply_impulse(contacts[0], start, bodies.data());
  }

  const OneContact &solve(const nscd::SolverEntry &solver, double parameter = 0, int maxiter = 1000)
  {
    const double v = nscd::normal_velocity(contacts[0], bodies.data()) + contacts[0].bias;
    const nscd::Material material{0, e, 0};
    const nscd::MaterialNumber number = 0;
    nscd::Problem problem{bodies, contacts, std::abs(v), workspace};
    problem.restitution = {{&number, 1}, {&material, 1}};
    report = solver.solve(problem, {tol, maxiter, parameter > 0 ? parameter : solver.default_parameter});
    return *this;
  }
};

static bool projects_a_gradient_step(const nscd::SolverEntry &s) { return s.name == "sbp" || s.name == "sal"; }

// v+ = -e v- for the pair, momentum kept, tangential components untouched.
TEST(every_law_gives_the_closed_form_of_an_impact)
{
  for (const auto &solver : nscd::solvers())
    for (const double e : {0.0, 0.5, 1.0})
      for (const double mj : {1.0, 3.0, 100.0, double(INFINITY)}) {
        OneContact c(2, -1.5, mj, std::isinf(mj) ? 0 : 0.5, e);
        const double approach = c.bodies[0][2] - c.bodies[1][2], m = c.contacts[0].w_inverse;
        c.solve(solver);
        const double close = 2 * tol * (1 + e);  // what criterion (42) below tol leaves to v
        CHECK(c.report.converged);
        CHECK_NEAR(c.bodies[0][2] - c.bodies[1][2], -e * approach, close);
        CHECK_NEAR(c.contacts[0].impulse, -m * (1 + e) * approach, m * close);
        CHECK_NEAR(c.bodies[0][2], -1.5 + c.contacts[0].impulse / 2, 1e-15);
        CHECK(c.bodies[0][0] == 1 && c.bodies[0][1] == 2 && c.bodies[1][0] == 3 && c.bodies[1][1] == 4);
        if (std::isinf(mj)) CHECK(c.bodies[1][2] == 0);
      }
}

// Table 1 of the paper: PDAS 1, EBP and EAL 2.
TEST(newton_laws_are_exact_after_one_or_two_visits)
{
  for (const double e : {0.0, 0.5, 1.0}) {
    CHECK(OneContact(2, -1, 5, 1, e).solve(nscd::find_solver("pdas")).report.iterations == 1);
    CHECK(OneContact(2, -1, 5, 1, e).solve(nscd::find_solver("ebp")).report.iterations == 2);
    CHECK(OneContact(2, -1, 5, 1, e).solve(nscd::find_solver("eal")).report.iterations == 2);
  }
}

// After k visits p = m (1 - q^k), v = -q^k with q = 1 - rho: with m = 1 (42) is below tol where q^k (2 - q^k) is.
TEST(gradient_laws_need_the_visits_of_their_geometric_series)
{
  for (const auto &solver : nscd::solvers()) {
    if (!projects_a_gradient_step(solver)) continue;
    for (const double rho : {0.1, 0.25, 4.0 / 9.0, 0.9, 1.5}) {
      const double q = 1 - rho;
      int expected = 1;
      // For rho > 1 visits overshoot: v > 0 then counts by its bipotential alone.
      for (double error = q; !(std::abs(error) * (1 - error) + std::max(0.0, error) < tol); error *= q) ++expected;
      const int iterations = OneContact(1, -1, INFINITY, 0).solve(solver, rho).report.iterations;
      CHECK(iterations >= expected && iterations <= 1.02 * expected + 1);  // nlgs.hpp: not each sweep is measured
    }
    CHECK(OneContact(1, -1, INFINITY, 0).solve(solver, 1.0).report.iterations == 1);
  }
}

TEST(one_visit_of_each_law_is_as_its_header_says)
{
  for (const auto &solver : nscd::solvers()) {
    OneContact c(2, -3, INFINITY, 0);
    c.solve(solver, 0, 1);
    double expected = 6;  // pdas and global solvers: the exact impulse m |v|
    if (projects_a_gradient_step(solver)) expected = 6 * solver.default_parameter;
    if (solver.name == "ebp" || solver.name == "eal") expected = 0;  // chi = 0: not in contact yet
    CHECK_NEAR(c.contacts[0].impulse, expected, 1e-15);
    CHECK_NEAR(c.bodies[0][2], -3 + expected / 2, 1e-15);
    CHECK(c.report.iterations == 1 && c.report.converged == (expected == 6));
  }
}

TEST(a_separating_contact_gets_no_impulse)
{
  for (const auto &solver : nscd::solvers()) {
    OneContact c(2, 1, 3, 0);
    c.solve(solver);
    CHECK(c.contacts[0].impulse == 0 && c.bodies[0][2] == 1 && c.bodies[1][2] == 0);
    CHECK(c.report.iterations == 1 && c.report.converged && c.report.criterion.total() == 0);
  }
}

TEST(a_start_impulse_is_taken_back_from_a_separating_contact)
{
  for (const auto &solver : nscd::solvers()) {
    OneContact c(2, 1, INFINITY, 0, 0, 0.25);
    c.solve(solver);
    CHECK(c.report.converged && c.contacts[0].impulse == 0);
    CHECK_NEAR(c.bodies[0][2], 1, 1e-15);
  }
}

TEST(the_exact_start_impulse_is_kept)
{
  for (const auto &solver : nscd::solvers()) {
    OneContact c(2, -1, INFINITY, 0, 0, 2);
    c.solve(solver);
    CHECK(c.report.converged && c.report.iterations == 1);
    CHECK_NEAR(c.contacts[0].impulse, 2, 1e-15);
  }
}

TEST(a_parameter_away_from_its_default_still_solves_one_contact)
{
  for (const auto &solver : nscd::solvers())
    for (const double factor : {0.1, 0.5, 2.0}) {
      if (solver.parameter.empty()) continue;
      OneContact c(2, -1, 3, 0);
      c.solve(solver, factor * solver.default_parameter);
      CHECK(c.report.converged);
      CHECK_NEAR(c.bodies[0][2], c.bodies[1][2], 2 * tol);
    }
}

// rho >= 2 / W_nn: the step overshoots, the projection drops the impulse, and so on for ever.
TEST(gradient_laws_with_rho_too_large_stop_at_maxiter_and_say_so)
{
  for (const auto &solver : nscd::solvers()) {
    if (!projects_a_gradient_step(solver)) continue;
    OneContact c(1, -1, INFINITY, 0);
    c.solve(solver, 2.5, 50);
    CHECK(!c.report.converged && c.report.iterations == 50 && c.report.criterion.total() > 0.1);
  }
}

TEST(maxiter_bounds_the_iterations)
{
  for (const auto &solver : nscd::solvers()) {
    OneContact c(1, -1, INFINITY, 0);
    c.solve(solver, 1e-3, 3);
    CHECK(c.report.iterations <= 3);
    CHECK(c.report.converged == (c.report.criterion.total() < tol));
  }
}

TEST(no_contacts_are_solved_at_once)
{
  nscd::AlignedVector<Body> bodies(3);
  nscd::Workspace workspace;
  for (const auto &solver : nscd::solvers()) {
    nscd::Problem problem{bodies, {}, 0, workspace};
    const nscd::SolverReport report = solver.solve(problem, {});
    CHECK(report.converged && report.iterations == 0 && report.criterion.total() == 0);
  }
}
