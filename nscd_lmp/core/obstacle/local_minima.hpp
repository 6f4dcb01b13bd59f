// SPDX-License-Identifier: GPL-2.0-or-later
// Which features of a surface a sphere may touch: mesh.hpp says what they are.
#pragma once

#include "obstacle/obstacle.hpp"
#include "obstacle/surface.hpp"

#include <vector>

namespace nscd {

class LocalMinima {
 public:
  // Adds to `found` what is apart from the sphere by no more than `within` (m). `wall` has the features of the surface.
  LocalMinima(const Surface &surface, const Obstacle &wall, const Vec4 &centre, double radius, double within,
              std::vector<Touch> &found);

  // Of each face that is within reach, once, and of others: it will be looked at.
  void take(std::int32_t face);
  // Adds what faces, edges and vertices of those that were taken there are.
  void add_all();

 private:
  // The foot of the centre in the plane of a face.
  struct Foot;
  void look_at(std::int32_t face);
  void look_at_edge(std::int32_t side);
  void look_at_vertex(std::int32_t vertex);
  bool is_passed(const Vec4 &point) const;
  bool rises(std::int32_t face, const Foot &foot) const;
  bool rises_beyond(std::int32_t side, const Foot &foot) const;
  double inside(std::int32_t side) const;
  void add_rising();
  void add(std::size_t feature);

  const Surface &surface_;
  const Obstacle &wall_;
  alignas(vec4_alignment) Vec4 centre_;
  double radius_, within_, reach_;
  std::vector<Touch> &found_;
  std::size_t first_;
  struct Left;
  Left &left_;
};

// Unit.
Vec4 any_perpendicular(const Vec4 &direction);

}    // namespace nscd
