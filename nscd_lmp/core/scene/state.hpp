// Everything one step works on: the arrays it was handed, and its own, kept from step to step.
#pragma once

#include "base/hot.hpp"
#include "base/storage.hpp"
#include "contact/contact.hpp"
#include "parallel/halo.hpp"
#include "scene/contact_table.hpp"
#include "scene/drift.hpp"
#include "scene/slabs.hpp"
#include "scene/views.hpp"
#include "settings/settings.hpp"

#include <span>
#include <vector>

namespace nscd {

// Centre and radius of an atom where contacts are sought; `reach` widens the search, 0 for law moreau.
struct Sphere {
  alignas(vec4_alignment) Vec4 centre;  // fourth component 0
  double radius;
  double reach;
};

// The largest of pairs: m, and over the smaller radius.
struct Overlap {
  double length = 0, ratio = 0;
};

// What scenes with friction have beside bodies and contacts; empty otherwise.
struct Friction {
  Model model = Model::frictionless;
  double spin_response = 0;                 // m r^2 / I
  AlignedVector<Vec4> spins{};              // (bodies) surface velocity r omega, m/s; walls 0
};

// How impacts under restitution bend the courses of grains: each acts when its pair meets. Empty where there are none.
struct Courses {
  AlignedVector<Vec4> start{};   // (bodies) m from q_k, where the straight way behind the last impact comes from
  AlignedVector<Vec4> shift{};   // (bodies) m, by which impacts displace more than if they acted half-way
  std::vector<char> straight{};  // (bodies) whether its impacts act half-way after all
  double work = 0;               // of smooth forces on the shift, J in the units of m v^2

  // Keeps the memory.
  void clear()
  {
    start.clear(), shift.clear(), straight.clear();
    work = 0;
  }
};

// Walls are bodies of infinite mass. Several copies, used in turn: consecutive wall contacts then do not wait
// for each other's store to the same body.
constexpr int obstacle_copies = 16;

// Grains of other ranks that have images here: bodies owned..owned + count - 1.
struct Copies {
  int count = 0;
  AlignedVector<Vec4> start{}, kick{};             // v_k and dt f / m, m/s
  AlignedVector<Vec4> start_spin{}, spin_kick{};   // the same of surface velocities, with friction
  AlignedVector<Vec4> place{};                     // q_k, m, where a box moves
};

// What an obstacle with a velocity does: LAMMPS has moved it ahead of the step, or will behind it, or it is a belt.
enum class Way : std::int8_t { has_moved, will_move, stands };

struct State {
  const Settings &settings;
  Grains grains;
  int dimension = 3;                     // 2: all grains in a plane z = const
  Halo *halo = nullptr;                  // none on one rank
  double dt = 0;

  std::vector<Sphere> spheres{};         // (owned + ghosts)
  std::vector<int> owner{};              // (owned + ghosts) index of the body that an atom is (an image of)
  std::vector<std::pair<std::int32_t, int>> own_tags{};   // sorted: tag and index of owned atoms, if there are images
  Copies copies{};
  AlignedVector<Body> bodies{};          // (moving() + obstacle_copies a slab)
  std::vector<Way> ways{};               // (moving()) of obstacles; or empty: none has a velocity
  AlignedVector<Vec4> paces{};           // (owned) velocities of obstacles in the step, m/s; or empty, as ways
  std::vector<double> kicks{};           // (bodies) |dt f / m| of the step, m/s; obstacles 0
  AlignedVector<Vec4> displacement{};    // (moving()) from where contacts were sought to q_{k+1}
  std::vector<double> moved{};           // (bodies) its length, m; scratch
  ContactTable table{};
  Courses courses{};                     // of grains with impacts

  Friction friction{};
  Drift drift{};
  Slabs slabs{1};                        // of threads

  std::vector<Candidate> found{};        // listed pairs that are near enough to watch, the first found_count
  std::size_t found_count = 0;
  std::vector<Candidate> touching{};     // contacts-to-be, in list order, or by part where threads share them
  std::vector<Watched> near{};           // by law gap: made contacts if the solution drives them together
  std::size_t unforeseen = 0;            // of those, pairs within reach that free motion does not bring together
  std::vector<Candidate> ordered{};      // scratch

  Overlap watched_overlap{};           // of near, at the end of the step
  double lasting_moment = 0;           // s after where contacts are sought, when those that last act
  double watch = 0;                    // surface distance within which pairs are watched, m
  double smooth_kick = 0;              // largest |dt f / m| of the step, m/s
  double round_off = 0;                // of velocities, m/s
  double tol_of_worth = 0;             // what a solved step leaves of a contact's velocity in error: a share of
  double tol_absolute = 0;             // worth(), and m/s

  // Bodies that are grains, of this rank or copies of others'.
  int moving() const { return grains.owned + copies.count; }
  // Body that stands for a wall in contact k of body i.
  int obstacle(int i, std::size_t k) const
  {
    return moving() + obstacle_copies * slabs.of(i) + int(k % obstacle_copies);
  }
};

inline Way way(const State &s, int body) { return s.ways.empty() ? Way::has_moved : s.ways[body]; }

// What a solved step leaves of a contact's velocity in error, m/s.
NSCD_INLINE double tolerance(const State &s, double worth) { return s.tol_of_worth * worth + s.tol_absolute; }

// What a solved step leaves of an overlap, m; `radius` of the smaller grain.
NSCD_INLINE double left_of_overlap(const State &s, double worth, double radius)
{
  const double left = tolerances * tolerance(s, worth) * s.dt;
  return s.settings.overlap ? std::min(left, *s.settings.overlap * radius) : left;
}

// By how much planes of lasting contacts may be nearer than the surface, m. Contacts that push lie at about no gap:
// none of them could take its plane half-way without. A pair that is stopped on its way there may overlap by so much.
NSCD_INLINE double left_by_planes(const State &s, double radius)
{
  return s.settings.overlap ? share_of_planes * *s.settings.overlap * radius : 0;
}

// Over all ranks.
inline double sum_everywhere(const State &s, double value) { return s.halo ? s.halo->sum(value) : value; }

// Velocity of grain i at the start of the step, of an obstacle in the step, m/s.
NSCD_INLINE Vec4 start_velocity(const State &s, int i)
{
  if (i >= s.grains.owned) return s.copies.start[i - s.grains.owned];
  if (!s.paces.empty() && !s.grains.moves(i)) return s.paces[i];
  const double *v = s.grains.v + 3 * std::size_t(i);
  return Vec4{v[0], v[1], v[2], 0};
}

// What the smooth forces change of its velocity in the step, m/s.
NSCD_INLINE Vec4 smooth_kick(const State &s, int i)
{
  if (i >= s.grains.owned) return s.copies.kick[i - s.grains.owned];
  const double *f = s.grains.f + 3 * std::size_t(i);
  return Vec4{f[0], f[1], f[2], 0} * (s.dt * s.grains.force_to_acceleration * s.bodies[i][3]);
}

}    // namespace nscd
