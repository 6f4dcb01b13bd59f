// SPDX-License-Identifier: GPL-2.0-or-later
// A region of LAMMPS with those that it is made of: which of their surfaces a point faces, at any time of a step.
//
// Region::surface() knows the simple shapes. Unions and intersections are put together here, and not by LAMMPS' own,
// whose numbers of walls neither tell the parts apart nor the faces of one part. A surface of a union is one of its
// parts' that lies in none of the others, of an intersection one that lies in all; outside it is the other way round.
#pragma once

#include <region.h>

#include <string>
#include <vector>

namespace LAMMPS_NS {

// How a part that moves lies, as LAMMPS has it: first turned about its axis, then shifted.
struct RegionPose {
  double shift[3];   // m
  double angle;      // rad
};

// Where the surface of a part is nearest to a point.
struct RegionSurface {
  int feature;          // the same from step to step
  double apart;         // m, from the surface to the point
  double normal[3];     // unit, towards the point
};

class RegionTree {
 public:
  // Raises nscd::Error for a region whose shape varies.
  explicit RegionTree(Region *region);

  // Ahead of all that follows: parts begin where their variables have them now.
  void begin_run();
  // Variables are asked anew, for the end of a step of length dt (s).
  void begin_step(double dt);

  bool moves() const { return !moving_.empty(); }
  // Whether a face of some part is open, so that grains may be on both sides.
  bool is_open() const { return is_open_; }
  const char *id() const { return region_->id; }

  // Of all parts that move, at a time after the start of the step, s; and puts them there.
  std::vector<RegionPose> poses_at(double time) const;
  void place(const std::vector<RegionPose> &poses) const;

  // With parts placed: adds the surfaces nearer than `cutoff` (m).
  void find(const double *point, double cutoff, std::vector<RegionSurface> &found) const;
  // That one, if the point faces it; returns false if not. A point beyond its part, where no grain can be, is apart
  // from the part's surface there by less than 0.
  bool find_feature(const double *point, int feature, RegionSurface &found) const;
  // Whether it is on the side where grains are.
  bool has(const double *point) const { return region_->match(point[0], point[1], point[2]) != 0; }

  // Number of the moving part of a feature in `poses`, or -1: it stands.
  int moving_part(int feature) const;
  // Of its surface at a point, m/s, its pose being that.
  void velocity(int part, const RegionPose &pose, const double *point, double *v) const;
  // No surface within `near` (m) of the point moves faster, m/s.
  double fastest(const std::vector<RegionPose> &poses, const double *point, double near) const;
  // Of the first part that moves.
  RegionPose rates() const { return rates_of(0); }
  const double *rotation_point() const;

 private:
  struct Node {
    Region *region = nullptr;
    std::vector<int> parts{};   // of a union or intersection
    bool is_union = false;
    bool flipped = false;       // of a part: grains are on the other side than it says itself
    int first_feature = 0;
    int moving = -1;            // in moving_, or -1: it stands
    bool is_open = false;       // LAMMPS has all points on its side
  };
  int add(Region *region, bool flipped);
  void find(const Node &node, const double *point, double cutoff, bool flipped,
            std::vector<RegionSurface> &found) const;
  bool is_kept(const Node &node, std::size_t part, const double *surface, bool flipped) const;
  const Node &leaf_of(int feature) const;
  RegionPose rates_of(int part) const;

  Region *region_;
  std::vector<Node> nodes_;           // parts stand before what is made of them
  std::vector<Region *> moving_;
  std::vector<RegionPose> start_, end_;
  double dt_ = 1;
  int features_ = 0;
  bool is_open_ = false;
};

}    // namespace LAMMPS_NS
