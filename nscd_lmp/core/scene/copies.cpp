// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/copies.hpp"

#include "parallel/halo_move.hpp"
#include "scene/spins.hpp"

#include <algorithm>

namespace nscd {

void plan_copies(State &s)
{
  const Grains &g = s.in.grains;
  const std::size_t owned = std::size_t(g.owned), ghosts = std::size_t(g.ghosts);
  const Known known{{g.tag, owned}, {g.tag + owned, ghosts}, {g.home, ghosts}};
  s.motion.copies.count = s.exec.halo->find_copies(known, std::span(s.atoms.owner).subspan(owned, ghosts));
  s.exec.halo->announce_copies(s.atoms.own_tags);
}

void share_motion(State &s)
{
  const bool spins = s.friction.model != Model::frictionless;
  Copies &copies = s.motion.copies;
  copies.start.resize(copies.count);
  copies.kick.resize(copies.count);
  if (spins) {
    copies.start_spin.resize(copies.count);
    copies.spin_kick.resize(copies.count);
  }
  const auto pack = [&](int body, double *to) {
    put(start_velocity(s, body), to);
    put(smooth_kick(s, body), to + 3);
    to[6] = s.motion.bodies[body][3] - double(way(s.motion, body));   // an obstacle has no inverse mass
    if (!spins) return;
    put(start_spin(s, body), to + 7);
    put(smooth_spin_kick(s, body), to + 10);
  };
  const auto unpack = [&](int body, const double *from) {
    const int c = body - s.in.grains.owned;
    copies.start[c] = Vec4{from[0], from[1], from[2], 0};
    copies.kick[c] = Vec4{from[3], from[4], from[5], 0};
    s.motion.bodies[body] = copies.start[c] + copies.kick[c] + Vec4{0, 0, 0, std::max(0.0, from[6])};
    if (from[6] < 0 && s.motion.ways.empty()) s.motion.ways.assign(s.moving(), Way::has_moved);
    if (from[6] < 0) s.motion.ways[body] = Way(int(-from[6]));
    if (!spins) return;
    copies.start_spin[c] = Vec4{from[7], from[8], from[9], 0};
    copies.spin_kick[c] = Vec4{from[10], from[11], from[12], 0};
    s.motion.spins[body] = copies.start_spin[c] + copies.spin_kick[c];
  };
  s.exec.halo->to_copies(spins ? 13 : 7, pack, unpack);
}

void share_places(State &s)
{
  s.motion.copies.place.resize(s.motion.copies.count);
  const auto pack = [&](int body, double *to) { std::copy_n(s.in.grains.x + 3 * std::size_t(body), 3, to); };
  const auto unpack = [&](int body, const double *from) {
    s.motion.copies.place[body - s.in.grains.owned] = Vec4{from[0], from[1], from[2], 0};
  };
  s.exec.halo->to_copies(3, pack, unpack);
}

void refresh_copies(State &s)
{
  const bool spins = s.friction.model != Model::frictionless;
  const auto pack = [&](int body, double *to) {
    put(s.motion.bodies[body], to);
    if (spins) put(s.motion.spins[body], to + 3);
  };
  const auto unpack = [&](int body, const double *from) {
    take(s.motion.bodies[body], from);
    if (spins) take(s.motion.spins[body], from + 3);
  };
  s.exec.halo->to_copies(spins ? 6 : 3, pack, unpack);
}

}    // namespace nscd
