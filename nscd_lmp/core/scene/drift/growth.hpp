// SPDX-License-Identifier: GPL-2.0-or-later
// How fast radii grow, from what they were in the steps before.
#pragma once

#include "scene/drift/box_motion.hpp"
#include "scene/views.hpp"

#include <cstdint>
#include <vector>

namespace nscd {

// A radius grows at a rate once two changes in a run agree on it: at the smaller of the two, 0 if they differ in sign.
// What is not covered by that is sudden, as all changes between runs are: a contact has nothing but an overlap of it,
// which it may give back over the time that has passed since the change before.
class Growth {
 public:
  void begin_run() { fresh_ = true; }
  // As the run starts, before the first step.
  void see(const Grains &grains);
  // At the start of a step: local. Returns whether a radius has changed.
  bool look(const Grains &grains, bool new_list);
  // With that of all ranks.
  void settle(const Grains &grains, bool changed, double dt, double recovery);

  // (atoms) m/s; empty where none grows.
  const std::vector<double> &rates() const { return rates_; }
  // (atoms) at which what a radius has grown suddenly may be given back, m/s; empty where there is none.
  const std::vector<double> &sudden() const { return sudden_; }
  // How long ago radii were what they are in the arrays.
  double lag() const { return pace_.since(); }
  // At most, of one radius, in the last step, m.
  double grown() const { return grown_; }

 private:
  void follow(const Grains &grains);

  std::vector<std::int32_t> tags_;    // (atoms) of the last step
  std::vector<double> radii_, rates_, before_, sudden_;   // (atoms) m; m/s, `before_` of the last change
  bool fresh_ = true, first_ = true;   // not seen in this run; before its first step
  double grown_ = 0;                  // m
  double run_ = 0, before_run_ = 0;   // s since the run began, and how long that before it took
  Pace pace_;
};

}    // namespace nscd
