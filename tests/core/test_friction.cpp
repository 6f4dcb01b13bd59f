// SPDX-License-Identifier: GPL-2.0-or-later
// Operations on contacts with friction, against formulas with radii and angular velocities, and the conservation laws.
#include "check.hpp"
#include "push_by_hand.hpp"
#include "scene.hpp"
#include "scene/slides.hpp"
#include "solver/solver.hpp"

#include <cmath>

using nscd::Planar;
using nscd::Spatial;
using nscd::Vec4;

static Vec4 in_box(Random &random, double size, bool planar = false)
{
  return Vec4{random(-size, size), random(-size, size), planar ? 0 : random(-size, size), 0};
}

static Vec4 slow_cross(const Vec4 &a, const Vec4 &b)
{
  return Vec4{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0], 0};
}

// Two grains that touch, with radii, places and angular velocities.
template <class M>
struct TouchingPair {
  static constexpr bool planar = std::is_same_v<M, Planar>;
  double response = planar ? nscd::disc_spin_response : nscd::sphere_spin_response;
  double radius[2], mass[2];
  Vec4 centre[2];
  nscd::AlignedVector<nscd::Body> bodies{2};
  nscd::AlignedVector<Vec4> spins{2};
  nscd::Contact contact{};

  explicit TouchingPair(Random &random)
  {
    Vec4 n = in_box(random, 1, planar);
    n /= nscd::length(n);
    for (int b = 0; b < 2; ++b) {
      radius[b] = random(0.1, 3);
      mass[b] = random(0.1, 5);
      bodies[b] = in_box(random, 4, planar);
      bodies[b][3] = 1 / mass[b];
      spins[b] = planar ? Vec4{0, 0, random(-4, 4), 0} : in_box(random, 4);
    }
    centre[0] = in_box(random, 10, planar);
    centre[1] = centre[0] - n * (radius[0] + radius[1]);
    contact = {n, 0, 1 / (bodies[0][3] + bodies[1][3]), 0, 0, 1};
  }

  Vec4 omega(int b) const { return spins[b] / radius[b]; }
  Vec4 speed(int b) const { return nscd::without_fourth(bodies[b]); }
  double inertia(int b) const { return mass[b] * radius[b] * radius[b] / response; }
  Vec4 point() const { return centre[0] - contact.normal * radius[0]; }
  // Velocity of the contact point as a material point of grain b.
  Vec4 surface_velocity(int b) const { return speed(b) + slow_cross(omega(b), point() - centre[b]); }

  Vec4 momentum() const { return speed(0) * mass[0] + speed(1) * mass[1]; }
  Vec4 angular_momentum(const Vec4 &about) const
  {
    Vec4 sum{};
    for (int b = 0; b < 2; ++b) sum += slow_cross(centre[b] - about, speed(b)) * mass[b] + omega(b) * inertia(b);
    return sum;
  }
  double energy() const
  {
    double sum = 0;
    for (int b = 0; b < 2; ++b)
      sum += (mass[b] * nscd::dot(speed(b), speed(b)) + inertia(b) * nscd::dot(omega(b), omega(b))) / 2;
    return sum;
  }

  nscd::Split<typename M::Tangent> velocity() const
  {
    return nscd::velocity<M>(contact, bodies.data(), spins.data());
  }
  void push(double normal, const typename M::Tangent &tangential)
  {
    nscd::apply_impulse(contact, normal, bodies.data());
    push_by_hand<M>(contact, tangential, response, bodies, spins);
  }
};

constexpr int touching_pairs = 300;

// Calls f with random pairs in the plane and in space, and a random tangential impulse for each.
template <class Function>
static void with_random_pairs(Function f)
{
  Random random(11);
  const auto all = [&]<class M>(M) {
    for (int k = 0; k < touching_pairs; ++k) {
      TouchingPair<M> pair(random);
      const auto tangential = M::from_space(pair.contact.normal, in_box(random, 3, TouchingPair<M>::planar));
      f(pair, random(-1, 5), tangential);
    }
  };
  all(Planar{});
  all(Spatial{});
}

TEST(cross_products_are_those_of_the_components)
{
  Random random(12);
  for (int k = 0; k < touching_pairs; ++k) {
    const Vec4 a = in_box(random, 2), b = in_box(random, 2), c = nscd::cross(a, b), d = slow_cross(a, b);
    for (int i = 0; i < 4; ++i) CHECK(c[i] == d[i]);
  }
  const Vec4 heavy = nscd::cross(Vec4{1, 0, 0, 7}, Vec4{0, 1, 0, 9});
  CHECK(heavy[2] == 1 && heavy[3] == 0);
  CHECK(nscd::without_fourth(Vec4{1, 2, 3, 4})[3] == 0 && nscd::without_fourth(Vec4{1, 2, 3, 4})[2] == 3);
}

TEST(projection_on_a_ball_keeps_the_inside_and_shortens_the_outside)
{
  Random random(13);
  for (int k = 0; k < touching_pairs; ++k) {
    const Vec4 t = in_box(random, 2);
    const double length = nscd::length(t), radius = random(0, 3);
    const Vec4 p = nscd::onto_ball<Vec4>(t, radius);
    CHECK_NEAR(nscd::length(p), std::min(length, radius), 1e-15 * 4);
    CHECK_NEAR(nscd::length(nscd::cross(p, t)), 0, 1e-15 * 16);
    CHECK(nscd::dot(p, t) >= 0);
    if (length <= radius) CHECK(nscd::length(p - t) == 0);
    CHECK(nscd::length(nscd::onto_ball<Vec4>(t, INFINITY) - t) == 0);
    CHECK(nscd::length(nscd::onto_ball<Vec4>(t, 0)) == 0);
  }
  CHECK(nscd::onto_ball<double>(-3, 2) == -2 && nscd::onto_ball<double>(1, 2) == 1);
  CHECK(nscd::onto_ball<double>(0, 0) == 0 && nscd::length(nscd::onto_ball<Vec4>(Vec4{}, 0)) == 0);
}

TEST(coulombs_disc_is_a_point_for_an_open_contact)
{
  CHECK(nscd::coulomb_radius(0.5, 4) == 2 && nscd::coulomb_radius(0.5, -4) == 0);
  CHECK(nscd::coulomb_radius(nscd::stick, 0) == 0 && nscd::coulomb_radius(nscd::stick, -1) == 0);
  CHECK(nscd::coulomb_radius(nscd::stick, 1e-300) == nscd::stick);
}

// u = (v_i + omega_i x r_i) - (v_j + omega_j x r_j) with the arms r from the centres to the contact point.
TEST(slip_is_the_velocity_of_the_surfaces_against_each_other)
{
  with_random_pairs([]<class M>(TouchingPair<M> &pair, double, const auto &) {
    const Vec4 n = pair.contact.normal, direct = pair.surface_velocity(0) - pair.surface_velocity(1);
    const auto u = pair.velocity();
    CHECK_NEAR(u.n, nscd::dot(n, direct), 1e-13);
    const Vec4 slip = M::in_space(n, u.t), difference = slip + n * u.n - direct;
    CHECK(nscd::length(difference) < 1e-13 && std::abs(nscd::dot(slip, n)) < 1e-13);
    CHECK(slip[3] == 0);
  });
}

TEST(impulses_conserve_momentum_and_angular_momentum_about_any_point)
{
  Random random(14);
  with_random_pairs([&]<class M>(TouchingPair<M> &pair, double normal, const auto &tangential) {
    const Vec4 about = in_box(random, 20);
    const Vec4 momentum = pair.momentum(), angular = pair.angular_momentum(about);
    pair.push(normal, tangential);
    CHECK(nscd::length(pair.momentum() - momentum) < 1e-13);
    CHECK(nscd::length(pair.angular_momentum(about) - angular) < 1e-11);
  });
}

// Change of kinetic energy, spins included: p (u- + u+) / 2.
TEST(the_work_of_an_impulse_is_that_of_the_mean_velocity)
{
  with_random_pairs([]<class M>(TouchingPair<M> &pair, double normal, const auto &tangential) {
    const double energy = pair.energy();
    const auto before = pair.velocity();
    pair.push(normal, tangential);
    const auto after = pair.velocity();
    const double work = (normal * (before.n + after.n) + nscd::inner(tangential, before.t + after.t)) / 2;
    CHECK_NEAR(pair.energy() - energy, work, 1e-11);
  });
}

// The contact's own block of W: W_nn, W_tt = (1 + k) W_nn in every tangential direction, nothing between them.
TEST(a_contacts_own_block_is_diagonal)
{
  with_random_pairs([]<class M>(TouchingPair<M> &pair, double normal, const auto &tangential) {
    const double w = 1 / pair.contact.w_inverse;
    const auto before = pair.velocity();
    pair.push(normal, tangential);
    const auto after = pair.velocity();
    CHECK_NEAR(after.n - before.n, w * normal, 1e-11);
    CHECK(nscd::length(after.t - before.t - tangential * (w * (1 + pair.response))) < 1e-11);
  });
}

TEST(tangents_make_a_right_handed_frame)
{
  Random random(15);
  for (int k = 0; k < touching_pairs; ++k) {
    Vec4 n = k < 3 ? Vec4{} : in_box(random, 1);
    if (k < 3) n[k] = -1;
    n /= nscd::length(n);
    const nscd::Tangents t = nscd::tangents(n, nscd::Model::spatial);
    CHECK(nscd::length(nscd::cross(n, t.first) - t.second) < 1e-15);
    CHECK(nscd::length(nscd::cross(t.first, t.second) - n) < 1e-15);
    CHECK_NEAR(nscd::dot(t.first, t.first), 1, 1e-15);
  }
  const nscd::Tangents flat = nscd::tangents(Vec4{0.6, 0.8, 0, 0}, nscd::Model::planar);
  CHECK(nscd::length(flat.first - Vec4{-0.8, 0.6, 0, 0}) == 0);
}

// The same contacts of discs for both models: any normals, many a body.
struct FlatPile {
  nscd::AlignedVector<nscd::Body> bodies{};
  nscd::AlignedVector<Vec4> spins{};
  std::vector<nscd::Contact> contacts{};
  nscd::AlignedVector<Planar::Slide> planar{};
  nscd::AlignedVector<Spatial::Slide> spatial{};
  nscd::Workspace workspace{};

  explicit FlatPile(Random &random)
  {
    for (int b = 0; b < 12; ++b) {
      bodies.push_back(in_box(random, 1, true) + Vec4{0, 0, 0, b == 0 ? 0 : random(0.2, 2)});
      spins.push_back(Vec4{0, 0, random(-1, 1), 0});
    }
    for (int k = 0; k < 25; ++k) {
      const int i = 1 + int(random(0, 11)), j = int(random(0, i));
      const double angle = random(0, 6.28), mu = k % 6 == 0 ? nscd::stick : random(0, 1.5), bias = random(-0.1, 0.1);
      const Vec4 n{std::cos(angle), std::sin(angle), 0, 0};
      contacts.push_back({n, bias, 1 / (bodies[i][3] + bodies[j][3]), 0, i, j});
      planar.push_back({0, bias, mu});
      spatial.push_back({Vec4{}, {-n[1] * bias, n[0] * bias, 0}, mu});
    }
  }

  nscd::SolverReport solve(const nscd::SolverEntry &solver, nscd::Model model)
  {
    const nscd::Material material{0, 0.5, 0.25};
    const std::vector<nscd::MaterialNumber> numbers(contacts.size(), 0);
    nscd::Problem problem{bodies, contacts, 1, workspace};
    problem.restitution = {numbers, {&material, 1}};
    problem.sliding = {model, nscd::disc_spin_response, spins.data(), planar.data(), spatial.data()};
    return solver.solve(problem, {1e-9, 40, solver.default_parameter});
  }
};

TEST(the_planar_model_is_the_spatial_one_in_the_plane)
{
  for (const auto &solver : nscd::frictional_solvers())
    for (int seed = 0; seed < 20; ++seed) {
      if (solver.name == "interior_point") continue;  // its path to one of many solutions is not the same in both
      Random random(seed);
      FlatPile flat(random), space = flat;
      const auto a = flat.solve(solver, nscd::Model::planar), b = space.solve(solver, nscd::Model::spatial);
      CHECK(a.iterations == b.iterations);
      CHECK_NEAR(a.criterion.total(), b.criterion.total(), 1e-10 * (1 + a.criterion.total()));
      for (std::size_t k = 0; k < flat.contacts.size(); ++k) {
        const Vec4 n = flat.contacts[k].normal;
        CHECK_NEAR(flat.contacts[k].impulse, space.contacts[k].impulse, 1e-10);
        CHECK(nscd::length(Planar::in_space(n, flat.planar[k].impulse) - space.spatial[k].impulse) < 1e-10);
      }
      for (int i = 0; i < 12; ++i) CHECK(nscd::length(flat.spins[i] - space.spins[i]) < 1e-10);
    }
}
