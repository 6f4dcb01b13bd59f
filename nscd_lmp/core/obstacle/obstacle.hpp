// SPDX-License-Identifier: GPL-2.0-or-later
// A wall: something rigid that grains touch, that no grain moves, and that LAMMPS has no atoms for.
//
// A kind of wall is a class of its own file, which registers itself (kinds.hpp). It says how near it is to a sphere and
// in which direction, part by part: a wall with edges or corners touches a grain in several places at once, and each
// feature is a contact of its own. A wall may move: after(dt) is the same wall later, and where it has a velocity,
// each of its contacts has a body of that velocity and of infinite mass.
#pragma once

#include "contact/contact.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace nscd {

struct BoxEdges {
  double edge[3][3];    // vectors along the box' edges, m
  bool periodic[3];
};

// Of a sphere and a feature of a wall.
struct Touch {
  alignas(vec4_alignment) Vec4 normal;   // unit, from the wall to the sphere
  double gap;                            // m, negative where they overlap
  int feature;                           // the same from step to step
};

// Where the centres of grains are in arrays of something else.
class Centres {
 public:
  // `first` and those that follow, `stride` bytes from one to the next.
  Centres(const Vec4 *first, std::size_t stride, std::size_t count) : first_(first), stride_(stride), count_(count) {}
  std::size_t count() const { return count_; }
  const Vec4 &operator[](std::size_t k) const
  {
    return *reinterpret_cast<const Vec4 *>(reinterpret_cast<const char *>(first_) + k * stride_);
  }

 private:
  const Vec4 *first_;
  std::size_t stride_, count_;
};

class Obstacle {
 public:
  Obstacle() = default;
  virtual ~Obstacle() = default;
  Obstacle(const Obstacle &) = default;
  Obstacle &operator=(const Obstacle &) = default;

  // To the nearest of its features, m, or less: what tells the many grains that are far away.
  virtual void distances(const Centres &centres, double *to) const = 0;
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

  // The same wall `dt` (s) later; null if it stands.
  virtual std::shared_ptr<const Obstacle> after(double) const { return nullptr; }
  // Of its surface there, m/s.
  virtual Vec4 velocity_at(const Vec4 &) const { return Vec4{}; }
  // No part of its surface comes nearer to anything faster, m/s.
  virtual double fastest() const { return 0; }

  // What does not fit raises Error; `name` is "wall 2".
  virtual void require_planar(const std::string &name) const = 0;                       // dimension 2
  virtual void require_repeats(const std::string &name, const BoxEdges &box) const = 0;  // in periodic boxes
};

// What a kind of wall gives as `double distance(const Vec4 &centre) const`, for many grains at a time.
template <class Shape>
class ObstacleOf : public Obstacle {
 public:
  void distances(const Centres &centres, double *to) const final
  {
    const Shape &shape = static_cast<const Shape &>(*this);
    for (std::size_t k = 0; k < centres.count(); ++k) to[k] = shape.distance(centres[k]);
  }
};

// A contact with a wall has the number of wall and feature in place of its second atom, below 0.
constexpr int most_walls = 1 << 16, most_features = 1 << 15;

constexpr std::int32_t wall_code(int wall, int feature) { return -1 - (feature * most_walls + wall); }
constexpr int wall_of(std::int32_t code) { return (-1 - code) % most_walls; }
constexpr int feature_of(std::int32_t code) { return (-1 - code) / most_walls; }

}    // namespace nscd
