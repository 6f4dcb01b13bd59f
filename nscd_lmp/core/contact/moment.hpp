// SPDX-License-Identifier: GPL-2.0-or-later
// When a contact's impulse acts within the step, and how the pair lies then.
//
// An impulse p n that acts t after the start of the step, between centres that are s apart and part with w, changes
// their angular momentum by (s + t w) x p n, and displaces them by p n / m for what is left of the step, dt - t. So n
// has to be the direction of s + t w. A lasting contact acts half-way: to second order that is right for a force that
// acts all the time. An impact acts when the two meet.
//
// The plane through the surface there, n.x = r_i + r_j, is a lower bound of the distance whatever n, since the sum of
// two spheres is convex: what is kept on its side does not overlap.
#pragma once

#include "base/hot.hpp"
#include "contact/contact.hpp"

#include <cmath>
#include <optional>

namespace nscd {

struct Turned {
  alignas(vec4_alignment) Vec4 normal;
  double curve;   // m, <= 0: by how much the plane is nearer than the surface, at the start of the step
};

// As the pair lies once it has moved by `way` (m). Written as a square: a pair that has not moved has a curve of 0, not
// of round-off, and none is > 0.
NSCD_INLINE Turned turned(const Vec4 &separation, double distance, const Vec4 &way)
{
  const Vec4 there = separation + way, normal = there / std::sqrt(dot(there, there));
  const Vec4 turn = normal - separation / distance;
  return {normal, -0.5 * distance * dot(turn, turn)};
}

// The same, or less of the way, so that the plane is nearer than the surface by `most` (m) at most.
NSCD_INLINE Turned turned_within(const Vec4 &separation, double distance, const Vec4 &way, double most)
{
  const Turned all = turned(separation, distance, way);
  if (all.curve + most >= 0) return all;
  if (!(most > 0)) return {separation / distance, 0};
  const Turned less = turned(separation, distance, way * std::sqrt(most / -all.curve));   // it grows with the square
  return {less.normal, std::max(less.curve, -most)};
}

// Whether a pair that goes on by `way` (m) for the whole step stays apart. No for ways so long that they turn the pair.
NSCD_INLINE bool passes(const Vec4 &separation, double distance, double radii, const Vec4 &way)
{
  constexpr double nearest = 0.5;   // of the distance, to which the way may lead along the line of the centres
  const Vec4 end = separation + way;
  return dot(end, end) >= radii * radii && dot(separation, end) >= nearest * distance * distance;
}

// When spheres meet that move on with `parting` (m/s) and whose radii grow by `growth` (m/s, both), s; none if they do
// not.
inline std::optional<double> meeting(const Vec4 &separation, double radii, const Vec4 &parting, double growth)
{
  const double ahead = dot(separation, separation) - radii * radii;
  const double closing = radii * growth - dot(separation, parting);
  if (!(closing > 0)) return {};
  if (ahead <= 0) return 0;
  const double discriminant = closing * closing - (dot(parting, parting) - growth * growth) * ahead;
  if (!(discriminant >= 0)) return {};
  return ahead / (closing + std::sqrt(discriminant));
}

}    // namespace nscd
