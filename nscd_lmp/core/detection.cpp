#include "detection.hpp"

#include "error.hpp"
#include "hot.hpp"

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

NSCD_INLINE double start_velocity(const State &s, const Vec4 &n, int i, int j)
{
  const double *vi = s.grains.v + 3 * std::size_t(i);
  double u = n[0] * vi[0] + n[1] * vi[1] + n[2] * vi[2];
  if (j < 0) return u;
  const double *vj = s.grains.v + 3 * std::size_t(j);
  return u - (n[0] * vj[0] + n[1] * vj[1] + n[2] * vj[2]);
}

NSCD_INLINE void add_contact(State &s, const Vec4 &normal, double w, int body_i, int body_j)
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

NSCD_INLINE void add_pair(State &s, int i, int j, const Vec4 &separation, double distance_squared)
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

// All listed pairs that are near enough to watch, into s.found. Most are not, and a branch on that would be
// mispredicted, so every pair is stored and the counter moves on or not.
NSCD_HOT void filter_pairs(State &s, const PairList &pairs)
{
  const Sphere *const spheres = s.spheres.data();
  std::size_t kept = 0;
  for (int entry = 0; entry < pairs.count; ++entry) {
    const int i = pairs.atom[entry], count = pairs.neighbors[entry];
    const int *const neighbors = pairs.first[entry];
    const Vec4 centre = spheres[i].centre;
    const double watch = spheres[i].radius + s.watch;
    if (s.found.size() < kept + count) s.found.resize(2 * (kept + count));
    NearPair *const found = s.found.data();
    for (int k = 0; k < count; ++k) {
      const int j = neighbors[k] & neighbor_index_mask;
      const Vec4 separation = centre - spheres[j].centre;
      const double watched = watch + spheres[j].radius;
      found[kept] = {i, j};
      kept += dot(separation, separation) <= watched * watched;
    }
  }
  s.found_count = kept;
}

NSCD_HOT void detect_pairs(State &s, const PairList &pairs)
{
  filter_pairs(s, pairs);
  for (std::size_t k = 0; k < s.found_count; ++k) {
    const auto [i, j] = s.found[k];
    if (pairs.cross_pairs_twice && j >= s.grains.owned && s.grains.tag[i] > s.grains.tag[j]) continue;
    const Sphere &a = s.spheres[i], &b = s.spheres[j];
    const Vec4 separation = a.centre - b.centre;
    const double distance_squared = dot(separation, separation);
    const double limit = a.radius + a.reach + b.radius + b.reach;
    if (distance_squared > limit * limit) s.near.push_back({i, j});
    else add_pair(s, i, j, separation, distance_squared);
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

// Neighbors in the list share bodies, and a sweep in list order would wait for each store before the next load.
// Taking the contacts from several places of the list in turn keeps the processor busy (6.6 -> 4.0 ns a contact,
// the sweep count within 1 %); more places than 8 gain nothing.
constexpr std::size_t streams = 8;

NSCD_HOT void interleave(State &s)
{
  const std::size_t n = s.contacts.size(), length = (n + streams - 1) / streams;
  s.listed_contacts.swap(s.contacts);
  s.listed_infos.swap(s.infos);
  s.contacts.resize(n);
  s.infos.resize(n);
  std::size_t k = 0;
  for (std::size_t place = 0; place < length; ++place)
    for (std::size_t listed = place; listed < n; listed += length, ++k) {
      s.contacts[k] = s.listed_contacts[listed];
      s.infos[k] = s.listed_infos[listed];
    }
}

}    // namespace

void detect(State &state, const PairList &pairs)
{
  state.contacts.clear();
  state.infos.clear();
  state.near.clear();
  detect_pairs(state, pairs);
  for (std::size_t wall = 0; wall < state.settings.walls.size(); ++wall) detect_wall(state, wall);
  interleave(state);
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
