// SPDX-License-Identifier: GPL-2.0-or-later
// Impulses and what they do, to come back to.
#pragma once

#include "contact/carried_velocity.hpp"
#include "problem/global_problem.hpp"
#include "problem/problem.hpp"

#include <algorithm>
#include <vector>

namespace nscd {

class IterateKept {
 public:
  template <class M>
  void keep(const Problem &problem, const M &mechanics)
  {
    constexpr std::size_t width = carried_doubles<typename M::Tangent>;
    bodies_.assign(problem.bodies.begin(), problem.bodies.end());
    if (problem.sliding.spins) spins_.assign(problem.sliding.spins, problem.sliding.spins + problem.bodies.size());
    impulses_.resize(problem.contacts.size() * width);
    for (std::size_t k = 0; k < problem.contacts.size(); ++k)
      store_carried<typename M::Tangent>(&impulses_[k * width], mechanics.impulse(problem.contacts[k], k));
  }
  template <class M>
  void restore(Problem &problem, const M &mechanics) const
  {
    constexpr std::size_t width = carried_doubles<typename M::Tangent>;
    std::copy(bodies_.begin(), bodies_.end(), problem.bodies.begin());
    std::copy(spins_.begin(), spins_.end(), problem.sliding.spins);
    for (std::size_t k = 0; k < problem.contacts.size(); ++k)
      mechanics.set_impulse(problem.contacts[k], k, load_carried<typename M::Tangent>(&impulses_[k * width]));
  }

  template <class F>
  void keep(const GlobalProblem &problem, const F &)
  {
    impulses_.assign(problem.p.begin(), problem.p.end());
  }
  template <class F>
  void restore(GlobalProblem &problem, const F &) const
  {
    std::copy(impulses_.begin(), impulses_.end(), problem.p.begin());
  }

 private:
  AlignedVector<Body> bodies_;
  AlignedVector<Vec4> spins_;
  std::vector<double> impulses_;
};

}    // namespace nscd
