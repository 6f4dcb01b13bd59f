// SPDX-License-Identifier: GPL-2.0-or-later
#include "stl_files.hpp"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <unistd.h>

void add_quad(Shape &shape, const Point &a, const Point &b, const Point &c, const Point &d, bool other)
{
  if (other) shape.insert(shape.end(), {{a, b, d}, {b, c, d}});
  else shape.insert(shape.end(), {{a, b, c}, {a, c, d}});
}

Shape box_shape(int cells)
{
  Shape shape;
  const auto at = [cells](int k) { return 2.0 * k / cells - 1; };
  for (int d = 0; d < 3; ++d)
    for (const double side : {-1.0, 1.0})
      for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j) {
          const auto point = [&](int p, int q) {
            Point x{};
            x[d] = side;
            x[(d + 1) % 3] = at(p);
            x[(d + 2) % 3] = at(q);
            return x;
          };
          add_quad(shape, point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1), (i + j) % 2);
        }
  return shape;
}

Shape terrain(double l, int cells, const std::function<double(double x, double y)> &height)
{
  Random random(3);
  std::vector<Point> points;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const double edge = 2 * l / cells;
      const double inner = i > 0 && j > 0 && i < cells && j < cells;
      const double x = -l + edge * (i + 0.35 * inner * random(-1, 1));
      const double y = -l + edge * (j + 0.35 * inner * random(-1, 1));
      points.push_back({x, y, height(x, y)});
    }
  Shape shape;
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const Point *const first = &points[std::size_t(j * (cells + 1) + i)], *const above = first + cells + 1;
      add_quad(shape, first[0], first[1], above[1], above[0], random() < 0.5);
    }
  return shape;
}

static Shape turned(int facets, const std::vector<double> &z, const std::vector<double> &radius)
{
  Shape shape;
  for (std::size_t ring = 0; ring + 1 < z.size(); ++ring)
    for (int k = 0; k < facets; ++k) {
      const auto point = [&](int facet, std::size_t of) {
        const double angle = 2 * M_PI * (facet % facets) / facets;
        return Point{radius[of] * std::cos(angle), radius[of] * std::sin(angle), z[of]};
      };
      const Point a = point(k, ring), b = point(k + 1, ring), c = point(k + 1, ring + 1), d = point(k, ring + 1);
      if (radius[ring] > 0) shape.push_back({a, b, c});
      if (radius[ring + 1] > 0) shape.push_back({a, c, d});
    }
  return shape;
}

Shape tube(double radius, double length, int facets, int rings)
{
  std::vector<double> z, radii(std::size_t(rings) + 1, radius);
  for (int ring = 0; ring <= rings; ++ring) z.push_back(length * (double(ring) / rings - 0.5));
  return turned(facets, z, radii);
}

Shape globe(double radius, int facets, int rings)
{
  std::vector<double> z, radii;
  for (int ring = 0; ring <= rings; ++ring) {
    const double angle = M_PI * ring / rings;
    z.push_back(-radius * std::cos(angle));
    radii.push_back(ring == 0 || ring == rings ? 0 : radius * std::sin(angle));
  }
  return turned(facets, z, radii);
}

nscd::Mesh mesh_of(const Shape &shape)
{
  nscd::AlignedVector<nscd::Triangle> triangles;
  for (const Corners &corners : shape) {
    nscd::Triangle &triangle = triangles.emplace_back();
    for (int k = 0; k < 3; ++k) triangle.corner[k] = nscd::Vec4{corners[k][0], corners[k][1], corners[k][2], 0};
  }
  return nscd::Mesh(triangles, "wall 1");
}

std::string write_file(const std::string &bytes, const std::string &name)
{
  const auto path = std::filesystem::temp_directory_path() / ("nscd_" + std::to_string(getpid()) + "_" + name);
  std::ofstream(path, std::ios::binary) << bytes;
  return path.string();
}

std::string write_ascii(const Shape &shape, const std::string &name)
{
  std::ostringstream text;
  text.precision(17);
  text << "solid some name\n";
  for (const Corners &triangle : shape) {
    text << "  facet normal 0 0 0\n    outer loop\n";
    for (const Point &corner : triangle)
      text << "      vertex " << corner[0] << ' ' << corner[1] << ' ' << corner[2] << '\n';
    text << "    endloop\n  endfacet\n";
  }
  text << "endsolid some name\n";
  return write_file(text.str(), name);
}

std::string write_binary(const Shape &shape, const std::string &name)
{
  std::string bytes = "solid though it is binary";
  bytes.resize(80);
  const auto put = [&](auto number) { bytes.append(reinterpret_cast<const char *>(&number), sizeof number); };
  put(std::uint32_t(shape.size()));
  for (const Corners &triangle : shape) {
    for (int k = 0; k < 3; ++k) put(float(0));
    for (const Point &corner : triangle)
      for (const double x : corner) put(float(x));
    put(std::uint16_t(0));
  }
  return write_file(bytes, name);
}
