// SPDX-License-Identifier: GPL-2.0-or-later
// Walls of triangles: what they say of themselves, against all triangles one after another and against planes.
#include "check.hpp"
#include "obstacle/mesh.hpp"
#include "stl_files.hpp"

using nscd::dot;
using nscd::Mesh;
using nscd::Touch;
using nscd::Vec4;

namespace {

// The nearest point of a triangle by its regions (Ericson, Real-time collision detection, 5.1.5).
double distance_to(const Vec4 &p, const Corners &corners)
{
  Vec4 at[3];
  for (int k = 0; k < 3; ++k) at[k] = Vec4{corners[k][0], corners[k][1], corners[k][2], 0};
  const auto [a, b, c] = at;
  const Vec4 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
               d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return nscd::length(ap);
  if (d3 >= 0 && d4 <= d3) return nscd::length(bp);
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return nscd::length(ap - ab * (d1 / (d1 - d3)));
  if (d6 >= 0 && d5 <= d6) return nscd::length(cp);
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return nscd::length(ap - ac * (d2 / (d2 - d6)));
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return nscd::length(bp - (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
  return nscd::length(ap - (ab * vb + ac * vc) / (va + vb + vc));
}

double distance_to_all(const Vec4 &centre, const Shape &shape)
{
  double nearest = INFINITY;
  for (const Corners &triangle : shape) nearest = std::min(nearest, distance_to(centre, triangle));
  return nearest;
}

std::vector<Touch> touches(const Mesh &mesh, const Vec4 &centre, double radius, double within)
{
  std::vector<Touch> found;
  mesh.touch(centre, radius, within, found);
  return found;
}

double smallest_gap(const std::vector<Touch> &found)
{
  double smallest = INFINITY;
  for (const Touch &touch : found) smallest = std::min(smallest, touch.gap);
  return smallest;
}

double wave(double x, double y) { return 0.3 * std::sin(3 * x) * std::cos(2.5 * y) + 0.05 * std::sin(11 * x + 7 * y); }
double level(double, double) { return 0; }

// Triangles of any sizes that have nothing to do with one another.
Shape heap_of_triangles(int count)
{
  Random random(8);
  Shape shape;
  for (int k = 0; k < count; ++k) {
    Corners &triangle = shape.emplace_back();
    const double size = 0.01 * std::pow(200, random());
    const Point middle{random(-1, 1), random(-1, 1), random(-1, 1)};
    for (Point &corner : triangle)
      for (int d = 0; d < 3; ++d) corner[std::size_t(d)] = middle[std::size_t(d)] + size * random(-1, 1);
  }
  return shape;
}

Shape and_a_large_triangle(Shape shape)
{
  shape.push_back({{{-1000, -900, -1.5}, {1100, -1000, -1.6}, {30, 1000, -1.7}}});
  return shape;
}

std::vector<Shape> shapes()
{
  return {box_shape(1),     box_shape(4),           globe(1, 16, 9),
          tube(1, 2, 20, 5), terrain(1.2, 14, wave), terrain(1, 9, level),
          heap_of_triangles(150), and_a_large_triangle(globe(0.8, 12, 7))};
}

}    // namespace

TEST(a_mesh_is_as_near_as_the_nearest_of_its_triangles)
{
  for (const Shape &shape : shapes()) {
    const Mesh mesh = mesh_of(shape);
    Random random(4);
    for (int k = 0; k < 300; ++k) {
      const Vec4 centre{random(-2, 2), random(-2, 2), random(-2, 2), 0};
      const double radius = random(0.01, 1), gap = distance_to_all(centre, shape) - radius;
      for (const double within : {1e9, gap + 1e-9, gap + 0.3}) {
        const std::vector<Touch> found = touches(mesh, centre, radius, within);
        CHECK_NEAR(smallest_gap(found), gap, 1e-9);
        for (const Touch &touch : found) {
          CHECK(touch.gap <= within);
          CHECK_NEAR(nscd::length(touch.normal), 1, 1e-12);
          const Touch same = mesh.at(centre, radius, touch.feature);
          CHECK(same.gap == touch.gap && nscd::length(same.normal - touch.normal) == 0);
          const double h = 1e-6 * std::min(1.0, touch.gap + radius), less = h / 10;
          const auto at = [&](double moved) { return mesh.at(centre + touch.normal * moved, radius, touch.feature); };
          CHECK_NEAR(at(h).gap - at(-h).gap, 2 * h, less);
        }
      }
      CHECK(touches(mesh, centre, radius, gap - 1e-9).empty());
    }
  }
}

TEST(a_mesh_finds_all_grains_that_are_near_it)
{
  for (const Shape &shape : shapes()) {
    const Mesh mesh = mesh_of(shape);
    Random random(6);
    std::vector<nscd::Sphere> spheres;
    for (int k = 0; k < 1000; ++k)
      spheres.push_back({Vec4{random(-2, 2), random(-2, 2), random(-2, 2), 0}, random(0, 0.3), 0});
    for (const double within : {-0.05, 0.0, 0.2}) {
      std::vector<std::int32_t> found;
      mesh.find_near(spheres, within, found);
      CHECK(std::is_sorted(found.begin(), found.end()));
      std::size_t count = 0;
      constexpr double cell = 0.4;   // from corner to corner, and more
      for (std::size_t k = 0; k < spheres.size(); ++k) {
        const bool is_found = std::binary_search(found.begin(), found.end(), std::int32_t(k));
        const double gap = distance_to_all(spheres[k].centre, shape) - spheres[k].radius;
        CHECK(is_found || gap > within);
        count += gap <= within + cell;
      }
      CHECK(found.size() <= count || mesh.surface().faces.size() == shapes().back().size());
    }
    const nscd::Sphere lost{Vec4{NAN, 0, 0, 0}, 1, 0};
    std::vector<std::int32_t> found;
    mesh.find_near({&lost, 1}, 0.1, found);
    CHECK(found.size() == 1);   // so that it is refused
  }
}

// On a seam, at a vertex, beside them by round-off: one contact, with the normal of the plane.
TEST(a_flat_mesh_has_one_contact_wherever_a_grain_lies)
{
  const Shape shape = terrain(1, 9, level);
  const Mesh mesh = mesh_of(shape);
  Random random(2);
  for (const Corners &triangle : shape)
    for (int k = 0; k < 30; ++k) {
      const Point &a = triangle[std::size_t(k % 3)], &b = triangle[std::size_t((k + 1) % 3)];
      const double t = k < 9 ? 0 : random();
      Vec4 centre{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), k % 2 ? 0.3 : -0.3, 0};
      if (std::max(std::abs(centre[0]), std::abs(centre[1])) > 1 - 1e-9) continue;
      for (int d = 0; d < 2; ++d) centre[d] += (k / 3 % 3) * 1e-16 * random(-1, 1);
      const std::vector<Touch> found = touches(mesh, centre, 0.3, 0.25);
      CHECK(found.size() == 1);
      for (const Touch &touch : found) CHECK(touch.gap == 0 && touch.normal[2] == (k % 2 ? 1 : -1));
    }
}

// In a valley both planes hold a grain, from both of its sides alone.
TEST(a_valley_is_two_planes_and_a_ridge_an_edge)
{
  for (const double slope : {0.05, 0.3, 1.0}) {
    Shape shape;
    add_quad(shape, {-1, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0});
    add_quad(shape, {0, -1, 0}, {1, -1, slope}, {1, 1, slope}, {0, 1, 0}, true);
    const Mesh mesh = mesh_of(shape);
    const double angle = std::atan(slope), r = 0.1;
    // Before the slope, its foot is not on it yet.
    const double x = -r * std::tan(angle) - 0.01;
    for (const double y : {0.0, 0.3, 0.77}) {
      std::vector<Touch> found = touches(mesh, Vec4{x, y, r, 0}, r, 0.05);
      CHECK(found.size() == 2);
      const double gap = -x * std::sin(angle) + r * std::cos(angle) - r;
      CHECK_NEAR(smallest_gap(found), 0, 1e-12);
      CHECK_NEAR(std::max(found[0].gap, found[1].gap), gap, 1e-12);
      found = touches(mesh, Vec4{x - 0.05, y, r, 0}, r, 0.05);
      CHECK(found.size() == 1);
      // From below it is a ridge.
      found = touches(mesh, Vec4{r * std::sin(angle / 2), y, -r * std::cos(angle / 2), 0}, r, 0.05);
      CHECK(found.size() == 1);
      CHECK_NEAR(found[0].normal[0], std::sin(angle / 2), 1e-12);
      CHECK_NEAR(found[0].gap, 0, 1e-12);
      found = touches(mesh, Vec4{-1e-3, y, -r, 0}, r, 0.05);
      CHECK(found.size() == 1 && found[0].normal[2] == -1);
    }
  }
}

TEST(a_wall_behind_a_floor_is_no_plane_below_the_floor)
{
  Shape shape;
  add_quad(shape, {-1, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0});
  add_quad(shape, {0, -1, 0}, {0.5, -1, 1}, {0.5, 1, 1}, {0, 1, 0});
  const Mesh mesh = mesh_of(shape);
  for (const double x : {-0.2, -0.11, -0.09, -0.01, 0.05}) {
    const std::vector<Touch> found = touches(mesh, Vec4{x, 0.1, -0.1, 0}, 0.1, 0.5);
    CHECK(found.size() == 1);   // of the floor, or of its border
  }
}

TEST(corners_of_a_mesh_that_differ_by_round_off_are_one)
{
  Shape shape = box_shape(3);
  Random random(1);
  for (Corners &triangle : shape)
    for (Point &corner : triangle)
      for (double &x : corner) x += 1e-10 * random(-1, 1);
  const Mesh mesh = mesh_of(shape);
  CHECK(mesh.surface().vertices.size() == 56 && mesh.surface().edges.size() == 162);
}

TEST(a_mesh_fits_scenes_in_the_plane_and_periodic_boxes_or_is_refused)
{
  const Mesh box = mesh_of(box_shape(2)), side = mesh_of(tube(1, 1, 12, 3));
  CHECK_ERROR(box.require_planar("wall 1"), "z component of");
  side.require_planar("wall 1");
}

TEST(a_mesh_tells_of_its_open_edges)
{
  CHECK(mesh_of(box_shape(2)).told() == "48 triangles, 26 corners, closed");
  CHECK(mesh_of(tube(3, 4, 24, 8)).told() == "384 triangles, 216 corners, 48 open edges, beside which grains may pass");
}

// In a box that ends a radius ahead of it, or which it crosses alike on both sides; not where it ends at a face.
TEST(a_mesh_lies_alike_on_both_faces_of_a_periodic_box)
{
  const Mesh box = mesh_of(box_shape(2)), tube_along_z = mesh_of(tube(3, 4, 24, 8));
  nscd::BoxEdges around{{{3, 0, 0}, {0, 9, 0}, {0, 0, 9}}, {true, false, false}, {-1.5, -4.5, -4.5}, 0.25};
  box.require_repeats("wall 1", around);
  around.radius = 0.75;
  CHECK_ERROR(box.require_repeats("wall 1", around), "wall 1: it does not lie alike on the two faces of the box in x");
  nscd::BoxEdges within{{{9, 0, 0}, {0, 9, 0}, {0, 0, 2}}, {false, false, true}, {-4.5, -4.5, -1}, 0.25};
  tube_along_z.require_repeats("wall 1", within);
  within.low[2] = 0.1;   // its end is at 2
  CHECK_ERROR(tube_along_z.require_repeats("wall 1", within), "in z, in which the box is periodic");
}

// Tiles that share no edges, since each row is moved by a third of a tile, and whose corners floats have rounded.
TEST(triangles_side_by_side_have_no_seams_either)
{
  Shape shape;
  for (int row = -6; row < 6; ++row)
    for (int k = -6; k < 6; ++k) {
      const double x = 0.3 * (k + row / 3.0), y = 0.3 * row;
      const auto point = [](double at, double up) { return Point{double(float(at)), double(float(up)), 0}; };
      add_quad(shape, point(x, y), point(x + 0.3, y), point(x + 0.3, y + 0.3), point(x, y + 0.3));
    }
  const Mesh mesh = mesh_of(shape);
  Random random(4);
  for (int k = 0; k < 2000; ++k) {
    const Vec4 centre{random(-0.9, 0.9), 0.3 * random(-4, 4), 0.2, 0};
    const std::vector<Touch> found = touches(mesh, centre, 0.2, 0.2);
    CHECK(found.size() == 1 && found[0].normal[2] == 1 && found[0].gap == 0);
  }
}
