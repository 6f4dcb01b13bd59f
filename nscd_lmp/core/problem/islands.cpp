// SPDX-License-Identifier: GPL-2.0-or-later
#include "problem/islands.hpp"

#include "parallel/halo.hpp"

#include <numeric>

namespace nscd {

void Islands::begin(std::size_t bodies)
{
  reserve(bodies);
  parent_.resize(bodies);
  std::iota(parent_.begin(), parent_.end(), 0);
}

void Islands::number(const Halo *halo)
{
  number_.assign(parent_.size(), -1);
  count_ = 0;
  if (halo) {
    halo->for_each_shared([this](int body) { number_[root(body)] = 0; });
    count_ = 1;
  }
  // A root comes before all others of its island.
  for (std::size_t body = 0; body < parent_.size(); ++body) {
    const int at = root(int(body));
    if (number_[at] < 0) number_[at] = count_++;
    number_[body] = number_[at];
  }
}

}    // namespace nscd
