// SPDX-License-Identifier: GPL-2.0-or-later
// What stands behind a wall's kind and its numbers: what its contacts have of their own, and how it moves.
#pragma once

#include "base/arguments.hpp"
#include "obstacle/course.hpp"
#include "settings/settings.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace nscd {

class WallOptions {
 public:
  static constexpr std::string_view doc =
      "*wiggle* dim A T: to and fro by A (1 - cos(2 pi t/T)) along *x*, *y* or *z*; *shear* dim V: its surface runs "
      "along itself, as a belt's; *rotate* T x y z ax ay az: about an axis through a point, once in a time T";

  // What messages call the wall.
  explicit WallOptions(std::string name) : name_(std::move(name)) {}

  // Takes the next of them; returns false if the next word is none of them. Raises Error for bad values.
  bool read(Arguments &words);
  bool moves() const { return course_.is_given(); }
  const OwnMaterial &own() const { return own_; }

  // Of that shape; `time` (s) since its motion began.
  Wall wall(std::shared_ptr<const Obstacle> shape, double time = 0) const;

 private:
  std::string name_;
  OwnMaterial own_;
  GivenCourse course_;
};

}    // namespace nscd
