// SPDX-License-Identifier: GPL-2.0-or-later
// A wall of triangles, from an STL file. Both of its sides are walls: normals point from it to the grain.
//
// Its features are faces, edges and vertices, and those that a sphere may touch are the local minima of the distance to
// the surface: the face that the centre's foot is on, an edge that is nearer than all that is beside it, such a vertex.
// So a seam between faces in one plane is never felt. A face whose foot is beyond a side where the surface rises, as in
// a valley, is a constraint as well before the grain comes onto it: the room there is what all planes leave, and the
// step that leads into the valley would end below the face otherwise. Over a side where the surface falls the edge or
// the vertex is what matters.
#pragma once

#include "obstacle/distance_grid.hpp"
#include "obstacle/obstacle.hpp"
#include "obstacle/surface.hpp"

#include <string>

namespace nscd {

class Mesh final : public Obstacle {
 public:
  // Raises Error for no triangles, for those without an area, and for too many. `name` is "wall 2: file 'x.stl'".
  Mesh(AlignedVector<Triangle> triangles, const std::string &name);

  void find_near(std::span<const Sphere> spheres, double within, std::vector<std::int32_t> &found) const override;
  // Of a face the distance to its plane, on the side on which the centre is; of edges and vertices to themselves.
  Touch at(const Vec4 &centre, double radius, int feature) const override;
  void touch(const Vec4 &centre, double radius, double within, std::vector<Touch> &found) const override;
  bool is_curved() const override { return true; }
  bool has_two_sides() const override { return true; }
  std::string told() const override;
  // No normal of a face may have a z component.
  void require_planar(const std::string &name) const override;
  // It is not repeated with the box: it has to end ahead of its faces, or to go on beyond them.
  void require_repeats(const std::string &name, const BoxEdges &box) const override;

  const Surface &surface() const { return surface_; }

 private:
  TriangleTree tree_;
  Surface surface_;
  DistanceGrid grid_;
};

}    // namespace nscd
