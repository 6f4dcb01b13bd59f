// SPDX-License-Identifier: GPL-2.0-or-later
// A region of LAMMPS as a wall, at one time of a step.
#pragma once

#include "obstacle/obstacle.hpp"
#include "region_tree.hpp"

#include <memory>

namespace LAMMPS_NS {

class RegionWall final : public nscd::Obstacle {
 public:
  // `planar`: faces across z are none, as a planar scene has none.
  RegionWall(std::shared_ptr<const RegionTree> tree, bool planar, double time = 0);

  void find_near(std::span<const nscd::Sphere> spheres, double within, std::vector<std::int32_t> &found) const override;
  nscd::Touch at(const nscd::Vec4 &centre, double radius, int feature) const override;
  void touch(const nscd::Vec4 &centre, double radius, double within, std::vector<nscd::Touch> &found) const override;
  bool is_curved() const override { return true; }
  bool has_two_sides() const override { return tree_->is_open(); }

  std::shared_ptr<const nscd::Obstacle> after(double time, double step) const override;
  nscd::Vec4 velocity_at(const nscd::Vec4 &point, const nscd::Touch &touch) const override;
  double fastest(const nscd::Vec4 &point, double near) const override;

  void require_planar(const std::string &) const override {}   // faces across the plane are left out
  void require_repeats(const std::string &name, const nscd::BoxEdges &box) const override;

 private:
  std::shared_ptr<const RegionTree> tree_;
  bool planar_;
  std::vector<RegionPose> poses_;
};

}    // namespace LAMMPS_NS
