// SPDX-License-Identifier: GPL-2.0-or-later
// The walls of a scene, as they lie in a step.
#pragma once

#include "obstacle/obstacle.hpp"

#include <cstddef>
#include <memory>
#include <vector>

namespace nscd {

struct Settings;

class Obstacles {
 public:
  Obstacles() = default;
  explicit Obstacles(const Settings &settings);

  int count() const { return int(walls_.size()); }
  // Where contacts are sought, when those that last act, and at the end of the step.
  const Obstacle &sought(int wall) const { return *sought_[std::size_t(wall)]; }
  const Obstacle &in_middle(int wall) const { return *in_middle_[std::size_t(wall)]; }
  const Obstacle &at_end(int wall) const { return *at_end_[std::size_t(wall)]; }
  bool moves(int wall) const { return moves_[std::size_t(wall)]; }
  // Bits of the groups whose grains it touches; 0: of all.
  int groups(int wall) const { return groups_[std::size_t(wall)]; }

  // Those of the settings, of which the first `kept` go on as they are.
  void change(const Settings &settings, std::size_t kept);

  // Of length dt; contacts are sought `predicted` after its start, and those that last act `moment` later, s.
  void begin_step(double dt, double predicted, double moment);
  // It has been taken: the next one starts from its end.
  void end_step() { walls_ = at_end_; }

 private:
  using Walls = std::vector<std::shared_ptr<const Obstacle>>;
  Walls walls_{}, sought_{}, in_middle_{}, at_end_{};
  std::vector<char> moves_{};
  std::vector<int> groups_{};
};

}    // namespace nscd
