// SPDX-License-Identifier: GPL-2.0-or-later
// What a step takes from the heap: nothing once it is steady, and no more than 200 bytes per contact.
#include "check.hpp"
#include "counted_new.hpp"
#include "scene.hpp"

#include <algorithm>
#include <cstdio>

using nscd::Step;

// 200 grains in a narrow box, 5 x 5 x 8, a little jittered so that they settle against each other and the walls.
static Scene bed(Random &random)
{
  Scene scene;
  for (int i = 0; i < 200; ++i) {
    const double r = random(0.85, 0.98);
    const Point cell{2.0 * (i % 5) + 1, 2.0 * (i / 5 % 5) + 1, 2.0 * (i / 25) + 1};
    scene.add({cell[0] + random(-1, 1) * (1 - r), cell[1] + random(-1, 1) * (1 - r), cell[2]}, r, r * r * r);
  }
  return scene;
}

// The same in the plane, 10 x 20 discs.
static Scene flat_bed(Random &random)
{
  Scene scene;
  for (int i = 0; i < 200; ++i) {
    const double r = random(0.85, 0.98);
    scene.add({2.0 * (i % 10) + 1 + random(-1, 1) * (1 - r), 2.0 * (i / 10) + 1, 0}, r, r * r * r);
  }
  return scene;
}

// How much there was of all that a step keeps.
struct Sizes {
  std::size_t contacts = 0, watched = 0, pairs = 0, impacts = 0;
  std::size_t room = 0;   // for watched pairs, of which there are most ahead of the solve
  explicit Sizes(const nscd::State &state) :
      contacts(state.table.contacts.size()), watched(state.search.near.size()),
      impacts(state.table.impact_impulse.size()),
      room(state.search.near.capacity())
  {
    for (const auto &info : state.table.infos) pairs += info.atom_j >= 0;
    for (const auto &near : state.search.near) pairs += near.pair.atom_j >= 0;
  }
  Sizes() = default;
  bool within(const Sizes &s) const
  {
    return contacts <= s.contacts && watched <= s.watched && pairs <= s.pairs && impacts <= s.impacts &&
        room <= s.room;
  }
  void widen(const Sizes &s)
  {
    contacts = std::max(contacts, s.contacts);
    watched = std::max(watched, s.watched);
    pairs = std::max(pairs, s.pairs);
    impacts = std::max(impacts, s.impacts);
    room = std::max(room, s.room);
  }
};

// Steady: nothing is more than in some step before, of those that were given up if this one is, and no impulses have to
// be kept from making energy, which is rare.
static void check_steady_steps_allocate_nothing(Scene scene, Step &step, const Point &gravity, std::size_t contacts)
{
  Sizes most, most_given_up;
  int steady_steps = 0;
  for (int k = 0; k < 300; ++k) {
    const std::size_t before = heap().allocations;
    const long limited = step.report().energy_limited;
    scene.accelerate(gravity);
    scene.advance(step, 0.01);
    const std::size_t after = heap().allocations;
    const Sizes now(step.state());
    const bool given_up = !step.report().converged;
    const bool as_before = now.within(most) && (!given_up || now.within(most_given_up));
    const auto &straight = step.state().courses.straight;   // another pass, which is rare too
    const bool once = std::count(straight.begin(), straight.end(), 1) == 0;
    const bool steady = k >= 170 && as_before && step.report().energy_limited == limited;
    if (steady && once) CHECK(after == before);
    steady_steps += steady;
    most.widen(now);
    if (given_up) most_given_up.widen(now);
  }
  CHECK(most.contacts > contacts);
  CHECK(steady_steps > 80);
}

static void check_spheres(const std::string &keywords)
{
  Random random(3);
  Step step(settings(keywords + " unconverged ignore maxiter 50" + box_walls(10, 17)));
  check_steady_steps_allocate_nothing(bed(random), step, {0, 0, -10}, 300);
}

static void check_discs(const std::string &keywords)
{
  Random random(3);
  const std::string walls = " wall plane 0 0 0 1 0 0 wall plane 20 0 0 -1 0 0 wall plane 0 0 0 0 1 0";
  Step step(settings(keywords + " unconverged ignore maxiter 50" + walls), {}, 2);
  check_steady_steps_allocate_nothing(flat_bed(random), step, {0, -10, 0}, 200);
}

TEST(steady_steps_allocate_nothing)
{
  for (const auto &law : nscd::schemes())
    for (const auto &solver : nscd::solvers())
      for (const char *e : {"0", "0.5"}) {
        if (solver.kind == "global" && solver.name != "apgs") continue;  // factorisations allocate
        check_spheres("law " + std::string(law.name) + " solver " + std::string(solver.name) + " restitution " + e);
      }
}

TEST(steady_steps_with_friction_allocate_nothing)
{
  for (const auto &law : nscd::schemes())
    for (const char *solver : {"pdas", "ebp restitution 0.5 e_t 0.5", "pdas restitution 0.5"}) {
      const std::string words = "friction 0.5 law " + std::string(law.name) + " solver " + solver;
      check_spheres(words);
      check_discs(words);
    }
}

TEST(steps_with_images_allocate_nothing)
{
  Random random(3);
  Scene scene = bed(random);
  for (int i = 0; i < 100; ++i) scene.add_image(i, {0, 0, 1000});
  Step step(settings("law gap" + box_walls(10, 17)));
  scene.advance(step, 1e-4);
  const std::size_t before = heap().allocations;
  for (int k = 0; k < 5; ++k) scene.advance(step, 1e-4);
  CHECK(heap().allocations == before);
}

// Heap that a step takes. The grains of a row close up: they touch (n contacts) or are too far apart (none).
static std::size_t bytes_in_use(int n, bool touching, const std::string &keywords, int dimension)
{
  Scene scene;
  std::vector<std::vector<int>> neighbors(n + 1);
  for (int i = 0; i <= n; ++i) {
    scene.add({(touching ? 2.0 : 3.0) * i, 0, 0}, 1, 1, {-1e-3 * i, 0, 0});
    if (i > 0) neighbors[i].push_back(i - 1);
  }
  scene.list_pairs(neighbors);
  Step step(settings(keywords + " unconverged ignore maxiter 10"), {}, dimension);
  const nscd::PairList pairs = scene.pairs();
  const std::size_t before = heap().bytes;
  step.advance(scene.grains(), pairs, 1e-3);
  CHECK(step.report().contacts == (touching ? n : 0));
  return heap().bytes - before;
}

// Most bytes per contact, over a factor of two in n, so that the least favorable n is there.
static double bytes_per_contact(const std::string &keywords, int dimension = 3)
{
  double most = 0, least = 1e9;
  for (int n = 1000; n <= 2000; n += 50) {
    const std::size_t with = bytes_in_use(n, true, keywords, dimension);
    const double each = double(with - bytes_in_use(n, false, keywords, dimension)) / n;
    most = std::max(most, each);
    least = std::min(least, each);
  }
  std::printf("%s, dimension %d: %.0f to %.0f bytes per contact\n", keywords.c_str(), dimension, least, most);
  return most;
}

static const std::string solved = " criterion paper tol 1e3";   // whatever sweeps do

// Contacts, their infos with what each has at stake, the hash table of the warm start, the workspace of the solver and
// of the law, with what vectors and table hold in reserve.
TEST(a_contact_takes_at_most_300_bytes)
{
  for (const auto &law : nscd::schemes())
    CHECK(bytes_per_contact("solver ebp restitution 0.5 law " + std::string(law.name) + solved) <= 300);
}

// Beside these the slides, 24 or 64 bytes, and longer entries of the warm start. Impacts under law gap, and e != e_t,
// which could make energy, keep impulses a second time. A step that is given up is kept from making energy by copies of
// the motion and by its islands, of which there is one grain a contact here.
TEST(a_contact_with_friction_takes_at_most_420_bytes_in_the_plane_and_600_in_space)
{
  for (const auto &law : nscd::schemes())
    for (const char *impacts : {"", " restitution 0.5"}) {
      const std::string words = "friction 0.5 solver ebp law " + std::string(law.name) + impacts;
      CHECK(bytes_per_contact(words + solved, 2) <= 420);
      CHECK(bytes_per_contact(words + solved, 3) <= 600);
      CHECK(bytes_per_contact(words, 2) <= 940);
      CHECK(bytes_per_contact(words, 3) <= 1140);
    }
}
