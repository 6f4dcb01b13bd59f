// SPDX-License-Identifier: GPL-2.0-or-later
// A wall that moves: a shape that stands in a frame of its own, and that frame's course.
//
// Its velocities are those of a step: that of the shift is the mean over the step, so that a contact's gap is exact at
// its end; the rotation's are those of the moment, w x r, so that the surface of a drum moves along itself. What the
// rotation turns a normal by in the step is seen at the step's middle and end (scene/contact_geometry.cpp).
#pragma once

#include "obstacle/course.hpp"
#include "obstacle/obstacle.hpp"

namespace nscd {

class Moved final : public Obstacle {
 public:
  Moved(std::shared_ptr<const Obstacle> shape, std::shared_ptr<const Course> course, double time = 0);

  void find_near(std::span<const Sphere> spheres, double within, std::vector<std::int32_t> &found) const override;
  Touch at(const Vec4 &centre, double radius, int feature) const override;
  void touch(const Vec4 &centre, double radius, double within, std::vector<Touch> &found) const override;
  bool is_curved() const override { return shape_->is_curved() || course_->rotates; }
  bool has_two_sides() const override { return shape_->has_two_sides(); }
  // Where a point is by the shape's own words.
  Vec4 in_own_frame(const Vec4 &point) const;

  std::shared_ptr<const Obstacle> after(double time, double step) const override;
  Vec4 velocity_at(const Vec4 &point, const Touch &touch) const override;
  double fastest(const Vec4 &point, double near) const override;

  void require_planar(const std::string &name) const override;
  // What turns repeats where its axis lies along all directions in which the box is periodic, or where no grain at a
  // face of the box touches it.
  void require_repeats(const std::string &name, const BoxEdges &box) const override;

  const Vec4 &shift() const { return place_.shift; }
  const Vec4 &shift_rate() const { return rate_; }
  const Course &course() const { return *course_; }
  double time() const { return time_; }

 private:
  Vec4 turned(const Vec4 &vector, double sine) const;

  std::shared_ptr<const Obstacle> shape_;
  std::shared_ptr<const Course> course_;
  double time_;                                 // s, of the course
  Place place_;
  double cosine_, sine_;                        // of its angle
  alignas(vec4_alignment) Vec4 rate_{};         // m/s, mean of the shift over the step
  alignas(vec4_alignment) Vec4 rotation_{};     // rad/s, likewise
};

}    // namespace nscd
