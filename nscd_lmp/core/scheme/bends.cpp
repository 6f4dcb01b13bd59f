// SPDX-License-Identifier: GPL-2.0-or-later
#include "scheme/bends.hpp"

#include "scene/contact_plane.hpp"
#include "scene/slides.hpp"
#include "solver/across_ranks.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

constexpr double parts_of_step = 100;
constexpr double none = -1;   // moment of a contact that is no impact, s

char parts(const State &s, double moment) { return char(parts_of_step * moment / s.in.dt); }

bool is_grain(const State &s, int body) { return s.motion.bodies[body][3] > 0; }

// How a pair lies and moves behind the impacts so far.
struct Pair {
  alignas(vec4_alignment) Vec4 separation;   // m, where its way comes from
  alignas(vec4_alignment) Vec4 parting;      // m/s
};

Pair pair_now(const State &s, std::size_t k)
{
  const Contact &c = s.table.contacts[k];
  const ContactInfo &info = s.table.infos[k];
  return {separation_at_start(s, info) + s.courses.start[c.i] - s.courses.start[c.j],
          without_fourth(s.motion.bodies[c.i] - s.motion.bodies[c.j]) + carried_apart(s, {info.atom_i, info.atom_j})};
}

// What impacts have given along contact k turns with its plane.
void turn_impact(State &s, std::size_t k)
{
  auto &tangential = s.table.impact_tangential;
  if (tangential.is_open()) tangential[k] = turned_along(s.table.contacts[k].normal, tangential[k]);
}

void turn(State &s, std::size_t k, const Vec4 &there)
{
  take_plane(s, k, there);
  turn_impact(s, k);
}

void turn_to_start(State &s, std::size_t k)
{
  take_start_plane(s, k);
  turn_impact(s, k);
}

// Whether neither course bends.
bool is_straight(const State &s, const Contact &c)
{
  const auto bends = [&s](int body) { return is_grain(s, body) && !s.courses.straight[body]; };
  return !bends(c.i) && !bends(c.j);
}

// How far the plane of contact k is at the end of the step, m; an overlap that it had is none.
double plane_at_end(const State &s, std::size_t k, double u)
{
  return plane_gap(s, k) - std::min(s.table.infos[k].gap, 0.0) + s.in.dt * u;
}

}    // namespace

void Bends::begin(State &s)
{
  meetings_.reserve(s.table.contacts.size());
  s.courses.shift.assign(s.motion.bodies.size(), Vec4{});
  s.courses.start.assign(s.motion.bodies.size(), Vec4{});
  s.courses.work = 0;
  struck_.assign(s.motion.bodies.size(), 0);
  s.courses.straight.resize(s.motion.bodies.size());
  all_changed_ = true;
  for (std::size_t k = 0; k < s.table.contacts.size(); ++k)
    if (s.table.infos[k].curve < 0 && is_straight(s, s.table.contacts[k]))
      turn_to_start(s, k);
}

// Whether the last look at this contact still holds.
bool Bends::is_seen(const State &s, const Contact &c) const
{
  return !all_changed_ && !s.exec.halo && !changed_[c.i] && !changed_[c.j];
}

void Bends::find_starts(State &s) const
{
  for (int i = 0; i < s.moving(); ++i) {
    if (!all_changed_ && !s.exec.halo && !changed_[i]) continue;
    if (!is_grain(s, i) || s.courses.straight[i]) {
      s.courses.start[i] = Vec4{};
      continue;
    }
    const Vec4 struck = s.motion.bodies[i] - start_velocity(s, i) - 0.5 * smooth_kick(s, i);
    s.courses.start[i] = s.courses.shift[i] - without_fourth(struck) * (0.5 * s.in.dt);
  }
}

double Bends::last_struck(const State &s, const Contact &c) const
{
  const auto at = [&](int body) { return s.courses.straight[body] ? char(0) : struck_[body]; };
  return s.in.dt / parts_of_step * std::max(at(c.i), at(c.j));
}

std::optional<double> Bends::meet(State &s, std::size_t k) const
{
  const Contact &c = s.table.contacts[k];
  const double struck = last_struck(s, c);
  const bool is_flat = s.table.infos[k].atom_j < 0 || is_straight(s, c);
  std::optional<double> moment = is_flat ? meet_plane(s, k, struck) : meet_grain(s, k, struck);
  if (moment) *moment += struck;
  return moment && *moment <= s.in.dt ? moment : std::nullopt;
}

std::optional<double> Bends::meet_plane(const State &s, std::size_t k, double struck) const
{
  const double closing = -(normal_velocity(s.table.contacts[k], s.motion.bodies.data()) + normal_drift(s, k));
  const double gap = s.table.infos[k].gap + put_apart(s, s.table.contacts[k]);
  return closing > 0 ? std::optional(std::max(gap / closing - struck, 0.0)) : std::nullopt;
}

std::optional<double> Bends::meet_grain(State &s, std::size_t k, double struck) const
{
  constexpr double most_turned = 0.5;   // cosine: a pair that is turned by more would be let through each other
  const ContactInfo &info = s.table.infos[k];
  const Pair pair = pair_now(s, k);
  const double growth = growth_of(s, {info.atom_i, info.atom_j});
  const double radii = s.atoms.spheres[info.atom_i].radius + s.atoms.spheres[info.atom_j].radius + growth * struck;
  const Vec4 start = separation_at_start(s, info), now = pair.separation + pair.parting * struck;
  const auto is_turned = [&](const Vec4 &there) {
    return dot(there, start) < most_turned * std::sqrt(dot(there, there) * dot(start, start));
  };
  const auto moment = meeting(now, radii, pair.parting, growth);
  const Vec4 there = now + pair.parting * std::clamp(moment.value_or(s.in.dt - struck), 0.0, s.in.dt - struck);
  if (is_turned(now) || is_turned(there)) {
    turn(s, k, start);
    return 0;
  }
  turn(s, k, there);
  return moment;
}

// The smooth forces change velocities evenly: at `moment` they differ by this from those in the middle, along n.
double Bends::kick_until(const State &s, std::size_t k, double moment) const
{
  const Contact &c = s.table.contacts[k];
  const auto kick = [&](int body) {
    return is_grain(s, body) && !s.courses.straight[body] ? smooth_kick(s, body) : Vec4{};
  };
  return dot(c.normal, kick(c.i) - kick(c.j)) * (moment / s.in.dt - 0.5);
}

void Bends::look(State &s, const IsImpact &is_impact)
{
  find_starts(s);
  meetings_.clear();
  s.table.impact_moment.open();
  s.table.impact_kick.open();
  for (std::size_t k = 0; k < s.table.contacts.size(); ++k) {
    if (is_seen(s, s.table.contacts[k])) {
      if (s.table.impact_moment[k] >= 0) meetings_.push_back(k);
      continue;
    }
    s.table.impact_moment[k] = none;
    const double before = normal_velocity(s.table.contacts[k], s.motion.bodies.data()) + normal_drift(s, k);
    if (plane_at_end(s, k, before) >= 0) continue;
    const auto moment = meet(s, k);
    if (!moment) continue;
    const double u = normal_velocity(s.table.contacts[k], s.motion.bodies.data()) + normal_drift(s, k);
    const double kick = kick_until(s, k, *moment);
    if (!is_impact(k, u + kick)) continue;
    s.table.impact_moment[k] = *moment;
    s.table.impact_kick[k] = kick;
    meetings_.push_back(k);
  }
  changed_.assign(s.motion.bodies.size(), 0);
  all_changed_ = false;
}

const std::vector<std::size_t> &Bends::first_meetings(State &s)
{
  sooner_.assign(s.motion.bodies.size(), 0);
  const auto left = [&s](std::size_t k) { return char(parts_of_step - parts(s, s.table.impact_moment[k])); };
  const auto each = [&](std::size_t k, auto act) {
    for (const int body : {s.table.contacts[k].i, s.table.contacts[k].j})
      if (is_grain(s, body)) act(body);
  };
  for (const std::size_t k : meetings_) each(k, [&](int b) { sooner_[b] = std::max(sooner_[b], left(k)); });
  if (s.exec.halo) s.exec.halo->spread(sooner_);
  std::erase_if(meetings_, [&](std::size_t k) {
    bool later = false;
    each(k, [&](int b) { later |= left(k) < sooner_[b]; });
    return later;
  });
  return meetings_;
}

void Bends::act(State &s, std::size_t count)
{
  change_across(s.exec.halo, s.courses.shift, nullptr, [&] {
    for (std::size_t k = 0; k < count; ++k) {
      const Contact &c = s.table.contacts[k];
      const double moment = s.table.impact_moment[k];
      const Vec4 way = (c.normal * c.impulse + tangential_impulse(s, k)) * (0.5 * s.in.dt - moment);
      s.courses.work += c.impulse * s.table.impact_kick[k];
      for (const int body : {c.i, c.j}) {
        changed_[body] = 1;
        const double moved = body == c.i ? s.motion.bodies[body][3] : -s.motion.bodies[body][3];
        if (!s.courses.straight[body]) s.courses.shift[body] += way * moved;
        if (c.impulse > 0 && is_grain(s, body)) struck_[body] = std::max(struck_[body], parts(s, moment));
      }
    }
  });
  if (s.exec.halo) s.exec.halo->spread(struck_);
}

// Contacts that are to be pushed apart although they part, by more than a solved step leaves.
void Bends::find_contradictions(State &s)
{
  for (std::size_t k = 0; k < s.table.contacts.size(); ++k) {
    const Contact &c = s.table.contacts[k];
    const auto is_kept = [&] {
      const double parts = std::max(0.0, normal_velocity(c, s.motion.bodies.data()) + normal_drift(s, k));
      return plane_at_end(s, k, parts) >= -left_of_overlap(s, worth(s.table.infos[k]), s.table.infos[k].radius);
    };
    if (put_apart(s, c) == 0 || is_kept()) continue;
    meet(s, k);
    if (is_kept()) continue;
    for (const int body : {c.i, c.j}) s.courses.straight[body] = is_grain(s, body);
  }
}

// Shifts of straight bodies are taken back, and planes between them that would drive pairs apart.
void Bends::take_back(State &s)
{
  all_changed_ = true;
  for (std::size_t b = 0; b < s.courses.straight.size(); ++b)
    if (s.courses.straight[b]) s.courses.shift[b] = Vec4{};
  find_starts(s);
  for (std::size_t k = 0; k < s.table.contacts.size(); ++k) {
    const Contact &c = s.table.contacts[k];
    const ContactInfo &info = s.table.infos[k];
    if (info.curve < 0 && is_straight(s, c)) turn_to_start(s, k);
  }
}

bool Bends::straighten(State &s)
{
  before_ = s.courses.straight;
  find_contradictions(s);
  if (s.exec.halo) s.exec.halo->spread(s.courses.straight);
  take_back(s);
  return sum_everywhere(s, double(s.courses.straight != before_)) > 0;
}

void Bends::straighten_connected(State &s, std::size_t count)
{
  joined_.clear();
  for (const Contact &c : s.table.contacts)
    if (is_grain(s, c.i) && is_grain(s, c.j)) joined_.push_back({c.i, c.j});
  islands_.find(s.motion.bodies.size(), joined_, s.exec.halo);
  islands_.clear_sums();
  for (std::size_t k = 0; k < count; ++k) islands_.add(grain_of(s.table.contacts[k], s.motion.bodies.data()), {1, 0});
  if (s.exec.halo) islands_.sum(0)[0] = s.exec.halo->sum(islands_.sum(0)[0]);
  for (int b = 0; b < s.moving(); ++b)
    if (is_grain(s, b) && islands_.sum(islands_.of(b))[0] > 0) s.courses.straight[b] = 1;
  take_back(s);
}

}    // namespace nscd
