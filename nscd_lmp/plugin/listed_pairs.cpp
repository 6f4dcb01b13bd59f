// SPDX-License-Identifier: GPL-2.0-or-later
#include "listed_pairs.hpp"

#include <atom.h>
#include <force.h>
#include <neighbor.h>

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

bool ListedPairs::begin_run()
{
  found_ = find_contact_list(lmp);
  reach_ = 0;
  if (neighbor->ago == 0) cutoffs_.clear();
  return found_.list != nullptr;
}

// Over the type pairs, cutoff + skin less the largest radii of the two types. Two types of obstacles need no cutoff.
void ListedPairs::measure_reach(int group)
{
  const int types = atom->ntypes + 1;   // from 1
  std::vector<double> found(2 * std::size_t(types), 0);
  const auto largest = found.begin(), moves = largest + types;
  for (int i = 0; i < atom->nlocal; ++i) {
    const int type = atom->type[i];
    largest[type] = std::max(largest[type], atom->radius[i]);
    if (atom->mask[i] & group) moves[type] = 1;
  }
  ranks_.max(found);  // the largest of a type may be on another rank
  reach_ = INFINITY;
  cutoffs_ = list_cutoffs(lmp);
  for (int a = 1; a < types; ++a)
    for (int b = 1; b < types; ++b) {
      const double cutoff = cutoffs_[std::size_t(a * types + b)];
      if (largest[a] > 0 && largest[b] > 0 && moves[a] + moves[b] > 0)
        reach_ = std::min(reach_, cutoff - largest[a] - largest[b]);
    }
}

nscd::PairList ListedPairs::pairs(int group)
{
  nscd::PairList p;
  p.count = found_.list->inum;
  p.atom = found_.list->ilist;
  p.neighbors = found_.list->numneigh;
  p.first = found_.list->firstneigh;
  p.cross_pairs_twice = !force->newton_pair;
  p.just_built = neighbor->ago == 0;
  if (p.just_built || cutoffs_.empty()) {
    measure_reach(group);
    images_ = images_of(lmp);
  }
  p.reach = std::min(reach_, found_.limit);
  p.beyond_radii = found_.limit;
  p.types = atom->ntypes + 1;
  p.type = atom->type;
  p.cutoffs = cutoffs_.data();
  p.images = images_;
  return p;
}
