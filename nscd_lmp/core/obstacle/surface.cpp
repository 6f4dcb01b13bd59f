// SPDX-License-Identifier: GPL-2.0-or-later
#include "obstacle/surface.hpp"

#include "base/error.hpp"
#include "obstacle/triangle_tree.hpp"
#include "obstacle/welding.hpp"

#include <array>
#include <cmath>

namespace nscd {

namespace {

constexpr double joined_share = 1e-9;      // of the size: corners nearer than that are one
constexpr double round_off_share = 1e-11;  // of the largest coordinate
constexpr double written_share = 2e-7;     // of the largest coordinate: two that a float has rounded
constexpr double flat_angle = 1e-6;        // rad

// Of a side, the angle to the first other face that one meets when one turns from the face to its normal's side and to
// the other one.
struct FirstMet {
  double angle = INFINITY;
  std::int32_t face = -1;
};

BeyondSide beyond(const FirstMet (&first)[2])
{
  BeyondSide found;
  for (const int on : {0, 1}) {
    const double from_flat = first[on].angle - M_PI;
    found.on[on] = from_flat < 0 ? first[on].face : BeyondSide::falls;
    if (std::abs(from_flat) <= flat_angle) found.on[on] = BeyondSide::flat;
  }
  return found;
}

}    // namespace

Surface::Surface(std::span<const Triangle> triangles, const std::string &name)
{
  const BoxAround bounds = box_around(triangles);
  double size2 = 0, largest = 0;
  for (int d = 0; d < 3; ++d) {
    const double length = bounds.high[d] - bounds.low[d];
    size2 += length * length;
    largest = std::max({largest, length, std::abs(bounds.low[d]), std::abs(bounds.high[d])});
  }
  if (!(size2 > 0)) fail(name, ": all of its corners are one point");
  const double joined = std::max(joined_share * std::sqrt(size2), 1e-15 * largest);
  round_off = round_off_share * largest;
  written = written_share * largest;
  Welded welded = weld(triangles, joined);
  vertices.swap(welded.vertices);
  faces.resize(triangles.size());
  for (std::size_t k = 0; k < welded.vertex_of.size(); ++k) faces[k / 3].vertex[k % 3] = welded.vertex_of[k];
  make_faces(name, joined);
  join_sides();
  find_neighbors();
  look_beyond();
}

void Surface::make_faces(const std::string &name, double joined)
{
  std::vector<char> owned(vertices.size(), 0);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    MeshFace &face = faces[f];
    const Vec4 corner[3] = {vertices[std::size_t(face.vertex[0])], vertices[std::size_t(face.vertex[1])],
                            vertices[std::size_t(face.vertex[2])]};
    const Vec4 area = cross(corner[1] - corner[0], corner[2] - corner[0]);
    double longest = 0;
    for (int k = 0; k < 3; ++k) longest = std::max(longest, length(corner[(k + 1) % 3] - corner[k]));
    if (!(length(area) > joined * longest))
      fail(name, ": a triangle has no area; its corners are (", corner[0][0], ", ", corner[0][1], ", ", corner[0][2],
           "), (", corner[1][0], ", ", corner[1][1], ", ", corner[1][2], "), (", corner[2][0], ", ", corner[2][1], ", ",
           corner[2][2], "), and it is less than ", joined, " high: leave it out of the file");
    face.corner = corner[0];
    face.normal = area / length(area);
    face.owns = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec4 inward = cross(face.normal, corner[(k + 1) % 3] - corner[k]);
      face.inward[k] = inward / length(inward);
      char &is_owned = owned[std::size_t(face.vertex[k])];
      if (!is_owned) face.owns |= 8u << k;
      is_owned = 1;
    }
    face.inward[1][3] = dot(face.inward[1], corner[0] - corner[1]);
  }
}

// Sides with the same two vertices lie behind one another when they are sorted.
void Surface::join_sides()
{
  std::vector<std::array<std::int32_t, 3>> ends;
  ends.reserve(3 * faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(faces[f].vertex[k], faces[f].vertex[(k + 1) % 3]);
      ends.push_back({low, high, std::int32_t(3 * f) + k});
    }
  std::sort(ends.begin(), ends.end());
  sides.resize(ends.size());
  for (std::size_t first = 0, last = 0; first < ends.size(); first = last) {
    const auto [low, high, owner] = ends[first];
    while (last < ends.size() && ends[last][0] == low && ends[last][1] == high) ++last;
    const Vec4 start = vertices[std::size_t(low)], along = vertices[std::size_t(high)] - start;
    for (std::size_t k = first; k < last; ++k) {
      MeshSide &side = sides[std::size_t(ends[k][2])];
      side.edge = std::int32_t(edges.size());
      side.next = ends[k + 1 < last ? k + 1 : first][2];
    }
    faces[std::size_t(owner / 3)].owns |= 1u << owner % 3;
    edges.push_back({start, along / length(along), length(along)});
    neighbors.insert(neighbors.end(), {low, high});
  }
}

// So far the two ends of each edge are in `neighbors`.
void Surface::find_neighbors()
{
  std::vector<std::int32_t> ends;
  ends.swap(neighbors);
  first_neighbor.assign(vertices.size() + 1, 0);
  for (const std::int32_t v : ends) ++first_neighbor[std::size_t(v) + 1];
  for (std::size_t v = 0; v < vertices.size(); ++v) first_neighbor[v + 1] += first_neighbor[v];
  neighbors.resize(ends.size());
  std::vector<std::int32_t> place(first_neighbor.begin(), first_neighbor.end() - 1);
  for (std::size_t k = 0; k < ends.size(); ++k) neighbors[std::size_t(place[std::size_t(ends[k])]++)] = ends[k ^ 1];
}

void Surface::look_beyond()
{
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const MeshFace &face = faces[k / 3];
    const Vec4 inward = without_fourth(face.inward[k % 3]);
    FirstMet first[2];
    for (std::size_t other = std::size_t(sides[k].next); other != k; other = std::size_t(sides[other].next)) {
      const Vec4 into = without_fourth(faces[other / 3].inward[other % 3]);
      double turn = std::atan2(dot(into, face.normal), dot(into, inward));
      for (const int on : {0, 1}) {
        if (on == 1) turn = -turn;
        // One that lies on the face is in the way on both sides of it.
        const double angle = turn < -flat_angle ? turn + 2 * M_PI : std::abs(turn);
        if (angle < first[on].angle) first[on] = {angle, std::int32_t(other / 3)};
      }
    }
    sides[k].beyond = beyond(first);
  }
}

}    // namespace nscd
