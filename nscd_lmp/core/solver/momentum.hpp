// SPDX-License-Identifier: GPL-2.0-or-later
// Nesterov's momentum over sweeps, restarted where it overshoots: what APGS adds to NLGS (global/apgs.cpp).
//
//   y = x_k + beta (x_k - x_{k-1}),  x_{k+1} = sweep(y)
//   theta' = (1 + sqrt(1 + 4 theta^2)) / 2,  beta = (theta - 1) / theta'
//
// A sweep moves bodies linearly with the impulses, so both are extrapolated alike; what round-off leaves between them
// is taken away before a problem is called solved (global/apgs.cpp).
// Restart (theta = 1, beta = 0) when the sweep turns against the last move, with the diagonal of W as weight:
// (y - x_{k+1}) . (x_{k+1} - x_k) > 0.
//
// With friction the sweep is no descent of anything, and momentum can drive it round in circles or apart. Then beta is
// kept below a cap, which is lowered wherever sweeps correct more than those before, down to none: what is left is NLGS
// with its relaxation.
//
// Source: Nesterov (1983); O'Donoghue & Candes (2015), gradient scheme.
#pragma once

#include "solver/iterate.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace nscd {

class Momentum {
 public:
  // beta, of the next sweep.
  double share() const { return share_; }
  double *previous = nullptr;  // impulses before the last sweep, a contact after another

  // After a sweep; `against` is the product above.
  void move_on(double against)
  {
    if (!(against <= 0)) return restart();
    const double next = 0.5 * (1 + std::sqrt(1 + 4 * theta_ * theta_));
    share_ = (theta_ - 1) / next;
    theta_ = next;
  }

  void restart()
  {
    theta_ = 1;
    share_ = 0;
  }

  void keep_below(double cap) { share_ = std::min(share_, cap); }

 private:
  double theta_ = 1, share_ = 0;
};

// The cap on momentum for sweeps with friction, and the share of their step that visits do once there is none.
//
// What a window of sweeps corrects tells whether momentum helps: more than the window before, and 1 - cap grows by
// half; less, and the cap may rise a little.
class Caution {
 public:
  double cap() const { return 1 - gap_; }
  double share() const { return relaxation_.share(); }

  // After a sweep. Whether momentum is to start anew.
  bool grows(double corrected)
  {
    if (gap_ == 1) relaxation_.look(corrected);
    sum_ += corrected;
    if (++sweeps_ % window != 0) return false;
    const double before = std::exchange(sum_before_, std::exchange(sum_, 0.0));
    if (!(sum_before_ <= before)) {
      gap_ = std::min(1.0, 1.5 * gap_);
      return true;
    }
    if (relaxation_.share() == 1) gap_ = std::max(narrowest, gap_ / 1.1);
    return false;
  }

 private:
  static constexpr int window = 24;
  static constexpr double narrowest = 0.02;

  double gap_ = 0.2, sum_ = 0, sum_before_ = INFINITY;
  int sweeps_ = 0;
  Relaxation relaxation_;
};

// Momentum and, with friction, the caution that it takes: what is the same on grains and on matrices.
class Pace {
 public:
  explicit Pace(bool friction) : friction_(friction) {}
  Momentum momentum;

  // What part of their step visits do.
  double share() const { return friction_ ? caution_.share() : 1; }

  // Returns what the sweep would have corrected with whole steps.
  double look(const Swept &swept)
  {
    const double corrected = swept.corrected / share();
    momentum.move_on(swept.against);
    if (!friction_) return corrected;
    if (caution_.grows(corrected)) momentum.restart();
    momentum.keep_below(caution_.cap());
    return corrected;
  }

 private:
  const bool friction_;
  Caution caution_;
};

}    // namespace nscd
