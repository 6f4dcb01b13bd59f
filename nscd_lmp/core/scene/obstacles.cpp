// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/obstacles.hpp"

#include "settings/settings.hpp"

namespace nscd {

Obstacles::Obstacles(const Settings &settings) { change(settings, 0); }

void Obstacles::change(const Settings &settings, std::size_t kept)
{
  walls_.resize(kept);
  groups_.resize(kept);
  for (std::size_t k = kept; k < settings.walls.size(); ++k) {
    walls_.push_back(settings.walls[k].shape);
    groups_.push_back(settings.walls[k].groups);
  }
  sought_ = in_middle_ = at_end_ = walls_;
  moves_.assign(walls_.size(), 0);
}

void Obstacles::begin_step(double dt, double predicted, double moment)
{
  for (std::size_t k = 0; k < walls_.size(); ++k) {
    const auto later = [&](double time) {
      const auto moved = walls_[k]->after(time, dt);
      return moved ? moved : walls_[k];
    };
    at_end_[k] = later(dt);
    moves_[k] = at_end_[k] != walls_[k];
    sought_[k] = moves_[k] ? later(predicted) : walls_[k];
    in_middle_[k] = moves_[k] ? later(predicted + moment) : walls_[k];
  }
}

}    // namespace nscd
