// SPDX-License-Identifier: GPL-2.0-or-later
#include "obstacle/local_minima.hpp"

#include "contact/space.hpp"

namespace nscd {

constexpr double same_direction = 1e-6;   // rad

// What is still to be looked at. Most of it is not in the cache, so it is asked for before it is its turn.
struct LocalMinima::Left {
  std::vector<std::int32_t> faces, sides, rising;

  // Kept from sphere to sphere: no allocation in a steady step.
  static Left &kept()
  {
    thread_local Left left;
    left.faces.clear();
    left.sides.clear();
    left.rising.clear();
    return left;
  }
};

struct LocalMinima::Foot {
  double height;      // m, on the side of the normal above 0
  double inside[3];   // m, of each side of the face
};

LocalMinima::LocalMinima(const Surface &surface, const Obstacle &wall, const Vec4 &centre, double radius,
                         double within, std::vector<Touch> &found) :
    surface_(surface),
    wall_(wall), centre_(centre), radius_(radius), within_(within),
    reach_((radius + within + surface.round_off) * (1 + 1e-12)), found_(found), first_(found.size()),
    left_(Left::kept())
{
}

// How far inside of the side of its face the foot of the centre is, m.
double LocalMinima::inside(std::int32_t side) const
{
  const MeshFace &face = surface_.faces[std::size_t(side / 3)];
  Vec4 from = centre_ - face.corner;
  from[3] = 1;
  return dot(face.inward[side % 3], from);
}

// One of several with the same normal and gap is enough, as of two faces in one plane whose seam the foot is on; it is
// that with the lowest number, so that round-off does not choose.
void LocalMinima::add(std::size_t feature)
{
  const Touch touch = wall_.at(centre_, radius_, int(feature));
  if (!(touch.gap <= within_)) return;
  for (std::size_t k = first_; k < found_.size(); ++k) {
    const Vec4 turn = found_[k].normal - touch.normal;
    if (std::abs(found_[k].gap - touch.gap) > surface_.round_off) continue;
    if (dot(turn, turn) > same_direction * same_direction) continue;
    if (touch.feature < found_[k].feature) found_[k] = touch;
    return;
  }
  found_.push_back(touch);
}

void LocalMinima::take(std::int32_t face)
{
  left_.faces.push_back(face);
  const char *const at = reinterpret_cast<const char *>(&surface_.faces[std::size_t(face)]);
  for (std::size_t line = 0; line < sizeof(MeshFace); line += 64) __builtin_prefetch(at + line);
}

void LocalMinima::add_all()
{
  for (const std::int32_t face : left_.faces) look_at(face);
  for (const std::int32_t side : left_.sides) look_at_edge(side);
  add_rising();
}

void LocalMinima::look_at(std::int32_t number)
{
  const MeshFace &face = surface_.faces[std::size_t(number)];
  Vec4 from = centre_ - face.corner;
  Foot foot;
  foot.height = dot(face.normal, from);
  const double round_off = surface_.round_off;
  if (std::abs(foot.height) > reach_) return;
  from[3] = 1;
  double beyond = 0;
  unsigned border = 0;   // as MeshFace::owns: sides that the foot is beyond, and their ends
  for (int k = 0; k < 3; ++k) {
    foot.inside[k] = dot(face.inward[k], from);
    beyond = std::max(beyond, -foot.inside[k]);
    if (foot.inside[k] <= round_off) border |= 1u << k | 8u << k | 8u << (k + 1) % 3;
  }
  if (beyond * beyond + foot.height * foot.height > reach_ * reach_) return;
  if (beyond <= round_off) add(std::size_t(number));
  else if (beyond <= within_ && rises(number, foot)) left_.rising.push_back(number);
  const unsigned asked = border & face.owns;
  for (int k = 0; asked && k < 3; ++k) {
    if (asked & 1u << k) {
      left_.sides.push_back(3 * number + k);
      __builtin_prefetch(&surface_.edges[std::size_t(surface_.sides[std::size_t(left_.sides.back())].edge)]);
    }
    if (asked & 8u << k) look_at_vertex(face.vertex[k]);
  }
}

// Whether this nearest point of an edge or a vertex lies on a face over which the surface comes nearer still. So it is
// where triangles lie side by side that share no edge: in a file of several parts, or with corners on another's side.
bool LocalMinima::is_passed(const Vec4 &point) const
{
  const Vec4 apart = centre_ - point;
  const double written = surface_.written;
  const auto passes = [&](const MeshFace &face) {
    Vec4 to = point - face.corner;
    if (std::abs(dot(face.normal, to)) > written) return false;
    to[3] = 1;
    for (const Vec4 &inward : face.inward) {
      const double at = dot(inward, to), ahead = dot(inward, apart);
      if (at < -written || (at <= written && ahead <= written)) return false;
    }
    const Vec4 along = apart - face.normal * dot(face.normal, apart);
    return dot(along, along) > written * written;
  };
  for (const std::int32_t face : left_.faces)
    if (passes(surface_.faces[std::size_t(face)])) return true;
  return false;
}

// The foot is not inside of the face of this side.
void LocalMinima::look_at_edge(std::int32_t side)
{
  const std::size_t number = std::size_t(surface_.sides[std::size_t(side)].edge);
  const MeshEdge &edge = surface_.edges[number];
  const Vec4 from = centre_ - edge.start;
  const double along = dot(from, edge.direction), round_off = surface_.round_off;
  if (along < -round_off || along > edge.length + round_off) return;
  if (dot(from, from) - along * along > reach_ * reach_) return;
  const auto next = [&](std::int32_t of) { return surface_.sides[std::size_t(of)].next; };
  for (std::int32_t other = next(side); other != side; other = next(other))
    if (inside(other) > round_off) return;
  if (is_passed(edge.start + edge.direction * along)) return;
  add(surface_.faces.size() + number);
}

void LocalMinima::look_at_vertex(std::int32_t vertex)
{
  const Vec4 start = surface_.vertices[std::size_t(vertex)], from = centre_ - start;
  if (dot(from, from) > reach_ * reach_) return;
  for (const std::int32_t other : surface_.around(vertex)) {
    const Vec4 along = surface_.vertices[std::size_t(other)] - start;
    const double ahead = dot(from, along);
    if (ahead > 0 && ahead * ahead > surface_.round_off * surface_.round_off * dot(along, along)) return;
  }
  if (is_passed(start)) return;
  add(surface_.faces.size() + surface_.edges.size() + std::size_t(vertex));
}

// Whether another face rises beyond this side, and the centre is before it and not behind.
bool LocalMinima::rises_beyond(std::int32_t side, const Foot &foot) const
{
  const std::int32_t risen = surface_.sides[std::size_t(side)].beyond.on[foot.height < 0];
  if (risen < 0) return false;
  const MeshFace &face = surface_.faces[std::size_t(side / 3)], &other = surface_.faces[std::size_t(risen)];
  return dot(other.normal, centre_ - other.corner) * dot(other.normal, face.inward[side % 3]) > 0;
}

// Whether the foot, which is outside, is beyond sides alone where the surface rises, and no farther than `within`.
bool LocalMinima::rises(std::int32_t number, const Foot &foot) const
{
  const MeshFace &face = surface_.faces[std::size_t(number)];
  int nearest = 0;
  double nearest2 = INFINITY;
  for (int k = 0; k < 3; ++k) {
    const std::int32_t side = 3 * number + k;
    const Vec4 from = centre_ - surface_.vertices[std::size_t(face.vertex[k])];
    const double distance2 = dot(from, from);
    if (distance2 < nearest2) nearest = k;
    nearest2 = std::min(nearest2, distance2);
    if (foot.inside[k] >= 0) continue;
    const MeshEdge &edge = surface_.edges[std::size_t(surface_.sides[std::size_t(side)].edge)];
    const double along = dot(centre_ - edge.start, edge.direction);
    if (along >= 0 && along <= edge.length) return rises_beyond(side, foot);
  }
  if (nearest2 - foot.height * foot.height > within_ * within_) return false;
  bool any = false;
  for (const int k : {nearest, (nearest + 2) % 3}) {
    const std::int32_t side = 3 * number + k;
    const bool flat = surface_.sides[std::size_t(side)].beyond.on[foot.height < 0] == BeyondSide::flat;
    if (foot.inside[k] >= 0 || flat) continue;
    if (!rises_beyond(side, foot)) return false;
    any = true;
  }
  return any;
}

// What lies in the plane of a face that is nearer than the surface is no constraint: the face is elsewhere.
void LocalMinima::add_rising()
{
  double nearest = INFINITY;
  for (std::size_t k = first_; k < found_.size(); ++k) nearest = std::min(nearest, found_[k].gap);
  for (const std::int32_t face : left_.rising)
    if (wall_.at(centre_, radius_, face).gap >= nearest - surface_.round_off) add(std::size_t(face));
}

Vec4 any_perpendicular(const Vec4 &direction)
{
  const Vec4 least = std::abs(direction[0]) < 0.6 ? Vec4{1, 0, 0, 0} : Vec4{0, 1, 0, 0};
  const Vec4 across = cross(direction, least);
  return across / length(across);
}

}    // namespace nscd
