// SPDX-License-Identifier: GPL-2.0-or-later
// Islands: grains that are connected through contacts that push. What happens in one has nothing to do with another, so
// whatever is judged or corrected is judged or corrected island by island, never over the whole scene.
// On several ranks all islands that reach across ranks count as one.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace nscd {

class Halo;

class Islands {
 public:
  struct Pair {
    std::int32_t i, j;
    bool connects() const { return true; }
  };
  // What is summed up over an island.
  using Sums = std::array<double, 2>;

  // Pairs connect the bodies .i and .j, two grains, if .connects(); obstacles connect nothing and are in no pair. On
  // several ranks number 0 is what reaches across ranks.
  template <class Pairs>
  void find(std::size_t bodies, const Pairs &pairs, const Halo *halo)
  {
    begin(bodies);
    for (const auto &pair : pairs)
      if (pair.connects()) connect(pair.i, pair.j);
    number(halo);
  }

  // So that finding islands of so many bodies allocates nothing.
  void reserve(std::size_t bodies)
  {
    parent_.reserve(bodies);
    number_.reserve(bodies);
    sums_.reserve(bodies);
  }

  int count() const { return count_; }
  // The island of a grain.
  int of(int body) const { return number_[body]; }

  void clear_sums() { sums_.assign(count_, {}); }
  Sums &sum(int island) { return sums_[island]; }
  void add(int body, const Sums &more)
  {
    Sums &sum = sums_[number_[body]];
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += more[k];
  }

 private:
  void begin(std::size_t bodies);
  void number(const Halo *halo);
  int root(int body)
  {
    while (parent_[body] != body) body = parent_[body] = parent_[parent_[body]];
    return body;
  }
  // The lower index is the root: the result does not depend on the order of pairs.
  void connect(int a, int b)
  {
    a = root(a), b = root(b);
    if (a > b) std::swap(a, b);
    parent_[b] = a;
  }

  std::vector<std::int32_t> parent_, number_;   // (bodies)
  std::vector<Sums> sums_;                      // (count)
  int count_ = 0;
};

}    // namespace nscd
