// SPDX-License-Identifier: GPL-2.0-or-later
// LAMMPS' arrays, box and list as the core takes them.
#include "external_fix.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

BoxEdges ExternalFix::box() const
{
  const double *low = library_.global<double>("boxlo"), *high = library_.global<double>("boxhi");
  const int *periodic = library_.global<int>("periodicity");
  BoxEdges box{{{high[0] - low[0], 0, 0}, {0, high[1] - low[1], 0}, {0, 0, high[2] - low[2]}},
               {periodic[0] != 0, periodic[1] != 0, periodic[2] && setting("dimension") == 3},
               {low[0], low[1], low[2]}};
  const int *triclinic = library_.global<int>("triclinic");
  if (!triclinic || !*triclinic) return box;
  box.edge[1][0] = *library_.global<double>("xy");
  box.edge[2][0] = *library_.global<double>("xz");
  box.edge[2][1] = *library_.global<double>("yz");
  return box;
}

// Its rate is not told.
void ExternalFix::look_at_box()
{
  double high[3], xy = 0, yz = 0, xz = 0;
  int periodic[3] = {}, changes = 0;
  library_.extract_box(library_.handle, box_.low, high, &xy, &yz, &xz, periodic, &changes);
  const double edges[6] = {high[0] - box_.low[0], high[1] - box_.low[1], high[2] - box_.low[2], yz, xz, xy};
  std::copy_n(edges, 6, box_.edges);
  std::copy_n(periodic, 3, box_.periodic);
}

// As LAMMPS has them.
Grains ExternalFix::arrays()
{
  Grains g;
  g.owned = setting("nlocal");
  g.ghosts = setting("nghost");
  g.x = *library_.per_atom<double *>("x");
  g.v = *library_.per_atom<double *>("v");
  g.f = *library_.per_atom<double *>("f");
  if (step_.settings().frictional()) {
    g.omega = *library_.per_atom<double *>("omega");
    if (double **torque = library_.per_atom<double *>("torque")) g.torque = *torque;
  } else if (double **torque = library_.per_atom<double *>("torque")) {
    g.unread_torque = *torque;
  }
  g.radius = library_.per_atom<double>("radius");
  g.tag = library_.per_atom<std::int32_t>("id");
  g.mask = library_.per_atom<int>("mask");
  g.type = library_.per_atom<int>("type");
  g.mass = library_.per_atom<double>("rmass");
  if (!g.mass) {
    const double *by_type = library_.per_atom<double>("mass");
    const int *type = library_.per_atom<int>("type");
    masses_.resize(g.owned);
    for (int i = 0; i < g.owned; ++i) masses_[i] = by_type[type[i]];
    g.mass = masses_.data();
  }
  g.group = group_bit_;
  g.held = held_;
  g.watched = !movers_;
  g.force_to_acceleration = *library_.global<double>("ftm2v");
  g.square_to_energy = *library_.global<double>("mvv2e");
  look_at_box();
  g.box = &box_;
  return g;
}

PairList ExternalFix::pairs(const Grains &g)
{
  const int count = library_.neighlist_num_elements(library_.handle, list_);
  atoms_.resize(count);
  counts_.resize(count);
  first_.resize(count);
  for (int k = 0; k < count; ++k)
    library_.neighlist_element_neighbors(library_.handle, list_, k, &atoms_[k], &counts_[k], &first_[k]);
  PairList p;
  p.count = count;
  p.atom = atoms_.data();
  p.neighbors = counts_.data();
  p.first = first_.data();
  p.cross_pairs_twice = setting("newton_pair") == 0;
  // Builds before 2023 do not tell the list's age (-1): every list is taken as new, which weakens the check on it.
  p.just_built = setting("neigh_ago") <= 0;
  const bool at_its_places = p.just_built || new_list_;
  if (at_its_places || list_reach_ == 0)
    list_reach_ = reach_.measure(g, library_.per_atom<int>("type"), setting("ntypes"), ranks_.get());
  if (at_its_places) images_ = find_images();
  p.reach = list_reach_;
  reach_.tell_cutoffs(p, library_.per_atom<int>("type"), setting("ntypes"));
  p.images = images_;
  if (at_its_places)
    leaves_out_pairs_ = reach_.leaves_out_pairs(g, p, timestep(), library_.get_natoms(library_.handle), ranks_.get());
  p.excludes = leaves_out_pairs_;
  new_list_ = false;
  return p;
}

// Which atoms had images on this rank when the list was built: all within the communication cutoff of its part of the
// box. Along an axis that is not periodic there is nothing beyond the outermost parts.
Images ExternalFix::find_images() const
{
  Images images;
  const int *periodic = library_.global<int>("periodicity");
  const double *box[] = {library_.global<double>("boxlo"), library_.global<double>("boxhi")};
  const double *part[] = {library_.global<double>("sublo"), library_.global<double>("subhi")};
  images.distance = std::max(reach_.cutoff(), image_cutoff_);
  if (!ranks_ && periodic && !periodic[0] && !periodic[1] && !periodic[2]) images.distance = INFINITY;
  const bool known = periodic && box[0] && box[1] && part[0] && part[1] && setting("triclinic") == 0;
  if (!known) return images;
  images.boxed = true;
  for (int d = 0; d < 3; ++d) {
    images.periodic[d] = periodic[d] && d < setting("dimension");
    const bool lowest = part[0][d] <= box[0][d], highest = part[1][d] >= box[1][d];
    images.lo[d] = lowest && !images.periodic[d] ? -INFINITY : part[0][d] - images.distance;
    images.hi[d] = highest && !images.periodic[d] ? INFINITY : part[1][d] + images.distance;
  }
  return images;
}

}    // namespace nscd
