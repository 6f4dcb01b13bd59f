// SPDX-License-Identifier: GPL-2.0-or-later
// A wall: something rigid that grains touch, that no grain moves, and that LAMMPS has no atoms for.
//
// A kind of wall is a class of its own file, which registers itself (kinds.hpp). It says how near it is to a sphere and
// in which direction, part by part: a wall with edges or corners touches a grain in several places at once, and each
// feature is a contact of its own. A wall may move: after() is the same wall later, and each of its contacts then has
// a body of infinite mass with the velocity of its surface there. What moves as a whole is a shape in its own frame
// that `Moved` (moved.hpp) places.
#pragma once

#include "contact/sphere.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace nscd {

struct BoxEdges {
  double edge[3][3];    // vectors along the box' edges, m
  bool periodic[3];     // along z never, where grains lie in a plane
  double low[3] = {};   // its corner, m
  double radius = 0;    // of the largest grain, m
};

// Of a sphere and a feature of a wall.
struct Touch {
  alignas(vec4_alignment) Vec4 normal;   // unit, from the wall to the sphere
  double gap;                            // m, negative where they overlap; infinite where the feature does not face it
  int feature;                           // the same from step to step
};

class Obstacle {
 public:
  Obstacle() = default;
  virtual ~Obstacle() = default;
  Obstacle(const Obstacle &) = default;
  Obstacle &operator=(const Obstacle &) = default;

  // Adds the numbers of the spheres that are no farther from the nearest of its features than `within` (m); it may add
  // others. This is asked of all grains, and what follows of few.
  virtual void find_near(std::span<const Sphere> spheres, double within, std::vector<std::int32_t> &found) const = 0;
  // A feature and a sphere, however far apart.
  virtual Touch at(const Vec4 &centre, double radius, int feature) const = 0;
  // Adds the features whose gap to the sphere is at most `within` (m).
  virtual void touch(const Vec4 &centre, double radius, double within, std::vector<Touch> &found) const
  {
    const Touch only = at(centre, radius, 0);
    if (only.gap <= within) found.push_back(only);
  }
  // Whether normals differ from place to place.
  virtual bool is_curved() const { return false; }
  // Whether at() answers from the side on which the centre is, so that a grain beyond it seems to be apart from it.
  virtual bool has_two_sides() const { return false; }

  // The same wall `time` (s) later, in a step that lasts `step` (s) from now: its velocities are those of that step.
  // Null if it stands.
  virtual std::shared_ptr<const Obstacle> after(double /*time*/, double /*step*/) const { return nullptr; }
  // Of its surface there, m/s, where that touch is of.
  virtual Vec4 velocity_at(const Vec4 & /*point*/, const Touch &) const { return Vec4{}; }
  // No part of its surface that is within `near` (m) of the point moves faster, m/s.
  virtual double fastest(const Vec4 & /*point*/, double /*near*/) const { return 0; }

  // What a user may want to compare with what was meant; or nothing.
  virtual std::string told() const { return {}; }

  // What does not fit raises Error; `name` is "wall 2".
  virtual void require_planar(const std::string &name) const = 0;                       // dimension 2
  virtual void require_repeats(const std::string &name, const BoxEdges &box) const = 0;  // in periodic boxes
};

// What a kind of wall gives as `double distance(const Vec4 &centre) const`, m, for all grains at a time.
template <class Shape>
class ObstacleOf : public Obstacle {
 public:
  void find_near(std::span<const Sphere> spheres, double within, std::vector<std::int32_t> &found) const final
  {
    const Shape &shape = static_cast<const Shape &>(*this);
    for (std::size_t k = 0; k < spheres.size(); ++k)
      if (!(shape.distance(spheres[k].centre) - spheres[k].radius > within)) found.push_back(std::int32_t(k));
  }
};

// A contact with a wall has the number of wall and feature in place of its second atom, below 0.
constexpr int most_walls = 1 << 9, most_features = 1 << 22;

constexpr std::int32_t wall_code(int wall, int feature) { return -1 - (feature * most_walls + wall); }
constexpr int wall_of(std::int32_t code) { return (-1 - code) % most_walls; }
constexpr int feature_of(std::int32_t code) { return (-1 - code) / most_walls; }

}    // namespace nscd
