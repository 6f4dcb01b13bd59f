// SPDX-License-Identifier: GPL-2.0-or-later
// The plane of one contact, and where the courses of its two bodies come from (moment.hpp).
#pragma once

#include "base/hot.hpp"
#include "contact/moment.hpp"
#include "scene/drift/drift_of.hpp"
#include "scene/gap.hpp"
#include "scene/state.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

// Where the way of a body behind its impacts comes from, m from q_k.
NSCD_INLINE Vec4 course_start(const State &s, int body)
{
  return s.courses.start.empty() ? Vec4{} : s.courses.start[body];
}

// By which that puts a contact's bodies apart, along its normal, m.
NSCD_INLINE double put_apart(const State &s, const Contact &c)
{
  return s.courses.start.empty() ? 0 : dot(c.normal, s.courses.start[c.i] - s.courses.start[c.j]);
}

// How far the contact's plane is where its way starts, m.
NSCD_INLINE double plane_gap(const State &s, std::size_t k)
{
  return s.table.infos[k].gap + s.table.infos[k].curve + put_apart(s, s.table.contacts[k]);
}

// How far from there the contact may close, m: no plane drives a pair apart, but what gives an overlap back.
NSCD_INLINE double open_gap(const State &s, std::size_t k)
{
  return std::max(plane_gap(s, k), std::min(s.table.infos[k].gap, 0.0));
}

// By which an impact of contact k meets faster along its normal than its bodies' mean velocities say, m/s.
NSCD_INLINE double impact_kick(const State &s, std::size_t k)
{
  return s.table.impact_kick.is_open() ? s.table.impact_kick[k] : 0;
}

inline Vec4 separation_at_start(const State &s, const ContactInfo &info)
{
  return s.atoms.spheres[info.atom_i].centre - s.atoms.spheres[info.atom_j].centre;
}

// Contact k, a pair without impulse, takes its plane where the two are `there` apart.
inline void take_plane(State &s, std::size_t k, const Vec4 &there)
{
  Contact &c = s.table.contacts[k];
  ContactInfo &info = s.table.infos[k];
  const Vec4 start = separation_at_start(s, info);
  const Turned plane = turned(start, std::sqrt(dot(start, start)), there - start);
  c.normal = plane.normal;
  info.curve = plane.curve;
  info.speed_before = dot(c.normal, start_velocity(s, c.i) - start_velocity(s, c.j)) + normal_drift(s, k);
}

// Contact k takes its plane where its bodies are at the start of the step.
inline void take_start_plane(State &s, std::size_t k)
{
  ContactInfo &info = s.table.infos[k];
  if (info.atom_j >= 0) return take_plane(s, k, separation_at_start(s, info));
  Contact &c = s.table.contacts[k];
  const Candidate wall{info.atom_i, info.atom_j};
  c.normal = touch_of(s.atoms.spheres[info.atom_i], wall, s.obstacles.sought(wall_of(info.atom_j))).normal;
  info.curve = 0;
  info.speed_before = dot(c.normal, start_velocity(s, c.i) - start_velocity(s, c.j)) + normal_drift(s, k);
}

// What was given along another plane turns with it, and stays as long.
inline Vec4 turned_along(const Vec4 &normal, const Vec4 &tangential)
{
  const Vec4 along = tangential - normal * dot(normal, tangential);
  const double now = dot(along, along);
  return now > 0 ? along * std::sqrt(dot(tangential, tangential) / now) : Vec4{};
}

}    // namespace nscd
