#include "detection.hpp"

#include "error.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

std::uint64_t pair_key(std::int32_t a, std::int32_t b)
{
  const auto [low, high] = std::minmax(a, b);
  return (std::uint64_t(std::uint32_t(low)) << 32) | std::uint32_t(high);
}

// Tags are positive, so a set top bit tells a wall from a pair.
std::uint64_t wall_key(std::int32_t tag, std::size_t wall)
{
  return (std::uint64_t(1) << 63) | (std::uint64_t(wall) << 32) | std::uint32_t(tag);
}

double start_velocity(const State &s, const Vec4 &n, int i, int j)
{
  const double *vi = s.grains.v + 3 * std::size_t(i);
  double u = n[0] * vi[0] + n[1] * vi[1] + n[2] * vi[2];
  if (j < 0) return u;
  const double *vj = s.grains.v + 3 * std::size_t(j);
  return u - (n[0] * vj[0] + n[1] * vj[1] + n[2] * vj[2]);
}

void add_contact(State &s, const Vec4 &normal, double w, int body_i, int body_j)
{
  s.contacts.push_back({normal, 0.0, 1 / w, 0.0, body_i, body_j});
}

[[noreturn]] void refuse_overlap(const State &s, int i, int j, double gap)
{
  const auto &g = s.grains;
  fail("grains ", g.tag[i], " and ", g.tag[j], " overlap by ", -gap, ", more than the smaller radius ",
       std::min(g.radius[i], g.radius[j]),
       ": remove one of them, or take a smaller timestep if they were apart before");
}

void add_pair(State &s, int i, int j, const Vec4 &separation, double distance_squared)
{
  const int bi = s.owner[i], bj = s.owner[j];
  const double w = s.bodies[bi][3] + s.bodies[bj][3];
  if (bi == bj || w == 0) return;    // a grain and its own image, or two obstacles
  const double distance = std::sqrt(distance_squared);
  const double gap = distance - s.spheres[i].radius - s.spheres[j].radius;
  if (gap < -std::min(s.spheres[i].radius, s.spheres[j].radius)) refuse_overlap(s, i, j, gap);
  const Vec4 normal = separation / distance;
  add_contact(s, normal, w, bi, bj);
  s.infos.push_back({gap, start_velocity(s, normal, bi, bj), pair_key(s.grains.tag[i], s.grains.tag[j]), i, j});
}

void detect_pairs(State &s, const PairList &pairs)
{
  const Sphere *const spheres = s.spheres.data();
  const int owned = s.grains.owned;
  for (int entry = 0; entry < pairs.count; ++entry) {
    const int i = pairs.atom[entry];
    const Sphere si = spheres[i];
    const double radius_i = si.radius + si.reach, watch_i = si.radius + s.watch;
    const int *const neighbors = pairs.first[entry];
    for (int k = 0; k < pairs.neighbors[entry]; ++k) {
      const int j = neighbors[k] & neighbor_index_mask;
      const Sphere &sj = spheres[j];
      const Vec4 separation = si.centre - sj.centre;
      const double distance_squared = dot(separation, separation);
      const double watched = watch_i + sj.radius;
      if (distance_squared > watched * watched) continue;
      if (pairs.cross_pairs_twice && j >= owned && s.grains.tag[i] > s.grains.tag[j]) continue;
      const double limit = radius_i + sj.radius + sj.reach;
      if (distance_squared > limit * limit) s.near.push_back({i, j});
      else add_pair(s, i, j, separation, distance_squared);
    }
  }
}

[[noreturn]] void refuse_wall_overlap(const State &s, int i, std::size_t wall, double gap)
{
  fail("grain ", s.grains.tag[i], " is ", -gap, " inside wall ", wall + 1, ", more than its radius ",
       s.grains.radius[i], ": start it on the side that the wall's normal points to, or take a smaller timestep");
}

// n.x - offset is the height above the plane.
struct Height {
  Vec4 normal;
  double offset;
  explicit Height(const Plane &plane) :
      normal{plane.normal[0], plane.normal[1], plane.normal[2], 0},
      offset(dot(normal, Vec4{plane.point[0], plane.point[1], plane.point[2], 0}))
  {
  }
  double of(const Vec4 &centre) const { return dot(normal, centre) - offset; }
};

void add_wall_contact(State &s, int i, std::size_t wall, const Vec4 &normal, double gap)
{
  const double w = s.bodies[i][3];
  if (w == 0) return;
  if (gap < -s.spheres[i].radius) refuse_wall_overlap(s, i, wall, gap);
  const int copy = s.grains.owned + int(s.contacts.size() % obstacle_copies);
  add_contact(s, normal, w, i, copy);
  s.infos.push_back({gap, start_velocity(s, normal, i, -1), wall_key(s.grains.tag[i], wall), i, -1 - int(wall)});
}

void detect_wall(State &s, std::size_t wall)
{
  const Height height(s.settings.walls[wall]);
  for (int i = 0; i < s.grains.owned; ++i) {
    const double gap = height.of(s.spheres[i].centre) - s.spheres[i].radius;
    if (gap > s.watch) continue;
    if (gap > s.spheres[i].reach) s.near.push_back({i, -1 - int(wall)});
    else add_wall_contact(s, i, wall, height.normal, gap);
  }
}

bool promote_wall(State &s, const NearPair &near)
{
  const std::size_t wall = std::size_t(-1 - near.atom_j);
  const Height height(s.settings.walls[wall]);
  const Sphere &a = s.spheres[near.atom_i];
  if (height.of(a.centre + s.displacement[near.atom_i]) >= a.radius) return false;
  add_wall_contact(s, near.atom_i, wall, height.normal, height.of(a.centre) - a.radius);
  return true;
}

bool promote_pair(State &s, const NearPair &near)
{
  const Sphere &a = s.spheres[near.atom_i], &b = s.spheres[near.atom_j];
  const Vec4 separation = a.centre - b.centre;
  const Vec4 after = separation + s.displacement[s.owner[near.atom_i]] - s.displacement[s.owner[near.atom_j]];
  const double touching = a.radius + b.radius;
  if (dot(after, after) >= touching * touching) return false;
  add_pair(s, near.atom_i, near.atom_j, separation, dot(separation, separation));
  return true;
}

}    // namespace

void detect(State &state, const PairList &pairs)
{
  state.contacts.clear();
  state.infos.clear();
  state.near.clear();
  detect_pairs(state, pairs);
  for (std::size_t wall = 0; wall < state.settings.walls.size(); ++wall) detect_wall(state, wall);
}

std::size_t promote_near(State &state)
{
  const std::size_t before = state.contacts.size();
  std::size_t kept = 0;
  for (const NearPair near : state.near) {
    const bool promoted = near.atom_j < 0 ? promote_wall(state, near) : promote_pair(state, near);
    if (!promoted) state.near[kept++] = near;
  }
  state.near.resize(kept);
  return state.contacts.size() - before;
}

}    // namespace nscd
