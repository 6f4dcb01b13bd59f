// SPDX-License-Identifier: GPL-2.0-or-later
#include "obstacle/mesh.hpp"

#include "base/error.hpp"
#include "obstacle/kinds.hpp"
#include "obstacle/local_minima.hpp"
#include "obstacle/repeats.hpp"
#include "obstacle/stl.hpp"

#include <cmath>
#include <sstream>

namespace nscd {

namespace {

AlignedVector<Triangle> &require_some(AlignedVector<Triangle> &triangles, const std::string &name)
{
  if (triangles.empty()) fail(name, " has no triangles");
  if (triangles.size() > most_features)
    fail(name, ": ", triangles.size(), " triangles are more than ", most_features, ": make it coarser");
  return triangles;
}

// The foot of a centre on a feature is `apart` (m) away; where it is on it, any normal will do.
Touch touch_apart(const Vec4 &apart, double radius, int feature, const Vec4 &any)
{
  const double distance = length(apart);
  return {distance > 0 ? apart / distance : any, distance - radius, feature};
}

}    // namespace

// The surface comes first, since it refuses what the others cannot do with.
Mesh::Mesh(AlignedVector<Triangle> triangles, const std::string &name) :
    tree_(require_some(triangles, name)), surface_(triangles, name), grid_(triangles, tree_)
{
  if (surface_.features() > most_features)
    fail(name, ": its ", surface_.faces.size(), " faces, ", surface_.edges.size(), " edges and ",
         surface_.vertices.size(), " vertices are more than ", most_features, ": make it coarser");
}

void Mesh::find_near(std::span<const Sphere> spheres, double within, std::vector<std::int32_t> &found) const
{
  const double more = within + surface_.round_off;
  for (std::size_t k = 0; k < spheres.size(); ++k)
    if (!grid_.is_beyond(spheres[k].centre, spheres[k].radius + more)) found.push_back(std::int32_t(k));
}

Touch Mesh::at(const Vec4 &centre, double radius, int feature) const
{
  const std::size_t number = std::size_t(feature), faces = surface_.faces.size(), edges = surface_.edges.size();
  if (number < faces) {
    const MeshFace &face = surface_.faces[number];
    const double height = dot(face.normal, centre - face.corner);
    return {height < 0 ? -face.normal : face.normal, std::abs(height) - radius, feature};
  }
  if (number < faces + edges) {
    const MeshEdge &edge = surface_.edges[number - faces];
    const Vec4 from = centre - edge.start;
    const double along = std::clamp(dot(from, edge.direction), 0.0, edge.length);
    return touch_apart(from - edge.direction * along, radius, feature, any_perpendicular(edge.direction));
  }
  return touch_apart(centre - surface_.vertices[number - faces - edges], radius, feature, Vec4{0, 0, 1, 0});
}

void Mesh::touch(const Vec4 &centre, double radius, double within, std::vector<Touch> &found) const
{
  LocalMinima minima(surface_, *this, centre, radius, within, found);
  const double reach = std::max(radius + within, 0.0) + surface_.round_off;
  tree_.visit(centre, reach, [&](std::int32_t face) { minima.take(face); });
  minima.add_all();
}

void Mesh::require_planar(const std::string &name) const
{
  for (const MeshFace &face : surface_.faces)
    if (face.normal[2] != 0)
      fail(name, ": a triangle at (", face.corner[0], ", ", face.corner[1], ", ", face.corner[2], ") has a normal ",
           "with a z component of ", face.normal[2], ", but the scene is planar (dimension 2): use a mesh of ",
           "triangles that are all parallel to z and reach to both sides of the grains' plane, or dimension 3");
}

std::string Mesh::told() const
{
  std::size_t open = 0;
  for (std::size_t side = 0; side < surface_.sides.size(); ++side)
    open += std::size_t(surface_.sides[side].next) == side;
  std::ostringstream text;
  text << surface_.faces.size() << " triangles, " << surface_.vertices.size() << " corners, ";
  if (open == 0) text << "closed";
  else text << open << " open edges, beside which grains may pass";
  return text.str();
}

void Mesh::require_repeats(const std::string &name, const BoxEdges &box) const
{
  require_alike_at_faces(*this, name, box);
}

static std::shared_ptr<const Obstacle> read(Arguments &words, const std::string &name)
{
  const std::string path = words.word();
  std::string of_file = name;
  of_file.append(": file '").append(path).append("'");
  return std::make_shared<Mesh>(read_stl(path, name), of_file);
}

static const RegisterObstacle mesh({.order = 20,
                                    .name = "mesh",
                                    .words = "FILE",
                                    .doc = "the triangles of an STL file, ASCII or binary; grains touch both sides",
                                    .read = read});

}    // namespace nscd
