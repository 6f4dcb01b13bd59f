// SPDX-License-Identifier: GPL-2.0-or-later
#include "region_tree.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;

namespace {

constexpr double everywhere = 1e20;   // m

// What regions keep to those that are derived from them.
struct Opened : Region {
  static const double *axis_of(const Region *region) { return region->*&Opened::runit; }
  static const double *point_of(const Region *region) { return region->*&Opened::point; }
};

RegionPose pose_of(const Region *region) { return {{region->dx, region->dy, region->dz}, region->theta}; }

// Regions know their inside and outside by this flag alone.
class Flipped {
 public:
  Flipped(Region *region, bool flip) : region_(region), flip_(flip) { region_->interior ^= flip_; }
  ~Flipped() { region_->interior ^= flip_; }
  Flipped(const Flipped &) = delete;
  Flipped &operator=(const Flipped &) = delete;

 private:
  Region *region_;
  int flip_;
};

// A point on the surface has no direction from it.
bool is_surface(const Region::Contact &c, int feature, RegionSurface &surface)
{
  if (!(c.r > 0)) return false;
  const double inverse = 1 / c.r;
  surface = {feature, c.r, {c.delx * inverse, c.dely * inverse, c.delz * inverse}};
  return true;
}

// The surface that is nearest to a point behind it.
bool find_beyond(Region *region, const double *point, int feature, RegionSurface &found)
{
  const Flipped flip(region, true);
  const int count = region->surface(point[0], point[1], point[2], everywhere);
  const auto nearer = [](const Region::Contact &a, const Region::Contact &b) { return a.r < b.r; };
  if (count == 0 || !is_surface(*std::min_element(region->contact, region->contact + count, nearer), feature, found))
    return false;
  found.apart = -found.apart;
  for (double &component : found.normal) component = -component;
  return true;
}

}    // namespace

RegionTree::RegionTree(Region *region) : region_(region)
{
  add(region, false);
}

int RegionTree::add(Region *region, bool flipped)
{
  Node node{.region = region,
            .is_union = strcmp(region->style, "union") == 0,
            .flipped = flipped,
            .is_open = region->openflag != 0};
  if (node.is_union || strcmp(region->style, "intersect") == 0) {
    const bool outside = (region->interior == 0) != flipped;
    for (int k = 0; k < region->nregion; ++k) node.parts.push_back(add(region->reglist[k], outside));
    const auto is_open = [this](int part) { return nodes_[std::size_t(part)].is_open; };
    node.is_open = node.is_union ? std::any_of(node.parts.begin(), node.parts.end(), is_open)
                                 : std::all_of(node.parts.begin(), node.parts.end(), is_open);
  } else {
    if (region->varshape)
      nscd::fail("region ", region->id, " has a size that varies: walls keep their shape; use `move`, or a mesh");
    if (strcmp(region->style, "ellipsoid") == 0)   // its contact is the place on the surface, not the way from there
      nscd::fail("region ", region->id, " is an ellipsoid, of which LAMMPS gives no normals: use a sphere or a mesh");
    node.first_feature = features_;
    features_ += region->cmax;
    is_open_ |= region->openflag != 0;
    if (region->dynamic) {
      node.moving = int(moving_.size());
      moving_.push_back(region);
    }
  }
  nodes_.push_back(node);
  return int(nodes_.size()) - 1;
}

void RegionTree::begin_run()
{
  if (moves()) region_->prematch();
  start_.clear();
  for (const Region *part : moving_) start_.push_back(pose_of(part));
  end_ = start_;
}

void RegionTree::begin_step(double dt)
{
  dt_ = dt;
  start_ = end_;
  region_->prematch();
  for (std::size_t k = 0; k < moving_.size(); ++k) end_[k] = pose_of(moving_[k]);
}

// Exact at both ends of the step.
std::vector<RegionPose> RegionTree::poses_at(double time) const
{
  if (time == dt_) return end_;
  std::vector<RegionPose> poses = start_;
  const double share = time / dt_;
  for (std::size_t k = 0; time != 0 && k < poses.size(); ++k) {
    for (int d = 0; d < 3; ++d) poses[k].shift[d] += share * (end_[k].shift[d] - start_[k].shift[d]);
    poses[k].angle += share * (end_[k].angle - start_[k].angle);
  }
  return poses;
}

void RegionTree::place(const std::vector<RegionPose> &poses) const
{
  for (std::size_t k = 0; k < poses.size(); ++k) {
    Region *part = moving_[k];
    part->dx = poses[k].shift[0], part->dy = poses[k].shift[1], part->dz = poses[k].shift[2];
    part->theta = poses[k].angle;
  }
}

void RegionTree::find(const double *point, double cutoff, std::vector<RegionSurface> &found) const
{
  find(nodes_.back(), point, cutoff, false, found);
}

void RegionTree::find(const Node &node, const double *point, double cutoff, bool flipped,
                      std::vector<RegionSurface> &found) const
{
  if (node.parts.empty()) {
    const Flipped flip(node.region, flipped);
    const int count = node.region->surface(point[0], point[1], point[2], cutoff);
    RegionSurface surface;
    for (int k = 0; k < count; ++k) {
      const Region::Contact &c = node.region->contact[k];
      if (is_surface(c, node.first_feature + c.iwall, surface)) found.push_back(surface);
    }
    return;
  }
  const bool outside = (node.region->interior == 0) != flipped;
  for (std::size_t part = 0; part < node.parts.size(); ++part) {
    const std::size_t before = found.size();
    find(nodes_[std::size_t(node.parts[part])], point, cutoff, outside, found);
    std::size_t kept = before;
    for (std::size_t k = before; k < found.size(); ++k) {
      double surface[3];
      for (int d = 0; d < 3; ++d) surface[d] = point[d] - found[k].apart * found[k].normal[d];
      if (is_kept(node, part, surface, outside)) found[kept++] = found[k];
    }
    found.resize(kept);
  }
}

bool RegionTree::is_kept(const Node &node, std::size_t part, const double *surface, bool outside) const
{
  const bool in_all = node.is_union == outside;
  for (std::size_t other = 0; other < node.parts.size(); ++other) {
    const Node &beside = nodes_[std::size_t(node.parts[other])];
    if (other == part || beside.is_open) continue;   // an open part hides nothing, as in LAMMPS
    Region *region = beside.region;
    const Flipped flip(region, outside);
    if ((region->match(surface[0], surface[1], surface[2]) != 0) != in_all) return false;
  }
  return true;
}

const RegionTree::Node &RegionTree::leaf_of(int feature) const
{
  const auto has = [feature](const Node &node) {
    return node.parts.empty() && feature >= node.first_feature && feature < node.first_feature + node.region->cmax;
  };
  return *std::find_if(nodes_.begin(), nodes_.end(), has);
}

bool RegionTree::find_feature(const double *point, int feature, RegionSurface &found) const
{
  const Node &leaf = leaf_of(feature);
  Region *region = leaf.region;
  const Flipped flip(region, leaf.flipped);
  const int count = region->surface(point[0], point[1], point[2], everywhere);
  for (int k = 0; k < count; ++k)
    if (leaf.first_feature + region->contact[k].iwall == feature) return is_surface(region->contact[k], feature, found);
  if (region->openflag || region->match(point[0], point[1], point[2])) return false;
  return find_beyond(region, point, feature, found);
}

int RegionTree::moving_part(int feature) const { return leaf_of(feature).moving; }

RegionPose RegionTree::rates_of(int part) const
{
  const RegionPose &from = start_[std::size_t(part)], &to = end_[std::size_t(part)];
  RegionPose rates{};
  for (int d = 0; d < 3; ++d) rates.shift[d] = (to.shift[d] - from.shift[d]) / dt_;
  rates.angle = (to.angle - from.angle) / dt_;
  return rates;
}

const double *RegionTree::rotation_point() const
{
  return moves() && moving_[0]->rotateflag ? Opened::point_of(moving_[0]) : nullptr;
}

void RegionTree::velocity(int part, const RegionPose &pose, const double *point, double *v) const
{
  const Region *region = moving_[std::size_t(part)];
  const RegionPose rates = rates_of(part);
  std::copy_n(rates.shift, 3, v);
  if (!region->rotateflag) return;
  const double *axis = Opened::axis_of(region), *about = Opened::point_of(region);
  double from[3], w[3];
  for (int d = 0; d < 3; ++d) from[d] = point[d] - about[d] - pose.shift[d], w[d] = rates.angle * axis[d];
  v[0] += w[1] * from[2] - w[2] * from[1];
  v[1] += w[2] * from[0] - w[0] * from[2];
  v[2] += w[0] * from[1] - w[1] * from[0];
}

double RegionTree::fastest(const std::vector<RegionPose> &poses, const double *point, double near) const
{
  double most = 0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    double v[3];
    velocity(int(k), poses[k], point, v);
    const double turns = moving_[k]->rotateflag ? std::abs(rates_of(int(k)).angle) : 0;
    most = std::max(most, std::hypot(v[0], v[1], v[2]) + turns * near);
  }
  return most;
}
