// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact_list.hpp"

#include <comm.h>
#include <domain.h>
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

nscd::Images LAMMPS_NS::images_of(LAMMPS *lmp)
{
  Comm *comm = lmp->comm;
  const Domain *domain = lmp->domain;
  nscd::Images images;
  const bool by_type = comm->mode != Comm::SINGLE;   // images of some types reach less far
  if (!by_type) images.distance = comm->get_comm_cutoff();
  if (comm->nprocs == 1 && !domain->xperiodic && !domain->yperiodic && !domain->zperiodic)
    images.distance = INFINITY;
  if (domain->triclinic || by_type) return images;
  images.boxed = true;
  for (int d = 0; d < 3; ++d) {
    images.periodic[d] = domain->periodicity[d] && d < domain->dimension;
    const bool lowest = domain->sublo[d] <= domain->boxlo[d], highest = domain->subhi[d] >= domain->boxhi[d];
    images.lo[d] = lowest && !images.periodic[d] ? -INFINITY : domain->sublo[d] - images.distance;
    images.hi[d] = highest && !images.periodic[d] ? INFINITY : domain->subhi[d] + images.distance;
  }
  return images;
}
