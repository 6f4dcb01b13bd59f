// Nesterov's momentum over sweeps, restarted where it overshoots: what APGS adds to NLGS (solvers/apgs.cpp).
//
//   y = x_k + beta (x_k - x_{k-1}),  x_{k+1} = sweep(y),  theta' = (1 + sqrt(1 + 4 theta^2)) / 2,  beta = (theta - 1) / theta'
//
// A sweep moves bodies linearly with the impulses, so both are extrapolated alike and stay consistent.
// Restart (theta = 1, beta = 0) when the sweep turns against the last move: (y - x_{k+1}) . (x_{k+1} - x_k) > 0.
// Source: Nesterov (1983); O'Donoghue & Candes (2015), gradient scheme.
#pragma once

#include <cmath>

namespace nscd {

class Momentum {
 public:
  double share() const { return share_; }
  double *previous = nullptr;  // impulses before the last sweep, a contact after another

  // After a sweep; `against` is the product above, in the metric of the diagonal of W.
  void move_on(double against)
  {
    if (!(against <= 0)) {
      theta_ = 1;
      share_ = 0;
      return;
    }
    const double next = 0.5 * (1 + std::sqrt(1 + 4 * theta_ * theta_));
    share_ = (theta_ - 1) / next;
    theta_ = next;
  }

 private:
  double theta_ = 1, share_ = 0;
};

}    // namespace nscd
