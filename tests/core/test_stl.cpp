// SPDX-License-Identifier: GPL-2.0-or-later
// STL files: what is read, and what is refused.
#include "check.hpp"
#include "obstacle/mesh.hpp"
#include "obstacle/stl.hpp"
#include "stl_files.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

using nscd::Mesh;

// Binary files and ASCII ones are the same triangles; several solids, capitals and other white space are read too.
TEST(a_mesh_is_read_from_binary_and_ascii_files)
{
  const Shape shape = box_shape(3);
  std::string text = "solid\n";
  for (std::size_t k = 0; k < shape.size(); ++k) {
    std::ostringstream facet;
    if (k == 5) facet << "endsolid\nsolid another\n";
    facet.precision(9);
    facet << "FACET NORMAL nan nan nan\r\nOUTER LOOP";
    for (const Point &corner : shape[k])
      facet << "\tVERTEX " << float(corner[0]) << ' ' << std::scientific << float(corner[1]) << std::defaultfloat
            << "  +" << float(corner[2]) + 2;
    text += facet.str() + "\r\nEndLoop EndFacet\n";
  }
  const std::string files[] = {write_binary(shape, "a.stl"), write_ascii(shape, "b.stl"),
                               write_file(text + "endsolid\n\n", "c.stl")};
  for (const std::string &file : files) {
    const auto triangles = nscd::read_stl(file, "wall 1");
    CHECK(triangles.size() == shape.size());
    for (std::size_t k = 0; k < shape.size(); ++k)
      for (std::size_t corner = 0; corner < 3; ++corner)
        for (int d = 0; d < 3; ++d) {
          const double up = file == files[2] && d == 2 ? 2 : 0;
          CHECK_NEAR(triangles[k].corner[corner][d], shape[k][corner][std::size_t(d)] + up, 3e-7);
        }
    const Mesh mesh(triangles, "wall 1");
    CHECK(mesh.surface().vertices.size() == 56 && mesh.surface().edges.size() == 162);   // V - E + F = 2
    std::filesystem::remove(file);
  }
}

TEST(files_that_are_no_mesh_are_refused)
{
  const auto refused = [](const std::string &path, const std::string &why) {
    CHECK_ERROR(settings("wall mesh " + path), why);
    CHECK_ERROR(settings("wall mesh " + path), "wall 1: file '" + path + "'");
    std::filesystem::remove(path);
  };
  refused("/nowhere/at.stl", "cannot be opened");
  refused(write_file("", "bad.stl"), "is empty");
  refused(write_file("ply\nformat ascii 1.0\n", "bad.stl"), "is no STL file");
  refused(write_file(std::string(400, 'x'), "bad.stl"), "is no STL file");
  refused(write_file("solid a\nendsolid a\n", "bad.stl"), "has no triangles");
  refused(write_binary({}, "bad.stl"), "has no triangles");
  const std::string facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex ";
  const std::string end = "\nendloop\nendfacet\nendsolid\n";
  refused(write_file("solid\n" + facet, "bad.stl"), "is cut off in line 6");
  refused(write_file("solid\n" + facet + "0 1 0\nendloop\nendfacet\n", "bad.stl"), "is cut off");
  refused(write_file("solid\n" + facet + "0 1 O" + end, "bad.stl"), "line 6: 'o' is not a number");
  refused(write_file("solid\n" + facet + "0 1" + end, "bad.stl"), "line 7: 'endloop' is not a number");
  refused(write_file("solid\n" + facet + "0 1 0\nvertex 2 2 0" + end, "bad.stl"), "'vertex' where 'endloop'");
  refused(write_file("solid\n" + facet + "0 nan 0" + end, "bad.stl"), "triangle 1 has a corner (0, nan, 0)");
  refused(write_file("solid\n" + facet + "0 1e200 0" + end, "bad.stl"), "not finite or beyond");
  refused(write_file("solid\n" + facet + "0.3 0 0" + end, "bad.stl"), "a triangle has no area");
  refused(write_file("solid\n" + facet + "0.3 1e-10 0" + end, "bad.stl"), "a triangle has no area");
  refused(write_ascii({{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}}, "bad.stl"), "one point");
  const std::string whole = write_binary(box_shape(1), "bad.stl");
  std::ifstream stream(whole, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  bytes[0] = 'S' + 1;
  refused(write_file(bytes.substr(0, bytes.size() - 7), "bad.stl"), "it has 677 bytes");
  CHECK_ERROR(settings("wall mesh"), "needs a value");
}
