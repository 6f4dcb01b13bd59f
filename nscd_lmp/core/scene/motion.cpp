#include "scene/motion.hpp"

namespace nscd {

namespace {

void resize(Motion &m, const State &s)
{
  m.from.resize(s.spheres.size());
  m.one.resize(s.moving());
  m.other.resize(s.moving());
}

Vec4 velocity(const Body &b) { return Vec4{b[0], b[1], b[2], 0}; }

}    // namespace

void free_motion(Motion &m, const State &s, double prediction, double look_ahead)
{
  resize(m, s);
  for (std::size_t a = 0; a < s.spheres.size(); ++a)
    m.from[a] = s.spheres[a].centre - start_velocity(s, s.owner[a]) * (s.dt * prediction);
  for (int b = 0; b < s.moving(); ++b) {
    const Vec4 start = start_velocity(s, b), to_sought = start * (s.dt * prediction);
    m.one[b] = to_sought + start * (s.dt * look_ahead);
    m.other[b] = to_sought + velocity(s.bodies[b]) * (s.dt * look_ahead);
  }
}

void solved_motion(Motion &m, const State &s, double look_ahead)
{
  resize(m, s);
  for (std::size_t a = 0; a < s.spheres.size(); ++a) m.from[a] = s.spheres[a].centre;
  for (int b = 0; b < s.moving(); ++b) {
    m.one[b] = s.displacement[b];
    m.other[b] = look_ahead > 0 ? velocity(s.bodies[b]) * (s.dt * look_ahead) : s.displacement[b];
  }
}

void next_motion(Motion &m, const State &s, double share)
{
  resize(m, s);
  for (std::size_t a = 0; a < s.spheres.size(); ++a) m.from[a] = s.spheres[a].centre + s.displacement[s.owner[a]];
  for (int b = 0; b < s.moving(); ++b) m.one[b] = m.other[b] = velocity(s.bodies[b]) * (s.dt * share);
}

}    // namespace nscd
