// Belts: obstacles that have a velocity and stay where they are, as scripts make conveyors of atoms that nothing moves.
// All other obstacles with a velocity have moved by it when a step begins.
#pragma once

#include "state.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace nscd {

class Belts {
 public:
  // Remembers where obstacles are: at a run's start, and at the end of every step.
  void see(const Grains &grains);
  // Fills state.ways for this rank's atoms. Obstacles that were not seen, since they came from elsewhere, are taken to
  // have moved. Empty if no obstacle has a velocity.
  void find(State &state) const;

 private:
  struct Seen {
    std::int32_t tag;
    std::array<double, 3> x;
  };
  std::vector<Seen> seen_;   // sorted by tag; those with a velocity
};

}    // namespace nscd
