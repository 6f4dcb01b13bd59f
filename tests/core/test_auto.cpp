// SPDX-License-Identifier: GPL-2.0-or-later
// What solver auto hands to whom: grains and matrices alike, the same bits every time.
#include "as_matrix.hpp"
#include "check.hpp"
#include "scene.hpp"

#include <cmath>

namespace {

// Balls on top of each other, the lowest first, that fall with 1 m/s; with friction they slide on each other too.
struct Tower {
  nscd::AlignedVector<nscd::Body> bodies{};
  nscd::AlignedVector<nscd::Vec4> spins{};
  std::vector<nscd::Contact> contacts{};
  nscd::AlignedVector<nscd::Planar::Slide> planar{};
  nscd::AlignedVector<nscd::Spatial::Slide> spatial{};
  nscd::Workspace workspace{};
  nscd::Model model;

  explicit Tower(const std::vector<double> &masses, nscd::Model kind = nscd::Model::frictionless) : model(kind)
  {
    Random random(1);
    const double slip = model == nscd::Model::frictionless ? 0 : 0.1;
    bodies.push_back(nscd::Vec4{});
    for (const double mass : masses) {
      const int i = int(bodies.size());
      bodies.push_back(nscd::Vec4{random(-slip, slip), -1, 0, 1 / mass});
      contacts.push_back({nscd::Vec4{0, 1, 0, 0}, 0, 1 / (bodies[i][3] + bodies[i - 1][3]), 0, i, i - 1});
      planar.push_back({0, 0, 0.3});
      spatial.push_back({nscd::Vec4{}, {}, 0.3});
    }
    spins.resize(bodies.size());
  }

  nscd::SolverReport solve(std::string_view solver, const nscd::SolverOptions &options, bool as_matrix = false)
  {
    nscd::Problem problem{bodies, contacts, 1, workspace};
    const double response = model == nscd::Model::planar ? nscd::disc_spin_response : nscd::sphere_spin_response;
    if (model != nscd::Model::frictionless)
      problem.sliding = {model, response, spins.data(), planar.data(), spatial.data()};
    const nscd::SolverEntry &entry = nscd::find_solver(solver);
    return as_matrix ? solve_as_matrix(problem, options, entry) : entry.solve(problem, options);
  }

  double fastest() const
  {
    double most = 0;
    for (const nscd::Contact &c : contacts) most = std::max(most, std::abs(nscd::normal_velocity(c, bodies.data())));
    return most;
  }
};

bool same_bits(const Tower &a, const Tower &b)
{
  bool same = true;
  for (std::size_t k = 0; k < a.contacts.size(); ++k) {
    same &= a.contacts[k].impulse == b.contacts[k].impulse;
    same &= a.planar[k].impulse == b.planar[k].impulse;
    for (int d = 0; d < 3; ++d) same &= a.spatial[k].impulse[d] == b.spatial[k].impulse[d];
  }
  for (std::size_t i = 0; i < a.bodies.size(); ++i)
    for (int d = 0; d < 4; ++d) same &= a.bodies[i][d] == b.bodies[i][d] && a.spins[i][d] == b.spins[i][d];
  return same;
}

std::vector<double> in_turn(int pairs)
{
  std::vector<double> masses;
  for (int k = 0; k < pairs; ++k) masses.insert(masses.end(), {1, 1e6});
  return masses;
}

nscd::SolverOptions natural(double tol, int maxiter)
{
  return {.tol = tol, .maxiter = maxiter, .stop = nscd::Stop::natural};
}

}    // namespace

TEST(auto_ends_where_apgs_alone_does_not)
{
  for (const bool as_matrix : {false, true}) {
    Tower alone(in_turn(150)), relay = alone;
    const nscd::SolverOptions options = natural(1e-5, 2000);  // impulses of 1e8 N s leave round-off of 1e-7 m/s
    CHECK(!alone.solve("apgs", options, as_matrix).converged);
    const auto report = relay.solve("auto", options, as_matrix);
    CHECK(report.converged && report.iterations < 200);
    CHECK(relay.fastest() < 1e-5);
    CHECK(alone.fastest() > 1e-3);
  }
}

TEST(auto_gives_the_same_bits_twice)
{
  for (const nscd::Model model : {nscd::Model::frictionless, nscd::Model::planar, nscd::Model::spatial})
    for (const int pairs : {1, 5, 40})
      for (const bool as_matrix : {false, true}) {
        Tower one(in_turn(pairs), model), two = one;
        const auto a = one.solve("auto", natural(1e-8, 500), as_matrix);
        const auto b = two.solve("auto", natural(1e-8, 500), as_matrix);
        CHECK(a.iterations == b.iterations && a.criterion.relative == b.criterion.relative);
        CHECK(same_bits(one, two));
      }
}

TEST(auto_keeps_to_the_iterations_it_is_given)
{
  for (const bool as_matrix : {false, true})
    for (const int most : {1, 2, 31, 32, 33, 34, 35, 40, 100, 300}) {
      Tower of(in_turn(50));
      // below round-off, so that everyone is asked
      const auto report = of.solve("auto", natural(1e-16, most), as_matrix);
      CHECK(!report.converged && report.iterations <= most);
      if (most < 15) CHECK(report.iterations == most);  // APGS is given 15 sweeps here
    }
}

TEST(auto_counts_on_in_its_history)
{
  for (const bool as_matrix : {false, true}) {
    Tower of(in_turn(50));
    std::vector<nscd::SolverReport> history;
    nscd::SolverOptions options = natural(1e-6, 500);
    options.history = &history;
    const auto report = of.solve("auto", options, as_matrix);
    CHECK(report.converged && history.size() > 1);
    for (std::size_t k = 1; k < history.size(); ++k) CHECK(history[k - 1].iterations < history[k].iterations);
    CHECK(history.back().iterations == report.iterations);
  }
}

TEST(auto_leaves_easy_problems_to_apgs)
{
  for (const bool as_matrix : {false, true}) {
    Tower relay({1, 2, 3}), alone = relay;
    const auto a = relay.solve("auto", natural(1e-4, 1000), as_matrix);
    const auto b = alone.solve("apgs", natural(1e-4, 1000), as_matrix);
    CHECK(a.converged && a.iterations < 32 && a.iterations == b.iterations);
    CHECK(same_bits(relay, alone));
  }
}

// The active set would refuse them.
TEST(auto_never_hands_friction_to_the_active_set)
{
  for (const nscd::Model model : {nscd::Model::planar, nscd::Model::spatial})
    for (const bool as_matrix : {false, true}) {
      Tower of(in_turn(20), model), refused = of;
      const auto report = of.solve("auto", natural(1e-14, 300), as_matrix);
      CHECK(!report.converged && report.iterations <= 300);
      CHECK_ERROR(refused.solve("active_set", natural(1e-14, 300), as_matrix), "without friction");
    }
}

TEST(auto_solves_nothing_at_once)
{
  Tower none({});
  for (const bool as_matrix : {false, true}) {
    const auto report = none.solve("auto", natural(1e-8, 10), as_matrix);
    CHECK(report.converged && report.iterations == 0);
  }
}
