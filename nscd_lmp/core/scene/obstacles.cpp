// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/obstacles.hpp"

#include "settings/settings.hpp"

namespace nscd {

Obstacles::Obstacles(const Settings &settings)
{
  for (const Wall &wall : settings.walls) walls_.push_back(wall.shape);
  sought_ = at_end_ = walls_;
  moves_.assign(walls_.size(), 0);
}

void Obstacles::begin_step(double dt, double predicted)
{
  const auto later = [](const std::shared_ptr<const Obstacle> &wall, double time) {
    const auto moved = wall->after(time);
    return moved ? moved : wall;
  };
  for (std::size_t k = 0; k < walls_.size(); ++k) {
    at_end_[k] = later(walls_[k], dt);
    moves_[k] = at_end_[k] != walls_[k];
    sought_[k] = moves_[k] ? later(walls_[k], predicted) : walls_[k];
  }
}

}    // namespace nscd
