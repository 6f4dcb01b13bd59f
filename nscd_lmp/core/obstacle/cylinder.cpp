// SPDX-License-Identifier: GPL-2.0-or-later
// The inside of a cylinder without ends: `zcylinder radius` and its kin as LAMMPS' fix wall/gran has them, whose axes
// pass through the origin, and `cylinder` with any axis.
#include "base/error.hpp"
#include "contact/space.hpp"
#include "obstacle/kinds.hpp"
#include "obstacle/obstacle.hpp"
#include "obstacle/repeats.hpp"

#include <cmath>

namespace nscd {

namespace {

class Cylinder final : public ObstacleOf<Cylinder> {
 public:
  Cylinder(const Vec4 &point, const Vec4 &axis, double radius) : point_(point), axis_(axis), radius_(radius) {}

  double distance(const Vec4 &centre) const { return radius_ - length(across(centre)); }

  // On the axis every direction is as good as another: the nearest to x, or y, that is across.
  Touch at(const Vec4 &centre, double radius, int) const override
  {
    Vec4 out = across(centre);
    const double gap = radius_ - length(out) - radius;
    if (length(out) == 0) out = std::abs(axis_[0]) < 0.9 ? Vec4{1, 0, 0, 0} : Vec4{0, 1, 0, 0};
    out -= axis_ * dot(axis_, out);
    return {-out / length(out), gap, 0};
  }
  bool is_curved() const override { return true; }

  void require_planar(const std::string &name) const override
  {
    if (std::hypot(axis_[0], axis_[1]) > 0)
      fail(name, ": its axis is not along z, but the scene is planar (dimension 2): use that axis, or dimension 3");
  }

  void require_repeats(const std::string &name, const BoxEdges &box) const override
  {
    require_alike_at_faces(*this, name, box);
  }

 private:
  Vec4 across(const Vec4 &centre) const
  {
    const Vec4 from = centre - point_;
    return without_fourth(from - axis_ * dot(axis_, from));
  }

  alignas(vec4_alignment) Vec4 point_, axis_;   // of its axis, which is a unit vector
  double radius_;
};

std::shared_ptr<const Obstacle> make(const Vec4 &point, const Vec4 &axis, Arguments &words, const std::string &name)
{
  const double radius = words.number<double>(), size = length(axis);
  if (!(radius > 0 && std::isfinite(radius))) fail(name, ": the radius ", radius, " must be > 0");
  if (!(size > 0 && std::isfinite(size) && std::isfinite(length(point))))
    fail(name, ": the axis needs a point and a vector of finite numbers that is not (0, 0, 0)");
  return std::make_shared<Cylinder>(point, axis / size, radius);
}

std::shared_ptr<const Obstacle> read_any(Arguments &words, const std::string &name)
{
  Vec4 point{}, axis{};
  for (int d = 0; d < 3; ++d) point[d] = words.number<double>();
  for (int d = 0; d < 3; ++d) axis[d] = words.number<double>();
  return make(point, axis, words, name);
}

template <int along>
std::shared_ptr<const Obstacle> read(Arguments &words, const std::string &name)
{
  Vec4 axis{};
  axis[along] = 1;
  return make(Vec4{}, axis, words, name);
}

const RegisterObstacle xcylinder({30, "xcylinder", "R", "", read<0>});
const RegisterObstacle ycylinder({31, "ycylinder", "R", "", read<1>});
const RegisterObstacle zcylinder({32, "zcylinder", "R", "the inside of a cylinder of radius R about an axis through "
                                  "the origin, without ends", read<2>});
const RegisterObstacle cylinder({33, "cylinder", "x y z ax ay az R", "the inside of a cylinder of radius R about an "
                                 "axis through a point, along a vector", read_any});

}    // namespace

}    // namespace nscd
