// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/drift/growth.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace nscd {

namespace {

double of_smaller(double a, double b)
{
  if (a * b <= 0) return 0;
  return std::abs(a) < std::abs(b) ? a : b;
}

// Puts what stands beside atoms in their new order; where `from` is -1 it is 0.
void reorder(std::vector<double> &values, const std::vector<int> &from)
{
  if (values.empty()) return;
  std::vector<double> ordered(from.size(), 0.0);
  for (std::size_t k = 0; k < from.size(); ++k)
    if (from[k] >= 0) ordered[k] = values[from[k]];
  values = std::move(ordered);
}

}    // namespace

// With a new list atoms have other places, and some are new here.
void Growth::follow(const Grains &g)
{
  const std::size_t n = std::size_t(g.owned) + g.ghosts;
  if (tags_.size() == n && std::equal(tags_.begin(), tags_.end(), g.tag)) return;
  std::vector<std::pair<std::int32_t, int>> known(tags_.size());
  for (std::size_t k = 0; k < known.size(); ++k) known[k] = {tags_[k], int(k)};
  std::sort(known.begin(), known.end());
  std::vector<int> from(n, -1);
  for (std::size_t k = 0; k < n; ++k) {
    const auto at = std::lower_bound(known.begin(), known.end(), std::pair<std::int32_t, int>{g.tag[k], -1});
    if (at != known.end() && at->first == g.tag[k]) from[k] = at->second;
  }
  for (auto *values : {&radii_, &rates_, &before_, &sudden_}) reorder(*values, from);
  radii_.resize(n);
  for (std::size_t k = 0; k < n; ++k)
    if (from[k] < 0) radii_[k] = g.radius[k];
  tags_.assign(g.tag, g.tag + n);
}

// Changes since the last run are found by `look`.
void Growth::see(const Grains &g)
{
  follow(g);
  rates_.clear();
  before_.clear();
  sudden_.clear();
  for (std::size_t k = 0; k < radii_.size(); ++k) {
    const double grown = g.radius[k] - radii_[k];
    if (grown != 0 && sudden_.empty()) sudden_.assign(radii_.size(), 0.0);
    if (grown != 0) sudden_[k] = grown;
    radii_[k] = g.radius[k];
  }
  before_run_ = run_;
  run_ = 0;
  pace_.begin();
  fresh_ = false;
  first_ = true;
}

bool Growth::look(const Grains &g, bool new_list)
{
  if (fresh_) see(g);
  else if (new_list || tags_.size() != std::size_t(g.owned) + g.ghosts) follow(g);
  return !std::equal(radii_.begin(), radii_.end(), g.radius);
}

void Growth::settle(const Grains &g, bool changed, double dt, double recovery)
{
  grown_ = 0;
  pace_.pass(dt);
  run_ += dt;
  if (!first_) sudden_.clear();
  for (double &jump : sudden_) jump = std::max(jump, 0.0) * give_back_rate(recovery, dt, before_run_);   // from m
  first_ = false;
  if (changed) {
    const std::size_t n = radii_.size();
    const double took = pace_.since(), share = took * give_back_rate(recovery, dt, took);
    rates_.assign(n, 0.0);
    sudden_.resize(n, 0.0);
    before_.resize(n, 0.0);
    for (std::size_t k = 0; k < n; ++k) {
      const double grown = g.radius[k] - radii_[k], now = grown / took;
      rates_[k] = of_smaller(now, before_[k]);
      sudden_[k] += std::max(now - rates_[k], 0.0) * share;
      grown_ = std::max(grown_, grown);
      before_[k] = now;
      radii_[k] = g.radius[k];
    }
    pace_.change();
  } else if (pace_.is_over()) {
    rates_.clear();
    before_.clear();
  }
}

}    // namespace nscd
