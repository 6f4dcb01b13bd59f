// SPDX-License-Identifier: GPL-2.0-or-later
#include "region_wall.hpp"

#include "obstacle/repeats.hpp"

#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using nscd::Touch;
using nscd::Vec4;

namespace {

struct Point {
  explicit Point(const Vec4 &centre) : x{centre[0], centre[1], centre[2]} {}
  double x[3];
};

Touch touch_of(const RegionSurface &surface, double radius)
{
  return {Vec4{surface.normal[0], surface.normal[1], surface.normal[2], 0}, surface.apart - radius, surface.feature};
}

// Scratch: detection asks grain after grain, on one thread.
std::vector<RegionSurface> &scratch()
{
  static thread_local std::vector<RegionSurface> surfaces;
  surfaces.clear();
  return surfaces;
}

bool is_across_plane(const RegionSurface &surface) { return std::abs(surface.normal[2]) > 0.5; }

}    // namespace

RegionWall::RegionWall(std::shared_ptr<const RegionTree> tree, bool planar, double time) :
    tree_(std::move(tree)), planar_(planar), poses_(tree_->poses_at(time))
{
}

void RegionWall::find_near(std::span<const nscd::Sphere> spheres, double within, std::vector<std::int32_t> &found) const
{
  tree_->place(poses_);
  for (std::size_t k = 0; k < spheres.size(); ++k) {
    auto &surfaces = scratch();
    tree_->find(Point(spheres[k].centre).x, spheres[k].radius + within, surfaces);
    if (!surfaces.empty()) found.push_back(std::int32_t(k));
  }
}

Touch RegionWall::at(const Vec4 &centre, double radius, int feature) const
{
  tree_->place(poses_);
  RegionSurface surface;
  if (tree_->find_feature(Point(centre).x, feature, surface)) return touch_of(surface, radius);
  return {Vec4{}, std::numeric_limits<double>::infinity(), feature};
}

void RegionWall::touch(const Vec4 &centre, double radius, double within, std::vector<Touch> &found) const
{
  tree_->place(poses_);
  auto &surfaces = scratch();
  tree_->find(Point(centre).x, radius + within, surfaces);
  for (const RegionSurface &surface : surfaces)
    if (!(planar_ && is_across_plane(surface))) found.push_back(touch_of(surface, radius));
}

std::shared_ptr<const nscd::Obstacle> RegionWall::after(double time, double /*step*/) const
{
  return tree_->moves() ? std::make_shared<RegionWall>(tree_, planar_, time) : nullptr;
}

Vec4 RegionWall::velocity_at(const Vec4 &point, const Touch &touch) const
{
  const int part = tree_->moving_part(touch.feature);
  double v[3] = {};
  if (part >= 0) tree_->velocity(part, poses_[std::size_t(part)], Point(point).x, v);
  return Vec4{v[0], v[1], v[2], 0};
}

double RegionWall::fastest(const Vec4 &point, double near) const
{
  return tree_->fastest(poses_, Point(point).x, near);
}

void RegionWall::require_repeats(const std::string &name, const nscd::BoxEdges &box) const
{
  nscd::require_alike_at_faces(*this, name, box);
}
