// SPDX-License-Identifier: GPL-2.0-or-later
// Momentum of bodies under sweeps (momentum.hpp).
#pragma once

#include "base/storage.hpp"
#include "parallel/chunks.hpp"
#include "problem/problem.hpp"
#include "solver/across_ranks.hpp"

#include <algorithm>
#include <cstddef>

namespace nscd {

// Moves vectors on by `share` of what they have moved since `last`, and puts them there.
void extrapolate_vectors(double share, const Range &range, Vec4 *vectors, Vec4 *last);

// Bodies and their spins, as they were at the start and as the last sweep left them, to extrapolate from.
//
// Round-off between them and the impulses grows by 1 / (1 - beta): `restore` gives bodies that carry their impulses.
class BodyMomentum {
 public:
  // `kept`: room for them.
  BodyMomentum(Problem &problem, AlignedVector<Vec4> &kept) :
      problem_(problem), kept_(kept), count_(problem.bodies.size())
  {
    kept.clear();
    for (int copies = 0; copies < 2; ++copies) {
      kept.insert(kept.end(), problem.bodies.begin(), problem.bodies.end());
      if (problem.sliding.spins) kept.insert(kept.end(), problem.sliding.spins, problem.sliding.spins + count_);
    }
  }

  void extrapolate(double share)
  {
    Vec4 *const last = kept_.data() + kept_each();
    in_chunks(problem_.team, count_, [&](const Range &range, int) {
      extrapolate_vectors(share, range, problem_.bodies.data(), last);
      if (problem_.sliding.spins) extrapolate_vectors(share, range, problem_.sliding.spins, last + count_);
    });
  }

  // add(k) hands contact k's bodies what it has gained since the start. The last sweep is moved along, or the next one
  // would take the correction for momentum.
  template <class Add>
  void restore(Add add)
  {
    const Vec4 *const first = kept_.data();
    move_last(-1);
    std::copy(first, first + count_, problem_.bodies.begin());
    if (problem_.sliding.spins) std::copy(first + count_, first + 2 * count_, problem_.sliding.spins);
    change_across(problem_.halo, problem_.bodies, problem_.sliding.spins, [&] {
      for (std::size_t k = 0; k < problem_.contacts.size(); ++k) add(k);
    });
    move_last(1);
  }

 private:
  // By the bodies' own velocities; the inverse masses come back.
  void move_last(double sign)
  {
    Vec4 *const last = kept_.data() + kept_each();
    for (std::size_t i = 0; i < count_; ++i) {
      last[i] += problem_.bodies[i] * sign;
      if (problem_.sliding.spins) last[count_ + i] += problem_.sliding.spins[i] * sign;
    }
  }

  std::size_t kept_each() const { return problem_.sliding.spins ? 2 * count_ : count_; }

  Problem &problem_;
  AlignedVector<Vec4> &kept_;
  const std::size_t count_;
};

}    // namespace nscd
