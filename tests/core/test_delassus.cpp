// SPDX-License-Identifier: GPL-2.0-or-later
// Delassus matrices of grains, and solvers on them against the same solvers on the bodies.
#include "as_matrix.hpp"
#include "check.hpp"
#include "contact/tangents.hpp"
#include "problem/delassus.hpp"
#include "scene.hpp"
#include "push_by_hand.hpp"

#include <cmath>
#include <memory>

using nscd::Model;
using nscd::Vec4;

namespace {

// Contacts between grains at random (rest solves them, as biases are not negative): many a body, some with an obstacle,
// one pair that touches twice.
struct Heap {
  nscd::AlignedVector<nscd::Body> bodies{};
  nscd::AlignedVector<Vec4> spins{};
  std::vector<nscd::Contact> contacts{};
  nscd::AlignedVector<nscd::Planar::Slide> planar{};
  nscd::AlignedVector<nscd::Spatial::Slide> spatial{};
  nscd::Workspace workspace{};
  Model model;

  Heap(Random &random, Model kind, int grains, int count) : model(kind)
  {
    const bool flat = model == Model::planar;
    for (int b = 0; b < grains; ++b) {
      const double mobility = b == 0 ? 0 : random(0.2, 2);
      bodies.push_back(Vec4{random(-1, 1), random(-1, 1), flat ? 0 : random(-1, 1), mobility});
      spins.push_back(Vec4{flat ? 0 : random(-1, 1), flat ? 0 : random(-1, 1), random(-1, 1), 0});
    }
    for (int k = 0; k < count; ++k) {
      const int i = k == 1 ? contacts[0].i : 1 + int(random(0, grains - 1));
      const int j = k == 1 ? contacts[0].j : int(random(0, i));
      Vec4 n{random(-1, 1), random(-1, 1), flat ? 0 : random(-1, 1), 0};
      n /= nscd::length(n);
      contacts.push_back({n, random(0, 0.1), 1 / (bodies[i][3] + bodies[j][3]), random(0, 0.1), i, j});
      const double mu = random(0, 0.3);
      planar.push_back({0, 0, mu});
      spatial.push_back({Vec4{}, {}, mu});
    }
    for (std::size_t k = 0; k < contacts.size(); ++k) give(k, contacts[k].impulse, 0);
  }

  // To the bodies alone: along N (0) or a tangent.
  void give(std::size_t k, double impulse, int along)
  {
    const nscd::Contact &c = contacts[k];
    if (along == 0) return nscd::apply_impulse(c, impulse, bodies.data());
    const nscd::Tangents t = nscd::tangents(c.normal, model);
    nscd::with_friction(model, [&]<class M>(M) {
      const auto p = M::from_space(c.normal, (along == 1 ? t.first : t.second) * impulse);
      push_by_hand<M>(c, p, response(), bodies, spins);
    });
  }

  double response() const { return model == Model::planar ? nscd::disc_spin_response : nscd::sphere_spin_response; }

  nscd::Problem problem()
  {
    nscd::Problem p{bodies, contacts, 1, workspace};
    if (model != Model::frictionless)
      p.sliding = {model, response(), spins.data(), planar.data(), spatial.data()};
    return p;
  }

  // Along N, T1[, T2], biases left out.
  std::vector<double> velocities() const
  {
    std::vector<double> u;
    for (const nscd::Contact &c : contacts) {
      u.push_back(nscd::normal_velocity(c, bodies.data()));
      const nscd::Tangents t = nscd::tangents(c.normal, model);
      nscd::with_friction(model, [&]<class M>(M) {
        const Vec4 slip = M::in_space(c.normal, nscd::velocity<M>(c, bodies.data(), spins.data()).t);
        u.push_back(nscd::dot(t.first, slip));
        if (model == Model::spatial) u.push_back(nscd::dot(t.second, slip));
      });
    }
    return u;
  }
};

constexpr Model models[] = {Model::frictionless, Model::planar, Model::spatial};

double entry(const nscd::BlockMatrix &w, std::size_t row, std::size_t column)
{
  const std::size_t d = w.dim;
  for (auto at = w.row_start[row / d]; at < w.row_start[row / d + 1]; ++at)
    if (std::size_t(w.column[at]) == column / d) return w.block[at * d * d + row % d * d + column % d];
  return 0;
}

}    // namespace

TEST(a_delassus_matrix_is_what_unit_impulses_do)
{
  Random random(1);
  for (const Model model : models) {
    Heap heap(random, model, 8, 14);
    const nscd::BlockMatrix w = nscd::delassus(heap.problem());
    CHECK(w.rows() == 14 && w.dim == nscd::unknowns(model));
    const std::vector<double> before = heap.velocities();
    for (std::size_t k = 0; k < 14; ++k)
      for (int along = 0; along < w.dim; ++along) {
        Heap pushed = heap;
        pushed.give(k, 1, along);
        const std::vector<double> after = pushed.velocities();
        for (std::size_t r = 0; r < after.size(); ++r)
          CHECK_NEAR(entry(w, r, k * w.dim + along), after[r] - before[r], 1e-14);
      }
  }
}

TEST(the_columns_of_a_delassus_matrix_are_sorted_and_only_those_of_shared_grains)
{
  Random random(2);
  Heap heap(random, Model::frictionless, 30, 40);
  const nscd::BlockMatrix w = nscd::delassus(heap.problem());
  for (std::size_t r = 0; r < w.rows(); ++r)
    for (auto at = w.row_start[r]; at < w.row_start[r + 1]; ++at) {
      if (at > w.row_start[r]) CHECK(w.column[at - 1] < w.column[at]);
      const nscd::Contact &a = heap.contacts[r], &b = heap.contacts[w.column[at]];
      CHECK(a.i == b.i || a.i == b.j || a.j == b.i || (a.j == b.j && a.j != 0) || r == std::size_t(w.column[at]));
    }
}

TEST(an_assembled_problem_starts_at_the_bodies_velocities)
{
  Random random(3);
  for (const Model model : models) {
    Heap heap(random, model, 8, 14);
    const nscd::Problem grains = heap.problem();
    const auto assembled = nscd::with_mechanics(
        grains, [&](const auto &mechanics) { return std::make_unique<nscd::AssembledProblem>(grains, mechanics); });
    nscd::GlobalProblem &p = assembled->problem();
    std::vector<double> u(p.p.size());
    p.w.multiply(p.p.data(), u.data());
    const std::vector<double> expected = heap.velocities();
    for (std::size_t i = 0; i < u.size(); ++i) {
      const double bias = i % p.dim() == 0 ? heap.contacts[i / p.dim()].bias : 0;
      CHECK_NEAR(u[i] + p.q[i], expected[i] + bias, 1e-14);
    }
  }
}

TEST(sweeps_over_rows_are_sweeps_over_grains)
{
  Random random(4);
  for (const auto &solver : nscd::solvers()) {
    if (solver.kind != "local law") continue;
    for (const Model model : models) {
      Heap heap(random, model, 8, 14), rows = heap;
      nscd::Problem grains = heap.problem(), matrix = rows.problem();
      const nscd::SolverOptions options{1e-30, 7, solver.default_parameter};
      const auto a = solver.solve(grains, options);
      const auto b = solve_as_matrix(matrix, options, solver);
      CHECK(a.iterations == 7 && b.iterations == 7 && !a.converged && !b.converged);
      for (std::size_t k = 0; k < 14; ++k) CHECK_NEAR(heap.contacts[k].impulse, rows.contacts[k].impulse, 1e-13);
      for (std::size_t i = 0; i < heap.bodies.size(); ++i) {
        CHECK(nscd::length(heap.bodies[i] - rows.bodies[i]) < 1e-13);
        CHECK(nscd::length(heap.spins[i] - rows.spins[i]) < 1e-13);
      }
    }
  }
}

TEST(every_solver_finds_the_velocities_of_a_frictionless_heap)
{
  for (const auto &solver : nscd::solvers())
    for (int seed = 0; seed < 20; ++seed) {
      Random random(seed);
      Heap heap(random, Model::frictionless, 12, 25), reference = heap, rows = heap;
      nscd::Problem exact = reference.problem(), grains = heap.problem(), matrix = rows.problem();
      CHECK(nscd::find_solver("pdas").solve(exact, {1e-14, 1000000, 1}).converged);
      const nscd::SolverOptions options{1e-12, 1000000, solver.default_parameter};
      CHECK(solver.solve(grains, options).converged);
      CHECK(solve_as_matrix(matrix, options, solver).converged);
      for (std::size_t i = 0; i < heap.bodies.size(); ++i) {
        CHECK(nscd::length(heap.bodies[i] - reference.bodies[i]) < 1e-7);
        CHECK(nscd::length(rows.bodies[i] - reference.bodies[i]) < 1e-7);
      }
    }
}

// Whether it is solved or given up, and whatever a solver extrapolates on the way.
TEST(bodies_carry_the_impulses_of_their_contacts)
{
  for (const auto &solver : nscd::solvers())
    for (const Model model : models)
      for (const int maxiter : {1, 7, 50, 400}) {
        if (model != Model::frictionless && !solver.friction) continue;
        Random random(maxiter);
        Heap heap(random, model, 8, 30);
        for (std::size_t k = 0; k < heap.contacts.size(); k += 3) heap.planar[k].mu = heap.spatial[k].mu = nscd::stick;
        Heap free = heap;
        nscd::Problem grains = heap.problem();
        solver.solve(grains, {1e-14, maxiter, solver.default_parameter});
        for (std::size_t k = 0; k < heap.contacts.size(); ++k) {
          nscd::Contact &c = free.contacts[k];
          nscd::apply_impulse(c, heap.contacts[k].impulse - c.impulse, free.bodies.data());
          nscd::with_friction(model, [&]<class M>(M) {
            const auto p = heap.problem().sliding.slides<M>()[k].impulse;
            push_by_hand<M>(c, p, heap.response(), free.bodies, free.spins);
          });
        }
        for (std::size_t i = 0; i < heap.bodies.size(); ++i) {
          const double scale = 1 + nscd::length(heap.bodies[i]);
          CHECK(nscd::length(heap.bodies[i] - free.bodies[i]) < 1e-11 * scale);
          if (model != Model::frictionless) CHECK(nscd::length(heap.spins[i] - free.spins[i]) < 1e-11 * scale);
        }
      }
}

// A column takes thousands of sweeps, in which round-off between bodies and impulses grows under momentum.
TEST(what_is_called_solved_is_solved_by_the_impulses_alone)
{
  constexpr int grains = 1000;
  for (const auto &solver : nscd::solvers()) {
    if (solver.kind == "local law") continue;
    nscd::AlignedVector<nscd::Body> bodies{Vec4{}};
    std::vector<nscd::Contact> contacts;
    for (int i = 1; i <= grains; ++i) {
      bodies.push_back(Vec4{0, 0, -5e-3, 1});
      contacts.push_back({Vec4{0, 0, 1, 0}, 0, i == 1 ? 1 : 0.5, 0, i, i - 1});
    }
    nscd::Workspace workspace{};
    nscd::Problem column{bodies, contacts, 5e-3, workspace};
    const nscd::SolverOptions options{1e-8, 20000, 1, nscd::Stop::natural};
    CHECK(solver.solve(column, options).converged);
    for (int i = 1; i <= grains; ++i) bodies[i] = Vec4{0, 0, -5e-3, 1};
    for (const nscd::Contact &c : contacts) nscd::apply_impulse(c, c.impulse, bodies.data());
    CHECK(nscd::measure(column).relative < 1e-8);
  }
}
