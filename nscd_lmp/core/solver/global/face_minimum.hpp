// SPDX-License-Identifier: GPL-2.0-or-later
// The minimum of a proximal problem on a face, with bounds left out: (S_AA + eps I) y_A = -b_A + eps z_A.
//
// By conjugate gradients preconditioned with the last factor, in about as many iterations as contacts have changed
// sides since, and in one (iterative refinement) with a fresh factor.
#pragma once

#include "solver/global/face_factor.hpp"

namespace nscd {

class FaceMinimum {
 public:
  explicit FaceMinimum(int size) : r_(Vector::Zero(size)), z_(size), d_(size), sd_(size) {}

  // y: in, a start; out, the minimum, 0 off the face. May raise eps. False if W cannot be factorised.
  bool find(Proximal &proximal, const Face &face, Vector &y)
  {
    Vector x = Vector::Zero(y.size());
    for (int k : face) x[k] = y[k];
    const int limit = int(reuse * factor_.worth());
    const bool near = factor_.usable() && changes(face, factor_.face()) <= std::size_t(limit);
    if (!near || !conjugate_gradient(proximal, face, x, limit)) {
      if (!factorise(proximal, face)) return false;
      conjugate_gradient(proximal, face, x, refinements);
    }
    y.swap(x);
    return true;
  }

 private:
  static constexpr double reuse = 0.15;  // iterations allowed with an old factor, over those that cost a new one
  static constexpr double raise = 1e2, largest = 1e-4;  // eps
  static constexpr int refinements = 5;

  bool factorise(Proximal &proximal, const Face &face)
  {
    for (;; proximal.eps *= raise) {
      if (factor_.factorise(proximal.s, face, proximal.eps)) return true;
      if (proximal.eps >= largest) return false;
    }
  }

  // True if it reached round-off.
  bool conjugate_gradient(const Proximal &proximal, const Face &face, Vector &x, int limit)
  {
    double rz = 0, size = 0;
    d_.setZero();
    r_.setZero();
    for (int k : face) {
      r_[k] = -proximal.gradient(k, x);
      size += proximal.s.b[k] * proximal.s.b[k];
    }
    for (int iteration = 0; iteration < limit; ++iteration) {
      factor_.apply(face, r_, z_);
      const double before = rz;
      rz = 0;
      for (int k : face) rz += r_[k] * z_[k];
      if (!(rz > 0)) return rz == 0;
      double curvature = 0;
      for (int k : face) d_[k] = z_[k] + (iteration ? rz / before : 0) * d_[k];
      for (int k : face) curvature += d_[k] * (sd_[k] = proximal.s.row_times(k, d_) + proximal.eps * d_[k]);
      if (!(curvature > 0)) return false;
      double left = 0;
      for (int k : face) {
        x[k] += rz / curvature * d_[k];
        r_[k] -= rz / curvature * sd_[k];
        left += r_[k] * r_[k];
      }
      if (left <= 1e-28 * size) return true;
    }
    return false;
  }

  FaceFactor factor_;
  Vector r_, z_, d_, sd_;
};

}    // namespace nscd
