// SPDX-License-Identifier: GPL-2.0-or-later
// Keeps Newton's law of impact with friction, and frictional solves that were given up, from making energy.
//
// With e = e_t on all contacts the law takes energy, always (Leine & van de Wouw 2008): the impulses P and the
// velocities u+ + e u- obey P.(u+ + e u-) <= 0. With e != e_t, or contacts of different e, that bound is lost, and
// where one impact drives another contact the energy may rise (Kane & Levinson 1985). The inelastic solution (e = e_t =
// 0) always takes energy. Both solutions lie in the convex cone of friction, and so does every blend of the two; the
// work of the contacts is a quadratic function of the share. So a solution that would make energy is blended with the
// inelastic one until it makes none.
//
// An unsolved problem, given up after maxiter, can show any energy. It is blended with no impulses at all
// until the contacts raise the kinetic energy above that of the free motion no more: they give way, but throw nothing.
// What was accepted is solved on first: a blend would leave more overlap than an accepted answer may.
//
// All of it island by island (islands.hpp): what one makes no other pays for.
#pragma once

#include "problem/islands.hpp"
#include "scene/state.hpp"

#include <functional>

namespace nscd {

class EnergyLimit {
 public:
  // Velocities that the work of the contacts is counted from: those at the start of the step, or of the solve.
  enum class From { step, solve };

  // Solves for the first `count` contacts. `newton`: their biases hold restitutions that may make energy, so they may
  // be solved twice; they then start from no impulses, or `from` is the step. `gives_back`: their biases give overlaps
  // back, which may do work. `solver` returns whether it solved the problem, `go_on` too, from where that left it.
  // Returns whether the solution had to be blended.
  bool solve(State &state, std::size_t count, bool newton, From from, bool gives_back,
             const std::function<bool()> &solver, const std::function<bool()> &go_on);

 private:
  struct Motion {
    AlignedVector<Body> bodies;
    AlignedVector<Vec4> spins;
    std::vector<double> normal;         // impulses, N s
    AlignedVector<Vec4> tangential;
  };
  void store(const State &state, std::size_t count, Motion &motion) const;
  void load(State &state, const Motion &motion) const;
  void load_blend(State &state, std::size_t count) const;
  void find_islands(const State &state, std::size_t count);
  void find_work(const State &state, std::size_t count, const Motion *before, std::vector<double> &work);
  bool find_excess(State &state, std::size_t count, const Motion *before, bool gives_back = false);
  void blend(State &state, std::size_t count, const Motion *before, double of_limit);
  bool limit_restitution(State &state, std::size_t count, From from, const std::function<bool()> &solver);
  bool makes_energy(State &state, std::size_t count, bool gives_back);
  bool limit_unsolved(State &state, std::size_t count, bool gives_back, const std::function<bool()> &go_on);
  void allow_recovery(const State &state, std::size_t count);

  Motion before_, first_, second_;
  Islands islands_;
  std::vector<Islands::Pair> joined_;
  // One an island: shares of second_, and work, J: what is the solver's own error, and what first_, second_ and their
  // mean make.
  std::vector<double> share_, limit_, at_first_, at_second_, half_way_;
};

}    // namespace nscd
