// SPDX-License-Identifier: GPL-2.0-or-later
// fix wall/nscd: one wall, with its material, its motion, its group and what it carries. Fix nscd solves its contacts.
#pragma once

#include "region_tree.hpp"
#include "scene/wall_touches.hpp"
#include "settings/wall_options.hpp"
#include "variable_course.hpp"

#include <fix.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {

class FixWallNscd : public Fix {
 public:
  FixWallNscd(LAMMPS *lmp, int narg, char **arg);
  ~FixWallNscd() override;
  int setmask() override { return 0; }
  void init() override;
  double compute_vector(int n) override;
  void write_restart(FILE *file) override;
  void restart(char *buffer) override;
  double memory_usage() override;

  // For fix nscd. Functions raise nscd::Error. Where it is as a run begins, with regions and variables as they are now.
  nscd::Wall begin_run();
  // Takes it on to the end of the present step, once for all fixes nscd; and what its contacts have given then.
  void begin_step();
  void add(const nscd::WallTouch &touch);
  // Of the moving grains of a group: those that are on the side of the region where none can be.
  void require_inside(int group) const;

 private:
  void read(std::vector<std::string> words);
  std::shared_ptr<const nscd::Obstacle> shape_in_run();
  void tell_fixes_nscd() const;
  void clear();
  void clear_rows();

  std::string place_, region_id_;                 // words of where it is and moves; of a region its ID, else empty
  std::shared_ptr<const nscd::Obstacle> shape_;   // of our own kinds
  nscd::WallOptions options_;
  std::shared_ptr<VariableCourse> variables_;
  std::shared_ptr<RegionTree> tree_;              // of a region, as it was handed out last
  std::vector<std::weak_ptr<RegionTree>> trees_;  // and to each fix nscd
  std::array<double, 3> about_{};                 // of torques: the point of the rotation, or the origin, m
  bool wants_rows_ = false;                       // keyword contacts
  double time_ = 0, dt_ = 0;                      // s, at the end of the present step since the fix was defined; step
  bigint step_ = -1;                              // that it has been taken to
  // Of this rank, and then of all:
  static constexpr int shift = 7, velocity = 10, angle = 13, columns = 15;   // behind those of WallLoad
  nscd::WallLoad sums_{}, all_{};
  bigint summed_ = -1;                            // step
  int rows_ = 0;                                  // of array_atom
  std::vector<double> strongest_;                 // (rows_) force of the contact whose place is told
};

// Those of the scene, in the order of their definition.
std::vector<FixWallNscd *> walls_of(LAMMPS *lmp);

}    // namespace LAMMPS_NS
