// SPDX-License-Identifier: GPL-2.0-or-later
// Bounds a contact's own block of W by a diagonal that has one number for the normal and one for each disc: what local
// laws take. Where the block is no such diagonal, a visit repeats itself against the block (matrix_nlgs.hpp, nlgs.hpp).
#pragma once

#include "contact/frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace nscd {

constexpr std::size_t most_discs = 3;

// diag(w, wt[0], ...) >= the block, equal for spheres and discs that only slide.
struct Diagonal {
  double w = 0;                          // 1/kg; 0: nothing that an impulse could move
  std::array<double, most_discs> wt{};
  bool exact = true;                     // whether it is the block
};

// Gershgorin's bound, by groups of rows that the frame's directions do not tell apart: diagonal - block is positive
// semidefinite.
template <class F>
Diagonal majorant(const double *block)
{
  static_assert(F::discs <= most_discs, "a contact has three parts beside its normal one at most");
  const auto at = [&](int i, int j) { return 0.5 * (block[F::dim * i + j] + block[F::dim * j + i]); };
  std::array<double, F::discs + 1> own{}, coupling{};
  bool isotropic = true;
  int first = 0;
  for (std::size_t g = 0; g <= F::discs; first += F::groups[g++]) {
    own[g] = at(first, first);
    if (F::groups[g] > 1) {
      const double half = 0.5 * (at(first, first) - at(first + 1, first + 1));
      const double mean = 0.5 * (at(first, first) + at(first + 1, first + 1));
      const double radius = std::hypot(half, at(first, first + 1));
      own[g] = mean + radius;
      isotropic &= radius <= 1e-14 * mean;
    }
    int other = first + F::groups[g];
    for (std::size_t h = g + 1; h <= F::discs; other += F::groups[h++]) {
      double between = 0;
      for (int i = first; i < first + F::groups[g]; ++i)
        for (int j = other; j < other + F::groups[h]; ++j) between = std::hypot(between, at(i, j));
      coupling[g] += between;
      coupling[h] += between;
    }
  }
  Diagonal d{block[0], {}, isotropic};
  for (const double c : coupling) d.exact &= c <= 1e-14 * d.w;
  if (!d.exact)
    for (std::size_t g = 0; g <= F::discs; ++g) own[g] += coupling[g];
  d.w = own[0];
  std::copy(own.begin() + 1, own.end(), d.wt.begin());
  return d;
}

// Its number for a row of the frame.
template <class F>
double bound_of_row(const Diagonal &d, int row)
{
  std::size_t group = 0;
  for (int first = F::groups[0]; row >= first; first += F::groups[group]) ++group;
  return group == 0 ? d.w : d.wt[group - 1];
}

// As a visit takes it.
template <class F>
OwnBlock<typename F::Tangent> own_block(const Diagonal &d, const double *mu)
{
  OwnBlock<typename F::Tangent> own{d.w, 1 / d.w, {}};
  for (std::size_t disc = 0; disc < F::discs; ++disc)
    own.discs[disc] = {d.wt[disc], 1 / d.wt[disc], d.wt[disc] / d.w, mu[disc]};
  return own;
}

}    // namespace nscd
