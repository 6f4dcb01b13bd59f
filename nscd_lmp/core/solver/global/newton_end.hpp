// SPDX-License-Identifier: GPL-2.0-or-later
// The last digits: undamped Newton steps on the projections of which solutions are fixed points (Alart & Curnier 1991).
//
//   open     x = 0                                where x_0 <= rho_n u_0
//   stick    u = 0                                where |tau| <= x_0,  tau = x_t - rho_t u_t
//   slide    u_0 = 0,  x_t = x_0 tau / |tau|      elsewhere
//
// Good near a solution only, and exact there once contacts are on their sides. Interior points end at about the root of
// the machine precision: where contacts are about to open or to slip, x and z share the digits of their product, and on
// the boundary of a cone x_0 - |x_t| has none left.
// W is singular as a rule: eps W_kk (x - x_old) is added to the rows of u, and taken out by a step of refinement.
#pragma once

#include "solver/global/newton_factor.hpp"

namespace nscd {

class NewtonEnd {
 public:
  explicit NewtonEnd(const UnitCones &cones) : cones_(cones) {}

  // A step from x; false if the matrix is singular.
  bool step(NewtonFactor &factor, UnitCones::Vectors &x)
  {
    const UnitCones::Vectors u = cones_.velocities(x);
    a_.assign(cones_.size(), cone::Matrix::Zero());
    b_.assign(cones_.size(), cone::Matrix::Identity());
    proximal_.assign(cones_.size(), cone::Matrix::Zero());
    right_.resize(cones_.size());
    for (int k = 0; k < cones_.size(); ++k) linearise(k, x[k], u[k]);
    if (!factor.factorise(a_, b_)) return false;
    for (int times = 0; times < 2; ++times) {  // the second takes out what eps has changed
      const UnitCones::Vectors dx = factor.solve(right_), response = cones_.responses(dx);
      for (int k = 0; k < cones_.size(); ++k) {
        x[k] += dx[k];
        right_[k] -= a_[k] * response[k] + (b_[k] - proximal_[k]) * dx[k];
      }
    }
    return true;
  }

 private:
  static constexpr double eps = 1e-10;

  // The rows of contact k in (A W + B) dx = right.
  void linearise(int k, const cone::Vector &x, const cone::Vector &u)
  {
    right_[k] = -x;
    const cone::Matrix &own = cones_.own(k);
    if (!(x[0] * own(0, 0) > u[0])) return;
    proximal_[k] = cone::Matrix(own.diagonal().asDiagonal()) * eps;
    a_[k].setIdentity();
    b_[k] = proximal_[k];
    right_[k] = -u;
    const double rho = 1 / std::max(own(1, 1), own(2, 2));
    const Eigen::Vector2d tau = x.tail<2>() - rho * u.tail<2>();
    if (cones_.width(k) == 1 || cones_.sticks(k) || tau.norm() <= x[0]) return;
    const Eigen::Vector2d along = tau.normalized();
    const double share = std::max(0.0, x[0]) / tau.norm();
    const Eigen::Matrix2d turn = share * (Eigen::Matrix2d::Identity() - along * along.transpose());
    a_[k].bottomRightCorner<2, 2>() = rho * turn;
    b_[k].bottomRightCorner<2, 2>() = Eigen::Matrix2d::Identity() - turn;
    b_[k].bottomLeftCorner<2, 1>() = -along;
    proximal_[k].bottomRightCorner<2, 2>().setZero();
    right_[k].tail<2>() = x[0] * along - x.tail<2>();
  }

  const UnitCones &cones_;
  std::vector<cone::Matrix> a_, b_, proximal_;
  UnitCones::Vectors right_;
};

}    // namespace nscd
