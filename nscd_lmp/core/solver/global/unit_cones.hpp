// SPDX-License-Identifier: GPL-2.0-or-later
// A contact problem scaled so that Coulomb's cones are all unit ones: p_n = x_0 r / m, p_d = x_d r mu_d / m for each of
// the contact's discs, with m its largest coefficient and r = W_nn^-1/2.
//
// Where no disc rubs, the half line x_0 >= 0 is left; a contact that no impulse moves (no W_nn > 0) is left out.
#pragma once

#include "problem/global_problem.hpp"
#include "solver/global/cone.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace nscd {

// The part of a contact's unknowns whose length x_0 bounds; without axes, that of a half line.
struct Tail {
  int first = 1, axes = 0;
  bool sticks = false;  // however weakly the contact pushes
};

// `most` unknowns a contact at most.
template <int most>
class UnitCones {
 public:
  using Vector = Eigen::Matrix<double, most, 1>;
  using Matrix = Eigen::Matrix<double, most, most>;
  using Vectors = std::vector<Vector>;
  struct Block {
    int column;  // among the contacts kept
    Matrix value;
  };

  // `groups`: rows of a contact by what they belong to, as Frame has them.
  UnitCones(const GlobalProblem &problem, std::span<const int> groups) : dim_(problem.dim())
  {
    std::vector<int> place(problem.contacts(), -1);
    for (std::size_t k = 0; k < problem.contacts(); ++k) {
      const double *own = problem.w.diagonal(k);
      if (!own || !(own[0] > 0)) continue;
      place[k] = size();
      add_contact(problem, k, groups, 1 / std::sqrt(own[0]));
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

  // The cones of a contact, of all contacts one after another: one at least.
  std::span<const Tail> tails(int k) const
  {
    return {tails_.data() + tail_start_[k], tail_start_[k + 1] - tail_start_[k]};
  }
  std::size_t cone(int k) const { return tail_start_[k]; }
  std::size_t cones() const { return tails_.size(); }

  // The contact's own block.
  const Matrix &own(int k) const { return own_[k]; }

  // f(block) for all blocks of a row.
  template <class Function>
  void each(int k, Function f) const
  {
    for (std::size_t e = row_start_[k]; e < row_start_[k + 1]; ++e) f(blocks_[e]);
  }

  // W x
  Vectors responses(const Vectors &x) const
  {
    Vectors u = zero();
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
    for (const Vector &q : q_) sum += q.template lpNorm<1>();
    return sum / std::max(1, unknowns());
  }

  Vectors zero() const { return Vectors(size(), Vector::Zero()); }

  Vectors from_impulses(const double *p) const
  {
    Vectors x = zero();
    for (int k = 0; k < size(); ++k)
      for (int a = 0; a < width(k); ++a) x[k][a] = p[contact_[k] * dim_ + row(k, a)] / unit(k, a);
    return x;
  }

  std::vector<double> impulses(const Vectors &x, std::size_t contacts) const
  {
    std::vector<double> p(contacts * dim_, 0.0);
    for (int k = 0; k < size(); ++k)
      for (int a = 0; a < width(k); ++a) p[contact_[k] * dim_ + row(k, a)] = unit(k, a) * x[k][a];
    return p;
  }

 private:
  // Coefficients that are as good as none or as stick: their squares, times W, must neither overflow nor vanish.
  // Infinite friction gets a cone that is wide and not yet flat.
  static constexpr double none = 1e-12, widest = 1e4, for_infinite = 30;

  // An unknown: a row of the contact in the problem, and its unit.
  struct Unknown {
    int row;
    double unit;
  };

  static double coefficient(double mu) { return std::isinf(mu) ? for_infinite : std::min(mu, widest); }

  void add_contact(const GlobalProblem &problem, std::size_t k, std::span<const int> groups, double root)
  {
    const std::size_t discs = groups.size() - 1;
    const double *mu = problem.mu.data() + k * discs;
    double largest = 0;
    for (std::size_t d = 0; d < discs; ++d) largest = std::max(largest, coefficient(mu[d]));
    const bool rubs = largest > none;
    unknowns_.push_back({0, rubs ? root / largest : root});
    for (std::size_t d = 0, row = 1; d < discs; row += std::size_t(groups[++d])) {
      if (!(coefficient(mu[d]) > none)) continue;
      tails_.push_back({int(unknowns_.size()) - first_.back(), groups[d + 1], std::isinf(mu[d])});
      for (int a = 0; a < groups[d + 1]; ++a)
        unknowns_.push_back({int(row) + a, root * (coefficient(mu[d]) / largest)});
    }
    if (!rubs) tails_.push_back({});
    tail_start_.push_back(tails_.size());
    contact_.push_back(k);
    first_.push_back(int(unknowns_.size()));
    q_.push_back(Vector::Zero());
    const int added = size() - 1;
    for (int a = 0; a < width(added); ++a) q_.back()[a] = unit(added, a) * problem.q[k * dim_ + row(added, a)];
  }

  int row(int k, int a) const { return unknowns_[first_[k] + a].row; }
  double unit(int k, int a) const { return unknowns_[first_[k] + a].unit; }

  Matrix scaled(int k, int j, const double *block) const
  {
    Matrix m = Matrix::Zero();
    for (int a = 0; a < width(k); ++a)
      for (int b = 0; b < width(j); ++b) m(a, b) = unit(k, a) * unit(j, b) * block[dim_ * row(k, a) + row(j, b)];
    return m;
  }

  const int dim_;
  std::vector<std::size_t> contact_;  // of the problem
  std::vector<int> first_{0};
  std::vector<Unknown> unknowns_;
  std::vector<std::size_t> tail_start_{0};
  std::vector<Tail> tails_;
  Vectors q_;
  std::vector<Matrix> own_;
  std::vector<std::size_t> row_start_{0};
  std::vector<Block> blocks_;
};

// The cone in a contact's vector, and the way back.
template <int most>
cone::Vector in_cone(const Eigen::Matrix<double, most, 1> &x, const Tail &tail)
{
  cone::Vector c(x[0], 0, 0);
  for (int a = 0; a < tail.axes; ++a) c[1 + a] = x[tail.first + a];
  return c;
}

template <int most>
void add_cone(Eigen::Matrix<double, most, 1> &x, const Tail &tail, const cone::Vector &c)
{
  x[0] += c[0];
  for (int a = 0; a < tail.axes; ++a) x[tail.first + a] += c[1 + a];
}

}    // namespace nscd
