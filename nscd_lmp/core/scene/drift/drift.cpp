// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/drift/drift.hpp"

#include "scene/copies.hpp"
#include "scene/drift/drift_of.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

Vec4 place_of(const Grains &g, int atom)
{
  const double *x = g.x + 3 * std::size_t(atom);
  return Vec4{x[0], x[1], x[2], 0};
}

// The whole edges of the box between an image and its grain, with which it moves; 0 for a grain.
Vec4 shift_of(const State &s, int atom)
{
  const int body = s.atoms.owner[atom];
  if (body == atom) return Vec4{};
  const bool own = body < s.in.grains.owned;
  const Grains &g = s.in.grains;
  return place_of(g, atom) - (own ? place_of(g, body) : s.motion.copies.place[body - g.owned]);
}

// What two atoms that are carried by the box differ by, over their distance: a little more than they touch.
constexpr double touching = 1.5;

}    // namespace

void Drifts::begin_run()
{
  growth_.begin_run();
  box_.begin_run();
}

void Drifts::see(const Grains &grains)
{
  growth_.see(grains);
  if (grains.box) box_.see(*grains.box);
}

bool Drifts::look(const State &s, bool new_list) { return growth_.look(s.in.grains, new_list); }

void Drifts::settle(State &s, bool changed, bool new_list)
{
  Drift &drift = s.drift;
  growth_.settle(s.in.grains, changed, s.in.dt, s.in.settings.recovery);
  if (s.in.grains.box) box_.look(s);
  const double grown = s.exec.halo && changed ? s.exec.halo->max(growth_.grown()) : growth_.grown();
  neared_ = new_list ? 0 : neared_ + 2 * s.in.dt * shifting_ + 2 * grown;
  shifting_ = 0;
  drift.sudden = growth_.sudden();
  drift.jump.clear();
  if (!box_.jump().is_zero()) fill_jump(s);
  drift.of.clear();
  drift.approach = 0;
  drift.fastest = 0;
  if (box_.moves() || !growth_.rates().empty()) fill(s);
  if (new_list) neared_ = 2 * shifting_ * box_.lag();
}

void Drifts::fill_jump(State &s) const
{
  const Gradient rate = box_.jump() * give_back_rate(s.in.settings.recovery, s.in.dt, box_.before_run());
  const bool carried = box_.jump_carries_grains();
  if (!carried && s.exec.halo) share_places(s);
  s.drift.jump.resize(std::size_t(s.in.grains.owned) + s.in.grains.ghosts);
  for (std::size_t a = 0; a < s.drift.jump.size(); ++a)
    s.drift.jump[a] = rate.at(carried ? place_of(s.in.grains, int(a)) : shift_of(s, int(a)));
}

void Drifts::fill(State &s)
{
  const Grains &g = s.in.grains;
  Drift &drift = s.drift;
  const std::vector<double> &rates = growth_.rates();
  const bool carried = box_.moves() && box_.carries_grains(), shifted = box_.moves() && !carried;
  if (shifted && s.exec.halo) share_places(s);
  double growing = 0;
  drift.of.resize(std::size_t(g.owned) + g.ghosts);
  for (int a = 0; a < g.owned + g.ghosts; ++a) {
    Vec4 of{};
    if (carried) of = box_.at(place_of(g, a));
    if (shifted) of = box_.gradient().at(shift_of(s, a));
    const double rate = rates.empty() ? 0 : rates[a];
    const double apart = carried ? box_.gradient().norm() * touching * g.radius[a] : std::sqrt(dot(of, of));
    shifting_ = std::max(shifting_, apart);
    growing = std::max(growing, rate);
    of[3] = rate;
    drift.of[a] = of;
  }
  double largest[] = {shifting_, growing};
  if (s.exec.halo) s.exec.halo->max(largest);
  shifting_ = largest[0];
  drift.fastest = shifting_ + largest[1];
}

void Drifts::place(State &s, double predicted, double look_ahead) const
{
  Drift &drift = s.drift;
  if (drift.of.empty()) return;
  const double centres = box_.moves() ? box_.lag() + predicted : 0;
  const double radii = growth_.rates().empty() ? 0 : growth_.lag() + predicted;
  drift.approach = 2 * (s.in.dt + std::max(centres, radii)) * drift.fastest;
  drift.to_end = s.in.dt - predicted;
  drift.centres = box_.moves() && box_.changes_within(s.in.dt) ? drift.to_end : -centres;
  drift.radii = -radii;
  drift.ahead = centres;
  for (std::size_t a = 0; a < s.atoms.spheres.size(); ++a) {
    const Vec4 &of = drift.of[a];
    Sphere &sphere = s.atoms.spheres[a];
    sphere.centre += without_fourth(of) * centres;
    sphere.radius += of[3] * radii;
    sphere.reach += s.in.dt * look_ahead * drift.fastest;
  }
  s.search.watch += drift.approach;
}

void Drifts::leave(const State &s)
{
  if (s.in.grains.box) box_.leave(s);
}

}    // namespace nscd
