// SPDX-License-Identifier: GPL-2.0-or-later
// The contact problem of all contacts at once, by its Delassus matrix: find p with u = W p + q and
//   0 <= u_n _|_ p_n >= 0,  |p_t| <= mu p_n,  p_t = -mu p_n u_t / |u_t| where u_t != 0.
//
// Whoever has no bodies (nscd_lmp.solve on a matrix) poses it directly; solvers that look at all contacts at once get
// it made from the bodies (delassus.hpp). Vectors are laid out contact by contact, N, T1[, T2].
#pragma once

#include "contact/majorant.hpp"
#include "contact/material.hpp"
#include "problem/block_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace nscd {

struct GlobalProblem {
  const BlockMatrix &w;            // 1/kg
  std::span<const double> q;       // (n, dim) velocities without impulses, biases included, m/s
  std::span<const double> mu;      // (n, discs) coefficients, infinite for stick; empty if dim = 1
  std::span<double> p;             // (n, dim) in: start impulses; out: solution, N s
  MaterialsOf restitution{};       // (n) that q contains: scales v in the criterion, as in Problem; or empty
  std::vector<Diagonal> diagonals{};  // (n), by find_diagonals()
  std::span<const double> per_approach{};   // (n) as Problem has it, or empty: any

  int dim() const { return w.dim; }
  std::size_t contacts() const { return w.rows(); }
  // Whether a disc of the contact is infinite.
  bool sticks(std::size_t k) const
  {
    const std::size_t discs = mu.size() / contacts();
    return std::ranges::any_of(mu.subspan(k * discs, discs), [](double x) { return std::isinf(x); });
  }
};

// F is the frame of the contacts.
template <class F>
void find_diagonals(GlobalProblem &problem)
{
  problem.diagonals.assign(problem.contacts(), {});
  for (std::size_t k = 0; k < problem.contacts(); ++k)
    if (const double *block = problem.w.diagonal(k)) problem.diagonals[k] = majorant<F>(block);
}

// What a visit of contact k takes.
template <class F>
OwnBlock<typename F::Tangent> own_block(const GlobalProblem &problem, std::size_t k)
{
  return own_block<F>(problem.diagonals[k], problem.mu.data() + k * F::discs);
}

// ||q||_2 of the contacts that an impulse can move, m/s.
double free_norm(const GlobalProblem &problem);

}    // namespace nscd
