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

// The k-th of points that fill the unit cube evenly (Roberts' sequence R3).
double share(int k, int axis)
{
  constexpr double steps[] = {0.8191725134, 0.6710436067, 0.5497004779};
  return std::fmod((k + 0.5) * steps[axis], 1.0);
}

}    // namespace

void RegionChecks::require_inside(int group, int group_of_wall, double time, const char *fix,
                                  const nscd::Moved *moved) const
{
  if (tree_.is_open()) return;
  tree_.place(tree_.poses_at(time));
  tagint outside = 0;
  const auto is_inside = [&](const double *x) {
    if (!moved) return tree_.has(x);
    const Vec4 own = moved->in_own_frame(Vec4{x[0], x[1], x[2], 0});
    const double point[] = {own[0], own[1], own[2]};
    return tree_.has(point);
  };
  for (int i = 0; i < atom->nlocal && outside == 0; ++i)
    if ((atom->mask[i] & group) && (atom->mask[i] & group_of_wall) && !is_inside(atom->x[i])) outside = atom->tag[i];
  tagint any = 0;
  MPI_Allreduce(&outside, &any, 1, MPI_LMP_TAGINT, MPI_MAX, world);
  if (any > 0)
    nscd::fail("grain ", any, " is beyond the wall of fix ", fix, ": its centre is not in region ", tree_.id(),
               ", whose surface can hold it from there alone: start it inside, give the region another `side`, or the ",
               "fix a group without it; take a smaller timestep if it was inside before");
}

void RegionChecks::require_true_normals(const nscd::Obstacle &wall) const
{
  constexpr int points = 400;
  std::vector<Touch> touches;
  const double size = std::max({domain->xprd, domain->yprd, domain->zprd}), step = 1e-6 * size;
  for (int k = 0; k < points; ++k) {
    Vec4 at{};
    for (int d = 0; d < 3; ++d) at[d] = domain->boxlo[d] + domain->prd[d] * share(k, d);
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
