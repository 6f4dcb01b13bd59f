// SPDX-License-Identifier: GPL-2.0-or-later
// What a contact's velocity has besides the velocities of its two bodies: radii that grow, and images (or grains) that
// move with the box. It is known at the start of a step, and every law takes it as part of the relative velocity.
#pragma once

#include "base/storage.hpp"
#include "scene/drift/box_motion.hpp"
#include "scene/drift/growth.hpp"

#include <vector>

namespace nscd {

struct State;

// Empty or 0 in a scene where nothing grows and no box moves.
struct Drift {
  AlignedVector<Vec4> of{};           // (atoms) velocity beside its body's, and fourth that of its radius, m/s
  std::vector<double> sudden{};       // (atoms) at which sudden growth may be given back, m/s
  AlignedVector<Vec4> jump{};         // (atoms) the same of a box that has jumped, in space
  double fastest = 0;                 // half of what brings two atoms together, m/s
  double approach = 0;                // by which drift brings two atoms together in the step, m
  double to_end = 0;                  // s, from where contacts are sought to the end of the step
  double ahead = 0;                   // s, by which centres are ahead of the arrays there
  double centres = 0, radii = 0;      // s, from there to what the arrays have at the end of the step
};

class Drifts {
 public:
  void begin_run();
  // As the run starts, before the first step.
  void see(const Grains &grains);
  // Ahead of gathering; local. Returns whether radii have changed.
  bool look(const State &state, bool new_list);
  // Fills state.drift, with `changed` for all ranks. Collective.
  void settle(State &state, bool changed, bool new_list);
  // Once bodies and images are gathered: moves spheres on to where contacts are sought, `predicted` s after the start.
  void place(State &state, double predicted, double look_ahead) const;
  // At the end of a step, with the arrays written.
  void leave(const State &state);
  // What has brought two atoms nearer, at most, beside their bodies' motion since the list was built, m.
  double neared() const { return neared_; }

 private:
  void fill(State &state);
  void fill_jump(State &state) const;

  Growth growth_;
  BoxMotion box_;
  double neared_ = 0, shifting_ = 0;   // m; m/s, the part of drift.fastest that is no growth
};

}    // namespace nscd
