// SPDX-License-Identifier: GPL-2.0-or-later
// Sparse LU of A W + B, with W of contacts scaled to unit cones, A and B one block a contact: Newton's matrices.
#pragma once

#include "solver/global/unit_cones.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

#include <algorithm>
#include <cmath>
#include <vector>

namespace nscd {

// Minimum degree. SparseLU reads a permutation the other way round from the one that AMDOrdering returns.
struct MinimumDegree {
  using PermutationType = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;
  template <class Pattern>
  void operator()(const Pattern &pattern, PermutationType &order)
  {
    PermutationType inverse;
    Eigen::AMDOrdering<int>()(pattern, inverse);
    order = inverse.inverse();
  }
};

template <int most>
class NewtonFactor {
 public:
  using Cones = UnitCones<most>;
  using Block = typename Cones::Block;
  using Matrices = std::vector<typename Cones::Matrix>;
  using Vectors = typename Cones::Vectors;

  explicit NewtonFactor(const Cones &cones) : cones_(cones), matrix_(cones.unknowns(), cones.unknowns())
  {
    std::vector<Eigen::Triplet<double>> entries;
    for (int k = 0; k < cones.size(); ++k)
      cones.each(k, [&](const Block &block) {
        for (int a = 0; a < cones.width(k); ++a)
          for (int b = 0; b < cones.width(block.column); ++b) {
            entries.emplace_back(cones.first(k) + a, cones.first(block.column) + b, 0.0);
            entries.emplace_back(cones.first(block.column) + b, cones.first(k) + a, 0.0);
          }
      });
    matrix_.setFromTriplets(entries.begin(), entries.end());
    for (int k = 0; k < cones.size(); ++k)
      cones.each(k, [&](const Block &block) {
        for (int b = 0; b < cones.width(block.column); ++b)
          place_.push_back(place(cones.first(k), cones.first(block.column) + b));
      });
    lu_.isSymmetric(true);  // by its pattern: pivots from the diagonal where they are not too small
    lu_.setPivotThreshold(pivot_threshold);
    lu_.analyzePattern(matrix_);
  }

  // False if it is singular or not finite.
  bool factorise(const Matrices &a, const Matrices &b)
  {
    std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
    std::size_t next = 0;
    for (int k = 0; k < cones_.size(); ++k)
      cones_.each(k, [&](const Block &block) {
        typename Cones::Matrix m = a[k] * block.value;
        if (block.column == k) m += b[k];
        for (int j = 0; j < cones_.width(block.column); ++j, ++next)
          for (int i = 0; i < cones_.width(k); ++i) matrix_.valuePtr()[place_[next] + i] += m(i, j);
      });
    if (!std::isfinite(matrix_.sum())) return false;
    lu_.factorize(matrix_);
    return lu_.info() == Eigen::Success;
  }

  Vectors solve(const Vectors &right) const
  {
    Eigen::VectorXd r(cones_.unknowns());
    for (int k = 0; k < cones_.size(); ++k)
      for (int a = 0; a < cones_.width(k); ++a) r[cones_.first(k) + a] = right[k][a];
    Eigen::VectorXd d = lu_.solve(r);
    d += lu_.solve(r - matrix_ * d);  // refinement: B grows as 1 / gap
    Vectors out = cones_.zero();
    for (int k = 0; k < cones_.size(); ++k)
      for (int a = 0; a < cones_.width(k); ++a) out[k][a] = d[cones_.first(k) + a];
    return out;
  }

 private:
  static constexpr double pivot_threshold = 0.01;

  int place(int row, int column) const
  {
    const int *inner = matrix_.innerIndexPtr(), *outer = matrix_.outerIndexPtr();
    return int(std::lower_bound(inner + outer[column], inner + outer[column + 1], row) - inner);
  }

  const Cones &cones_;
  Eigen::SparseMatrix<double> matrix_;
  std::vector<int> place_;  // of each column of each block, row after row
  Eigen::SparseLU<Eigen::SparseMatrix<double>, MinimumDegree> lu_;
};

}    // namespace nscd
