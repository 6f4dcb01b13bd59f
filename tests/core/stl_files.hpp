// SPDX-License-Identifier: GPL-2.0-or-later
// Meshes that tests make, and the STL files they are written to.
#pragma once

#include "obstacle/mesh.hpp"
#include "scene.hpp"

#include <string>
#include <vector>

using Corners = std::array<Point, 3>;
using Shape = std::vector<Corners>;

// Two triangles, split along the diagonal from the first corner or the other one.
void add_quad(Shape &shape, const Point &a, const Point &b, const Point &c, const Point &d, bool other = false);
// The box [-1, 1]^3, each side of it in cells x cells squares.
Shape box_shape(int cells);
// z = height(x, y) above [-l, l]^2, of irregular triangles.
Shape terrain(double l, int cells, const std::function<double(double x, double y)> &height);
// About z: the side of a cylinder, or a sphere with poles.
Shape tube(double radius, double length, int facets, int rings);
Shape globe(double radius, int facets, int rings);

nscd::Mesh mesh_of(const Shape &shape);

// Returns the path of a file in the folder for temporary files, which `name` tells from others of this process.
std::string write_ascii(const Shape &shape, const std::string &name);
std::string write_binary(const Shape &shape, const std::string &name);
std::string write_file(const std::string &bytes, const std::string &name);
