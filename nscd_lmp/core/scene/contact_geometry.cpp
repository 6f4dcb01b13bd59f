// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/contact_geometry.hpp"

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

// A grain slides along a curved wall, whose plane a lasting contact takes where the two are half-way. Beside a wall
// that curves towards the grain that plane is farther than the wall at the end of the way; so it is moved until it is
// not.
void take_plane_ahead(const State &s, const Candidate &c, const Obstacle &wall, Placed &at)
{
  Sphere grain = s.atoms.spheres[c.atom_i];
  const Vec4 way = (at.before + carried_apart(s, c)) * s.scales.lasting_moment;
  grain.centre += way;
  const Touch ahead = touch_of(grain, c, wall);
  grain.centre += way;
  const double end = touch_of(grain, c, wall).gap;
  const double start = std::min(ahead.gap - dot(ahead.normal, way), end - 2 * dot(ahead.normal, way));
  at.normal = ahead.normal;
  at.curve = std::min(start - at.gap, 0.0);
}

}    // namespace

Placed placed_at_wall(State &s, const Candidate &c, int i, std::size_t k)
{
  const int number = wall_of(c.atom_j);
  const Obstacle &wall = s.obstacles.sought(number);
  const Sphere &grain = s.atoms.spheres[c.atom_i];
  const Touch touch = touch_of(grain, c, wall);
  Placed at{touch.normal, start_velocity(s, i), touch.gap, grain.radius, 0, 0};
  if (s.obstacles.moves(number)) {
    at.j = s.add_obstacle(wall.velocity_at(grain.centre - touch.normal * (grain.radius + touch.gap)));
    at.before -= s.motion.bodies[at.j];
  } else {
    at.j = s.obstacle(i, k);
  }
  if (wall.is_curved() && s.scales.lasting_moment > 0) take_plane_ahead(s, c, wall, at);
  return at;
}

}    // namespace nscd
