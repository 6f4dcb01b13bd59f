// SPDX-License-Identifier: GPL-2.0-or-later
// The own blocks of contacts whose parts W couples, or whose bodies are no spheres, each bounded by a diagonal.
#pragma once

#include "contact/majorant.hpp"
#include "contact/tangents.hpp"
#include "problem/problem.hpp"

#include <array>
#include <vector>

namespace nscd {

template <class M>
std::vector<typename M::Own> own_blocks(const Problem &problem, const M &mechanics)
{
  using F = typename M::Frame;
  std::vector<typename M::Own> all;
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    const Contact &c = problem.contacts[k];
    const Axes axes(c.normal);
    const auto pair = mechanics.load(c, k);
    std::array<typename M::Wrench, F::dim> unit;
    for (int a = 0; a < F::dim; ++a) {
      double along[F::dim] = {};
      along[a] = 1;
      unit[a] = mechanics.wrench(c, k, pair, axes.template vector<typename M::Tangent>(along));
    }
    double block[F::dim * F::dim];
    for (int a = 0; a < F::dim; ++a)
      for (int b = 0; b < F::dim; ++b)
        block[F::dim * a + b] = mechanics.dynamics().inner(c.i, unit[a], true, unit[b], true) +
            mechanics.dynamics().inner(c.j, unit[a], false, unit[b], false);
    std::vector<double> mu;
    mechanics.each_coefficient(k, [&](double coefficient) { mu.push_back(coefficient); });
    all.push_back(own_block<F>(majorant<F>(block), mu.data()));
  }
  return all;
}

}    // namespace nscd
