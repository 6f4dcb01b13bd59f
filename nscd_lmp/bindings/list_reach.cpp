// SPDX-License-Identifier: GPL-2.0-or-later
#include "list_reach.hpp"

#include "base/error.hpp"
#include "scene/list/list_audit.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

int ListReach::take(ToldList told)
{
  told_ = std::move(told);
  return told_.number;
}

// Of two types, from 0.
double ListReach::cutoff_of(int a, int b, int types) const
{
  if (!told_.cutoffs.empty()) return told_.cutoffs[std::size_t(a + 1) * (types + 1) + b + 1];
  return listed_.cutoff - (listed_.shorter.empty() ? 0 : listed_.shorter[std::size_t(a) * types + b]);
}

double ListReach::measure(const Grains &g, const int *type, int types, Ranks *ranks) const
{
  std::vector<double> of_type(2 * types, 0.0);   // largest radius, and whether one moves
  for (int i = 0; i < g.owned; ++i) {
    double &largest = of_type[type[i] - 1], &moves = of_type[types + type[i] - 1];
    largest = std::max(largest, g.radius[i]);
    if (g.moves(i)) moves = 1;
  }
  if (ranks) ranks->max(of_type);
  double reach = INFINITY;
  for (int a = 0; a < types; ++a)
    for (int b = a; b < types; ++b) {
      const bool can_meet = of_type[a] > 0 && of_type[b] > 0 && of_type[types + a] + of_type[types + b] > 0;
      if (can_meet) reach = std::min(reach, cutoff_of(a, b, types) - of_type[a] - of_type[b]);
    }
  return told_.cutoffs.empty() ? reach : std::min(reach, told_.beyond_radii);
}

void ListReach::tell_cutoffs(PairList &pairs, const int *type, int types)
{
  const bool told = !told_.cutoffs.empty();
  if (told) pairs.beyond_radii = told_.beyond_radii;
  else pairs.cutoff = listed_.cutoff;
  if (!told && listed_.shorter.empty()) return;
  const std::size_t width = types + 1;
  cutoffs_.assign(width * width, 0);
  for (int a = 0; a < types; ++a)
    for (int b = 0; b < types; ++b)
      cutoffs_[(a + 1) * width + b + 1] = cutoff_of(a, b, types);
  pairs.types = types + 1;
  pairs.type = type;
  pairs.cutoffs = cutoffs_.data();
}

bool ListReach::leaves_out_pairs(const Grains &grains, const PairList &pairs, std::int64_t timestep, double atoms,
                                 Ranks *ranks)
{
  if (next_audit_ == 0) leaves_out_ = false;
  if (timestep < next_audit_ && listed_.cutoffs_known) return leaves_out_;
  // An audit costs what a few steps of a cloud that falls cost: few grains are looked at with every list.
  constexpr double longest_pause = 50, atoms_a_step = 10;
  next_audit_ = timestep + std::int64_t(std::min(longest_pause, atoms / atoms_a_step));
  double unlisted = count_unlisted(grains, pairs, pairs.reach);
  if (ranks) ranks->sum({&unlisted, 1});
  if (unlisted > 0 && !listed_.cutoffs_known)
    fail("grains are less than ", pairs.reach, " apart, and the neighbor list of pair_style ", listed_.pair_style,
         " does not have them, though its largest cutoff and the skin are ", listed_.cutoff, ": give all pairs of ",
         "types this cutoff, by pair_style zero, or beside other styles by `pair_style hybrid/overlay zero CUTOFF ",
         "...` with `pair_coeff * * zero`, and exclude none by neigh_modify; fix nscd can do without");
  leaves_out_ = leaves_out_ || unlisted > 0;
  return leaves_out_;
}

}    // namespace nscd
