// SPDX-License-Identifier: GPL-2.0-or-later
// What stands behind a wall's kind and its numbers: what its contacts have of their own, and how it moves.
#pragma once

#include "base/arguments.hpp"
#include "obstacle/course.hpp"
#include "settings/settings.hpp"

#include <memory>
#include <string>

namespace nscd {

class WallOptions {
 public:
  // What messages call the wall.
  explicit WallOptions(std::string name) : name_(std::move(name)) {}

  // Takes the next of them; returns false if the next word is none of them. Raises Error for bad values.
  bool read(Arguments &words);
  bool moves() const { return course_.is_given(); }
  // Null if it stands.
  const Course *course() const { return moves() ? &course_ : nullptr; }
  const OwnMaterial &own() const { return own_; }

  // Of that shape; `time` (s) since its motion began.
  Wall wall(std::shared_ptr<const Obstacle> shape, double time = 0) const;

 private:
  std::string name_;
  OwnMaterial own_;
  GivenCourse course_;
};

}    // namespace nscd
