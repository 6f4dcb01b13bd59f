// SPDX-License-Identifier: GPL-2.0-or-later
// The last digits: undamped Newton steps on the projections of which solutions are fixed points (Alart & Curnier 1991).
//
//   open     x = 0                                where x_0 <= rho_n u_0
//   stick    u = 0                                where |tau| <= x_0,  tau = x_t - rho_t u_t
//   slide    u_0 = 0,  x_t = x_0 tau / |tau|      elsewhere
//
// with a tail x_t for each cone of a contact.
// Good near a solution only, and exact there once contacts are on their sides. Interior points end at about the root of
// the machine precision: where contacts are about to open or to slip, x and z share the digits of their product, and on
// the boundary of a cone x_0 - |x_t| has none left.
// W is singular as a rule: eps W_kk (x - x_old) is added to the rows of u, and taken out by a step of refinement.
#pragma once

#include "solver/global/newton_factor.hpp"

namespace nscd {

template <int most>
class NewtonEnd {
 public:
  using Cones = UnitCones<most>;
  using Vectors = typename Cones::Vectors;

  explicit NewtonEnd(const Cones &cones) : cones_(cones) {}

  // A step from x; false if the matrix is singular.
  bool step(NewtonFactor<most> &factor, Vectors &x)
  {
    const Vectors u = cones_.velocities(x);
    a_.assign(cones_.size(), Cones::Matrix::Zero());
    b_.assign(cones_.size(), Cones::Matrix::Identity());
    proximal_.assign(cones_.size(), Cones::Matrix::Zero());
    right_.resize(cones_.size());
    for (int k = 0; k < cones_.size(); ++k) linearise(k, x[k], u[k]);
    if (!factor.factorise(a_, b_)) return false;
    for (int times = 0; times < 2; ++times) {  // the second takes out what eps has changed
      const Vectors dx = factor.solve(right_), response = cones_.responses(dx);
      for (int k = 0; k < cones_.size(); ++k) {
        x[k] += dx[k];
        right_[k] -= a_[k] * response[k] + (b_[k] - proximal_[k]) * dx[k];
      }
    }
    return true;
  }

 private:
  using Vector = typename Cones::Vector;
  static constexpr double eps = 1e-10;

  // The rows of contact k in (A W + B) dx = right.
  void linearise(int k, const Vector &x, const Vector &u)
  {
    right_[k] = -x;
    const auto &own = cones_.own(k);
    if (!(x[0] * own(0, 0) > u[0])) return;
    proximal_[k] = typename Cones::Matrix(own.diagonal().asDiagonal()) * eps;
    a_[k].setIdentity();
    b_[k] = proximal_[k];
    right_[k] = -u;
    for (const Tail &tail : cones_.tails(k)) slide(k, tail, x, u);
  }

  // Where it does.
  void slide(int k, const Tail &tail, const Vector &x, const Vector &u)
  {
    const int first = tail.first, n = tail.axes;
    if (n == 0 || tail.sticks) return;
    double largest = 0;
    for (int i = first; i < first + n; ++i) largest = std::max(largest, cones_.own(k)(i, i));
    const double rho = 1 / largest;
    const Eigen::Vector2d pushes = in_cone(x, tail).template tail<2>(), slips = in_cone(u, tail).template tail<2>();
    const Eigen::Vector2d tau = pushes - rho * slips;
    if (tau.norm() <= x[0]) return;
    const Eigen::Vector2d along = tau.normalized();
    const double share = std::max(0.0, x[0]) / tau.norm();
    const Eigen::Matrix2d turn = share * (Eigen::Matrix2d::Identity() - along * along.transpose());
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        a_[k](first + i, first + j) = rho * turn(i, j);
        b_[k](first + i, first + j) = (i == j) - turn(i, j);
        proximal_[k](first + i, first + j) = 0;
      }
      b_[k](first + i, 0) = -along[i];
      right_[k][first + i] = x[0] * along[i] - pushes[i];
    }
  }

  const Cones &cones_;
  typename NewtonFactor<most>::Matrices a_, b_, proximal_;
  Vectors right_;
};

}    // namespace nscd
