// SPDX-License-Identifier: GPL-2.0-or-later
// From a pair of atoms, or an atom and a wall, to a contact: gap, normal, bodies, W_nn.
#pragma once

#include "base/error.hpp"
#include "base/hot.hpp"
#include "contact/moment.hpp"
#include "scene/drift/drift_of.hpp"
#include "scene/gap.hpp"
#include "scene/state.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

// Identifies a contact across steps: a pair's tags in either order, or a tag, a wall and its feature. Tags are
// positive, so the top bit tells the two apart.
inline std::uint64_t contact_key(const State &s, const Candidate &c)
{
  const std::uint32_t tag = s.in.grains.tag[c.atom_i];
  if (is_wall(c)) return (std::uint64_t(1) << 63) | (std::uint64_t(-1 - c.atom_j) << 32) | tag;
  const std::uint32_t other = s.in.grains.tag[c.atom_j];
  return (std::uint64_t(std::min(tag, other)) << 32) | std::max(tag, other);
}

// Contact k overlaps beyond the smaller radius.
[[noreturn]] inline void refuse_overlap(const State &s, std::size_t k)
{
  const Candidate c{s.table.infos[k].atom_i, s.table.infos[k].atom_j};
  const double gap = s.table.infos[k].gap;
  const auto &g = s.in.grains;
  if (is_wall(c))
    fail("grain ", g.tag[c.atom_i], " is ", -gap, " inside ", s.in.settings.walls[std::size_t(wall_of(c.atom_j))].name,
         ", more than its radius ", g.radius[c.atom_i], ": start it on the side that the wall's normal points to, or ",
         "take a smaller timestep");
  fail("grains ", g.tag[c.atom_i], " and ", g.tag[c.atom_j], " overlap by ", -gap, ", more than the smaller radius ",
       std::min(g.radius[c.atom_i], g.radius[c.atom_j]),
       ": remove one of them, or take a smaller timestep if they were apart before");
}

// How a contact lies, before it is one.
struct Placed {
  alignas(vec4_alignment) Vec4 normal;
  alignas(vec4_alignment) Vec4 before;   // m/s, velocity of i at the start of the step less that of j
  double gap, smaller, curve;            // m, as in ContactInfo
  int j;                                 // body
};

// A pair that lasts takes its plane where the two are half-way, if they do not pass each other.
NSCD_INLINE Placed placed_pair(const State &s, const Candidate &c, int i)
{
  const Sphere &a = s.atoms.spheres[c.atom_i], &b = s.atoms.spheres[c.atom_j];
  const auto [separation, distance, gap] = apart(a, b);
  const int j = s.atoms.owner[c.atom_j];
  const Vec4 before = start_velocity(s, i) - start_velocity(s, j);
  Placed at{separation / distance, before, gap, std::min(a.radius, b.radius), 0, j};
  if (!(s.scales.lasting_moment > 0)) return at;
  const Vec4 parting = at.before + carried_apart(s, c);
  if (!passes(separation, distance, a.radius + b.radius, parting * s.in.dt)) return at;
  const double most = std::max(gap, 0.0) + left_by_planes(s, at.smaller);
  const Turned ahead = turned_within(separation, distance, parting * s.scales.lasting_moment, most);
  at.normal = ahead.normal;
  at.curve = ahead.curve;
  return at;
}

// With a wall, in contact k of body i.
Placed placed_at_wall(State &s, const Candidate &c, int i, std::size_t k);

// Fills contact number k. Impulse and bias are left 0. Returns whether it fits: no overlap beyond the smaller radius.
NSCD_INLINE bool place_contact(State &s, std::size_t k, const Candidate &c)
{
  const int i = s.atoms.owner[c.atom_i];
  Placed at = is_wall(c) ? placed_at_wall(s, c, i, k) : placed_pair(s, c, i);
  const double w = s.motion.bodies[i][3] + s.motion.bodies[at.j][3];
  s.table.contacts[k] = {at.normal, 0.0, 1 / w, 0.0, i, at.j};
  if (!s.drift.of.empty()) at.before += drift_of(s, c, at.normal);
  s.table.infos[k] = {at.gap, dot(at.normal, at.before), contact_key(s, c), c.atom_i, c.atom_j,
                      at.smaller, std::max(s.motion.kicks[i], s.motion.kicks[at.j]), 0.0, at.curve};
  return !(at.gap < -at.smaller);
}

}    // namespace nscd
