// SPDX-License-Identifier: GPL-2.0-or-later
// Steps that are given up because nothing can give way: grains are not thrown.
//
// Where obstacles, a box or growing grains close in on grains that have nowhere to go, no impulses are a solution,
// those that sweeps find grow without end, and so can velocities. No grain of an island of such a step is left faster
// than what drives it: the fastest of its free grains, its obstacles and its drift. Its energy alone is no bound: given
// to one grain it makes that faster step by step. Where no obstacle takes part the island keeps its momentum.
#pragma once

#include "problem/islands.hpp"
#include "scene/state.hpp"

#include <span>
#include <vector>

namespace nscd {

class Calm {
 public:
  struct Found {
    bool jammed = false;   // obstacles or what drifts close in on grains, pushing far harder than that is worth
    double energy = 0;     // kinetic energy taken, J; of this rank
    std::span<const char> bodies{};   // (moving()) 1: in a jammed island; or empty. Until the next call
  };
  // Slows down the jammed islands of the first `count` contacts that are faster than that. Collective.
  Found slow_down(State &state, std::size_t count);

 private:
  struct Island {
    double drive = 0, closing = 0;   // m/s: of all that drives it, and of what is no grain
    int jam = -1;                    // its number, or none
    bool held = false;               // whether obstacles or walls take part
  };
  struct Jam {
    alignas(vec4_alignment) Vec4 motion{};   // momentum, N s; then the velocity that it keeps, m/s
    double mass = 0;                         // kg
    double fastest = 0;                      // m/s, of its grains beside that
  };
  void find_islands(const State &state, std::size_t count);
  void find_drives(const State &state, std::size_t count);
  void find_jams(const State &state, std::size_t count);
  void find_motions(const State &state);
  void find_fastest(const State &state);
  double slow_down(State &state);
  Island &of_contact(const State &state, const Contact &contact);

  Islands islands_;
  std::vector<Islands::Pair> joined_;
  std::vector<Island> of_;
  std::vector<Jam> jams_;
  std::vector<char> jammed_;   // bodies
};

}    // namespace nscd
