// SPDX-License-Identifier: GPL-2.0-or-later
// Interior points on random problems: against sweeps, against the active set, and where there is nothing to find.
#include "check.hpp"
#include "scene.hpp"
#include "solver/solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace {

// W = G G^T, q = G v with as many rows of G as unknowns: contacts of bodies without names. A solution exists.
struct Coupled {
  nscd::BlockMatrix w;
  std::vector<double> q, mu, p;

  Coupled(Random &random, int dim, int contacts, int freedoms, double friction) :
      mu(contacts), p(std::size_t(contacts) * dim, 0.0)
  {
    std::vector<std::vector<double>> g(p.size(), std::vector<double>(freedoms));
    std::vector<double> v(freedoms);
    for (auto &row : g)
      for (double &x : row) x = random(-1, 1);
    for (double &x : v) x = random(-1, 1);
    for (double &x : mu) x = friction;
    const auto dot = [](const auto &a, const auto &b) {
      double sum = 0;
      for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
      return sum;
    };
    for (const auto &row : g) q.push_back(dot(row, v));
    w.dim = dim;
    for (int k = 0; k < contacts; ++k) {
      for (int j = 0; j < contacts; ++j) {
        w.column.push_back(j);
        for (int a = 0; a < dim; ++a)
          for (int b = 0; b < dim; ++b) w.block.push_back(dot(g[k * dim + a], g[j * dim + b]));
      }
      w.row_start.push_back(std::int64_t(w.column.size()));
    }
  }

  nscd::SolverReport solve(const char *solver, double tol, int maxiter = 1000)
  {
    nscd::GlobalProblem problem{.w = w, .q = q, .mu = mu, .p = p};
    const auto &entry = nscd::find_solver(solver);
    nscd::SolverOptions options{tol, maxiter, entry.default_parameter};
    options.stop = nscd::Stop::natural;
    return entry.solve_global(problem, options);
  }

  // The natural map over |q| of the impulses it has now.
  double residual()
  {
    using Frame = nscd::Frame<2>;
    nscd::GlobalProblem problem{.w = w, .q = q, .mu = mu, .p = p};
    nscd::find_diagonals<Frame>(problem);
    return nscd::measure(problem, Frame{}, velocities().data(), nullptr).relative;
  }

  std::vector<double> velocities() const
  {
    std::vector<double> u(p.size());
    w.multiply(p.data(), u.data());
    for (std::size_t i = 0; i < u.size(); ++i) u[i] += q[i];
    return u;
  }

  double away_from(const Coupled &other) const
  {
    const auto a = velocities(), b = other.velocities();
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
  }
};

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

}    // namespace

// Of rank-deficient W too. 1e-6: velocities are off by the natural map times the condition on the active set, < 100.
TEST(interior_points_end_at_the_velocities_of_sweeps)
{
  int solved = 0;
  for (int dim = 2; dim <= 3; ++dim)
    for (const double share : {0.5, 1.5})
      for (int seed = 0; seed < 25; ++seed) {
        Random random(seed);
        Coupled sought(random, dim, 12, int(12 * dim * share), 0.1), swept = sought;
        const auto report = sought.solve("interior_point", 1e-8);
        CHECK(report.converged == (report.criterion.relative < 1e-8));
        solved += report.converged;
        CHECK(swept.solve("pdas", 1e-11, 1000000).converged);
        if (report.converged) CHECK(sought.away_from(swept) < 1e-6);
      }
  CHECK(solved == 100);
}

TEST(interior_points_without_friction_end_at_the_velocities_of_the_active_set)
{
  for (int dim = 1; dim <= 3; ++dim)
    for (int seed = 0; seed < 20; ++seed) {
      Random random(seed);
      Coupled sought(random, dim, 20, 12, 0), normal = sought;
      CHECK(sought.solve("interior_point", 1e-11).converged);
      normal.w.dim = 1;  // the normal rows alone
      std::vector<double> block, q;
      for (std::size_t b = 0; b < normal.w.column.size(); ++b) block.push_back(normal.w.block[b * dim * dim]);
      for (std::size_t k = 0; k < normal.mu.size(); ++k) q.push_back(normal.q[k * dim]);
      normal.w.block = block;
      normal.q = q;
      normal.p.assign(q.size(), 0.0);
      normal.mu.clear();
      CHECK(normal.solve("active_set", 1e-11).converged);
      const auto u = sought.velocities(), v = normal.velocities();
      for (std::size_t k = 0; k < v.size(); ++k) CHECK_NEAR(u[k * dim], v[k], 1e-8);
      for (std::size_t i = 0; i < sought.p.size(); ++i)
        if (i % dim) CHECK(sought.p[i] == 0);
    }
}

TEST(interior_points_have_nothing_to_do_without_contacts)
{
  Random random(1);
  const auto report = Coupled(random, 3, 0, 5, 0.3).solve("interior_point", 1e-8);
  CHECK(report.converged && report.iterations == 0 && report.criterion.relative == 0);
}

TEST(one_factorisation_does_not_solve_a_problem_with_friction_and_makes_it_no_worse)
{
  for (int seed = 0; seed < 10; ++seed) {
    Random random(seed);
    Coupled problem(random, 3, 12, 18, 0.1);
    for (std::size_t i = 0; i < problem.p.size(); i += 3) problem.p[i] = 0.01;
    const double before = problem.residual();
    const auto report = problem.solve("interior_point", 1e-8, 1);
    CHECK(report.iterations == 1 && !report.converged && report.criterion.relative <= before);
    CHECK(problem.residual() == report.criterion.relative);
  }
}

// From its own answer the solver returns at once, with the same bits.
TEST(interior_points_leave_a_solution_alone)
{
  Random random(2);
  Coupled problem(random, 3, 12, 18, 0.1);
  CHECK(problem.solve("interior_point", 1e-10).converged);
  const std::vector<double> p = problem.p;
  const auto again = problem.solve("interior_point", 1e-10);
  CHECK(again.converged && again.iterations == 1 && problem.p == p);
}

TEST(interior_points_pass_over_contacts_that_nothing_moves)
{
  Random random(3);
  Coupled problem(random, 2, 8, 10, 0.1);
  Coupled more = problem;  // a row without blocks, one of zeros
  more.w.row_start.push_back(more.w.row_start.back());
  more.w.column.push_back(9);
  more.w.block.insert(more.w.block.end(), 4, 0.0);
  more.w.row_start.push_back(std::int64_t(more.w.column.size()));
  more.q.insert(more.q.end(), {1, 0.5, 0, -1});
  more.mu.insert(more.mu.end(), {0.1, 0.1});
  more.p.insert(more.p.end(), 4, 0.0);
  CHECK(problem.solve("interior_point", 1e-10).converged && more.solve("interior_point", 1e-10).converged);
  for (std::size_t i = 0; i < problem.p.size(); ++i) CHECK_NEAR(more.p[i], problem.p[i], 1e-8);
  more.q[16] = -1;  // it will penetrate
  CHECK(!more.solve("interior_point", 1e-10).converged);
  more.w.row_start.assign(11, 0);  // and nothing moves at all
  more.w.column.clear();
  more.w.block.clear();
  CHECK(!more.solve("interior_point", 1e-10).converged);
}

TEST(stick_is_solved_where_sweeps_solve_it_or_said_not_to_be)
{
  int solved = 0;
  for (int dim = 2; dim <= 3; ++dim)
    for (int seed = 0; seed < 20; ++seed) {
      Random random(seed);
      Coupled problem(random, dim, 6, 6 * dim + 8, nscd::stick);
      const auto report = problem.solve("interior_point", 1e-9);
      CHECK(report.converged == (report.criterion.relative < 1e-9));
      for (const double p : problem.p) CHECK(std::isfinite(p));
      solved += report.converged;
    }
  CHECK(solved >= 20);  // half of them
}

TEST(numbers_that_are_none_are_never_called_solved)
{
  for (int dim = 1; dim <= 3; ++dim)
    for (int what = 0; what < 4; ++what) {
      Random random(4);
      Coupled problem(random, dim, 6, 20, dim == 1 ? 0 : 0.1);
      if (what == 0) problem.q[dim] = no_number;
      if (what == 1) problem.w.block[0] = no_number;
      if (what == 2) problem.w.block[3] = INFINITY;
      if (what == 3) problem.q[0] = -INFINITY;
      CHECK(!problem.solve("interior_point", 1e-8).converged);
    }
  Random random(4);
  Coupled problem(random, 3, 6, 20, 0.1);
  problem.p[0] = no_number;  // a start that is none does no harm
  CHECK(problem.solve("interior_point", 1e-8).converged);
}

// Two walls that close in on a grain: impulses grow until p - u / W_nn is p, where the natural map is 0.
TEST(a_problem_without_a_solution_is_not_called_solved_by_round_off)
{
  nscd::BlockMatrix w;
  w.row_start = {0, 2, 4};
  w.column = {0, 1, 0, 1};
  w.block = {1, -1, -1, 1};
  Random random(5);
  Coupled problem(random, 1, 2, 1, 0);
  problem.w = w;
  problem.q = {-1, -2};
  const auto report = problem.solve("interior_point", 1e-8);
  CHECK(!report.converged && report.criterion.relative > 0.1);
}
