// SPDX-License-Identifier: GPL-2.0-or-later
#include "obstacle/plane.hpp"

#include "base/error.hpp"
#include "obstacle/kinds.hpp"

#include <cmath>

namespace nscd {

Plane::Plane(const double (&point)[3], const double (&normal)[3], const std::string &name)
{
  const double length = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
  for (const double component : {length, point[0], point[1], point[2]})
    if (!std::isfinite(component)) fail(name, ": point and normal must be finite numbers");
  if (!(length > 0)) fail(name, ": the normal is (0, 0, 0); give a vector that points into the free side");
  normal_ = Vec4{normal[0] / length, normal[1] / length, normal[2] / length, 0};
  point_ = Vec4{point[0], point[1], point[2], 0};
  offset_ = dot(normal_, point_);
}

Touch Plane::at(const Vec4 &centre, double radius, int) const { return {normal_, distance(centre) - radius, 0}; }

void Plane::require_planar(const std::string &name) const
{
  if (normal_[2] != 0)
    fail(name, ": its normal has a z component, but the scene is planar (dimension 2): make it 0, or use dimension 3");
}

void Plane::require_repeats(const std::string &name, const BoxEdges &box) const
{
  constexpr double round_off = 1e-9;
  for (int d = 0; d < 3; ++d) {
    if (!box.periodic[d]) continue;
    const Vec4 edge{box.edge[d][0], box.edge[d][1], box.edge[d][2], 0};
    const double slant = dot(normal_, edge) / std::sqrt(dot(edge, edge));
    if (std::abs(slant) > round_off)
      fail(name, ": its normal has a component ", slant, " along ", "xyz"[d], ", in which the box is ",
           "periodic and the plane is not: use a normal without it, or a boundary that is not periodic");
  }
}

static std::shared_ptr<const Obstacle> read(Arguments &words, const std::string &name)
{
  double point[3], normal[3];
  for (double &value : point) value = words.number<double>();
  for (double &value : normal) value = words.number<double>();
  return std::make_shared<Plane>(point, normal, name);
}

static const RegisterObstacle plane({.order = 10,
                                     .name = "plane",
                                     .words = "x y z nx ny nz",
                                     .doc = "a point of the plane, a normal into the free side (any length but 0)",
                                     .read = read});

}    // namespace nscd
