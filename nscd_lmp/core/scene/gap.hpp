// SPDX-License-Identifier: GPL-2.0-or-later
// How far apart two spheres are, or one and a wall: the one place that says so.
#pragma once

#include "base/hot.hpp"
#include "scene/state.hpp"

#include <cmath>

namespace nscd {

inline bool is_wall(const Candidate &candidate) { return candidate.atom_j < 0; }

// From the centre of b to that of a, m.
struct Apart {
  alignas(vec4_alignment) Vec4 separation;
  double distance, gap;
};

NSCD_INLINE Apart apart(const Sphere &a, const Sphere &b)
{
  const Vec4 separation = a.centre - b.centre;
  const double distance = std::sqrt(dot(separation, separation));
  return {separation, distance, distance - (a.radius + b.radius)};
}

NSCD_INLINE double gap_of(const Sphere &a, const Sphere &b) { return apart(a, b).gap; }

// A grain and the feature of the wall that it is a candidate with, `wall` being where that is then.
inline Touch touch_of(const Sphere &grain, const Candidate &c, const Obstacle &wall)
{
  return wall.at(grain.centre, grain.radius, feature_of(c.atom_j));
}

// The gap of a touch, on the side of the wall that `normal` points to: beyond it the grain is inside by all that it has
// gone through.
inline double gap_on_side(const Touch &touch, const Vec4 &normal, double radius)
{
  return dot(touch.normal, normal) < 0 ? -touch.gap - 2 * radius : touch.gap;
}

// An atom moved by its body and, for these times (s), by its drift.
NSCD_INLINE Sphere drifted(const State &s, int atom, double centre, double radius)
{
  const Sphere &sought = s.atoms.spheres[atom];
  Sphere sphere{sought.centre + s.motion.displacement[s.atoms.owner[atom]], sought.radius, 0};
  if (s.drift.of.empty()) return sphere;
  sphere.centre += without_fourth(s.drift.of[atom]) * centre;
  sphere.radius += s.drift.of[atom][3] * radius;
  return sphere;
}

// Where it is at the end of the step, as the contact laws see it; and as the arrays have it then.
NSCD_INLINE Sphere at_end(const State &s, int atom) { return drifted(s, atom, s.drift.to_end, s.drift.to_end); }
NSCD_INLINE Sphere in_arrays(const State &s, int atom) { return drifted(s, atom, s.drift.centres, s.drift.radii); }

// Where a grain of this rank has got to before the box moves on.
NSCD_INLINE Vec4 moved_in_arrays(const State &s, int i) { return drifted(s, i, -s.drift.ahead, 0).centre; }

// At the end of the step.
template <class Where>
NSCD_INLINE double gap_at(const State &s, const Candidate &c, Where where)
{
  const Sphere a = where(s, c.atom_i);
  if (is_wall(c)) {
    const Obstacle &wall = s.obstacles.at_end(wall_of(c.atom_j));
    const Touch end = touch_of(a, c, wall);
    if (!wall.has_two_sides()) return end.gap;
    const Touch start = touch_of(s.atoms.spheres[c.atom_i], c, s.obstacles.sought(wall_of(c.atom_j)));
    return gap_on_side(end, start.normal, a.radius);
  }
  return gap_of(a, where(s, c.atom_j));
}

}    // namespace nscd
