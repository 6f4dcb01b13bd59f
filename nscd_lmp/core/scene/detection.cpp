// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/detection.hpp"

#include "scene/contact_geometry.hpp"
#include "scene/contact_plane.hpp"
#include "scene/gap.hpp"

#include <optional>

namespace nscd {

namespace {

// A share of their reach within which pairs are contacts although free motion keeps them apart: less means fewer
// contacts, and more rounds of promotion. In a cloud that falls on a bed most pairs within reach fall together; with a
// quarter a bed of 100,000 has 283,000 contacts in place of 904,000.
constexpr double near_share = 0.25;

// What is foreseen of a step by free velocities.
struct Foresight {
  double dt;

  // `rate`: of the gap, m/s; `kick`: of the grain that forces change more, m/s.
  bool meets(double gap, double reach, double rate, double kick) const
  {
    const double always = 2 * dt * kick;   // smooth forces may close such a gap
    return !(gap + dt * std::min(rate, 0.0) > near_share * reach + always);   // not-a-number meets, and is refused
  }
};

// All listed pairs that are near enough to watch, into s.search.found. Most are not, and a branch on that would be
// mispredicted, so every pair is stored and the counter moves on or not.
NSCD_HOT void filter_pairs(State &s, const PairList &pairs)
{
  const Sphere *const spheres = s.atoms.spheres.data();
  std::size_t kept = 0;
  for (int entry = 0; entry < pairs.count; ++entry) {
    const int i = pairs.atom[entry], count = pairs.neighbors[entry];
    const int *const neighbors = pairs.first[entry];
    const Vec4 centre = spheres[i].centre;
    const double watch = spheres[i].radius + s.search.watch;
    if (s.search.found.size() < kept + count) s.search.found.resize(2 * (kept + count));
    Candidate *const found = s.search.found.data();
    for (int k = 0; k < count; ++k) {
      const int j = neighbors[k] & neighbor_index_mask;
      const Vec4 separation = centre - spheres[j].centre;
      const double watched = watch + spheres[j].radius;
      found[kept] = {i, j};
      kept += dot(separation, separation) <= watched * watched;
    }
  }
  s.search.found_count = kept;
}

// A grain can be no contact of itself, so a box that is narrower than a grain would hold an overlap that nothing sees.
bool overlaps_own_image(const State &s, const Candidate &c)
{
  constexpr double touches = 1e-9;
  const Sphere &grain = s.atoms.spheres[c.atom_i];
  return s.atoms.owner[c.atom_i] == s.atoms.owner[c.atom_j] && s.motion.bodies[s.atoms.owner[c.atom_i]][3] > 0 &&
      gap_of(grain, s.atoms.spheres[c.atom_j]) < -touches * grain.radius;
}

[[noreturn]] void refuse_narrow_box(const State &s, const Candidate &c)
{
  const Sphere &grain = s.atoms.spheres[c.atom_i];
  fail("grain ", s.in.grains.tag[c.atom_i], " overlaps its own periodic image by ",
       -gap_of(grain, s.atoms.spheres[c.atom_j]), ": the box must be wider than the grain's diameter ",
       2 * grain.radius);
}

// Not a contact: a grain and its own image, two obstacles, or a pair that the list has a second time.
bool is_void(const State &s, const Candidate &c, const PairList &pairs)
{
  const int i = s.atoms.owner[c.atom_i], j = s.atoms.owner[c.atom_j];
  if (i == j || s.motion.bodies[i][3] + s.motion.bodies[j][3] == 0) return true;
  const Grains &g = s.in.grains;
  return pairs.cross_pairs_twice && c.atom_j >= g.owned && g.tag[c.atom_i] > g.tag[c.atom_j];
}

// So that near[count] may be written; most scenes watch few pairs, and those that watch many come to hold them once.
NSCD_INLINE void make_room(std::vector<Watched> &near, std::size_t count)
{
  if (count >= near.size()) near.resize(std::max(near.capacity(), 2 * count + 64));
}

// Sorts what was found into contacts-to-be and watched pairs, without branching on which it is. Returns a grain and its
// image that overlap, if there are such.
NSCD_HOT std::optional<Candidate> sort_pairs(State &s, const PairList &pairs)
{
  std::optional<Candidate> narrow;
  s.search.touching.resize(s.search.found_count);
  std::size_t touching = 0, near = 0;
  for (std::size_t k = 0; k < s.search.found_count; ++k) {
    const Candidate c = s.search.found[k];
    if (is_void(s, c, pairs)) {
      if (!narrow && overlaps_own_image(s, c)) narrow = c;
      continue;
    }
    const Sphere &a = s.atoms.spheres[c.atom_i], &b = s.atoms.spheres[c.atom_j];
    const double gap = gap_of(a, b);
    const bool reaches = !(gap > a.reach + b.reach);   // not-a-number does, and is refused
    make_room(s.search.near, near);
    s.search.touching[touching] = c;
    s.search.near[near] = {c, gap};
    touching += reaches;
    near += !reaches;
  }
  make_room(s.search.near, near);
  s.search.touching.resize(touching);
  s.search.near.resize(near);
  return narrow;
}

// Each of them is one rank's, once, and of two bodies.
void take_unlisted(State &s)
{
  s.search.touching.insert(s.search.touching.end(), s.search.unlisted.begin(), s.search.unlisted.end());
}

// Those of the contacts-to-be that are not foreseen are watched instead.
NSCD_HOT void watch_unforeseen(State &s)
{
  const Foresight foresight{s.in.dt};
  const std::size_t watched = s.search.near.size(), count = s.search.touching.size();
  const bool drifts = !s.drift.of.empty();
  std::size_t kept = 0, doubted = watched;
  for (std::size_t k = 0; k < count; ++k) {
    const Candidate c = s.search.touching[k];
    const Sphere &a = s.atoms.spheres[c.atom_i], &b = s.atoms.spheres[c.atom_j];
    const auto [separation, distance, gap] = apart(a, b);
    const int i = s.atoms.owner[c.atom_i], j = s.atoms.owner[c.atom_j];
    Vec4 parting = s.motion.bodies[i] - s.motion.bodies[j];
    if (drifts) parting += drift_of(s, c, separation / distance);
    const double rate = dot(separation, parting) / distance;
    const bool meets = foresight.meets(gap, a.reach + b.reach, rate, std::max(s.motion.kicks[i], s.motion.kicks[j]));
    make_room(s.search.near, doubted);
    s.search.touching[kept] = c;
    s.search.near[doubted] = {c, gap};
    kept += meets;
    doubted += !meets;
  }
  make_room(s.search.near, doubted);
  s.search.touching.resize(kept);
  s.search.near.resize(doubted);
  s.search.unforeseen = doubted - watched;
}

// How far the box carries a grain, which it does not carry away from others, m.
double carried_to_wall(const State &s, int i)
{
  return s.drift.of.empty() ? 0 : s.in.dt * length(without_fourth(s.drift.of[i]));
}

double most_carried(const State &s)
{
  double most = 0;
  for (int i = 0; !s.drift.of.empty() && i < s.in.grains.owned; ++i) most = std::max(most, carried_to_wall(s, i));
  return most;
}

// How far the box carries the grain and the wall's surface comes, m; `near`: how far that surface is at most.
double approach_of_wall(const State &s, int i, int number, double near)
{
  const double carried = carried_to_wall(s, i);
  if (!s.obstacles.moves(number)) return carried;
  return carried + s.in.dt * s.obstacles.sought(number).fastest(s.atoms.spheres[i].centre, near);
}

double most_approach_of_wall(const State &s, int number, double watch)
{
  if (!s.obstacles.moves(number)) return most_carried(s);
  double most = 0;
  for (int i = 0; i < s.in.grains.owned; ++i)
    most = std::max(most, approach_of_wall(s, i, number, s.atoms.spheres[i].radius + watch));
  return most;
}

// Calls f(i, touch, extra) for what a wall's features and grains are apart by no more than `watch`; both that and reach
// grow by `extra`, what the box carries the grain and the wall moves, m.
template <class F>
void for_each_near(State &s, int number, double watch, F f)
{
  const Obstacle &wall = s.obstacles.sought(number);
  const int groups = s.obstacles.groups(number);
  const std::span owned(s.atoms.spheres.data(), std::size_t(s.in.grains.owned));
  s.search.beside.clear();
  wall.find_near(owned, watch + most_approach_of_wall(s, number, watch), s.search.beside);
  for (const std::int32_t i : s.search.beside) {
    if (s.motion.bodies[i][3] == 0 || (groups != 0 && !(s.in.grains.mask[i] & groups))) continue;
    const Sphere &grain = s.atoms.spheres[i];
    const double extra = approach_of_wall(s, i, number, grain.radius + watch);
    s.search.touches.clear();
    wall.touch(grain.centre, grain.radius, watch + extra, s.search.touches);
    for (const Touch &touch : s.search.touches) f(i, touch, extra);
  }
}

void sort_wall(State &s, int wall)
{
  for_each_near(s, wall, s.search.watch, [&](int i, const Touch &touch, double extra) {
    const Candidate found{i, wall_code(wall, touch.feature)};
    if (touch.gap > s.atoms.spheres[i].reach + extra) s.search.near.push_back({found, touch.gap});
    else s.search.touching.push_back(found);
  });
}

// Neighbors in the list share bodies, and a sweep in list order would wait for each store before the next load.
// Taking the contacts from several places of the list in turn keeps the processor busy (6.6 -> 4.0 ns a contact
// without AVX2 and criterion, on a bed of 500; the sweep count changes by 1 %); more places than 8 gain nothing.
constexpr std::size_t streams = 8;

// Returns the first contact that does not fit, or as many as there are.
NSCD_HOT std::size_t place_range(State &s, const Range &range)
{
  std::size_t unfit = s.table.contacts.size();
  const std::size_t length = (range.size() + streams - 1) / streams;
  std::size_t k = range.first;
  for (std::size_t place = range.first; place < range.first + length; ++place)
    for (std::size_t listed = place; listed < range.last; listed += length, ++k)
      if (!place_contact(s, k, s.search.touching[listed])) unfit = std::min(unfit, k);
  return unfit;
}

void place_all_of(State &s, const Range &range)
{
  const std::size_t unfit = place_range(s, range);
  if (unfit < s.table.contacts.size()) refuse_overlap(s, unfit);
}

void place_contacts(State &s)
{
  const std::size_t n = s.search.touching.size();
  s.table.resize(n);
  if (s.exec.slabs.count() == 1) return place_all_of(s, {0, n});
  s.exec.slabs.divide(s);
  s.exec.slabs.order_candidates(s);
  for (int part = 0; part < s.exec.slabs.parts().count(); ++part) place_all_of(s, s.exec.slabs.parts().range(part));
}

// How far grains get at most, be it by displacement or by dt v_{k+1}.
void measure_moves(State &s)
{
  s.search.moved.assign(s.motion.bodies.size(), 0);
  for (int i = 0; i < s.moving(); ++i) {
    const Body &b = s.motion.bodies[i];
    const double speed2 = b[0] * b[0] + b[1] * b[1] + b[2] * b[2];
    const Vec4 &displacement = s.motion.displacement[i];
    s.search.moved[i] = std::sqrt(std::max(dot(displacement, displacement), s.in.dt * s.in.dt * speed2));
  }
}

// Whether the moves are long enough: next to nothing to ask, and nearly always no.
NSCD_INLINE bool may_meet(const State &s, const Watched &near)
{
  const double other = is_wall(near.pair) ? 0 : s.search.moved[s.atoms.owner[near.pair.atom_j]];
  const double extra = is_wall(near.pair)
      ? approach_of_wall(s, near.pair.atom_i, wall_of(near.pair.atom_j),
                         s.atoms.spheres[near.pair.atom_i].radius + near.gap)
      : 0;
  return near.gap <= 1.0000001 * (s.search.moved[s.atoms.owner[near.pair.atom_i]] + other + s.drift.approach + extra);
}

// Of the two that move farthest, m.
double sum_of_longest_moves(const State &s)
{
  double longest = 0, second = 0;
  for (const double moved : s.search.moved) {
    second = std::max(second, std::min(moved, longest));
    longest = std::max(longest, moved);
  }
  return longest + second + s.drift.approach;
}

// Those that filter_pairs left out, by the same expression, and now takes in.
void watch_pairs_beyond(State &s, const PairList &pairs, double watched)
{
  const auto is_within = [&s](int i, int j, double watch) {
    const Vec4 separation = s.atoms.spheres[i].centre - s.atoms.spheres[j].centre;
    const double distance = s.atoms.spheres[i].radius + watch + s.atoms.spheres[j].radius;
    return dot(separation, separation) <= distance * distance;
  };
  for (int entry = 0; entry < pairs.count; ++entry)
    for (int k = 0; k < pairs.neighbors[entry]; ++k) {
      const Candidate c{pairs.atom[entry], pairs.first[entry][k] & neighbor_index_mask};
      if (!is_within(c.atom_i, c.atom_j, s.search.watch) || is_within(c.atom_i, c.atom_j, watched)) continue;
      if (overlaps_own_image(s, c)) refuse_narrow_box(s, c);
      if (is_void(s, c, pairs)) continue;
      s.search.near.push_back({c, gap_of(s.atoms.spheres[c.atom_i], s.atoms.spheres[c.atom_j])});
    }
}

void watch_wall_beyond(State &s, int wall, double watched)
{
  for_each_near(s, wall, s.search.watch, [&](int i, const Touch &touch, double extra) {
    if (touch.gap > watched + extra) s.search.near.push_back({{i, wall_code(wall, touch.feature)}, touch.gap});
  });
}

double smaller_radius(const State &s, const Candidate &c)
{
  const double radius = s.atoms.spheres[c.atom_i].radius;
  return is_wall(c) ? radius : std::min(radius, s.atoms.spheres[c.atom_j].radius);
}

// What a solved step would leave of an overlap of the pair if it was a contact, m.
double left_of_contact(const State &s, const Candidate &c)
{
  double kick = s.motion.kicks[s.atoms.owner[c.atom_i]];
  if (!is_wall(c)) kick = std::max(kick, s.motion.kicks[s.atoms.owner[c.atom_j]]);
  return left_of_overlap(s, kick, smaller_radius(s, c));
}

// gap + dt v_n^{k+1}, which a contact keeps from being negative.
double gap_constrained(const State &s, const Watched &near)
{
  const auto [i, j] = near.pair;
  const Body of_i = s.motion.bodies[s.atoms.owner[i]];
  if (is_wall(near.pair)) {
    const int number = wall_of(j);
    const Obstacle &wall = s.obstacles.sought(number);
    const Sphere &grain = s.atoms.spheres[i];
    const Touch touch = touch_of(grain, near.pair, wall);
    const Vec4 &normal = touch.normal;
    Vec4 parting = of_i + drift_of(s, near.pair, normal);
    if (s.obstacles.moves(number))
      parting -= wall.velocity_at(grain.centre - normal * (grain.radius + near.gap), touch);
    return near.gap + dot(normal, course_start(s, s.atoms.owner[i]) + s.in.dt * parting);
  }
  const auto [separation, distance, gap] = apart(s.atoms.spheres[i], s.atoms.spheres[j]);
  const Vec4 parting = of_i - s.motion.bodies[s.atoms.owner[j]] + drift_of(s, near.pair, separation / distance);
  const Vec4 starts = course_start(s, s.atoms.owner[i]) - course_start(s, s.atoms.owner[j]);
  return near.gap + dot(separation, starts + s.in.dt * parting) / distance;
}

NSCD_INLINE void note_overlap(State &s, const Candidate &c, double overlap)
{
  if (overlap <= 0) return;
  Overlap &largest = s.search.watched_overlap;
  largest.length = std::max(largest.length, overlap);
  largest.ratio = std::max(largest.ratio, overlap / smaller_radius(s, c));
}

}    // namespace

void detect(State &state, const PairList &pairs, Sought sought)
{
  filter_pairs(state, pairs);
  if (const auto narrow = sort_pairs(state, pairs)) refuse_narrow_box(state, *narrow);
  take_unlisted(state);
  state.search.unforeseen = 0;
  if (sought == Sought::foreseen) watch_unforeseen(state);
  for (int wall = 0; wall < state.obstacles.count(); ++wall) sort_wall(state, wall);
  place_contacts(state);
}

void watch_farther(State &state, const PairList &pairs)
{
  measure_moves(state);
  const double longest = sum_of_longest_moves(state);
  if (longest <= state.search.watch) return;
  const double watched = state.search.watch;
  state.search.watch = 1.5 * longest;
  watch_pairs_beyond(state, pairs, watched);
  for (int wall = 0; wall < state.obstacles.count(); ++wall) watch_wall_beyond(state, wall, watched);
}

std::size_t promote_near(State &state)
{
  const std::size_t before = state.table.contacts.size();
  state.search.watched_overlap = {};
  std::size_t kept = 0;
  for (const Watched near : state.search.near) {
    if (may_meet(state, near)) {
      const double displaced = gap_at(state, near.pair, at_end);
      if (std::min(displaced, gap_constrained(state, near)) < -left_of_contact(state, near.pair)) {
        const std::size_t last = state.table.size();
        state.table.resize(last + 1);
        if (!place_contact(state, last, near.pair)) refuse_overlap(state, last);
        continue;
      }
      note_overlap(state, near.pair, -gap_at(state, near.pair, in_arrays));
    }
    state.search.near[kept++] = near;
  }
  state.search.near.resize(kept);
  return state.table.contacts.size() - before;
}

void look_at_near(State &state)
{
  state.search.watched_overlap = {};
  for (const Watched &near : state.search.near)
    if (may_meet(state, near)) note_overlap(state, near.pair, -gap_at(state, near.pair, in_arrays));
}

}    // namespace nscd
