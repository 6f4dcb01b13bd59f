// SPDX-License-Identifier: GPL-2.0-or-later
// Impulses and what they do, to come back to.
#pragma once

#include "problem/global_problem.hpp"
#include "problem/problem.hpp"

#include <algorithm>
#include <vector>

namespace nscd {

class IterateKept {
 public:
  void keep(const Problem &problem)
  {
    bodies_.assign(problem.bodies.begin(), problem.bodies.end());
    contacts_.assign(problem.contacts.begin(), problem.contacts.end());
    with_friction(problem.sliding.model, [&]<class M>(M) {
      const auto *const slides = problem.sliding.slides<M>();
      spins_.assign(problem.sliding.spins, problem.sliding.spins + problem.bodies.size());
      tangential_.clear();
      for (std::size_t k = 0; k < problem.contacts.size(); ++k)
        tangential_.push_back(M::in_space(problem.contacts[k].normal, slides[k].impulse));
    });
  }
  void restore(Problem &problem) const
  {
    std::copy(bodies_.begin(), bodies_.end(), problem.bodies.begin());
    std::copy(contacts_.begin(), contacts_.end(), problem.contacts.begin());
    std::copy(spins_.begin(), spins_.end(), problem.sliding.spins);
    with_friction(problem.sliding.model, [&]<class M>(M) {
      for (std::size_t k = 0; k < tangential_.size(); ++k)
        problem.sliding.slides<M>()[k].impulse = M::from_space(problem.contacts[k].normal, tangential_[k]);
    });
  }

  void keep(const GlobalProblem &problem) { impulses_.assign(problem.p.begin(), problem.p.end()); }
  void restore(GlobalProblem &problem) const { std::copy(impulses_.begin(), impulses_.end(), problem.p.begin()); }

 private:
  AlignedVector<Body> bodies_;
  AlignedVector<Vec4> spins_, tangential_;
  std::vector<Contact> contacts_;
  std::vector<double> impulses_;
};

}    // namespace nscd
