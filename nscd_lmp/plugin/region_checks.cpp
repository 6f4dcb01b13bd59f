// SPDX-License-Identifier: GPL-2.0-or-later
#include "region_checks.hpp"

#include "base/error.hpp"

#include <atom.h>
#include <domain.h>

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using nscd::Touch;
using nscd::Vec4;

namespace {

// The k-th of points that fill the unit square or cube evenly (Roberts' sequences R2, R3).
double share2(int k, int axis) { return std::fmod((k + 0.5) * (axis ? 0.5698402910 : 0.7548776662), 1.0); }
double share3(int k, int axis)
{
  constexpr double steps[] = {0.8191725134, 0.6710436067, 0.5497004779};
  return std::fmod((k + 0.5) * steps[axis], 1.0);
}

double nearest(const nscd::Obstacle &wall, const Vec4 &point, double within)
{
  std::vector<Touch> touches;
  wall.touch(point, 0, within, touches);
  double gap = within;
  for (const Touch &touch : touches) gap = std::min(gap, touch.gap);
  return gap;
}

}    // namespace

void RegionChecks::require_inside(int group, int group_of_wall, double time, const char *fix) const
{
  if (tree_.is_open()) return;
  tree_.place(tree_.poses_at(time));
  tagint outside = 0;
  for (int i = 0; i < atom->nlocal && outside == 0; ++i)
    if ((atom->mask[i] & group) && (atom->mask[i] & group_of_wall) && !tree_.has(atom->x[i])) outside = atom->tag[i];
  tagint any = 0;
  MPI_Allreduce(&outside, &any, 1, MPI_LMP_TAGINT, MPI_MAX, world);
  if (any > 0)
    nscd::fail("grain ", any, " is beyond the wall of fix ", fix, ": its centre is not in region ", tree_.id(),
               ", whose surface can hold it from there alone: start it inside, give the region another `side`, or the ",
               "fix a group without it");
}

void RegionChecks::require_true_normals(const nscd::Obstacle &wall) const
{
  constexpr int points = 400;
  std::vector<Touch> touches;
  const double size = std::max({domain->xprd, domain->yprd, domain->zprd}), step = 1e-6 * size;
  for (int k = 0; k < points; ++k) {
    Vec4 at{};
    for (int d = 0; d < 3; ++d) at[d] = domain->boxlo[d] + domain->prd[d] * share3(k, d);
    touches.clear();
    wall.touch(at, 0, size, touches);
    for (const Touch &touch : touches) {
      const double there = wall.at(at + touch.normal * step, 0, touch.feature).gap;
      if (std::isinf(there) || std::abs(there - touch.gap - step) <= 1e-3 * step) continue;
      nscd::fail("LAMMPS gives a surface of region ", tree_.id(), " near (", at[0], ", ", at[1], ", ", at[2], ") a ",
                 "normal that is not perpendicular to it, as it does at the ends of a cone along y: turn the scene, ",
                 "or use a mesh");
    }
  }
}

double RegionChecks::largest_radius() const
{
  double largest = 0;
  for (int i = 0; i < atom->nlocal; ++i) largest = std::max(largest, atom->radius[i]);
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, world);
  return largest;
}

void RegionChecks::require_repeats(const nscd::Obstacle &wall) const
{
  constexpr int points = 256;
  const double radius = largest_radius();
  const Vec4 corner{domain->boxlo[0], domain->boxlo[1], domain->boxlo[2], 0};
  const Vec4 edges[] = {
      {domain->xprd, 0, 0, 0}, {domain->xy, domain->yprd, 0, 0}, {domain->xz, domain->yz, domain->zprd, 0}};
  for (int d = 0; d < domain->dimension; ++d)
    for (int k = 0; domain->periodicity[d] && k < points; ++k) {
      const Vec4 at = corner + edges[(d + 1) % 3] * share2(k, 0) + edges[(d + 2) % 3] * share2(k, 1);
      if (std::abs(nearest(wall, at, radius) - nearest(wall, at + edges[d], radius)) <= 1e-6 * radius) continue;
      nscd::fail("region ", tree_.id(), " lies otherwise on the two sides of the box in ", "xyz"[d], ", in which the ",
                 "box is periodic, and a grain there would miss a part of it: use a boundary that is not periodic, or ",
                 "a region that ends a radius ahead of the box' face or goes on beyond it");
    }
}
