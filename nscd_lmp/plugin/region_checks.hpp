// SPDX-License-Identifier: GPL-2.0-or-later
// What fix wall/nscd asks of a region and of the grains beside it. Functions raise nscd::Error, on all ranks.
#pragma once

#include "obstacle/moved.hpp"
#include "region_tree.hpp"

namespace LAMMPS_NS {

class RegionChecks : protected Pointers {
 public:
  RegionChecks(LAMMPS *lmp, const RegionTree &tree) : Pointers(lmp), tree_(tree) {}

  // Grains of both groups, with parts placed where they are `time` (s) after the start of the last step: their centres
  // are where the region's surface can hold them. `fix`: the wall's ID; `moved`: where its own motion has taken the
  // region, or null.
  void require_inside(int group, int group_of_wall, double time, const char *fix, const nscd::Moved *moved) const;
  // LAMMPS has a shape whose normals are not those of its surface (the ends of a cone along y).
  void require_true_normals(const nscd::Obstacle &wall) const;

 private:
  const RegionTree &tree_;
};

}    // namespace LAMMPS_NS
