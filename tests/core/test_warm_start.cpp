// SPDX-License-Identifier: GPL-2.0-or-later
// Warm start under friction: impulses turn with their contact, whichever grain is named first.
#include "check.hpp"
#include "scene.hpp"
#include "scene/slides.hpp"
#include "warm_start/warm_start.hpp"

#include <cmath>

using nscd::Planar;
using nscd::Spatial;
using nscd::Vec4;

static Vec4 random_direction(Random &random)
{
  const Vec4 d{random(-1, 1), random(-1, 1), random(-1, 1), 0};
  return d / nscd::length(d);
}

static Vec4 random_tangent(Random &random, const Vec4 &n) { return Spatial::from_space(n, random_direction(random)); }

// Rodrigues' formula: v turned about the unit vector `axis`.
static Vec4 rotated(const Vec4 &v, const Vec4 &axis, double angle)
{
  const Vec4 along = axis * nscd::dot(axis, v);
  return along + (v - along) * std::cos(angle) + nscd::cross(axis, v) * std::sin(angle);
}

// The rotation from `from` to `to` about their common perpendicular, which no rotation undercuts.
TEST(turning_is_the_shortest_rotation)
{
  Random random(21);
  for (int k = 0; k < 1000; ++k) {
    const Vec4 from = random_direction(random), axis = random_tangent(random, from);
    const double angle = k % 2 ? random(0, 3) : std::pow(10, random(-12, 0));
    const Vec4 unit = axis / nscd::length(axis), to = rotated(from, unit, angle);
    const Vec4 p = random_tangent(random, from), turned = nscd::turn_along(p, from, to);
    CHECK(nscd::length(turned - rotated(p, unit, angle)) < 1e-13);
    CHECK_NEAR(nscd::length(turned), nscd::length(p), 1e-13);
    CHECK(std::abs(nscd::dot(turned, to)) < 1e-15);
    CHECK(turned[3] == 0);
  }
}

TEST(turning_back_and_turning_on_about_the_same_axis_compose)
{
  Random random(22);
  for (int k = 0; k < 1000; ++k) {
    const Vec4 a = random_direction(random), across = random_tangent(random, a), axis = across / nscd::length(across);
    const Vec4 b = rotated(a, axis, random(0, 1.5)), c = rotated(b, axis, random(0, 1.5));
    const Vec4 p = random_tangent(random, a), once = nscd::turn_along(p, a, b);
    CHECK(nscd::length(nscd::turn_along(once, b, a) - p) < 1e-14);
    CHECK(nscd::length(nscd::turn_along(once, b, c) - nscd::turn_along(p, a, c)) < 1e-12);
  }
}

TEST(directions_that_do_not_turn_or_turn_over_keep_the_impulse)
{
  const Vec4 n{0, 0, 1, 0}, p{1, 2, 0, 0};
  CHECK(nscd::length(nscd::turn_along(p, n, n) - p) == 0);
  CHECK(nscd::length(nscd::turn_along(p, n, -n) - p) == 0);
}

// One contact of two bodies, in a state of its own.
template <class M>
struct RememberedContact {
  nscd::Settings chosen{};
  nscd::Materials materials{chosen, 1};
  nscd::State state{.in = {.settings = chosen, .materials = materials}};

  RememberedContact(const Vec4 &normal, double impulse, const Vec4 &tangential)
  {
    constexpr bool planar = std::is_same_v<M, Planar>;
    state.friction.model = planar ? nscd::Model::planar : nscd::Model::spatial;
    state.friction.spin_response = planar ? nscd::disc_spin_response : nscd::sphere_spin_response;
    state.motion.bodies = {Vec4{0, 0, 0, 0.5}, Vec4{0, 0, 0, 0.25}};
    state.motion.spins.resize(2);
    state.table.open_slides(state.friction.model);
    state.table.resize(1);
    state.table.contacts[0] = {normal, 0, 1 / 0.75, impulse, 0, 1};
    state.table.infos[0] = {.key = 77, .atom_i = 0, .atom_j = 1};
    state.table.slides<M>()[0].impulse = M::from_space(normal, tangential);
  }
  RememberedContact(const RememberedContact &) = delete;

  void swap_bodies()
  {
    nscd::Contact &c = state.table.contacts[0];
    c.normal = -c.normal;
    std::swap(c.i, c.j);
  }
  // On body 0, in space, N s.
  Vec4 impulse_on_first() const
  {
    const nscd::Contact &c = state.table.contacts[0];
    return (c.normal * c.impulse + nscd::tangential_impulse(state, 0)) * (c.i == 0 ? 1.0 : -1.0);
  }
};

// The recalled impulse, and that the bodies have what it does: m v = p, (m / k) s = -n x p.
template <class M>
static void check_recall(const Vec4 &before, const Vec4 &now, const Vec4 &tangential, const Vec4 &expected,
                         bool swapped)
{
  RememberedContact<M> old(before, 3, tangential), fresh(now, 0, Vec4{});
  nscd::WarmStart memory;
  memory.remember(old.state);
  if (swapped) fresh.swap_bodies();
  memory.recall(fresh.state, 0);
  const Vec4 whole = now * 3 + expected;
  CHECK(nscd::length(fresh.impulse_on_first() - whole) < 1e-14);
  const auto &s = fresh.state;
  CHECK(nscd::length(nscd::without_fourth(s.motion.bodies[0]) - whole * 0.5) < 1e-14);
  CHECK(nscd::length(nscd::without_fourth(s.motion.bodies[1]) + whole * 0.25) < 1e-14);
  const Vec4 turn = nscd::cross(now, expected) * -s.friction.spin_response;
  CHECK(nscd::length(s.motion.spins[0] - turn * 0.5) < 1e-14);
  CHECK(nscd::length(s.motion.spins[1] - turn * 0.25) < 1e-14);
}

TEST(recalled_impulses_do_not_depend_on_which_grain_is_first)
{
  Random random(23);
  for (int k = 0; k < 200; ++k)
    for (const bool swapped : {false, true}) {
      const Vec4 n = random_direction(random), across = random_tangent(random, n), axis = across / nscd::length(across);
      const double angle = random(0, 1);
      const Vec4 p = random_tangent(random, n);
      check_recall<Spatial>(n, rotated(n, axis, angle), p, rotated(p, axis, angle), swapped);
      const Vec4 z{0, 0, 1, 0}, start = rotated(Vec4{1, 0, 0, 0}, z, random(-3, 3)), flat = Planar::tangent(start);
      check_recall<Planar>(start, rotated(start, z, angle), flat * 2, rotated(flat * 2, z, angle), swapped);
    }
}

TEST(contacts_that_were_not_there_start_from_nothing)
{
  RememberedContact<Spatial> old(Vec4{0, 0, 1, 0}, 3, Vec4{1, 0, 0, 0}), fresh(Vec4{0, 0, 1, 0}, 5, Vec4{0, 1, 0, 0});
  nscd::WarmStart memory;
  memory.remember(old.state);
  fresh.state.table.infos[0].key = 78;
  memory.recall(fresh.state, 0);
  CHECK(nscd::length(fresh.impulse_on_first()) == 0);
  CHECK(nscd::length(nscd::without_fourth(fresh.state.motion.bodies[0])) == 0);
}

// Impulse in space of the only contact, on grain 0, from what a solver is handed.
static Vec4 in_space_on_first(const nscd::State &s, std::span<const double> p)
{
  const nscd::Contact &c = s.table.contacts[0];
  const nscd::Tangents t = nscd::tangents(c.normal, s.friction.model);
  Vec4 sum = c.normal * p[0] + t.first * p[1];
  if (p.size() == 3) sum += t.second * p[2];
  return s.table.infos[0].atom_i == 0 ? sum : -sum;
}

// Solves for a contact that sticks, of grains that do not spin.
static void stop_both(const nscd::State &s, std::span<double> p)
{
  const nscd::Contact &c = s.table.contacts[0];
  const nscd::Tangents t = nscd::tangents(c.normal, s.friction.model);
  const Vec4 u = nscd::without_fourth(s.motion.bodies[c.i] - s.motion.bodies[c.j]);
  p[0] = -c.w_inverse * nscd::dot(c.normal, u);
  const double tangential = -c.w_inverse / (1 + s.friction.spin_response);
  p[1] = tangential * nscd::dot(t.first, u);
  if (p.size() == 3) p[2] = tangential * nscd::dot(t.second, u);
}

static void place_pair(Scene &scene, const Vec4 &normal, const Vec4 &velocity, bool backwards)
{
  scene.v.assign(6, 0.0);
  for (int d = 0; d < 3; ++d) {
    scene.x[d] = normal[d];
    scene.x[3 + d] = -normal[d];
    scene.v[d] = velocity[d];
  }
  scene.omega.assign(6, 0.0);
  scene.accelerate({});
  scene.list_pairs(backwards ? std::vector<std::vector<int>>{{}, {0}} : std::vector<std::vector<int>>{{1}, {}});
}

// Two grains that touch, turned as one between two steps: the impulse of the first is the second's start, turned.
static void check_rigid_turn(const char *law, int dimension, const Vec4 &axis, const Vec4 &first, bool backwards)
{
  const double angle = 0.3;
  Vec4 given{}, started{};
  int calls = 0;
  const auto solver = [&](const nscd::State &s, std::size_t, std::span<double> p) {
    started = in_space_on_first(s, p);
    if (calls++ > 0) return;
    stop_both(s, p);
    given = in_space_on_first(s, p);
  };
  const std::string words = "friction 0.5 unconverged ignore criterion paper tol 1e-9 law ";
  nscd::Step step(settings(words + law), solver, dimension);
  Scene scene;
  scene.add({}, 1, 1);
  scene.add({}, 1, 2);
  place_pair(scene, first, nscd::cross(axis, first) * 0.5 - first, false);
  scene.advance(step, 1e-9);
  CHECK(calls == 1 && step.report().converged && nscd::length(started) == 0);
  CHECK(nscd::length(nscd::tangential_impulse(step.state(), 0)) > 0.09 && nscd::length(given) > 0.6);
  const Vec4 turned = rotated(first, axis, angle);
  place_pair(scene, turned, nscd::cross(axis, turned) * 0.5 - turned, backwards);
  scene.advance(step, 1e-9);
  CHECK(calls == 2 && nscd::length(started - rotated(given, axis, angle)) < 1e-8);
}

TEST(a_pair_that_turns_rigidly_keeps_its_impulse)
{
  const Vec4 x{1, 0, 0, 0}, y{0, 1, 0, 0}, z{0, 0, 1, 0};
  for (const char *law : {"moreau", "gap"})
    for (const bool backwards : {false, true}) {
      check_rigid_turn(law, 3, z, x, backwards);
      check_rigid_turn(law, 3, y, x * 0.6 + z * 0.8, backwards);
      check_rigid_turn(law, 2, z, x * 0.8 + y * 0.6, backwards);
    }
}

// Started from its own solution a heap at rest is solved at once; with friction in both models.
TEST(a_warm_start_saves_the_iterations_of_a_heap_with_friction)
{
  for (const int dimension : {2, 3})
    for (const char *law : {"moreau", "gap"}) {
      int iterations[2];
      for (const bool warm : {false, true}) {
        Scene scene;
        for (int i = 0; i < 4; ++i) scene.add({1.999 * i, 0.999, 0}, 1, 1);
        for (int i = 0; i < 3; ++i) scene.add({1.999 * i + 1, 2.729, 0}, 1, 1);
        const std::string words = "solver pdas criterion paper tol 1e-7 friction 0.6 wall plane 0 0 0 0 1 0 law ";
        nscd::Step step(settings(words + law + " warmstart " + (warm ? "yes" : "no")), {}, dimension);
        for (int k = 0; k < 5; ++k) {
          scene.accelerate({0, -10, 0});
          scene.advance(step, 1e-3);
          CHECK(step.report().converged);
        }
        iterations[warm] = step.report().iterations;
      }
      CHECK(iterations[0] > 15 && iterations[1] <= 5);
    }
}
