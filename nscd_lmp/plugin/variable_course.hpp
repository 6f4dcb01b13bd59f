// SPDX-License-Identifier: GPL-2.0-or-later
// The motion of a wall by variables of LAMMPS, `move v_x v_y v_z` and `rotate v_theta x y z ax ay az`, as regions have
// them.
#pragma once

#include "obstacle/course.hpp"

#include <lammps.h>

#include <string>
#include <vector>

namespace LAMMPS_NS {

// Even within a step. Time counts from the fix's definition, as for its other motions.
class VariableCourse final : public nscd::Course {
 public:
  // `name`: what messages call the wall.
  VariableCourse(LAMMPS *lmp, std::string name) : lmp_(lmp), name_(std::move(name)) {}

  // Takes such motions out of the words; raises nscd::Error for bad ones.
  void read(std::vector<std::string> &words);
  bool is_given() const { return moves_ || rotates; }

  // Starts from where variables say that the wall is now; `time` (s) is that of the start.
  void begin_run(double time);
  // Of length dt from that time on, s.
  void begin_step(double time, double dt);
  nscd::Place at(double time) const override;
  bool shifts_along_z() const override { return !along_[2].empty(); }

 private:
  nscd::Place ask() const;
  double ask(const std::string &variable) const;
  void take_move(std::vector<std::string> &words, std::size_t first);
  void take_rotation(std::vector<std::string> &words, std::size_t first);

  LAMMPS *lmp_;
  std::string name_;
  bool moves_ = false;
  std::string along_[3], angle_;   // names of variables; empty: none
  nscd::Place start_, end_;
  double time_ = 0, dt_ = 1;       // s, of the start of the step, and its length
};

}    // namespace LAMMPS_NS
