// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/gather.hpp"

#include "base/error.hpp"
#include "base/hot.hpp"
#include "scene/spins.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

// Impulses can make a grain faster than any was: watch pairs within this many moves of the fastest.
constexpr double watched_moves = 4;
// Where contacts are not sought ahead, pairs are watched only to see how they overlap at the end of the step.
constexpr double seen_moves = 2;

struct Search {
  double prediction, look_ahead;
};

[[noreturn]] void refuse(const State &s, int i)
{
  const Grains &g = s.in.grains;
  if (!(g.radius[i] > 0 && std::isfinite(g.radius[i])))
    fail("grain ", g.tag[i], " has radius ", g.radius[i], ": nscd needs spheres of finite radius > 0");
  if (g.moves(i) && !(g.mass[i] > 0 && std::isfinite(g.mass[i])))
    fail("grain ", g.tag[i], " has mass ", g.mass[i], ": every grain of the group needs a finite mass > 0");
  fail("grain ", g.tag[i], " has a position, velocity or force that is not a finite number");
}

// Free velocity (14) and predicted centre (18) of one atom. LAMMPS has already moved obstacles to where they end the
// step; they are taken back by dt v. Belts stay where they are.
NSCD_INLINE void load_body(State &s, int i, const Search &search, Largest &largest)
{
  const Grains &g = s.in.grains;
  const double *x = g.x + 3 * std::size_t(i), *v = g.v + 3 * std::size_t(i), *f = g.f + 3 * std::size_t(i);
  const bool moves = g.moves(i);
  const double inverse_mass = moves ? 1 / g.mass[i] : 0;
  const Vec4 before = moves ? Vec4{v[0], v[1], v[2], 0} : start_velocity(s, i);
  const Vec4 kick = Vec4{f[0], f[1], f[2], 0} * (s.in.dt * g.force_to_acceleration * inverse_mass);
  const Vec4 free = before + kick;
  const bool has_moved = !moves && way(s.motion, i) == Way::has_moved;
  const Vec4 centre = Vec4{x[0], x[1], x[2], 0} + before * (s.in.dt * (search.prediction - has_moved));
  const double before2 = dot(before, before), free2 = dot(free, free), speed2 = std::max(before2, free2);
  const double kick2 = dot(kick, kick);
  s.motion.kicks[i] = std::sqrt(kick2);
  largest.kick2 = std::max(largest.kick2, kick2);
  largest.speed2 = std::max(largest.speed2, speed2);
  largest.smallest_radius = std::min(largest.smallest_radius, g.radius[i]);
  s.atoms.spheres[i] = {centre, g.radius[i], s.in.dt * search.look_ahead * std::sqrt(speed2)};
  s.motion.bodies[i] = free + Vec4{0, 0, 0, inverse_mass};
  // One test for all that is wrong: a not-a-number fails every comparison.
  const bool fit = dot(centre, centre) + before2 + free2 < INFINITY && g.radius[i] > 0 && g.radius[i] < INFINITY &&
      inverse_mass >= 0 && inverse_mass < INFINITY && (inverse_mass > 0) == moves;
  if (!fit && largest.unfit < 0) largest.unfit = i;
}

// Images take their grain's velocity, so ghosts need none of their own.
void place_images(State &s, const Search &search)
{
  const Grains &g = s.in.grains;
  const auto of = [&g](int j, int groups) { return groups != 0 && (g.mask[j] & groups) != 0; };
  for (int j = g.owned; j < g.owned + g.ghosts; ++j) {
    const int i = s.atoms.owner[j];
    const double *xj = g.x + 3 * std::size_t(j);
    const Vec4 image{xj[0], xj[1], xj[2], 0};
    if (i < g.owned && !of(j, g.earlier)) {
      const double *xi = g.x + 3 * std::size_t(i);
      const Sphere &own = s.atoms.spheres[i];
      s.atoms.spheres[j] = {own.centre + (image - Vec4{xi[0], xi[1], xi[2], 0}), g.radius[i], own.reach};
      continue;
    }
    const Vec4 before = start_velocity(s, i), free = before + smooth_kick(s, i);
    const double speed2 = std::max(dot(before, before), dot(free, free));
    const bool has_moved = s.motion.bodies[i][3] == 0 && way(s.motion, i) == Way::has_moved && !of(j, g.earlier);
    s.atoms.spheres[j] = {image + before * (s.in.dt * (search.prediction - has_moved)), g.radius[j],
                    s.in.dt * search.look_ahead * std::sqrt(speed2)};
  }
}

}    // namespace

void hold_still(const Grains &g)
{
  if (g.held == 0) return;
  for (int i = 0; i < g.owned; ++i) {
    if (!(g.mask[i] & g.group) || !(g.mask[i] & g.held)) continue;
    std::fill_n(g.v + 3 * std::size_t(i), 3, 0.0);
    if (g.omega) std::fill_n(g.omega + 3 * std::size_t(i), 3, 0.0);
  }
}

bool has_unread_torque(const Grains &g)
{
  if (!g.unread_torque) return false;
  for (int i = 0; i < g.owned; ++i) {
    const double *t = g.unread_torque + 3 * std::size_t(i);
    if ((t[0] != 0 || t[1] != 0 || t[2] != 0) && g.moves(i)) return true;
  }
  return false;
}

static NSCD_HOT Largest load_bodies(State &s, const Search &search)
{
  Largest largest;
  for (int i = 0; i < s.in.grains.owned; ++i) load_body(s, i, search, largest);
  return largest;
}

Largest gather_owned(State &s, double prediction, double look_ahead)
{
  s.atoms.spheres.resize(s.in.grains.owned + s.in.grains.ghosts);
  s.motion.stage = Motion::Stage::free;
  s.motion.bodies.resize(s.moving() + obstacle_copies * s.exec.slabs.count());
  s.motion.kicks.resize(s.motion.bodies.size());
  s.motion.displacement.resize(s.moving());
  const Largest largest = load_bodies(s, {prediction, look_ahead});
  if (largest.unfit >= 0) refuse(s, largest.unfit);
  std::fill(s.motion.bodies.begin() + s.in.grains.owned, s.motion.bodies.end(), Body{});
  std::fill(s.motion.kicks.begin() + s.in.grains.owned, s.motion.kicks.end(), 0.0);
  if (s.friction.model != Model::frictionless) gather_spins(s);
  return largest;
}

void gather_images(State &s, double prediction, double look_ahead, const Largest &largest)
{
  s.scales.smooth_kick = std::sqrt(largest.kick2);
  s.search.watch = (look_ahead > 0 ? watched_moves : seen_moves) * s.in.dt * std::sqrt(largest.speed2);
  const Copies &copies = s.motion.copies;
  for (int c = 0; c < copies.count; ++c) s.motion.kicks[s.in.grains.owned + c] = length(copies.kick[c]);
  place_images(s, {prediction, look_ahead});
}

}    // namespace nscd
