// SPDX-License-Identifier: GPL-2.0-or-later
// The frictionless contact problem as a quadratic program of unit diagonal: least y.S y / 2 + b.y over y >= 0.
//
// S = D^-1/2 W D^-1/2, b = D^-1/2 q, y = D^1/2 p, D = diag W: mass ratios of 1e6 leave a matrix of unit diagonal. Rows
// without a positive diagonal are zero in S and in no face.
#pragma once

#include "problem/block_matrix.hpp"

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace nscd {

using Vector = Eigen::VectorXd;

struct ScaledRows {
  const BlockMatrix &w;       // dim 1
  std::vector<double> value;  // entries of S, in the places of W's
  std::vector<double> root;   // D^1/2, 0 on a zero row
  Vector b;

  ScaledRows(const BlockMatrix &matrix, const double *q) :
      w(matrix), value(matrix.block), root(matrix.rows(), 0.0), b(matrix.rows())
  {
    for (std::size_t k = 0; k < w.rows(); ++k)
      if (const double *own = w.diagonal(k)) root[k] = *own > 0 ? std::sqrt(*own) : 0;
    for (std::size_t k = 0; k < w.rows(); ++k) {
      b[k] = root[k] > 0 ? q[k] / root[k] : 0;
      for (auto e = w.row_start[k]; e < w.row_start[k + 1]; ++e) {
        const double scale = root[k] * root[w.column[e]];
        value[e] = scale > 0 ? value[e] / scale : 0;
      }
    }
  }

  int size() const { return int(w.rows()); }

  double row_times(int k, const Vector &x) const
  {
    double sum = 0;
    for (auto e = w.row_start[k]; e < w.row_start[k + 1]; ++e) sum += value[e] * x[w.column[e]];
    return sum;
  }
};

// The same with eps |y - centre|^2 / 2 added, which makes it strictly convex whatever the rank of W.
struct Proximal {
  const ScaledRows &s;
  double eps;
  Vector centre;

  double gradient(int k, const Vector &y) const
  {
    return s.row_times(k, y) + s.b[k] + eps * (y[k] - centre[k]);
  }

  double objective(const Vector &y) const
  {
    double sum = 0;
    for (int k = 0; k < s.size(); ++k)
      if (y[k] != 0) sum += y[k] * (0.5 * (s.row_times(k, y) + eps * y[k]) + s.b[k] - eps * centre[k]);
    return sum;
  }

  // One projected Gauss-Seidel sweep; returns how many contacts opened or closed.
  int sweep(Vector &y) const
  {
    int switched = 0;
    for (int k = 0; k < s.size(); ++k) {
      if (!(s.root[k] > 0)) continue;
      const double next = std::max(0.0, y[k] - gradient(k, y) / (1 + eps));
      switched += (next > 0) != (y[k] > 0);
      y[k] = next;
    }
    return switched;
  }
};

}    // namespace nscd
