// SPDX-License-Identifier: GPL-2.0-or-later
// From a pair of atoms, or an atom and a wall, to a contact: gap, normal, bodies, W_nn.
#pragma once

#include "base/error.hpp"
#include "base/hot.hpp"
#include "contact/moment.hpp"
#include "obstacle/plane.hpp"
#include "scene/drift_of.hpp"
#include "scene/state.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

inline bool is_wall(const Candidate &candidate) { return candidate.atom_j < 0; }
inline int wall_index(const Candidate &candidate) { return -1 - candidate.atom_j; }

// Identifies a contact across steps: a pair's tags in either order, or a tag and a wall. Tags are positive, so the
// top bit tells the two apart.
inline std::uint64_t contact_key(const State &s, const Candidate &c)
{
  const std::uint32_t tag = s.in.grains.tag[c.atom_i];
  if (is_wall(c)) return (std::uint64_t(1) << 63) | (std::uint64_t(wall_index(c)) << 32) | tag;
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
    fail("grain ", g.tag[c.atom_i], " is ", -gap, " inside wall ", wall_index(c) + 1, ", more than its radius ",
         g.radius[c.atom_i], ": start it on the side that the wall's normal points to, or take a smaller timestep");
  fail("grains ", g.tag[c.atom_i], " and ", g.tag[c.atom_j], " overlap by ", -gap, ", more than the smaller radius ",
       std::min(g.radius[c.atom_i], g.radius[c.atom_j]),
       ": remove one of them, or take a smaller timestep if they were apart before");
}

// Fills contact number k. Impulse and bias are left 0. Returns whether it fits: no overlap beyond the smaller radius.
NSCD_INLINE bool place_contact(State &s, std::size_t k, const Candidate &c)
{
  const Sphere &a = s.atoms.spheres[c.atom_i];
  const int i = s.atoms.owner[c.atom_i];
  int j;
  Vec4 normal, before = start_velocity(s, i);
  double gap, smaller = a.radius, curve = 0;
  if (is_wall(c)) {
    const Height height(s.in.settings.walls[wall_index(c)]);
    normal = height.normal;
    gap = height.of(a.centre) - a.radius;
    j = s.obstacle(i, k);
  } else {
    const Sphere &b = s.atoms.spheres[c.atom_j];
    const Vec4 separation = a.centre - b.centre;
    const double distance = std::sqrt(dot(separation, separation));
    const double radii = a.radius + b.radius;
    normal = separation / distance;
    gap = distance - radii;
    smaller = std::min(smaller, b.radius);
    j = s.atoms.owner[c.atom_j];
    before -= start_velocity(s, j);
    if (s.scales.lasting_moment > 0) {
      const Vec4 parting = before + carried_apart(s, c);
      if (passes(separation, distance, radii, parting * s.in.dt)) {
        const double most = std::max(gap, 0.0) + left_by_planes(s, smaller);
        const Turned ahead = turned_within(separation, distance, parting * s.scales.lasting_moment, most);
        normal = ahead.normal;
        curve = ahead.curve;
      }
    }
  }
  const double w = s.motion.bodies[i][3] + s.motion.bodies[j][3];
  s.table.contacts[k] = {normal, 0.0, 1 / w, 0.0, i, j};
  if (!s.drift.of.empty()) before += drift_of(s, c, normal);
  s.table.infos[k] = {gap, dot(normal, before), contact_key(s, c), c.atom_i, c.atom_j,
                smaller, std::max(s.motion.kicks[i], s.motion.kicks[j]), 0.0, curve};
  return !(gap < -smaller);
}

}    // namespace nscd
