// Nesterov's momentum over sweeps, restarted where it overshoots: what APGS adds to NLGS (solvers/apgs.cpp).
//
//   y = x_k + beta (x_k - x_{k-1}),  x_{k+1} = sweep(y)
//   theta' = (1 + sqrt(1 + 4 theta^2)) / 2,  beta = (theta - 1) / theta'
//
// A sweep moves bodies linearly with the impulses, so both are extrapolated alike; what round-off leaves between them
// is taken away before a problem is called solved (solvers/apgs.cpp).
// Restart (theta = 1, beta = 0) when the sweep turns against the last move, with the diagonal of W as weight:
// (y - x_{k+1}) . (x_{k+1} - x_k) > 0.
//
// With friction the sweep is no descent of anything, and momentum can drive it round in circles or apart. Then beta is
// kept below a cap, which is lowered whenever the sweeps get nowhere, down to none: what is left is NLGS with its
// relaxation.
//
// Source: Nesterov (1983); O'Donoghue & Candes (2015), gradient scheme.
#pragma once

#include "iterate.hpp"

#include <algorithm>
#include <cmath>

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
// Short solves want a low cap, for they end before circles matter, and long ones a high one: 1 - cap goes from 1/10 to
// 1/50 with the sweeps, and is doubled wherever they get nowhere.
class Caution {
 public:
  double cap() const { return 1 - gap(); }
  double share() const { return relaxation_.share(); }

  // After a sweep. Whether it has grown.
  bool grows(double corrected)
  {
    ++sweeps_;
    if (gap() == 1) {
      relaxation_.look(corrected);
      return false;
    }
    if (!plateau_.is_reached(corrected)) return false;
    factor_ *= 2;
    plateau_ = {};
    return true;
  }

 private:
  static constexpr double widest = 0.1, narrowest = 0.02, first_sweeps = 256;
  double gap() const
  {
    const double base = std::clamp(widest * first_sweeps / std::max(sweeps_, 1), narrowest, widest);
    return std::min(1.0, factor_ * base);
  }

  int sweeps_ = 0;
  double factor_ = 1;
  Plateau plateau_;
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
