// SPDX-License-Identifier: GPL-2.0-or-later
// Everything one step works on: the arrays it was handed, and its own, kept from step to step.
#pragma once

#include "base/hot.hpp"
#include "base/storage.hpp"
#include "contact/contact.hpp"
#include "contact/sphere.hpp"
#include "parallel/halo.hpp"
#include "scene/contact_table.hpp"
#include "scene/drift/drift.hpp"
#include "scene/obstacles.hpp"
#include "scene/slabs.hpp"
#include "scene/views.hpp"
#include "settings/settings.hpp"

#include <span>
#include <vector>

namespace nscd {

// The largest of pairs: m, and over the smaller radius.
struct Overlap {
  double length = 0, ratio = 0;
};

// How contacts resist sliding, and how grains answer to it.
struct Friction {
  Model model = Model::frictionless;
  double spin_response = 0;                 // m r^2 / I
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

// Walls that stand are bodies of infinite mass. Several copies, used in turn: consecutive wall contacts then do not
// wait for each other's store to the same body.
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

// What a step was handed. Arrays of others, none of them kept.
struct Input {
  const Settings &settings;
  const Materials &materials;
  Grains grains{};
  int dimension = 3;                     // 2: all grains in a plane z = const
  double dt = 0;
};

// Atoms, as they are where contacts are sought.
struct Atoms {
  std::vector<Sphere> spheres{};         // (owned + ghosts)
  std::vector<int> owner{};              // (owned + ghosts) index of the body that an atom is (an image of)
  std::vector<std::pair<std::int32_t, int>> own_tags{};   // sorted: tag and index of owned atoms, if there are images
};

// Bodies and how they move.
struct Motion {
  // What `bodies` and `spins` are now: the velocities of free motion, as gathered or behind the impacts of the step;
  // those of the middle of the step, while impacts are resolved; with what the impulses of contacts have given so far;
  // v_{k+1}, once the rounds are over.
  enum class Stage { free, in_impacts, with_impulses, solved };
  Stage stage = Stage::free;
  AlignedVector<Body> bodies{};          // (moving() + obstacle_copies a slab + contacts with walls that move), m/s
  AlignedVector<Vec4> spins{};           // (bodies) surface velocity r omega, m/s; walls 0. With friction
  AlignedVector<Vec4> displacement{};    // (moving()) from where contacts were sought to q_{k+1}
  std::vector<double> kicks{};           // (bodies) |dt f / m| of the step, m/s; obstacles 0
  std::vector<Way> ways{};               // (moving()) of obstacles; or empty: none has a velocity
  AlignedVector<Vec4> paces{};           // (owned) velocities of obstacles in the step, m/s; or empty, as ways
  Copies copies{};
};

// What the search for pairs keeps: detection.cpp fills it, and watches the pairs that are near.
struct PairSearch {
  std::vector<Candidate> found{};        // listed pairs that are near enough to watch, the first found_count
  std::size_t found_count = 0;
  std::vector<Candidate> unlisted{};     // pairs that the list lacks, and that free motion brings together
  std::vector<Candidate> touching{};     // contacts-to-be, in list order, or by part where threads share them
  std::vector<Candidate> ordered{};      // scratch
  std::vector<Watched> near{};           // by law gap: made contacts if the solution drives them together
  std::size_t unforeseen = 0;            // of those, pairs within reach that free motion does not bring together
  double watch = 0;                      // surface distance within which pairs are watched, m
  std::vector<std::int32_t> beside{};    // atoms that are near a wall; scratch
  std::vector<Touch> touches{};          // scratch
  std::vector<double> moved{};           // (bodies) length of their displacement, m; scratch
  Overlap watched_overlap{};             // of near, at the end of the step
};

// What is much and what is little in a step.
struct Scales {
  double smooth_kick = 0;                // largest |dt f / m| of the step, m/s
  double lasting_moment = 0;             // s after where contacts are sought, when those that last act
  double round_off = 0;                  // of velocities, m/s
  double tol_of_worth = 0;               // what a solved step leaves of a contact's velocity in error: a share of
  double tol_absolute = 0;               // worth(), and m/s
};

// Who works on it.
struct Execution {
  Halo *halo = nullptr;                  // none on one rank
  Slabs slabs{1};                        // of threads
};

struct State {
  Input in;
  Atoms atoms{};
  Motion motion{};
  ContactTable table{};
  Obstacles obstacles{};                 // walls
  Friction friction{};
  Courses courses{};                     // of grains with impacts
  Drift drift{};
  PairSearch search{};
  Scales scales{};
  Execution exec{};

  // Bodies that are grains, of this rank or copies of others'.
  int moving() const { return in.grains.owned + motion.copies.count; }
  // Of contact k, where the table has them.
  const Material &material(std::size_t k) const { return in.materials[table.material[k]]; }
  // Body that stands for a wall in contact k of body i.
  int obstacle(int i, std::size_t k) const
  {
    return moving() + obstacle_copies * exec.slabs.of(i) + int(k % obstacle_copies);
  }
  // A body of a contact with a wall that moves: of infinite mass, with the velocity of the wall's surface there.
  int add_obstacle(const Vec4 &velocity);
};

inline Way way(const Motion &m, int body) { return m.ways.empty() ? Way::has_moved : m.ways[body]; }

// What a solved step leaves of a contact's velocity in error, m/s.
NSCD_INLINE double tolerance(const Scales &s, double worth) { return s.tol_of_worth * worth + s.tol_absolute; }

// What a solved step leaves of an overlap, m; `radius` of the smaller grain.
NSCD_INLINE double left_of_overlap(const State &s, double worth, double radius)
{
  const double left = tolerances * tolerance(s.scales, worth) * s.in.dt;
  return s.in.settings.overlap ? std::min(left, *s.in.settings.overlap * radius) : left;
}

// By how much planes of lasting contacts may be nearer than the surface, m. Contacts that push lie at about no gap:
// none of them could take its plane half-way without. A pair that is stopped on its way there may overlap by so much.
NSCD_INLINE double left_by_planes(const State &s, double radius)
{
  return s.in.settings.overlap ? share_of_planes * *s.in.settings.overlap * radius : 0;
}

// Over all ranks.
inline double sum_everywhere(const State &s, double value) { return s.exec.halo ? s.exec.halo->sum(value) : value; }

// Velocity of grain i at the start of the step, of an obstacle (a wall's body too) in the step, m/s.
NSCD_INLINE Vec4 start_velocity(const State &s, int i)
{
  if (i >= s.moving()) return s.motion.bodies[i];
  if (i >= s.in.grains.owned) return s.motion.copies.start[i - s.in.grains.owned];
  if (!s.motion.paces.empty() && !s.in.grains.moves(i)) return s.motion.paces[i];
  const double *v = s.in.grains.v + 3 * std::size_t(i);
  return Vec4{v[0], v[1], v[2], 0};
}

// What the smooth forces change of its velocity in the step, m/s.
NSCD_INLINE Vec4 smooth_kick(const State &s, int i)
{
  if (i >= s.in.grains.owned) return s.motion.copies.kick[i - s.in.grains.owned];
  const double *f = s.in.grains.f + 3 * std::size_t(i);
  return Vec4{f[0], f[1], f[2], 0} * (s.in.dt * s.in.grains.force_to_acceleration * s.motion.bodies[i][3]);
}

}    // namespace nscd
