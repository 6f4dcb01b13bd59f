// SPDX-License-Identifier: GPL-2.0-or-later
// How the box moves, from what it was in the steps before.
#pragma once

#include "contact/contact.hpp"
#include "scene/views.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace nscd {

struct State;

// At which what jumped is given back, 1/s: over the time that has passed since the change before, and not more than
// `recovery` a step.
inline double give_back_rate(double recovery, double dt, double took) { return std::min(recovery / dt, 1 / took); }

// Something that changes now and then: how long ago that was, and how long the change took. A change is motion at its
// mean rate, which is taken to last for as long again: boxes and radii mostly change every N-th step.
class Pace {
 public:
  void begin() { since_ = took_ = 0; }
  void pass(double time) { since_ += time; }
  void change()
  {
    took_ = since_;
    since_ = 0;
  }
  void last_forever() { took_ = std::numeric_limits<double>::infinity(); }
  double since() const { return since_; }
  double took() const { return took_; }
  // Whether the next change has not come when it was due, or comes within this time.
  bool is_over() const { return is_due(0); }
  bool is_due(double time) const { return since_ + time >= took_ * (1 - 1e-6); }

 private:
  double since_ = 0, took_ = 0;   // s
};

// A velocity that grows linearly with the place: the upper triangle of its gradient, 1/s. The motion of a box, and of
// all that moves with it.
struct Gradient {
  double xx = 0, yy = 0, zz = 0, yz = 0, xz = 0, xy = 0;

  bool is_zero() const { return xx == 0 && yy == 0 && zz == 0 && yz == 0 && xz == 0 && xy == 0; }
  Vec4 at(const Vec4 &x) const
  {
    return Vec4{xx * x[0] + xy * x[1] + xz * x[2], yy * x[1] + yz * x[2], zz * x[2], 0};
  }
  Gradient operator*(double factor) const
  {
    return {xx * factor, yy * factor, zz * factor, yz * factor, xz * factor, xy * factor};
  }
  double norm() const;
};

// What a box did between two steps.
struct BoxChange {
  double edges[6] = {}, low[3] = {};   // m
  // The gradient of the displacement, over `box`; `images_only`: of what images can see, edges that are periodic.
  Gradient gradient(const Box &box, bool images_only) const;
};

// A box that is flipped, its tilt taken back by a whole edge, has the same images and has not moved.
BoxChange change_between(const Box &from, const Box &to);

// Within a run a change of the box is motion. Between runs it is a jump, which has no velocity.
class BoxMotion {
 public:
  void begin_run() { fresh_ = true; }
  // As the run starts, before the first step.
  void see(const Box &box);
  // At the start of a step of length dt. On several ranks collective where the box has changed.
  void look(const State &state);
  // At its end, with grains where they have got to.
  void leave(const State &state);

  bool moves() const { return rides_ ? !all_.is_zero() || low_rate_[0] != 0 || low_rate_[1] != 0 || low_rate_[2] != 0
                                     : !images_.is_zero(); }
  // Grains move with the box beside their own velocity (fix deform remap x), or their images alone do.
  bool carries_grains() const { return rides_; }
  const Gradient &gradient() const { return rides_ ? all_ : images_; }
  // Velocity of a place that moves with the box.
  Vec4 at(const Vec4 &x) const;
  // How long ago it was where it is in the arrays.
  double lag() const { return pace_.since(); }
  bool changes_within(double time) const { return known_ ? changes_now_ : pace_.is_due(time); }
  // What the box has done since the last run, in the first step of a run: displacement over place, of grains too or of
  // images alone; and how long that run took, s.
  const Gradient &jump() const { return jump_; }
  bool jump_carries_grains() const { return jump_rides_; }
  double before_run() const { return before_run_; }

 private:
  struct Sample {
    std::int32_t tag;
    int index;
    alignas(vec4_alignment) Vec4 x;
  };
  void take(const BoxChange &change, double time);
  bool carries(const State &state, const BoxChange &change) const;

  Box last_;
  bool seen_ = false, fresh_ = true, first_ = true;   // of any run; of this run, and its first step
  bool known_ = false, changes_now_ = false, rides_ = false, jump_rides_ = false;
  double dt_ = 0;                                     // s, of the last step
  double run_ = 0, before_run_ = 0;                   // s since the run began, and how long that before it took
  Pace pace_;
  Gradient all_, images_, jump_;
  BoxChange jumped_;
  double low_rate_[3] = {};
  std::vector<Sample> samples_;                       // some grains where the last step left them
};

}    // namespace nscd
