// SPDX-License-Identifier: GPL-2.0-or-later
// The path that interior points follow: iterates x (impulses) and z (velocities with mu |u_t| along N) inside unit
// cones. The equations are in interior_point.cpp. A contact of several cones has one x, which is in all of them, and
// a z of each: along N these add up to its velocity with all its mu |u_t|.
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

template <int most>
class CentralPath {
 public:
  using Cones = UnitCones<most>;
  using Vector = typename Cones::Vector;
  using Vectors = typename Cones::Vectors;
  using ConeVectors = std::vector<cone::Vector>;  // of each cone

  explicit CentralPath(const Cones &cones) : cones_(cones), factor_(cones), dz_(cones.cones()) {}

  // From these impulses, moved into the cones.
  void start(const Vectors &impulses, double shift)
  {
    x_ = impulses;
    z_.resize(cones_.cones());
    u_ = cones_.velocities(x_);
    const double inwards = shift * cones_.speed();
    for (int k = 0; k < cones_.size(); ++k) {
      const auto tails = cones_.tails(k);
      const double apart = std::max(u_[k][0], 0.0) / double(tails.size());
      double &push = x_[k][0];
      push = std::max(push, 0.0);
      for (std::size_t t = 0; t < tails.size(); ++t) {
        push = std::max(push, cone::tangent(in_cone(x_[k], tails[t])));
        cone::Vector &z = z_[cones_.cone(k) + t];
        z = in_cone(u_[k], tails[t]);
        z[0] = apart + cone::tangent(z) + inwards;
      }
      push += inwards;
    }
  }

  const Vectors &impulses() const { return x_; }
  NewtonFactor<most> &factor() { return factor_; }

  // A predictor and a corrector with one factorisation; returns the share of the step taken, 0 if it cannot go on.
  double step(const Tuning &t)
  {
    u_ = cones_.velocities(x_);
    if (!factorise()) return 0;
    move(ConeVectors(cones_.cones(), cone::Vector::Zero()), 0);
    double reach = std::min(1.0, longest()), centring = std::max(std::pow(1 - reach, t.power), least_centring);
    const double gap = complementarity();
    ConeVectors bend(cones_.cones());
    each_cone([&](int k, const Tail &tail, std::size_t c) {
      bend[c] = cone::product(scaling_[c].s * in_cone(dx_[k], tail), scaling_[c].back * dz_[c]);
    });
    for (int attempt = 0; attempt < 2; ++attempt) {
      move(bend, centring * gap);
      reach = std::min(1.0, t.reach * longest());
      if (reach > hardly) break;
      bend.assign(cones_.cones(), cone::Vector::Zero());  // the second-order term spoils short steps
      centring = std::max(centring, bounded_centring);
    }
    for (int k = 0; k < cones_.size(); ++k) x_[k] += reach * dx_[k];
    for (std::size_t c = 0; c < cones_.cones(); ++c) z_[c] += reach * dz_[c];
    return reach;
  }

 private:
  // f(contact, tail, number of the cone)
  template <class Function>
  void each_cone(Function f) const
  {
    std::size_t c = 0;
    for (int k = 0; k < cones_.size(); ++k)
      for (const Tail &tail : cones_.tails(k)) f(k, tail, c++);
  }

  double complementarity() const
  {
    double sum = 0;
    each_cone([&](int k, const Tail &tail, std::size_t c) { sum += in_cone(x_[k], tail).dot(z_[c]); });
    return sum / double(cones_.cones());
  }

  // G, the derivative of u + |u_t| e with respect to u, and the sum of S^2; one scaling for each cone.
  bool factorise()
  {
    scaling_.clear();
    typename NewtonFactor<most>::Matrices a(cones_.size(), Cones::Matrix::Identity());
    typename NewtonFactor<most>::Matrices b(cones_.size(), Cones::Matrix::Zero());
    each_cone([&](int k, const Tail &tail, std::size_t c) {
      scaling_.emplace_back(in_cone(x_[k], tail), z_[c]);
      const cone::Matrix s2 = scaling_.back().s * scaling_.back().s;
      const cone::Vector u = in_cone(u_[k], tail);
      const double slip = cone::tangent(u);
      b[k](0, 0) += s2(0, 0);
      for (int i = 0; i < tail.axes; ++i) {
        if (slip > 0) a[k](0, tail.first + i) = u[1 + i] / slip;
        b[k](0, tail.first + i) = s2(0, 1 + i);
        b[k](tail.first + i, 0) = s2(1 + i, 0);
        for (int j = 0; j < tail.axes; ++j) b[k](tail.first + i, tail.first + j) = s2(1 + i, 1 + j);
      }
    });
    return factor_.factorise(a, b);
  }

  // Newton's step for x o z = target e - bend in the scaled space.
  void move(const ConeVectors &bend, double target)
  {
    Vectors right = cones_.zero(), off = u_;
    ConeVectors goal(cones_.cones());
    each_cone([&](int k, const Tail &tail, std::size_t c) {
      const cone::Scaling &s = scaling_[c];
      goal[c] = -s.lambda - cone::quotient(s.lambda, bend[c] - cone::Vector(target, 0, 0));
      add_cone<most>(right[k], tail, s.s * goal[c]);
      add_cone<most>(off[k], tail, -z_[c]);
    });
    for (int k = 0; k < cones_.size(); ++k) right[k] -= off[k];
    each_cone([&](int k, const Tail &tail, std::size_t) { right[k][0] -= cone::tangent(in_cone(u_[k], tail)); });
    dx_ = factor_.solve(right);
    each_cone([&](int k, const Tail &tail, std::size_t c) {
      dz_[c] = scaling_[c].s * (goal[c] - scaling_[c].s * in_cone(dx_[k], tail));
    });
  }

  double longest() const
  {
    double a = std::numeric_limits<double>::infinity();
    each_cone([&](int k, const Tail &tail, std::size_t c) {
      const double of_x = cone::longest(in_cone(x_[k], tail), in_cone(dx_[k], tail));
      a = std::min({a, of_x, cone::longest(z_[c], dz_[c])});
    });
    return a;
  }

  static constexpr double least_centring = 0.01, bounded_centring = 0.5, hardly = 0.1;

  const Cones &cones_;
  NewtonFactor<most> factor_;
  Vectors x_, u_, dx_;
  ConeVectors z_, dz_;
  std::vector<cone::Scaling> scaling_;
};

}    // namespace nscd
