// SPDX-License-Identifier: GPL-2.0-or-later
#include "scheme/displacements.hpp"

#include "base/hot.hpp"
#include "scene/contact_plane.hpp"
#include "scene/gap.hpp"
#include "scene/slides.hpp"
#include "solver/across_ranks.hpp"

#include <algorithm>

namespace nscd {

// Rate at which the contact's gap changes as its bodies move now, m/s.
NSCD_INLINE double Displacements::rate(const State &s, std::size_t k) const
{
  const Contact &c = s.table.contacts[k];
  return dot(c.normal, mean_[c.i] - mean_[c.j]) + normal_drift(s, k);
}

// The rate at which it does if all but impacts acts from the start.
NSCD_INLINE double solved_rate(const State &s, std::size_t k)
{
  const Contact &c = s.table.contacts[k];
  return normal_velocity(c, s.motion.bodies.data()) + put_apart(s, c) / s.in.dt + normal_drift(s, k);
}

// Whether the contact is left with no more overlap than the solver's tolerance leaves anyway.
NSCD_INLINE bool Displacements::is_open(const State &s, std::size_t k, double rate) const
{
  const ContactInfo &info = s.table.infos[k];
  return !(info.gap + info.curve + s.in.dt * rate < -left_of_overlap(s, worth(info), info.radius));
}

// All but impacts acts from the start of the step on.
NSCD_INLINE Vec4 final_velocity(const State &s, int body)
{
  return s.motion.bodies[body] + course_start(s, body) / s.in.dt;
}

void Displacements::start_half_way(const State &s)
{
  const std::size_t bodies = s.motion.bodies.size();
  mean_.resize(bodies);
  final_.assign(bodies, 0);
  for (std::size_t i = 0; i < bodies; ++i) {
    const Body &b = s.motion.bodies[i];
    if (b[3] > 0) {
      mean_[i] = 0.5 * (start_velocity(s, int(i)) + Vec4{0, 0, 0, b[3]} + b);
    } else {
      mean_[i] = b;
      final_[i] = 1;
    }
  }
}

void Displacements::add_shift(const State &s)
{
  for (std::size_t i = 0; i < s.courses.shift.size(); ++i)
    if (!final_[i]) mean_[i] += s.courses.shift[i] / s.in.dt;
}

// Collected without branches, which would be mispredicted.
NSCD_HOT void Displacements::find_suspects(const State &s)
{
  const std::size_t n = s.table.contacts.size();
  resize_closely(suspects_, n);
  std::size_t count = 0;
  for (std::size_t k = 0; k < n; ++k) {
    fetch_bodies(s.table.contacts[std::min(k + fetch_ahead, n - 1)], mean_.data());
    suspects_[count] = std::uint32_t(k);
    count += !is_open(s, k, rate(s, k));
  }
  suspects_.resize(count);
}

// What an impulse displaces acts half-way: half of it again makes it act from the start. No more of that than opens the
// contact, or gives back what the solution does.
void Displacements::act_earlier(const State &s)
{
  for (const std::uint32_t k : suspects_) {
    const Contact &c = s.table.contacts[k];
    if (!(c.impulse > 0)) continue;
    const double of_i = final_[c.i] ? 0 : s.motion.bodies[c.i][3], of_j = final_[c.j] ? 0 : s.motion.bodies[c.j][3];
    const double opens = -(s.table.infos[k].gap + s.table.infos[k].curve) / s.in.dt;
    const double missing = std::min(opens, solved_rate(s, k)) - rate(s, k);
    const double share = std::clamp(missing / ((of_i + of_j) * c.impulse), 0.0, 0.5);
    const Vec4 earlier = share * (c.normal * c.impulse + tangential_impulse(s, k));
    mean_[c.i] += earlier * of_i;
    mean_[c.j] -= earlier * of_j;
  }
}

// If the contact is driven into overlap, both grains are made to move with v_{k+1}, unless that is worse still.
// Returns whether that changed a grain.
NSCD_INLINE bool Displacements::open_contact(const State &s, std::uint32_t k)
{
  const Contact &c = s.table.contacts[k];
  if (final_[c.i] && final_[c.j]) return false;
  const double now = rate(s, k);
  if (is_open(s, k, now) || now >= solved_rate(s, k)) return false;
  for (const int b : {c.i, c.j}) {
    mean_[b] = final_velocity(s, b);
    final_[b] = lately;
  }
  return true;
}

// Returns whether that changed a grain.
NSCD_HOT bool Displacements::open_suspects(const State &s)
{
  bool changed = false;
  for (const std::uint32_t k : suspects_) changed |= open_contact(s, k);
  return changed;
}

// Those between a grain that has changed in the pass before and one that has not.
NSCD_HOT void Displacements::find_neighbors(const State &s)
{
  const std::size_t n = s.table.contacts.size();
  resize_closely(suspects_, n);
  std::size_t count = 0;
  for (std::size_t k = 0; k < n; ++k) {
    suspects_[count] = std::uint32_t(k);
    count += final_[s.table.contacts[k].i] + final_[s.table.contacts[k].j] == lately;
  }
  suspects_.resize(count);
}

// Opens contacts until none is driven into overlap. After the first pass only contacts between a grain that has
// changed and one that has not can fail.
void Displacements::open_contacts(const State &s)
{
  find_suspects(s);
  for (bool changed = true; changed;) {
    changed = open_suspects(s);
    if (changed) find_neighbors(s);
    for (char &is_final : final_) is_final &= 1;
  }
}

// Contact k takes the plane of the start of the step, with its impulse.
static void turn_back(State &s, std::size_t k)
{
  const Contact &c = s.table.contacts[k];
  const double normal = c.impulse;
  const Vec4 tangential = tangential_impulse(s, k);
  remove_impulse(s, k);
  take_start_plane(s, k);
  add_impulse(s, k, normal, turned_along(c.normal, tangential));
}

// A plane taken elsewhere says nothing of a pair that is stopped on the way there: whether it overlaps for that by more
// than may be.
static bool has_left_plane(const State &s, std::size_t k)
{
  const ContactInfo &info = s.table.infos[k];
  if (info.curve == 0 || !s.in.settings.overlap) return false;
  const double end = gap_at(s, {info.atom_i, info.atom_j}, at_end);
  return end < -*s.in.settings.overlap * info.radius && end < info.gap;
}

static bool is_jammed(const State &s, std::size_t k, std::span<const char> jammed)
{
  return !jammed.empty() && jammed[grain_of(s.table.contacts[k], s.motion.bodies.data())] != 0;
}

// Contacts that overlap since a course comes from beyond their surface.
bool Displacements::straighten_broken(State &s, std::span<const char> jammed)
{
  std::vector<char> &straight = s.courses.straight;
  before_ = straight;
  for (std::size_t k = 0; k < s.table.contacts.size(); ++k) {
    const Contact &c = s.table.contacts[k];
    if (is_open(s, k, rate(s, k)) || is_jammed(s, k, jammed)) continue;
    const bool relied = put_apart(s, c) < 0 && rate(s, k) < 0;
    if (!relied && !has_left_plane(s, k)) continue;
    for (const int b : {c.i, c.j}) straight[b] = s.motion.bodies[b][3] > 0;
  }
  if (s.exec.halo) s.exec.halo->spread(straight);
  return sum_everywhere(s, double(straight != before_)) > 0;
}

bool Displacements::turn_back_broken(State &s, std::span<const char> jammed)
{
  double broken = 0;
  find_suspects(s);
  change_across(s.exec.halo, s.motion.bodies, s.motion.spins.data(), [&] {
    for (const std::uint32_t k : suspects_) {
      if (!has_left_plane(s, k) || is_jammed(s, k, jammed)) continue;
      turn_back(s, k);
      ++broken;
    }
  });
  return sum_everywhere(s, broken) > 0;
}

bool Displacements::fill(State &s, std::span<const char> jammed)
{
  start_half_way(s);
  add_shift(s);
  find_suspects(s);
  const bool drives = sum_everywhere(s, double(suspects_.size())) > 0;
  if (drives) {
    change_across(s.exec.halo, mean_, nullptr, [&] { act_earlier(s); });
    open_contacts(s);
    while (s.exec.halo && s.exec.halo->spread(final_)) {
      for (int i = 0; i < s.moving(); ++i)
        if (final_[i]) mean_[i] = final_velocity(s, i);
      open_contacts(s);
    }
  }
  for (int i = 0; i < s.moving(); ++i) {
    const Vec4 &w = mean_[i];
    s.motion.displacement[i] = Vec4{w[0], w[1], w[2], 0} * (way(s.motion, i) == Way::stands ? 0.0 : s.in.dt);
  }
  return drives && (s.courses.start.empty() ? turn_back_broken(s, jammed) : straighten_broken(s, jammed));
}

}    // namespace nscd
