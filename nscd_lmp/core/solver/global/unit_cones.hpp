// SPDX-License-Identifier: GPL-2.0-or-later
// A contact problem scaled so that Coulomb's cones are all the unit one: p_n = x_0 r / mu, p_t = x_t r, r = W_nn^-1/2.
//
// Without friction the half line x_0 >= 0 is left; a contact that no impulse moves (no W_nn > 0) is left out.
#pragma once

#include "problem/global_problem.hpp"
#include "solver/global/cone.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace nscd {

class UnitCones {
 public:
  using Vectors = std::vector<cone::Vector>;
  struct Block {
    int column;  // among the contacts kept
    cone::Matrix value;
  };

  explicit UnitCones(const GlobalProblem &problem) : dim_(problem.dim())
  {
    std::vector<int> place(problem.contacts(), -1);
    for (std::size_t k = 0; k < problem.contacts(); ++k) {
      const double *own = problem.w.diagonal(k);
      if (!own || !(own[0] > 0)) continue;
      place[k] = size();
      add_contact(problem, k, 1 / std::sqrt(own[0]));
    }
    for (int k = 0; k < size(); ++k) {
      const auto row = contact_[k];
      for (auto at = problem.w.row_start[row]; at < problem.w.row_start[row + 1]; ++at)
        if (const int j = place[problem.w.column[at]]; j >= 0)
          blocks_.push_back({j, scaled(k, j, &problem.w.block[std::size_t(at) * dim_ * dim_])});
      own_.push_back(scaled(k, k, problem.w.diagonal(row)));
      row_start_.push_back(blocks_.size());
    }
  }

  int size() const { return int(contact_.size()); }
  // Where the unknowns of a contact begin, and how many they are: 1 without friction.
  int first(int k) const { return first_[k]; }
  int width(int k) const { return first_[k + 1] - first_[k]; }
  int unknowns() const { return first_.back(); }

  // Whether the contact cannot slip however weakly it pushes.
  bool sticks(int k) const { return sticks_[k]; }
  // The contact's own block.
  const cone::Matrix &own(int k) const { return own_[k]; }

  // f(block) for all blocks of a row.
  template <class Function>
  void each(int k, Function f) const
  {
    for (std::size_t e = row_start_[k]; e < row_start_[k + 1]; ++e) f(blocks_[e]);
  }

  // W x
  Vectors responses(const Vectors &x) const
  {
    Vectors u(size(), cone::Vector::Zero());
    for (int k = 0; k < size(); ++k)
      each(k, [&](const Block &block) { u[k].noalias() += block.value * x[block.column]; });
    return u;
  }

  // W x + q
  Vectors velocities(const Vectors &x) const
  {
    Vectors u = responses(x);
    for (int k = 0; k < size(); ++k) u[k] += q_[k];
    return u;
  }

  // What velocities are measured against: the mean |q|.
  double speed() const
  {
    double sum = 0;
    for (const cone::Vector &q : q_) sum += q.lpNorm<1>();
    return sum / std::max(1, unknowns());
  }

  Vectors from_impulses(const double *p) const
  {
    Vectors x(size(), cone::Vector::Zero());
    for (int k = 0; k < size(); ++k)
      for (int a = 0; a < width(k); ++a) x[k][a] = p[contact_[k] * dim_ + a] / unit_[k][a];
    return x;
  }

  std::vector<double> impulses(const Vectors &x, std::size_t contacts) const
  {
    std::vector<double> p(contacts * dim_, 0.0);
    for (int k = 0; k < size(); ++k)
      for (int a = 0; a < width(k); ++a) p[contact_[k] * dim_ + a] = unit_[k][a] * x[k][a];
    return p;
  }

 private:
  // Coefficients that are as good as none or as stick: their squares, times W, must neither overflow nor vanish.
  // Infinite friction gets a cone that is wide and not yet flat.
  static constexpr double none = 1e-12, most = 1e4, for_infinite = 30;

  void add_contact(const GlobalProblem &problem, std::size_t k, double root)
  {
    const bool sticks = std::isinf(problem.friction(k));
    const double mu = sticks ? for_infinite : std::min(problem.friction(k), most);
    const bool rubs = mu > none;
    contact_.push_back(k);
    sticks_.push_back(sticks);
    first_.push_back(first_.back() + (rubs ? dim_ : 1));
    unit_.emplace_back(rubs ? root / mu : root, root, root);
    q_.push_back(cone::Vector::Zero());
    for (int a = 0; a < width(size() - 1); ++a) q_.back()[a] = unit_.back()[a] * problem.q[k * dim_ + a];
  }

  cone::Matrix scaled(int k, int j, const double *block) const
  {
    cone::Matrix m = cone::Matrix::Zero();
    for (int a = 0; a < width(k); ++a)
      for (int b = 0; b < width(j); ++b) m(a, b) = unit_[k][a] * unit_[j][b] * block[dim_ * a + b];
    return m;
  }

  const int dim_;
  std::vector<std::size_t> contact_;  // of the problem
  std::vector<int> first_{0};
  std::vector<bool> sticks_;
  Vectors unit_, q_;
  std::vector<cone::Matrix> own_;
  std::vector<std::size_t> row_start_{0};
  std::vector<Block> blocks_;
};

}    // namespace nscd
