// SPDX-License-Identifier: GPL-2.0-or-later
// The active set method where the plain one ends wrongly or not at all, and what it says where there is no solution.
#include "check.hpp"
#include "scene.hpp"
#include "solver/solver.hpp"

#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace {

constexpr nscd::SolverOptions to_1e11{.tol = 1e-11, .maxiter = 1000, .stop = nscd::Stop::natural};

// A frictionless problem with all entries of W, row by row; zeros are not stored.
struct Quadratic {
  std::vector<double> w, q, p;
  nscd::BlockMatrix rows{};

  explicit Quadratic(std::size_t n) : w(n * n), q(n), p(n) {}
  std::size_t size() const { return q.size(); }
  double &at(std::size_t i, std::size_t j) { return w[i * size() + j]; }

  nscd::SolverReport solve(std::string_view solver, const nscd::SolverOptions &options)
  {
    rows = {};
    for (std::size_t i = 0; i < size(); ++i) {
      for (std::size_t j = 0; j < size(); ++j)
        if (at(i, j) != 0) {
          rows.column.push_back(std::int32_t(j));
          rows.block.push_back(at(i, j));
        }
      rows.row_start.push_back(std::int64_t(rows.column.size()));
    }
    nscd::GlobalProblem problem{.w = rows, .q = q, .mu = {}, .p = p};
    return nscd::find_solver(solver).solve_global(problem, options);
  }

  std::vector<double> velocities() const
  {
    std::vector<double> u(size());
    rows.multiply(p.data(), u.data());
    for (std::size_t i = 0; i < size(); ++i) u[i] += q[i];
    return u;
  }
};

// Balls of these masses, the lowest first, that all fall with 1 m/s.
Quadratic column_of(const std::vector<double> &masses)
{
  const std::size_t n = masses.size();
  Quadratic of(n);
  for (std::size_t k = 0; k < n; ++k) {
    of.at(k, k) = 1 / masses[k] + (k > 0 ? 1 / masses[k - 1] : 0);
    if (k > 0) of.at(k, k - 1) = of.at(k - 1, k) = -1 / masses[k - 1];
  }
  of.q[0] = -1;
  return of;
}

// W = G G^T, q = G v with rows of G that push unit masses: a solution exists whatever the rank.
Quadratic pushed(const std::vector<std::vector<double>> &g, const std::vector<double> &v)
{
  Quadratic of(g.size());
  for (std::size_t i = 0; i < g.size(); ++i)
    for (std::size_t d = 0; d < v.size(); ++d) {
      of.q[i] += g[i][d] * v[d];
      for (std::size_t j = 0; j < g.size(); ++j) of.at(i, j) += g[i][d] * g[j][d];
    }
  return of;
}

std::vector<double> numbers(Random &random, std::size_t n)
{
  std::vector<double> some(n);
  for (double &x : some) x = random(-1, 1);
  return some;
}

// All entries at random, of rank `freedoms`, which differ in mass by 10^(4 spread).
Quadratic dense(std::uint64_t seed, std::size_t n, std::size_t freedoms, double spread = 0)
{
  Random random(seed);
  std::vector<double> root(freedoms);
  for (double &r : root) r = std::pow(10.0, random(-spread, spread));
  std::vector<std::vector<double>> g;
  for (std::size_t i = 0; i < n; ++i) {
    g.push_back(numbers(random, freedoms));
    for (std::size_t d = 0; d < freedoms; ++d) g[i][d] *= root[d];
  }
  return pushed(g, numbers(random, freedoms));
}

// side x side discs of unequal masses on a triangular lattice between floor, lid and walls: three contacts a disc.
Quadratic discs_in_a_box(std::uint64_t seed, int side)
{
  Random random(seed);
  const int discs = side * side;
  std::vector<double> root(discs), x(discs), y(discs), v;
  for (int i = 0; i < discs; ++i) {
    root[i] = std::pow(10.0, random(-0.3, 0.3));
    x[i] = i % side + 0.5 * (i / side % 2);
    y[i] = std::sqrt(0.75) * (i / side);
  }
  std::vector<std::vector<double>> g;
  const auto touch = [&](int i, int j, double nx, double ny) {
    g.emplace_back(2 * discs, 0.0);
    for (const auto &[disc, sign] : {std::pair{i, 1}, std::pair{j, -1}}) {
      if (disc < 0) continue;
      g.back()[2 * disc] = sign * nx * root[disc];
      g.back()[2 * disc + 1] = sign * ny * root[disc];
    }
  };
  for (int i = 0; i < discs; ++i) {
    for (int j = 0; j < i; ++j)
      if (std::hypot(x[i] - x[j], y[i] - y[j]) < 1.01) touch(i, j, x[i] - x[j], y[i] - y[j]);
    if (i < side) touch(i, -1, 0, 1);
    if (i >= discs - side) touch(i, -1, 0, -1);
    if (x[i] < 0.1) touch(i, -1, 1, 0);
    if (x[i] > side - 0.6) touch(i, -1, -1, 0);
  }
  for (int i = 0; i < discs; ++i)
    for (const double fall : {0.0, 1.0}) v.push_back((random(-1, 1) - fall) / root[i]);
  return pushed(g, v);
}

// (W_AA + 1e-12 I) p_A = -q_A by Cholesky; p = 0 outside A.
void solve_on(const std::vector<std::size_t> &face, Quadratic &of)
{
  const std::size_t n = face.size();
  std::vector<double> l(n * n), y(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = of.at(face[i], face[j]) + (i == j ? 1e-12 : 0);
      for (std::size_t k = 0; k < j; ++k) sum -= l[i * n + k] * l[j * n + k];
      l[i * n + j] = i == j ? std::sqrt(std::max(sum, 1e-15)) : sum / l[j * n + j];
    }
    y[i] = -of.q[face[i]];
    for (std::size_t k = 0; k < i; ++k) y[i] -= l[i * n + k] * y[k];
    y[i] /= l[i * n + i];
  }
  of.p.assign(of.size(), 0.0);
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) y[i] -= l[k * n + i] * y[k];
    of.p[face[i]] = y[i] /= l[i * n + i];
  }
}

// Whether the plain method comes back to a face that it has left.
bool plain_method_cycles(Quadratic of)
{
  std::vector<std::size_t> face;
  std::set<std::vector<std::size_t>> met;
  for (;;) {
    std::vector<std::size_t> next;
    for (std::size_t i = 0; i < of.size(); ++i) {
      double u = of.q[i];
      for (std::size_t j = 0; j < of.size(); ++j) u += of.at(i, j) * of.p[j];
      if (of.p[i] - u / of.at(i, i) >= 0) next.push_back(i);
    }
    if (next == face) return false;
    if (!met.insert(next).second) return true;
    face = next;
    solve_on(face, of);
  }
}

// The active set's velocities are those of NLGS, run to 1e-13. Returns whether the plain method cycles.
bool solves(Quadratic of)
{
  const bool cycles = plain_method_cycles(of);
  Quadratic sweeps = of;
  const auto report = of.solve("active_set", to_1e11);
  CHECK(report.converged && report.criterion.relative < 1e-11);
  CHECK(sweeps.solve("pdas", {.tol = 1e-13, .maxiter = 1000000, .stop = nscd::Stop::natural}).converged);
  const auto u = of.velocities(), expected = sweeps.velocities();
  double off = 0;
  for (std::size_t k = 0; k < u.size(); ++k) off = std::max(off, std::abs(u[k] - expected[k]));
  CHECK_NEAR(off, 0, 1e-9);  // 1e-11 |q|, times what shut contacts do to open ones
  for (const double p : of.p) CHECK(p >= 0);
  return cycles;
}

}    // namespace

TEST(the_active_set_ends_where_the_plain_method_cycles)
{
  int cycles = 0;
  for (int seed = 1; seed <= 30; ++seed) {
    cycles += solves(dense(seed, 20, 10));
    cycles += solves(dense(seed, 20, 12, 0.5));
  }
  CHECK(cycles > 10);
}

TEST(the_active_set_solves_hyperstatic_lattices_where_the_plain_method_cycles)
{
  int cycles = 0;
  for (int seed = 1; seed <= 20; ++seed) cycles += solves(discs_in_a_box(seed, 6));
  CHECK(cycles > 3);
}

TEST(the_active_set_needs_three_faces_for_a_column_of_ties)
{
  for (const std::size_t n : {1, 10, 100, 300}) {
    Quadratic of = column_of(std::vector<double>(n, 2.0));
    const auto report = of.solve("active_set", {.tol = 1e-9, .maxiter = 100, .stop = nscd::Stop::natural});
    CHECK(report.converged && report.iterations <= 3);
    for (std::size_t k = 0; k < n; ++k) CHECK_NEAR(of.p[k], 2.0 * double(n - k), 1e-6 * double(n));
  }
}

TEST(the_active_set_takes_a_solution_as_it_is)
{
  Quadratic of = dense(3, 20, 30);
  CHECK(of.solve("active_set", to_1e11).converged);
  const std::vector<double> p = of.p;
  const auto again = of.solve("active_set", to_1e11);
  CHECK(again.converged && again.iterations == 1);
  CHECK(of.p == p);
}

TEST(the_active_set_starts_from_anything)
{
  for (const double start : {-1e3, 1e3}) {
    Quadratic of = dense(4, 20, 30), zero = of;
    of.p.assign(20, start);
    CHECK(of.solve("active_set", to_1e11).converged && zero.solve("active_set", to_1e11).converged);
    for (int k = 0; k < 20; ++k) CHECK_NEAR(of.p[k], zero.p[k], 1e-8);
  }
}

TEST(the_active_set_takes_slightly_unsymmetric_matrices_as_they_are)
{
  for (int seed = 1; seed <= 10; ++seed) {
    Quadratic of = dense(seed, 20, 40);
    Random random(seed);
    for (int i = 0; i < 20; ++i)
      for (int j = 0; j < i; ++j) {
        const double odd = 1e-6 * random(-1, 1);
        of.at(i, j) += odd;
        of.at(j, i) -= odd;
      }
    const auto report = of.solve("active_set", to_1e11);
    CHECK(report.converged && report.criterion.relative < 1e-11);
  }
}

TEST(the_active_set_says_so_where_there_is_no_solution)
{
  Quadratic stuck = dense(5, 10, 20);  // contact 3 cannot be moved, and penetrates
  for (int k = 0; k < 10; ++k) stuck.at(3, k) = stuck.at(k, 3) = 0;
  stuck.q[3] = -1;
  Quadratic squeezed(2);  // between a floor and a lid that come closer
  squeezed.at(0, 0) = squeezed.at(1, 1) = 1;
  squeezed.at(0, 1) = squeezed.at(1, 0) = -1;
  squeezed.q = {-1, -1};
  for (Quadratic *of : {&stuck, &squeezed})
    for (const nscd::Stop stop : {nscd::Stop::natural, nscd::Stop::paper}) {
      const auto report = of->solve("active_set", {.tol = 1e-8, .maxiter = 100, .stop = stop});
      CHECK(!report.converged && report.iterations <= 100);
      for (const double p : of->p) CHECK(std::isfinite(p));
    }
  CHECK(stuck.p[3] == 0);
}

TEST(the_active_set_ends_on_numbers_that_are_none)
{
  for (const nscd::Stop stop : {nscd::Stop::natural, nscd::Stop::paper})
    for (const int where : {0, 1, 2, 3}) {
      Quadratic of = dense(6, 10, 20);
      double *const places[] = {&of.at(2, 4), &of.at(2, 2), &of.q[2], &of.q[2]};
      *places[where] = std::numeric_limits<double>::quiet_NaN();
      for (int k = 0; where == 3 && k < 10; ++k) of.at(2, k) = of.at(k, 2) = 0;
      const auto report = of.solve("active_set", {.tol = 1e-8, .maxiter = 100, .stop = stop});
      CHECK(!report.converged && report.iterations <= 100);
    }
}

TEST(the_active_set_leaves_rows_of_zeros_alone)
{
  Quadratic of = dense(7, 10, 20), inner(9);
  for (int k = 0; k < 10; ++k) of.at(3, k) = of.at(k, 3) = 0;
  of.q[3] = 1;
  of.p[3] = 5;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) inner.at(i, j) = of.at(i + (i >= 3), j + (j >= 3));
  for (int i = 0; i < 9; ++i) inner.q[i] = of.q[i + (i >= 3)];
  CHECK(of.solve("active_set", to_1e11).converged && inner.solve("active_set", to_1e11).converged);
  CHECK(of.p[3] == 0);
  for (int i = 0; i < 9; ++i) CHECK_NEAR(of.p[i + (i >= 3)], inner.p[i], 1e-12);
}

TEST(the_active_set_is_not_for_friction)
{
  const nscd::BlockMatrix w{.dim = 2, .row_start = {0, 1}, .column = {0}, .block = {1, 0, 0, 1}};
  std::vector<double> q(2), p(2), mu(1);
  nscd::GlobalProblem problem{.w = w, .q = q, .mu = mu, .p = p};
  CHECK_ERROR(nscd::find_solver("active_set").solve_global(problem, {}),
              "solver active_set is for contacts without friction: choose another");
}
