// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/list/motion.hpp"

namespace nscd {

namespace {

void resize(AtomMotion &m, const State &s)
{
  m.from.resize(s.atoms.spheres.size());
  m.one.resize(s.moving());
  m.other.resize(s.moving());
}

Vec4 velocity(const Body &b) { return Vec4{b[0], b[1], b[2], 0}; }

}    // namespace

void free_motion(AtomMotion &m, const State &s, double prediction, double look_ahead)
{
  resize(m, s);
  for (std::size_t a = 0; a < s.atoms.spheres.size(); ++a)
    m.from[a] = s.atoms.spheres[a].centre - start_velocity(s, s.atoms.owner[a]) * (s.in.dt * prediction);
  for (int b = 0; b < s.moving(); ++b) {
    const Vec4 start = start_velocity(s, b), to_sought = start * (s.in.dt * prediction);
    m.one[b] = to_sought + start * (s.in.dt * look_ahead);
    m.other[b] = to_sought + velocity(s.motion.bodies[b]) * (s.in.dt * look_ahead);
  }
}

void solved_motion(AtomMotion &m, const State &s, double look_ahead)
{
  resize(m, s);
  for (std::size_t a = 0; a < s.atoms.spheres.size(); ++a) m.from[a] = s.atoms.spheres[a].centre;
  for (int b = 0; b < s.moving(); ++b) {
    m.one[b] = s.motion.displacement[b];
    m.other[b] = look_ahead > 0 ? velocity(s.motion.bodies[b]) * (s.in.dt * look_ahead) : s.motion.displacement[b];
  }
}

void next_motion(AtomMotion &m, const State &s, double share)
{
  resize(m, s);
  for (std::size_t a = 0; a < s.atoms.spheres.size(); ++a)
    m.from[a] = s.atoms.spheres[a].centre + s.motion.displacement[s.atoms.owner[a]];
  for (int b = 0; b < s.moving(); ++b) m.one[b] = m.other[b] = velocity(s.motion.bodies[b]) * (s.in.dt * share);
}

}    // namespace nscd
