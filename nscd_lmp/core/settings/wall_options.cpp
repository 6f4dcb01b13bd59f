// SPDX-License-Identifier: GPL-2.0-or-later
#include "settings/wall_options.hpp"

#include "obstacle/moved.hpp"

namespace nscd {

bool WallOptions::read(Arguments &words) { return read_own_part(own_, words) || course_.read(words, name_); }

Wall WallOptions::wall(std::shared_ptr<const Obstacle> shape, double time) const
{
  if (moves()) shape = std::make_shared<Moved>(std::move(shape), std::make_shared<GivenCourse>(course_), time);
  return {.shape = std::move(shape), .own = own_, .name = name_};
}

}    // namespace nscd
