// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact_list.hpp"

#include "scene/list/told_list.hpp"

#include <atom.h>
#include <comm.h>
#include <domain.h>
#include <force.h>
#include <neighbor.h>
#include <utils.h>

#include <algorithm>
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

std::vector<double> LAMMPS_NS::list_cutoffs(LAMMPS *lmp)
{
  const std::size_t types = std::size_t(lmp->atom->ntypes) + 1;   // from 1
  std::vector<double> cutoffs(types * types, 0);
  if (!lmp->neighbor->cutneighsq) return cutoffs;   // before the first run
  for (std::size_t a = 1; a < types; ++a)
    for (std::size_t b = 1; b < types; ++b) cutoffs[a * types + b] = std::sqrt(lmp->neighbor->cutneighsq[a][b]);
  return cutoffs;
}

std::vector<double> LAMMPS_NS::told_list(LAMMPS *lmp)
{
  const ContactList found = find_contact_list(lmp);
  const Neighbor *neighbor = lmp->neighbor;
  const auto end = neighbor->lists + neighbor->nlist, place = std::find(neighbor->lists, end, found.list);
  const int number = found.list && place != end ? int(place - neighbor->lists) : -1;
  return nscd::ToldList{number, lmp->atom->ntypes, found.limit, images_of(lmp).distance, list_cutoffs(lmp)}.packed();
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
