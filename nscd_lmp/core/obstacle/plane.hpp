// SPDX-License-Identifier: GPL-2.0-or-later
// A plane wall: the half-space behind it is solid.
#pragma once

#include "obstacle/obstacle.hpp"

namespace nscd {

class Plane final : public ObstacleOf<Plane> {
 public:
  // `normal` points into the free side and has any length but 0; raises Error otherwise. `name` is "wall 2".
  Plane(const double (&point)[3], const double (&normal)[3], const std::string &name);

  const Vec4 &normal() const { return normal_; }   // unit
  const Vec4 &point() const { return point_; }
  double distance(const Vec4 &centre) const { return dot(normal_, centre) - offset_; }

  Touch at(const Vec4 &centre, double radius, int feature) const override;
  void require_planar(const std::string &name) const override;
  // Its normal has to be perpendicular to every edge along which the box is periodic.
  void require_repeats(const std::string &name, const BoxEdges &box) const override;

 private:
  alignas(vec4_alignment) Vec4 normal_;
  alignas(vec4_alignment) Vec4 point_;
  double offset_;
};

}    // namespace nscd
