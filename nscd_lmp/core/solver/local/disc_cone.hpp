// SPDX-License-Identifier: GPL-2.0-or-later
// The cone of all impulses that a contact may have, K = { |p_d| <= mu_d p_n for each disc d }: what is nearest in it.
//
// With the discs S that are left outside, the height of the nearest point is (tau_n + sum_S mu |tau_d|) / (1 + sum_S
// mu^2). S begins as all discs, whose height is too low; discs that are inside at that height are left out, which
// raises it. The function whose root this finds is concave, so each disc leaves at most once (Newton from the left).
// An infinite mu bounds nothing.
#pragma once

#include "solver/visit.hpp"

#include <array>
#include <cmath>

namespace nscd {

template <class Tangent>
class DiscCone {
 public:
  static constexpr std::size_t count = disc_count<Tangent>;

  // `tau`: along the normal, and the lengths of what is along each disc.
  NSCD_INLINE DiscCone(double tau, const std::array<double, count> &lengths, const OwnBlock<Tangent> &own) :
      tau_(tau), lengths_(lengths), own_(own)
  {
    for (std::size_t d = 0; d < count; ++d) outside_[d] = !std::isinf(own.discs[d].mu);
    add_up();
    for (bool changed = count > 1; changed;) {
      changed = false;
      for (std::size_t d = 0; d < count; ++d)
        if (outside_[d] && lengths[d] * (1 + squares_) <= own.discs[d].mu * sum_) {
          outside_[d] = false;
          changed = true;
        }
      if (changed) add_up();
    }
  }

  // Leaves a disc out, whose vector is to be what it is inside.
  NSCD_INLINE void leave(std::size_t disc)
  {
    outside_[disc] = false;
    add_up();
  }
  NSCD_INLINE bool is_outside(std::size_t disc) const { return outside_[disc]; }
  NSCD_INLINE bool any_outside() const
  {
    for (std::size_t d = 0; d < count; ++d)
      if (outside_[d]) return true;
    return false;
  }
  // The height is sum / (1 + squares).
  NSCD_INLINE double sum() const { return sum_; }
  NSCD_INLINE double squares() const { return squares_; }

 private:
  NSCD_INLINE void add_up()
  {
    sum_ = tau_;
    squares_ = 0;
    for (std::size_t d = 0; d < count; ++d) {
      if (!outside_[d]) continue;
      const double mu = own_.discs[d].mu;
      sum_ = sum_ + mu * lengths_[d];
      squares_ = squares_ + mu * mu;
    }
  }

  const double tau_;
  const std::array<double, count> lengths_;
  const OwnBlock<Tangent> &own_;
  std::array<bool, count> outside_{};
  double sum_ = 0, squares_ = 0;
};

}    // namespace nscd
