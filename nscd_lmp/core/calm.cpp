#include "calm.hpp"

#include "drift_of.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

void Calm::find_islands(const State &s, std::size_t count)
{
  of_.reserve(s.bodies.size());   // more islands need no more
  joined_.clear();
  joined_.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const Contact &c = s.contacts[k];
    if (c.impulse > 0 && s.bodies[c.i][3] > 0 && s.bodies[c.j][3] > 0) joined_.push_back({c.i, c.j});
  }
  islands_.find(s.bodies.size(), joined_, s.halo);
  of_.assign(islands_.count(), {});
  for (int b = 0; b < s.moving(); ++b) {
    if (s.bodies[b][3] == 0) continue;
    Island &island = of_[islands_.of(b)];
    island.drive = std::max(island.drive, std::sqrt(speed2(start_velocity(s, b) + smooth_kick(s, b))));
    island.fastest = std::max(island.fastest, std::sqrt(speed2(s.bodies[b])));
  }
}

// What obstacles and drifts drive it by, all ranks' together.
void Calm::find_drives(const State &s, std::size_t count)
{
  for (std::size_t k = 0; k < count; ++k) {
    const Contact &c = s.contacts[k];
    Island &island = of_[islands_.of(grain_of(c, s.bodies.data()))];
    for (const int b : {c.i, c.j})
      if (s.bodies[b][3] == 0) island.closing = std::max(island.closing, std::sqrt(speed2(s.bodies[b])));
    island.closing = std::max(island.closing, std::abs(normal_drift(s, k)));
  }
  for (Island &island : of_) island.drive = std::max(island.drive, island.closing);
  if (!s.halo) return;
  double largest[] = {of_[0].drive, of_[0].closing, of_[0].fastest};
  s.halo->max(largest);
  of_[0].drive = largest[0], of_[0].closing = largest[1], of_[0].fastest = largest[2];
}

// Jammed is an island in which a contact still approaches by a good part of what closes in.
void Calm::find_jams(const State &s, std::size_t count)
{
  constexpr double part = 0.1, far_harder = 100;
  for (std::size_t k = 0; k < count; ++k) {
    const Contact &c = s.contacts[k];
    Island &island = of_[islands_.of(grain_of(c, s.bodies.data()))];
    const double v = normal_velocity(c, s.bodies.data()) + normal_drift(s, k), push = c.impulse / c.w_inverse;
    island.jammed |= island.closing > 0 && v < -part * island.closing && push > far_harder * island.drive;
  }
  if (s.halo) of_[0].jammed = s.halo->max(double(of_[0].jammed)) > 0;
}

// Returns the energy that this rank's grains have lost, J.
double Calm::slow_down(State &s) const
{
  double lost = 0;
  for (int b = 0; b < s.moving(); ++b) {
    if (s.bodies[b][3] == 0) continue;
    const Island &island = of_[islands_.of(b)];
    if (!island.jammed || !(island.fastest > island.drive)) continue;
    const double share = island.drive / island.fastest;
    if (b < s.grains.owned) lost += 0.5 * speed2(s.bodies[b]) / s.bodies[b][3] * (1 - share * share);
    s.bodies[b] *= Vec4{share, share, share, 1};
  }
  return lost;
}

Calm::Found Calm::slow_down(State &s, std::size_t count)
{
  find_islands(s, count);
  find_drives(s, count);
  find_jams(s, count);
  double jammed = 0;
  for (const Island &island : of_) jammed = std::max(jammed, double(island.jammed));
  return {(s.halo ? s.halo->max(jammed) : jammed) > 0, slow_down(s)};
}

}    // namespace nscd
