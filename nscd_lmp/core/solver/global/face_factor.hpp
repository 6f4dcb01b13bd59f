// SPDX-License-Identifier: GPL-2.0-or-later
// Sparse LDL^T of S_FF + eps I on a face F (a sorted list of contacts), and its use as a preconditioner on faces near
// F.
#pragma once

#include "solver/global/scaled_rows.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

namespace nscd {

using Face = std::vector<int>;

// How many contacts are in one of two faces only.
inline std::size_t changes(const Face &a, const Face &b)
{
  Face changed;
  std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(changed));
  return changed.size();
}

class FaceFactor {
 public:
  // False if a pivot is not positive: eps is too small for the round-off of a singular S_FF, or W is indefinite.
  bool factorise(const ScaledRows &s, const Face &face, double eps)
  {
    face_ = face;
    right_.resize(face.size());
    ldlt_.compute(submatrix(s, eps));
    usable_ = ldlt_.info() == Eigen::Success && (face.empty() || ldlt_.vectorD().minCoeff() > 0);
    if (!usable_) return false;
    const auto &l = ldlt_.matrixL().nestedExpression();
    double products = 0;
    for (int c = 0; c < l.outerSize(); ++c) {
      const double below = l.outerIndexPtr()[c + 1] - l.outerIndexPtr()[c];
      products += below * below;
    }
    worth_ = products / std::max(1.0, double(l.nonZeros()));
    return true;
  }

  bool usable() const { return usable_; }
  // About the number of back-substitutions that cost as much as another factorisation.
  double worth() const { return worth_; }
  const Face &face() const { return face_; }

  // z = E (S_FF + eps I)^-1 E^T r on `face`, with E the injection of F, and z = r on contacts new to it: symmetric
  // positive definite. r must be 0 outside `face`; z is to be read on `face` only.
  void apply(const Face &face, const Vector &r, Vector &z)
  {
    for (int k : face) z[k] = r[k];
    for (std::size_t a = 0; a < face_.size(); ++a) right_[a] = r[face_[a]];
    solution_ = ldlt_.solve(right_);
    for (std::size_t a = 0; a < face_.size(); ++a) z[face_[a]] = solution_[a];
  }

 private:
  Eigen::SparseMatrix<double> submatrix(const ScaledRows &s, double eps) const
  {
    std::vector<int> local(s.size(), -1);
    for (std::size_t a = 0; a < face_.size(); ++a) local[face_[a]] = int(a);
    std::vector<Eigen::Triplet<double>> lower;
    lower.reserve(face_.size() * 8);
    for (int a = 0; a < int(face_.size()); ++a) {
      lower.emplace_back(a, a, eps);
      for (auto e = s.w.row_start[face_[a]]; e < s.w.row_start[face_[a] + 1]; ++e) {
        const int other = local[s.w.column[e]];
        if (other >= 0 && other <= a) lower.emplace_back(a, other, s.value[e]);
      }
    }
    Eigen::SparseMatrix<double> matrix(face_.size(), face_.size());
    matrix.setFromTriplets(lower.begin(), lower.end());
    return matrix;
  }

  Face face_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::AMDOrdering<int>> ldlt_;
  Vector right_, solution_;
  double worth_ = 0;
  bool usable_ = false;
};

}    // namespace nscd
