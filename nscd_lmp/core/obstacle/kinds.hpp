// SPDX-License-Identifier: GPL-2.0-or-later
// The one list of kinds of walls, keyword `wall KIND ...`.
#pragma once

#include "base/arguments.hpp"
#include "obstacle/obstacle.hpp"

#include <memory>
#include <string_view>
#include <vector>

namespace nscd {

struct ObstacleEntry {
  int order;
  std::string_view name;
  std::string_view words;   // those behind the name, as the docs have them
  std::string_view doc;     // what they are
  // Takes the words; raises Error for what is no such wall. `name` is "wall 2".
  std::shared_ptr<const Obstacle> (*read)(Arguments &words, const std::string &name);
};

const std::vector<ObstacleEntry> &obstacle_kinds();
const ObstacleEntry &find_obstacle_kind(std::string_view name);    // Raises Error naming the choices.

struct RegisterObstacle {
  explicit RegisterObstacle(const ObstacleEntry &entry);
};

}    // namespace nscd
