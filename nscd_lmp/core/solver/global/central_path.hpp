// SPDX-License-Identifier: GPL-2.0-or-later
// The path that interior points follow: iterates x (impulses) and z (velocities with mu |u_t| along N) inside unit
// cones. The equations are in interior_point.cpp.
#pragma once

#include "solver/global/newton_factor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace nscd {

struct Tuning {
  double shift;  // of a start into the cones, times the mean |q|
  double power;  // of what the predictor leaves of the gap: the centring
  double reach;  // share of the way to the boundary
};

class CentralPath {
 public:
  using Vectors = UnitCones::Vectors;

  explicit CentralPath(const UnitCones &cones) : cones_(cones), n_(cones.size()), factor_(cones), dz_(n_) {}

  // From these impulses, moved into the cones.
  void start(const Vectors &impulses, double shift)
  {
    x_ = impulses;
    z_ = cones_.velocities(x_);
    const double inwards = shift * cones_.speed();
    for (int k = 0; k < n_; ++k) {
      const double slip = cone::tangent(z_[k]);
      z_[k][0] = std::max(z_[k][0] + slip, slip) + inwards;
      x_[k][0] = std::max(x_[k][0], cone::tangent(x_[k])) + inwards;
    }
  }

  const Vectors &impulses() const { return x_; }
  NewtonFactor &factor() { return factor_; }

  // A predictor and a corrector with one factorisation; returns the share of the step taken, 0 if it cannot go on.
  double step(const Tuning &t)
  {
    u_ = cones_.velocities(x_);
    if (!factorise()) return 0;
    move(Vectors(n_, cone::Vector::Zero()), 0);
    double reach = std::min(1.0, longest()), centring = std::max(std::pow(1 - reach, t.power), least_centring);
    const double gap = complementarity();
    Vectors bend(n_);
    for (int k = 0; k < n_; ++k) bend[k] = cone::product(scaling_[k].s * dx_[k], scaling_[k].back * dz_[k]);
    for (int attempt = 0; attempt < 2; ++attempt) {
      move(bend, centring * gap);
      reach = std::min(1.0, t.reach * longest());
      if (reach > hardly) break;
      bend.assign(n_, cone::Vector::Zero());  // the second-order term spoils short steps
      centring = std::max(centring, bounded_centring);
    }
    for (int k = 0; k < n_; ++k) {
      x_[k] += reach * dx_[k];
      z_[k] += reach * dz_[k];
    }
    return reach;
  }

 private:
  double complementarity() const
  {
    double sum = 0;
    for (int k = 0; k < n_; ++k) sum += x_[k].dot(z_[k]);
    return sum / n_;
  }

  // G, the derivative of u + |u_t| e with respect to u.
  cone::Matrix shift_slope(int k) const
  {
    cone::Matrix g = cone::Matrix::Identity();
    const double slip = cone::tangent(u_[k]);
    if (slip > 0) g.block<1, 2>(0, 1) = u_[k].tail<2>().transpose() / slip;
    return g;
  }

  bool factorise()
  {
    scaling_.clear();
    std::vector<cone::Matrix> a, b;
    for (int k = 0; k < n_; ++k) {
      scaling_.emplace_back(x_[k], z_[k]);
      a.push_back(shift_slope(k));
      b.push_back(scaling_[k].s * scaling_[k].s);
    }
    return factor_.factorise(a, b);
  }

  // Newton's step for x o z = target e - bend in the scaled space.
  void move(const Vectors &bend, double target)
  {
    Vectors right(n_), goal(n_);
    for (int k = 0; k < n_; ++k) {
      const cone::Scaling &s = scaling_[k];
      goal[k] = -s.lambda - cone::quotient(s.lambda, bend[k] - cone::Vector(target, 0, 0));
      right[k] = s.s * goal[k] - (u_[k] - z_[k]);
      right[k][0] -= cone::tangent(u_[k]);
    }
    dx_ = factor_.solve(right);
    for (int k = 0; k < n_; ++k) dz_[k] = scaling_[k].s * (goal[k] - scaling_[k].s * dx_[k]);
  }

  double longest() const
  {
    double a = std::numeric_limits<double>::infinity();
    for (int k = 0; k < n_; ++k) a = std::min({a, cone::longest(x_[k], dx_[k]), cone::longest(z_[k], dz_[k])});
    return a;
  }

  static constexpr double least_centring = 0.01, bounded_centring = 0.5, hardly = 0.1;

  const UnitCones &cones_;
  const int n_;
  NewtonFactor factor_;
  Vectors x_, z_, u_, dx_, dz_;
  std::vector<cone::Scaling> scaling_;
};

}    // namespace nscd
