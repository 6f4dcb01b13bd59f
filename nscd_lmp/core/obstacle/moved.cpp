// SPDX-License-Identifier: GPL-2.0-or-later
#include "obstacle/moved.hpp"

#include "base/error.hpp"
#include "contact/space.hpp"
#include "obstacle/repeats.hpp"

#include <cmath>

namespace nscd {

Moved::Moved(std::shared_ptr<const Obstacle> shape, std::shared_ptr<const Course> course, double time) :
    shape_(std::move(shape)), course_(std::move(course)), time_(time), place_(course_->at(time)),
    cosine_(std::cos(place_.angle)), sine_(std::sin(place_.angle))
{
}

// About the axis, by the angle whose sine is +- sine_.
Vec4 Moved::turned(const Vec4 &vector, double sine) const
{
  if (!course_->rotates) return vector;
  const Vec4 along = course_->axis * dot(course_->axis, vector), across = vector - along;
  return along + across * cosine_ + cross(course_->axis, across) * sine;
}

Vec4 Moved::in_own_frame(const Vec4 &point) const
{
  return course_->point + turned(point - course_->point - place_.shift, -sine_);
}

void Moved::find_near(std::span<const Sphere> spheres, double within, std::vector<std::int32_t> &found) const
{
  static thread_local std::vector<Sphere> own;   // kept, since it is as long as all grains
  own.assign(spheres.begin(), spheres.end());
  for (Sphere &sphere : own) sphere.centre = in_own_frame(sphere.centre);
  shape_->find_near(own, within, found);
}

Touch Moved::at(const Vec4 &centre, double radius, int feature) const
{
  Touch touch = shape_->at(in_own_frame(centre), radius, feature);
  touch.normal = turned(touch.normal, sine_);
  return touch;
}

void Moved::touch(const Vec4 &centre, double radius, double within, std::vector<Touch> &found) const
{
  const std::size_t before = found.size();
  shape_->touch(in_own_frame(centre), radius, within, found);
  for (std::size_t k = before; k < found.size(); ++k) found[k].normal = turned(found[k].normal, sine_);
}

std::shared_ptr<const Obstacle> Moved::after(double time, double step) const
{
  auto later = std::make_shared<Moved>(shape_, course_, time_ + time);
  const Place begins = place_, ends = course_->at(time_ + step);
  later->rate_ = (ends.shift - begins.shift) / step;
  later->rotation_ = course_->axis * ((ends.angle - begins.angle) / step);
  return later;
}

Vec4 Moved::velocity_at(const Vec4 &point, const Touch &touch) const
{
  const Vec4 belt = course_->belt - touch.normal * dot(touch.normal, course_->belt);
  return rate_ + cross(rotation_, point - course_->point - place_.shift) + belt;
}

double Moved::fastest(const Vec4 &point, double near) const
{
  const double rotation = length(rotation_);
  if (rotation == 0) return length(rate_);
  const Vec4 from = point - course_->point - place_.shift;
  const double from_axis = length(from - course_->axis * dot(course_->axis, from));
  return length(rate_) + rotation * (from_axis + near);
}

void Moved::require_planar(const std::string &name) const
{
  shape_->require_planar(name);
  if (course_->belt[2] != 0 || course_->shifts_along_z())
    fail(name, ": it moves along z, but the scene is planar (dimension 2): move it along x or y, or use dimension 3");
  if (course_->rotates && std::hypot(course_->axis[0], course_->axis[1]) > 0)
    fail(name, ": it rotates out of the plane of the scene (dimension 2): give it the axis 0 0 1, or use dimension 3");
}

namespace {

// A wall held at an angle of another course.
class Held final : public Course {
 public:
  Held(const Course &of, double angle) : Course(of), angle_(angle) {}
  Place at(double) const override { return {Vec4{}, angle_}; }
  bool shifts_along_z() const override { return false; }

 private:
  double angle_;
};

}    // namespace

void Moved::require_repeats(const std::string &name, const BoxEdges &box) const
{
  constexpr double round_off = 1e-9;
  constexpr int angles = 6;   // rad, which go round once about
  shape_->require_repeats(name, box);
  for (int d = 0; course_->rotates && d < 3; ++d) {
    const Vec4 edge{box.edge[d][0], box.edge[d][1], box.edge[d][2], 0};
    if (!box.periodic[d] || length(cross(course_->axis, edge)) <= round_off * length(edge)) continue;
    for (int angle = 0; angle < angles; ++angle)
      if (is_touched_at_faces(Moved(shape_, std::make_shared<Held>(*course_, angle)), box, d))
        fail(name, ": it rotates about an axis that is not along ", "xyz"[d], ", in which the box is periodic, and ",
             "grains touch it at the box' faces: use that axis, or a boundary that is not periodic");
  }
}

}    // namespace nscd
