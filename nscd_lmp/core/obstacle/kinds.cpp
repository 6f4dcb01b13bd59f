// SPDX-License-Identifier: GPL-2.0-or-later
#include "obstacle/kinds.hpp"

#include "base/registry.hpp"

namespace nscd {

static Registry<ObstacleEntry> &registry()
{
  static Registry<ObstacleEntry> list;
  return list;
}

RegisterObstacle::RegisterObstacle(const ObstacleEntry &entry) { registry().add(entry); }

const std::vector<ObstacleEntry> &obstacle_kinds() { return registry().entries(); }

const ObstacleEntry &find_obstacle_kind(std::string_view name) { return registry().find("wall", name); }

}    // namespace nscd
