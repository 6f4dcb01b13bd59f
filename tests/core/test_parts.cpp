// SPDX-License-Identifier: GPL-2.0-or-later
// Parts of contacts beside each other: the cone of their impulses, and impulses that turn with their contact.
#include "check.hpp"
#include "parts/roll.hpp"
#include "scene.hpp"
#include "solver/local/disc_cone.hpp"
#include "warm_start/remembered.hpp"

#include <cmath>

using nscd::Planar;
using nscd::Spatial;
using nscd::Vec4;

namespace {

using TwoDiscs = nscd::Discs<Vec4, Vec4>;

// The point of the cone that is nearest to tau, as SBP makes it of the discs that are outside.
nscd::Split<TwoDiscs> nearest(const nscd::Split<TwoDiscs> &tau, const nscd::OwnBlock<TwoDiscs> &own)
{
  std::array<double, 2> lengths{};
  nscd::Split<TwoDiscs> p = tau;
  bool inside = tau.n > 0;
  nscd::for_each_disc([&](std::size_t d, const auto &t) {
    lengths[d] = nscd::length(t);
    inside &= lengths[d] <= own.discs[d].mu * tau.n;
  }, tau.t);
  if (inside) return p;
  const nscd::DiscCone<TwoDiscs> cone(tau.n, lengths, own);
  p.n = cone.sum() / (1 + cone.squares());
  if (!(p.n > 0)) return {};
  nscd::for_each_disc([&](std::size_t d, auto &t) {
    if (cone.is_outside(d)) t = t * (own.discs[d].mu * p.n / lengths[d]);
  }, p.t);
  return p;
}

Vec4 random_vector_in_disc(Random &random)
{
  const double size = std::pow(10, random(-2, 1));
  return Vec4{random(-size, size), random(-size, size), 0, 0};
}

Vec4 direction(Random &random)
{
  const Vec4 d{random(-1, 1), random(-1, 1), random(-1, 1), 0};
  return d / nscd::length(d);
}

// v turned about the unit vector `axis` (Rodrigues).
Vec4 turned(const Vec4 &v, const Vec4 &axis, double angle)
{
  const Vec4 along = axis * nscd::dot(axis, v);
  return along + (v - along) * std::cos(angle) + nscd::cross(axis, v) * std::sin(angle);
}

}    // namespace

// Nearest in a convex cone K: p in K, tau - p in its polar cone, both at right angles. The polar cone of
// { |p_d| <= mu_d p_n } is { y_n + sum mu_d |y_d| <= 0 }.
TEST(what_is_nearest_in_the_cone_of_two_discs)
{
  Random random(31);
  int slips[3] = {};
  for (int k = 0; k < 10000; ++k) {
    nscd::OwnBlock<TwoDiscs> own{1, 1, {}};
    own.discs[0].mu = random(0, 2);
    own.discs[1].mu = k % 9 == 0 ? 0 : random(0, 2);
    const nscd::Split<TwoDiscs> tau{random(-2, 2), {random_vector_in_disc(random), {random_vector_in_disc(random)}}};
    const auto p = nearest(tau, own);
    double polar = tau.n - p.n, at_right_angles = p.n * (tau.n - p.n);
    int outside = 0;
    nscd::for_each_disc([&](std::size_t d, const auto &from, const auto &to) {
      const Vec4 rest = from - to;
      CHECK(nscd::length(to) <= own.discs[d].mu * p.n * (1 + 1e-12) + 1e-300);
      polar += own.discs[d].mu * nscd::length(rest);
      at_right_angles += nscd::dot(to, rest);
      outside += p.n > 0 && nscd::length(rest) > 0;
    }, tau.t, p.t);
    ++slips[outside];
    const double size = std::abs(tau.n) + nscd::length(tau.t.first) + nscd::length(tau.t.rest.first);
    CHECK(p.n >= 0);
    CHECK(polar <= 1e-12 * size);
    CHECK_NEAR(at_right_angles, 0, 1e-12 * size * size);
  }
  for (const int count : slips) CHECK(count > 300);
}

// A contact that slides and rolls, and the same one step later: turned, and maybe listed the other way round.
template <class Space>
static void check_that_impulses_turn(Random &random)
{
  using M = nscd::Mechanics<nscd::Spheres<Space>, nscd::Slide<Space>, Roll<Space>>;
  constexpr bool planar = std::is_same_v<Space, Planar>;
  nscd::AlignedVector<nscd::Body> bodies{Vec4{0, 0, 0, 1}, Vec4{0, 0, 0, 0.5}};
  nscd::AlignedVector<Vec4> spins(2);
  nscd::AlignedVector<nscd::Contact> contacts(1);
  nscd::AlignedVector<nscd::Slide<Space>> slides(1);
  nscd::AlignedVector<Roll<Space>> rolls(1);
  std::vector<nscd::ContactInfo> infos(1);
  infos[0].key = 5;
  const M mechanics(nscd::Spheres<Space>(bodies.data(), spins.data(), 2.5), slides.data(), rolls.data());
  const double weights[2] = {0.3, 0.7};
  const bool swapped = random() < 0.5;
  const Vec4 z{0, 0, 1, 0}, n = planar ? turned(Vec4{1, 0, 0, 0}, z, random(-3, 3)) : direction(random);
  const Vec4 across = planar ? z : nscd::cross(n, direction(random)), axis = across / nscd::length(across);
  const double angle = random(-1.5, 1.5);

  nscd::Contact &c = contacts[0];
  c.normal = n;
  c.i = 0, c.j = 1;
  rolls[0].weight_i = weights[0];
  rolls[0].weight_j = weights[1];
  const Vec4 slide = planar ? Planar::in_space(n, random(-1, 1)) : Spatial::from_space(n, direction(random));
  const Vec4 roll = planar ? z * random(-1, 1) : Spatial::from_space(n, direction(random));
  c.impulse = 2;
  if constexpr (planar) slides[0].impulse = Planar::from_space(n, slide), rolls[0].impulse = roll[2];
  else slides[0].impulse = slide, rolls[0].impulse = roll;
  nscd::ImpulseMemory<nscd::Entry<M>> memory;
  nscd::remember<M>(memory, mechanics, contacts, infos);

  // Impulses on the first body, turned; on the second they are opposite.
  const double sign = swapped ? -1 : 1;
  c.normal = turned(n, axis, angle) * sign;
  if (swapped) {
    std::swap(c.i, c.j);
    std::swap(rolls[0].weight_i, rolls[0].weight_j);
  }
  nscd::recall<M>(memory, mechanics, contacts, infos, 0);
  const auto p = mechanics.impulse(c, 0);
  CHECK_NEAR(p.n, 2, 0);
  const Vec4 slide_now = Space::in_space(c.normal, p.t.first) * sign;
  Vec4 roll_now{};
  if constexpr (planar) roll_now[2] = p.t.rest.first * sign;
  else roll_now = p.t.rest.first * sign;
  CHECK(nscd::length(slide_now - turned(slide, axis, angle)) < 1e-13);
  CHECK(nscd::length(roll_now - (planar ? roll : turned(roll, axis, angle))) < 1e-13);

  // What the bodies got: momentum, and spins of the first body by sliding and by rolling.
  const Vec4 now = turned(n, axis, angle), push = now * 2 + slide_now;
  const Vec4 spin = (nscd::cross(now, slide_now) * -1 + roll_now * weights[0]) * 2.5;
  CHECK(nscd::length(nscd::without_fourth(bodies[0] - push)) < 1e-13);
  CHECK(nscd::length(nscd::without_fourth(bodies[1] + push * 0.5)) < 1e-13);
  CHECK(nscd::length(spins[0] - spin) < 1e-13);
}

TEST(impulses_of_all_parts_turn_with_their_contact)
{
  Random random(32);
  for (int k = 0; k < 500; ++k) {
    check_that_impulses_turn<Spatial>(random);
    check_that_impulses_turn<Planar>(random);
  }
}
