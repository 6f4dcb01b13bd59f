// SPDX-License-Identifier: GPL-2.0-or-later
// The best impulses that sweeps with friction have met, for iterate().
#pragma once

#include "contact/carried_velocity.hpp"
#include "problem/global_problem.hpp"
#include "solver/across_ranks.hpp"

#include <cstddef>
#include <vector>

namespace nscd {

// On grains.
template <class M>
class BestImpulses {
  using Tangent = typename M::Tangent;
  using Vector = typename M::Vector;
  static constexpr std::size_t width = carried_doubles<Tangent>;

 public:
  static constexpr bool keeps = true;
  BestImpulses(Problem &problem, const M &mechanics) : problem_(problem), mechanics_(mechanics) {}

  void keep()
  {
    kept_.resize(count() * width);
    for (std::size_t k = 0; k < count(); ++k)
      store_carried<Tangent>(&kept_[k * width], mechanics_.impulse(problem_.contacts[k], k));
  }

  // Bodies get what the impulses change by.
  void restore()
  {
    change_across(problem_.halo, problem_.bodies, problem_.sliding.spins, [this] {
      for (std::size_t k = 0; k < count(); ++k) restore(k);
    });
  }

 private:
  std::size_t count() const { return problem_.contacts.size(); }
  void restore(std::size_t k)
  {
    Contact &c = problem_.contacts[k];
    const Vector p = load_carried<Tangent>(&kept_[k * width]), now = mechanics_.impulse(c, k);
    mechanics_.push(c, k, {p.n - now.n, p.t - now.t});
    mechanics_.set_impulse(c, k, p);
  }

  Problem &problem_;
  const M &mechanics_;
  std::vector<double> &kept_ = problem_.workspace.best;
};

// On a matrix.
class BestMatrixImpulses {
 public:
  static constexpr bool keeps = true;
  explicit BestMatrixImpulses(GlobalProblem &problem) : problem_(problem) {}
  void keep() { kept_.assign(problem_.p.begin(), problem_.p.end()); }
  void restore() { std::copy(kept_.begin(), kept_.end(), problem_.p.begin()); }

 private:
  GlobalProblem &problem_;
  std::vector<double> kept_;
};

}    // namespace nscd
