// SPDX-License-Identifier: GPL-2.0-or-later
// Triangles joined to a surface: corners that are one point, to 1e-9 of the surface's size, are one vertex, sides that
// triangles share are one edge, and each knows what meets there. Any number of triangles may share an edge, and nothing
// says which side is the outer one.
#pragma once

#include "base/storage.hpp"
#include "obstacle/triangle.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace nscd {

// `side` k of a face is from its corner k to the next one.
struct MeshFace {
  alignas(64) Vec4 corner;   // the first, m
  alignas(vec4_alignment) Vec4 normal;
  // Unit, in the face, perpendicular to each of its sides; with the fourth component the product with
  // (centre - corner, 1) is how far inside of the side the foot of a centre is.
  alignas(vec4_alignment) Vec4 inward[3];
  std::int32_t vertex[3];
  // Bits 0 to 2: it is the one that is asked for the edge of this side, 3 to 5: for this vertex.
  std::uint32_t owns;
};

struct MeshEdge {
  alignas(vec4_alignment) Vec4 start;       // m
  alignas(vec4_alignment) Vec4 direction;   // unit
  double length;                            // m
};

// What lies beyond a side of a face, on the side of it that its normal points to and on the other one.
struct BeyondSide {
  enum : std::int32_t { falls = -1, flat = -2 };   // or the number of the first face that rises there
  std::int32_t on[2];
};

struct MeshSide {
  std::int32_t edge;
  std::int32_t next;   // of the same edge, 3 face + side, in a ring
  BeyondSide beyond;
};

struct Surface {
  // Raises Error for triangles without an area. `name` is "wall 2: file 'x.stl'".
  Surface(std::span<const Triangle> triangles, const std::string &name);

  int features() const { return int(faces.size() + edges.size() + vertices.size()); }
  // Of vertex v: where edges go from it.
  std::span<const std::int32_t> around(std::int32_t v) const
  {
    return {neighbors.data() + first_neighbor[std::size_t(v)], neighbors.data() + first_neighbor[std::size_t(v) + 1]};
  }

  AlignedVector<MeshFace> faces;
  std::vector<MeshSide> sides;   // three of each face
  AlignedVector<MeshEdge> edges;
  AlignedVector<Vec4> vertices;   // m
  std::vector<std::int32_t> first_neighbor, neighbors;
  double round_off;   // m, of what is computed of its coordinates, and more
  double written;     // m, of coordinates that were written to a file as floats

 private:
  void make_faces(const std::string &name, double joined);
  void join_sides();
  void find_neighbors();
  void look_beyond();
};

}    // namespace nscd
