// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/drift/box_motion.hpp"

#include "base/error.hpp"
#include "scene/state.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

enum Edge { xx, yy, zz, yz, xz, xy };

// So many grains of a rank tell whether grains are moved with the box.
constexpr int samples = 64;

bool has_changed(const BoxChange &c)
{
  const auto moved = [](double change) { return change != 0; };
  return std::any_of(c.edges, c.edges + 6, moved) || std::any_of(c.low, c.low + 3, moved);
}

// The vector without whole edges of the box: what a grain has moved that has been put back into the box.
Vec4 without_edges(Vec4 d, const Box &box)
{
  const double *e = box.edges;
  const Vec4 edge[3] = {{e[xx], 0, 0, 0}, {e[xy], e[yy], 0, 0}, {e[xz], e[yz], e[zz], 0}};
  for (int k = 2; k >= 0; --k)
    if (box.periodic[k]) d -= edge[k] * std::round(d[k] / edge[k][k]);
  return d;
}

// The grain's index now; -1 if it is not here.
int find_owned(const State &s, std::int32_t tag, int index)
{
  if (index < s.in.grains.owned && s.in.grains.tag[index] == tag) return index;
  const auto &tags = s.atoms.own_tags;
  const auto at = std::lower_bound(tags.begin(), tags.end(), std::pair<std::int32_t, int>{tag, -1});
  return at != s.atoms.own_tags.end() && at->first == tag ? at->second : -1;
}

Vec4 place(const Grains &g, int i)
{
  const double *x = g.x + 3 * std::size_t(i);
  return Vec4{x[0], x[1], x[2], 0};
}

}    // namespace

double Gradient::norm() const
{
  return std::sqrt(xx * xx + yy * yy + zz * zz + yz * yz + xz * xz + xy * xy);
}

// Of change = gradient edges, both upper triangular.
Gradient BoxChange::gradient(const Box &box, bool images_only) const
{
  const double *e = box.edges;
  const auto seen = [&](int edge, int direction) {
    return images_only && !box.periodic[direction] ? 0.0 : edges[edge];
  };
  Gradient g;
  g.xx = seen(xx, 0) / e[xx];
  g.yy = seen(yy, 1) / e[yy];
  g.zz = seen(zz, 2) / e[zz];
  g.xy = (seen(xy, 1) - g.xx * e[xy]) / e[yy];
  g.yz = (seen(yz, 2) - g.yy * e[yz]) / e[zz];
  g.xz = (seen(xz, 2) - g.xx * e[xz] - g.xy * e[yz]) / e[zz];
  return g;
}

BoxChange change_between(const Box &from, const Box &to)
{
  BoxChange c;
  for (int k = 0; k < 6; ++k) c.edges[k] = to.edges[k] - from.edges[k];
  for (int d = 0; d < 3; ++d) c.low[d] = to.low[d] - from.low[d];
  const double flips = std::round(c.edges[yz] / to.edges[yy]);
  c.edges[yz] -= flips * to.edges[yy];
  c.edges[xz] -= flips * to.edges[xy];
  c.edges[xz] -= std::round(c.edges[xz] / to.edges[xx]) * to.edges[xx];
  c.edges[xy] -= std::round(c.edges[xy] / to.edges[xx]) * to.edges[xx];
  return c;
}

Vec4 BoxMotion::at(const Vec4 &x) const
{
  const Vec4 low{last_.low[0], last_.low[1], last_.low[2], 0};
  return gradient().at(x - low) + Vec4{low_rate_[0], low_rate_[1], low_rate_[2], 0};
}

void BoxMotion::take(const BoxChange &change, double time)
{
  all_ = change.gradient(last_, false) * (1 / time);
  images_ = change.gradient(last_, true) * (1 / time);
  for (int d = 0; d < 3; ++d) low_rate_[d] = change.low[d] / time;
}

void BoxMotion::see(const Box &box)
{
  jumped_ = seen_ ? change_between(last_, box) : BoxChange{};
  before_run_ = run_;
  run_ = 0;
  last_ = box;
  seen_ = first_ = true;
  fresh_ = false;
  pace_.begin();
  rides_ = false;
  take({}, 1);
  known_ = box.rate_known;
  if (!known_) return;
  BoxChange in_a_second;
  std::copy_n(box.rate, 6, in_a_second.edges);
  take(in_a_second, 1);
  pace_.last_forever();
}

// Whether grains have been moved as the box was. Those near its corner have not moved enough to tell.
bool BoxMotion::carries(const State &s, const BoxChange &change) const
{
  const Gradient gradient = change.gradient(last_, false);
  const Vec4 low{last_.low[0], last_.low[1], last_.low[2], 0}, shift{change.low[0], change.low[1], change.low[2], 0};
  double farthest = 0;
  for (const Sample &sample : samples_) farthest = std::max(farthest, length(gradient.at(sample.x - low) + shift));
  if (s.exec.halo) farthest = s.exec.halo->max(farthest);
  double counts[2] = {};   // that have stayed, that have been carried
  for (const Sample &sample : samples_) {
    const int i = find_owned(s, sample.tag, sample.index);
    const Vec4 carried = gradient.at(sample.x - low) + shift;
    const double enough = std::max(0.1 * farthest, 1e-12 * length(sample.x));
    if (i < 0 || length(carried) < enough) continue;
    const Vec4 moved = without_edges(place(s.in.grains, i) - sample.x, last_);
    ++counts[dot(carried, moved) > 0.5 * dot(carried, carried)];
  }
  if (s.exec.halo) s.exec.halo->sum(counts);
  if (counts[0] > 0 && counts[1] > 0)
    fail("the box carries some grains with it and leaves others where they are: give fix deform (or what else moves ",
         "the box and remaps positions) the group of all atoms, or take remap v or none");
  return counts[0] + counts[1] > 0 ? counts[1] > 0 : rides_;
}

void BoxMotion::look(const State &s)
{
  const Box &box = *s.in.grains.box;
  if (fresh_) see(box);
  jump_ = {};
  if (first_ && has_changed(jumped_)) {
    jump_rides_ = carries(s, jumped_);
    jump_ = jumped_.gradient(last_, !jump_rides_);
  }
  run_ += s.in.dt;
  changes_now_ = box.changes_now;
  pace_.pass(first_ ? 0 : dt_);
  const BoxChange change = change_between(last_, box);
  last_ = box;
  if (has_changed(change)) {
    if (pace_.since() == 0) pace_.pass(s.in.dt);   // ahead of the first step
    rides_ = carries(s, change);
    take(change, pace_.since());
    pace_.change();
    known_ = false;
  } else if (!known_ && pace_.is_over()) {
    take({}, 1);
  }
  first_ = false;
  dt_ = s.in.dt;
}

void BoxMotion::leave(const State &s)
{
  samples_.clear();
  const int every = 1 + s.in.grains.owned / samples;
  for (int i = 0; i < s.in.grains.owned; i += every) {
    const Vec4 v = start_velocity(s, i);
    const bool moved_by_others = s.motion.bodies[i][3] == 0 && dot(v, v) > 0;
    if (!moved_by_others) samples_.push_back({s.in.grains.tag[i], i, place(s.in.grains, i)});
  }
}

}    // namespace nscd
