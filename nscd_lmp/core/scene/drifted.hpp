// SPDX-License-Identifier: GPL-2.0-or-later
// Where atoms have got to, by their bodies and by their drift.
#pragma once

#include "base/hot.hpp"
#include "scene/contact_geometry.hpp"
#include "scene/state.hpp"

#include <cmath>

namespace nscd {

// An atom moved by its body and, for these times (s), by its drift.
inline Sphere drifted(const State &s, int atom, double centre, double radius)
{
  Sphere sphere = s.atoms.spheres[atom];
  sphere.centre += s.motion.displacement[s.atoms.owner[atom]];
  if (s.drift.of.empty()) return sphere;
  sphere.centre += without_fourth(s.drift.of[atom]) * centre;
  sphere.radius += s.drift.of[atom][3] * radius;
  return sphere;
}

// Where it is at the end of the step, as the contact laws see it; and as the arrays have it then.
inline Sphere at_end(const State &s, int atom) { return drifted(s, atom, s.drift.to_end, s.drift.to_end); }
inline Sphere in_arrays(const State &s, int atom) { return drifted(s, atom, s.drift.centres, s.drift.radii); }

// Where a grain of this rank has got to before the box moves on.
inline Vec4 moved_in_arrays(const State &s, int i) { return drifted(s, i, -s.drift.ahead, 0).centre; }

// How far apart two spheres are, or one and a wall.
inline double gap_at(const State &s, const Candidate &c, Sphere (*where)(const State &, int))
{
  const Sphere a = where(s, c.atom_i);
  if (is_wall(c)) return Height(s.in.settings.walls[wall_index(c)]).of(a.centre) - a.radius;
  const Sphere b = where(s, c.atom_j);
  const Vec4 separation = a.centre - b.centre;
  return std::sqrt(dot(separation, separation)) - a.radius - b.radius;
}

}    // namespace nscd
