// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/list/missed_pairs.hpp"

#include "base/error.hpp"
#include "base/hot.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

// Ranks may differ by round-off in which of two grains is faster.
constexpr double same_pace = 1e-9;

void MissedPairs::begin(const PairList &pairs, double listed)
{
  range_ = pairs;
  listed_ = listed;
  missed_.clear();
  beyond_.reset();
}

double MissedPairs::cutoff(const State &s, int a, int b) const
{
  const double by_radii = s.atoms.spheres[a].radius + s.atoms.spheres[b].radius + range_.beyond_radii;
  if (range_.types > 0) return std::min(by_radii, range_.cutoffs[range_.type[a] * range_.types + range_.type[b]]);
  return range_.cutoff > 0 ? std::min(by_radii, range_.cutoff) : listed_ + 2 * largest_radius_;
}

double MissedPairs::images() const
{
  return range_.images.distance > 0 ? range_.images.distance : listed_ + 2 * largest_radius_;
}

Bounds MissedPairs::since_listed(int atom) const
{
  const Vec4 since = motion_.from[atom] - list_.listed_at(atom);
  return {since, since};
}

// Since the list was built, on the way that the motion takes from there.
Bounds MissedPairs::displacements(const State &s, int atom) const
{
  Bounds box = since_listed(atom);
  const Vec4 since = box.lo;
  box.include(since + motion_.one[s.atoms.owner[atom]]);
  box.include(since + motion_.other[s.atoms.owner[atom]]);
  return box;
}

// How much displacements of a moving grain and any other differ at most.
double MissedPairs::spread(const State &s)
{
  since_ = moving_ = all_ = {};
  double largest = 0;
  for (int a = 0; a < int(s.atoms.spheres.size()); ++a) {
    const Bounds box = displacements(s, a);
    since_.include(since_listed(a));
    all_.include(box);
    largest = std::max(largest, s.atoms.spheres[a].radius);
    if (s.motion.bodies[s.atoms.owner[a]][3] > 0) moving_.include(box);
  }
  Bounds boxes[] = {since_, moving_, all_};
  unite(s.exec.halo, boxes);
  since_ = boxes[0], moving_ = boxes[1], all_ = boxes[2];
  largest_radius_ = s.exec.halo ? s.exec.halo->max(largest) : largest;
  return moving_.farthest(all_);
}

// The same of two that can meet, in scenes that flow in layers across an axis.
double MissedPairs::spread_by_layers(const State &s, double spread)
{
  if (!has_profile()) return spread;
  profile_.gather(s.exec.halo, s.in.grains.owned, range_.images.periodic, [this](int i) { return list_.listed_at(i); },
                  [this, &s](int i) { return displacements(s, i); });
  return profile_.farthest(2 * largest_radius_ + spread);
}

// As the mean grain sees it, of all ranks.
void MissedPairs::measure_paces(const State &s)
{
  double sums[4] = {0, 0, 0, double(s.in.grains.owned)};
  for (int b = 0; b < s.in.grains.owned; ++b)
    for (int d = 0; d < 3; ++d) sums[d] += motion_.one[b][d];
  if (s.exec.halo) s.exec.halo->sum(sums);
  frame_ = Vec4{sums[0], sums[1], sums[2], 0} * (1 / sums[3]);
  pace_.resize(s.moving());
  for (int b = 0; b < s.moving(); ++b) {
    const Vec4 one = motion_.one[b] - frame_, other = motion_.other[b] - frame_;
    pace_[b] = std::sqrt(std::max(dot(one, one), dot(other, other)));
  }
}

// Each pair is one rank's, once: two owned grains, or one and the image of a slower one.
bool MissedPairs::is_ours(const State &s, int i, int j) const
{
  if (i >= s.in.grains.owned) return false;
  if (j < s.in.grains.owned) return true;
  const double mine = pace_[s.atoms.owner[i]], its = pace_[s.atoms.owner[j]];
  return std::abs(mine - its) > same_pace * (mine + its) ? mine > its : s.in.grains.tag[i] < s.in.grains.tag[j];
}

void MissedPairs::examine(const State &s, int a, int b, double margin)
{
  const int i = std::min(a, b), j = std::max(a, b), of_i = s.atoms.owner[i], of_j = s.atoms.owner[j];
  if (!is_ours(s, i, j) || of_i == of_j || s.motion.bodies[of_i][3] + s.motion.bodies[of_j][3] == 0) return;
  const Vec4 separation = motion_.from[i] - motion_.from[j], was = list_.listed_at(i) - list_.listed_at(j);
  const double distance = std::sqrt(dot(separation, separation)), listed = std::sqrt(dot(was, was));
  if (listed <= cutoff(s, i, j) * (1 - 1e-12)) return;
  const double gap = distance - s.atoms.spheres[i].radius - s.atoms.spheres[j].radius;
  const Vec4 one = motion_.one[of_i] - motion_.one[of_j], other = motion_.other[of_i] - motion_.other[of_j];
  const double approach = -std::min(dot(separation, one), dot(separation, other)) / distance;
  if (gap - approach > margin) return;   // grains in the same place meet
  missed_.push_back({{i, j}, gap, distance > 0 ? approach : 0, listed});
}

// Each pair is looked at from the larger one, so that a few large or fast grains do not make all others look far.
// Returns the atom at which that became too much, or -1.
NSCD_HOT int MissedPairs::look_at_pairs(const State &s, double margin)
{
  constexpr double cell_sizes = 4, most_for_each = 5000, most_at_least = 1e7;
  const std::size_t n = s.atoms.spheres.size();
  sized_.resize(n);
  double sum = 0;
  for (std::size_t a = 0; a < n; ++a) {
    const double size = s.atoms.spheres[a].radius + 0.5 * margin + pace_[s.atoms.owner[a]];
    sized_[a] = motion_.from[a] + Vec4{0, 0, 0, size};
    sum += size;
  }
  missed_.clear();
  if (n == 0) return -1;
  grid_.fill(sized_, cell_sizes * sum / double(n));
  std::size_t looked_at = 0;
  for (int a = 0; a < int(n); ++a) {
    const Vec4 here = sized_[a];
    grid_.near(here, 2 * here[3], [&](int b, const Vec4 &there) {
      ++looked_at;
      if (there[3] > here[3] || (there[3] == here[3] && b >= a)) return;
      const Vec4 apart = here - there, reach = here + there;
      const double distance2 = apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2];
      if (distance2 <= reach[3] * reach[3]) examine(s, a, b, margin);
    });
    if (double(looked_at) > most_at_least + most_for_each * double(n)) return a;
  }
  return -1;
}

void MissedPairs::search(const State &s, double margin)
{
  const int a = look_at_pairs(s, margin);
  if (a >= 0)
    fail("grain ", s.in.grains.tag[a], " moves by ", sized_[a][3] - s.atoms.spheres[a].radius,
         " in the step, many times the ",
         "distance of its neighbors, and so do others: take a smaller timestep");
}

// Where slower grains were that the atom can meet, from where it was when the list was built.
Bounds MissedPairs::partners(const State &s, int atom, double margin) const
{
  const double touch = s.atoms.spheres[atom].radius + largest_radius_ + margin;
  const Bounds since = since_listed(atom);
  const auto against = [&](const Bounds &others) { return displacements(s, atom).less(others).wider(touch); };
  const int body = s.atoms.owner[atom];
  Bounds seen;   // in the frame, in which the others are within the pace
  for (const Vec4 &d : {Vec4{}, motion_.one[body] - frame_, motion_.other[body] - frame_}) seen.include(d);
  const Bounds earlier = since.less(since_);
  const double wider = touch + (1 + 4 * same_pace) * pace_[body];
  const Bounds by_pace = Bounds{seen.lo + earlier.lo, seen.hi + earlier.hi}.wider(wider);
  const Bounds near = against(s.motion.bodies[body][3] > 0 ? all_ : moving_).common(by_pace);
  if (all_known(atom, near) || !has_profile()) return near;
  return near.common(against(profile_.around(list_.listed_at(atom), near.farthest(Bounds{{}, {}}))));
}

// Whether all atoms from there are here.
bool MissedPairs::all_known(int atom, const Bounds &partners) const
{
  const Images &known = range_.images;
  if (partners.farthest(Bounds{{}, {}}) <= images() * (1 + 1e-12)) return true;
  if (!known.boxed) return false;
  const Vec4 at = list_.listed_at(atom);
  for (int d = 0; d < 3; ++d)
    if (at[d] + partners.lo[d] < known.lo[d] || at[d] + partners.hi[d] > known.hi[d]) return false;
  return true;
}

// Of several the one that gets farthest.
std::optional<Beyond> MissedPairs::farthest_beyond(const State &s, double margin) const
{
  std::optional<Beyond> found;
  for (int i = 0; i < s.in.grains.owned; ++i) {
    const Bounds around = partners(s, i, margin);
    if (all_known(i, around)) continue;
    double distance = range_.images.boxed ? 0 : around.farthest(Bounds{{}, {}});
    for (int d = 0; d < 3; ++d) distance = std::max({distance, -around.lo[d], around.hi[d]});
    if (!found || distance > found->distance) found = Beyond{i, distance};
  }
  return found;
}

bool MissedPairs::may_find(const State &s, double margin)
{
  const double spread = this->spread(s);
  return !(spread + margin <= listed_ || spread_by_layers(s, spread) + margin <= listed_);
}

// From the cheapest judgement to the closest.
bool MissedPairs::find(const State &s, double margin)
{
  missed_.clear();
  beyond_.reset();
  if (!may_find(s, margin)) return false;
  measure_paces(s);
  if (s.exec.halo) s.exec.halo->together([&] { search(s, margin); });
  else search(s, margin);
  beyond_ = farthest_beyond(s, margin);
  const double any = !missed_.empty() || beyond_;
  return s.exec.halo ? s.exec.halo->max(any) > 0 : any > 0;
}

}    // namespace nscd
