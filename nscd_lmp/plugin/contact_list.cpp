// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact_list.hpp"

#include <force.h>
#include <neighbor.h>
#include <utils.h>

#include <cmath>

using namespace LAMMPS_NS;

namespace {

// Granular styles and pair nscd list pairs by the grains' own radii, not by the types' cutoffs.
double limit_of(const char *style, double skin)
{
  return style && (utils::strmatch(style, "^gran") || utils::strmatch(style, "^nscd$")) ? skin : INFINITY;
}

// A list of some types' pairs is made of one that has all.
NeighList *complete(NeighList *list)
{
  while (list->listskip) list = list->listskip;
  return list;
}

bool is_kept_up(const NeighList *list)
{
  return list->requestor_type == NeighList::PAIR && !list->occasional && !list->trim;
}

}    // namespace

ContactList LAMMPS_NS::find_contact_list(LAMMPS *lmp)
{
  const Neighbor *neighbor = lmp->neighbor;
  Force *force = lmp->force;
  if (!force->pair) return {};
  if (NeighList *own = neighbor->find_list(force->pair)) return {own, limit_of(force->pair_style, neighbor->skin)};
  ContactList best;
  for (int k = 0; k < neighbor->nlist; ++k) {
    NeighList *list = neighbor->lists[k];
    if (!is_kept_up(list)) continue;
    const double limit = limit_of(force->pair_match_ptr(static_cast<Pair *>(list->requestor)), neighbor->skin);
    if (limit > best.limit) best = {complete(list), limit};
  }
  return best;
}
