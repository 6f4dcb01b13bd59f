// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/contact_geometry.hpp"

#include <optional>

namespace nscd {

int State::add_obstacle(const Vec4 &velocity)
{
  const int body = int(motion.bodies.size());
  motion.bodies.push_back(without_fourth(velocity));
  motion.kicks.push_back(0);
  if (friction.model != Model::frictionless) motion.spins.push_back(Vec4{});
  if (courses.start.empty()) return body;
  courses.start.push_back(Vec4{});
  courses.shift.push_back(Vec4{});
  courses.straight.push_back(0);
  return body;
}

namespace {

// How a grain and a wall's feature lie when contacts that last act, with the grain's velocity at the start of the step.
struct Ahead {
  Sphere grain;
  Touch touch;
  alignas(vec4_alignment) Vec4 way;   // m, of the grain until then
};

// None if it does not matter, or if the grain has passed the feature by then, or gone through it: it is on the side
// that `normal` points to now.
std::optional<Ahead> ahead_of(const State &s, const Candidate &c, int i, const Vec4 &normal)
{
  const int wall = wall_of(c.atom_j);
  if (s.scales.lasting_moment == 0 || !(s.obstacles.moves(wall) || s.obstacles.sought(wall).is_curved())) return {};
  Sphere grain = s.atoms.spheres[c.atom_i];
  const Vec4 way = (start_velocity(s, i) + carried_apart(s, c)) * s.scales.lasting_moment;
  grain.centre += way;
  const Ahead ahead{grain, touch_of(grain, c, s.obstacles.in_middle(wall)), way};
  if (std::isinf(ahead.touch.gap) || dot(ahead.touch.normal, normal) < 0) return {};
  return ahead;
}

// A grain slides along a curved wall, or one that turns, whose plane a lasting contact takes where the two are
// half-way. Beside a wall that curves towards the grain that plane is farther than the wall at the end of the way; so
// it is moved until it is not.
void take_plane_ahead(const State &s, const Candidate &c, const Ahead &ahead, Placed &at)
{
  Sphere grain = ahead.grain;
  grain.centre += ahead.way;
  const Touch then = touch_of(grain, c, s.obstacles.at_end(wall_of(c.atom_j)));
  if (std::isinf(then.gap)) return;   // by then it has passed the feature
  const Vec4 way = (at.before + carried_apart(s, c)) * s.scales.lasting_moment;
  const Vec4 &normal = ahead.touch.normal;
  const double end = gap_on_side(then, normal, grain.radius);
  const double start = std::min(ahead.touch.gap - dot(normal, way), end - 2 * dot(normal, way));
  at.normal = normal;
  at.curve = std::min(start - at.gap, 0.0);
}

// The velocity of a wall's surface where it faces the grain: of the middle of the step, so that a wall that turns is as
// far on as its mean, where there is such a moment.
Vec4 wall_velocity(const Obstacle &wall, const Sphere &grain, const Touch &touch)
{
  return wall.velocity_at(grain.centre - touch.normal * (grain.radius + touch.gap), touch);
}

}    // namespace

Placed placed_at_wall(State &s, const Candidate &c, int i, std::size_t k)
{
  const int number = wall_of(c.atom_j);
  const Obstacle &wall = s.obstacles.sought(number);
  const Sphere &grain = s.atoms.spheres[c.atom_i];
  const Touch touch = touch_of(grain, c, wall);
  Placed at{touch.normal, start_velocity(s, i), touch.gap, grain.radius, 0, 0};
  const std::optional<Ahead> ahead = ahead_of(s, c, i, touch.normal);
  if (s.obstacles.moves(number)) {
    at.j = s.add_obstacle(ahead ? wall_velocity(s.obstacles.in_middle(number), ahead->grain, ahead->touch)
                                : wall_velocity(wall, grain, touch));
    at.before -= s.motion.bodies[at.j];
  } else {
    at.j = s.obstacle(i, k);
  }
  if (ahead && wall.is_curved()) take_plane_ahead(s, c, *ahead, at);
  return at;
}

}    // namespace nscd
