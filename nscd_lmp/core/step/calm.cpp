// SPDX-License-Identifier: GPL-2.0-or-later
#include "step/calm.hpp"

#include "scene/drift/drift_of.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

Calm::Island &Calm::of_contact(const State &s, const Contact &c)
{
  return of_[islands_.of(grain_of(c, s.motion.bodies.data()))];
}

void Calm::find_islands(const State &s, std::size_t count)
{
  of_.reserve(s.motion.bodies.size());   // more islands need no more
  joined_.clear();
  joined_.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const Contact &c = s.table.contacts[k];
    if (c.impulse > 0 && s.motion.bodies[c.i][3] > 0 && s.motion.bodies[c.j][3] > 0) joined_.push_back({c.i, c.j});
  }
  islands_.find(s.motion.bodies.size(), joined_, s.exec.halo);
  of_.assign(islands_.count(), {});
  for (int b = 0; b < s.moving(); ++b) {
    if (s.motion.bodies[b][3] == 0) continue;
    Island &island = of_[islands_.of(b)];
    island.drive = std::max(island.drive, std::sqrt(speed2(start_velocity(s, b) + smooth_kick(s, b))));
  }
}

// What obstacles and drifts drive it by, all ranks' together.
void Calm::find_drives(const State &s, std::size_t count)
{
  for (std::size_t k = 0; k < count; ++k) {
    const Contact &c = s.table.contacts[k];
    Island &island = of_contact(s, c);
    for (const int b : {c.i, c.j}) {
      if (s.motion.bodies[b][3] > 0) continue;
      island.closing = std::max(island.closing, std::sqrt(speed2(s.motion.bodies[b])));
      island.held = true;
    }
    island.closing = std::max(island.closing, std::abs(normal_drift(s, k)));
  }
  for (Island &island : of_) island.drive = std::max(island.drive, island.closing);
  if (!s.exec.halo) return;
  double largest[] = {of_[0].drive, of_[0].closing, double(of_[0].held)};
  s.exec.halo->max(largest);
  of_[0].drive = largest[0], of_[0].closing = largest[1], of_[0].held = largest[2] > 0;
}

// Jammed is an island in which a contact still approaches by a good part of what closes in.
void Calm::find_jams(const State &s, std::size_t count)
{
  constexpr double part = 0.1, far_harder = 100;
  jams_.clear();
  const auto jam = [this](Island &island) {
    if (island.jam >= 0) return;
    island.jam = int(jams_.size());
    jams_.emplace_back();
  };
  for (std::size_t k = 0; k < count; ++k) {
    const Contact &c = s.table.contacts[k];
    Island &island = of_contact(s, c);
    const double v = normal_velocity(c, s.motion.bodies.data()) + normal_drift(s, k), push = c.impulse / c.w_inverse;
    if (island.closing > 0 && v < -part * island.closing && push > far_harder * island.drive) jam(island);
  }
  if (s.exec.halo && s.exec.halo->max(double(jams_.size())) > 0) jam(of_[0]);   // ranks have one island
}

// What a jammed island may keep as it is: its mean velocity, where no obstacle takes part.
void Calm::find_motions(const State &s)
{
  for (int b = 0; b < s.in.grains.owned; ++b) {
    const Island *island = s.motion.bodies[b][3] > 0 ? &of_[islands_.of(b)] : nullptr;
    if (!island || island->jam < 0 || island->held) continue;
    Jam &jam = jams_[island->jam];
    jam.mass += 1 / s.motion.bodies[b][3];
    jam.motion += without_fourth(s.motion.bodies[b]) / s.motion.bodies[b][3];
  }
  if (s.exec.halo) {
    Jam &jam = jams_[0];
    double sums[] = {jam.mass, jam.motion[0], jam.motion[1], jam.motion[2]};
    s.exec.halo->sum(sums);
    jam.mass = sums[0];
    jam.motion = Vec4{sums[1], sums[2], sums[3], 0};
  }
  for (Jam &jam : jams_) jam.motion = jam.mass > 0 ? jam.motion / jam.mass : Vec4{};
}

void Calm::find_fastest(const State &s)
{
  for (int b = 0; b < s.moving(); ++b) {
    const int number = s.motion.bodies[b][3] > 0 ? of_[islands_.of(b)].jam : -1;
    if (number < 0) continue;
    Jam &jam = jams_[number];
    jam.fastest = std::max(jam.fastest, std::sqrt(speed2(s.motion.bodies[b] - jam.motion)));
  }
  if (s.exec.halo) jams_[0].fastest = s.exec.halo->max(jams_[0].fastest);
}

// Returns the energy that this rank's grains have lost, J.
double Calm::slow_down(State &s)
{
  double lost = 0;
  jammed_.assign(s.moving(), 0);
  for (int b = 0; b < s.moving(); ++b) {
    const Island *island = s.motion.bodies[b][3] > 0 ? &of_[islands_.of(b)] : nullptr;
    if (!island || island->jam < 0) continue;
    jammed_[b] = 1;
    const Jam &jam = jams_[island->jam];
    if (!(jam.fastest > island->drive)) continue;
    const double before2 = speed2(s.motion.bodies[b]), share = island->drive / jam.fastest;
    s.motion.bodies[b] += (without_fourth(s.motion.bodies[b]) - jam.motion) * (share - 1);
    if (b < s.in.grains.owned) lost += 0.5 * (before2 - speed2(s.motion.bodies[b])) / s.motion.bodies[b][3];
  }
  return lost;
}

Calm::Found Calm::slow_down(State &s, std::size_t count)
{
  find_islands(s, count);
  find_drives(s, count);
  find_jams(s, count);
  if (jams_.empty()) return {};
  find_motions(s);
  find_fastest(s);
  const double energy = slow_down(s);
  return {true, energy, jammed_};
}

}    // namespace nscd
