// SPDX-License-Identifier: GPL-2.0-or-later
// The best impulses that sweeps with friction have met, for iterate().
#pragma once

#include "contact/carried_velocity.hpp"
#include "problem/global_problem.hpp"
#include "solver/across_ranks.hpp"

#include <cstddef>
#include <vector>

namespace nscd {

// On grains; M is Planar or Spatial.
template <class M>
class BestImpulses {
  using Tangent = typename M::Tangent;
  static constexpr std::size_t width = carried_doubles<Tangent>;

 public:
  static constexpr bool keeps = true;
  explicit BestImpulses(Problem &problem) : problem_(problem) {}

  void keep()
  {
    kept_.resize(count() * width);
    for (std::size_t k = 0; k < count(); ++k)
      store_carried<Tangent>(&kept_[k * width], {problem_.contacts[k].impulse, slide(k).impulse});
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
  auto &slide(std::size_t k) { return problem_.sliding.slides<M>()[k]; }
  void restore(std::size_t k)
  {
    Contact &c = problem_.contacts[k];
    const Split<Tangent> p = load_carried<Tangent>(&kept_[k * width]);
    apply_impulse(c, p.n - c.impulse, problem_.bodies.data());
    apply_tangential<M>(c, p.t - slide(k).impulse, problem_.sliding.spin_response, problem_.bodies.data(),
                        problem_.sliding.spins);
    c.impulse = p.n;
    slide(k).impulse = p.t;
  }

  Problem &problem_;
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
