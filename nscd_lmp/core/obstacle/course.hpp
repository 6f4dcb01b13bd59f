// SPDX-License-Identifier: GPL-2.0-or-later
// How a wall moves: as one rigid body, by given functions of time.
//
//   x(t) = c + s(t) + R(a, angle(t)) (X - c),    X where the point is by the wall's own words, c and a of the rotation
//
// and how its surface runs, as a belt does, without taking the wall along.
#pragma once

#include "base/arguments.hpp"
#include "contact/sphere.hpp"

#include <optional>
#include <string>

namespace nscd {

// Where a wall has got to.
struct Place {
  alignas(vec4_alignment) Vec4 shift{};   // m
  double angle = 0;                       // rad
};

// Functions of a time (s) that counts from where the wall is defined.
class Course {
 public:
  virtual ~Course() = default;
  virtual Place at(double time) const = 0;
  virtual bool shifts_along_z() const = 0;

  alignas(vec4_alignment) Vec4 point{}, axis{0, 0, 1, 0};   // of the rotation: c (m) and a (unit)
  alignas(vec4_alignment) Vec4 belt{};                      // m/s, of its surface beside that
  bool rotates = false;
};

// `wiggle` and `shear` as LAMMPS' fix wall/gran has them, and `rotate`.
class GivenCourse final : public Course {
 public:
  // Takes a motion from the words, if one of these is next; raises Error for one that is given twice. `name`: "wall 2".
  bool read(Arguments &words, const std::string &name);
  bool is_given() const { return wiggles_ || shears_ || rotates; }
  Place at(double time) const override;
  bool shifts_along_z() const override { return amplitude_[2] != 0; }

 private:
  void read_wiggle(Arguments &words, const std::string &name);
  void read_shear(Arguments &words);
  void read_rotation(Arguments &words, const std::string &name);

  bool wiggles_ = false, shears_ = false;
  alignas(vec4_alignment) Vec4 amplitude_{};   // m
  double wiggle_rate_ = 0, rotation_rate_ = 0;   // rad/s
};

}    // namespace nscd
