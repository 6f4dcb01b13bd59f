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

// How much there was of all that a step keeps.
struct Sizes {
  std::size_t contacts = 0, watched = 0, pairs = 0;
  explicit Sizes(const nscd::State &state) : contacts(state.contacts.size()), watched(state.near.size())
  {
    for (const auto &info : state.infos) pairs += info.atom_j >= 0;
    for (const auto &near : state.near) pairs += near.atom_j >= 0;
  }
  Sizes() = default;
  bool within(const Sizes &s) const { return contacts <= s.contacts && watched <= s.watched && pairs <= s.pairs; }
  void widen(const Sizes &s)
  {
    contacts = std::max(contacts, s.contacts);
    watched = std::max(watched, s.watched);
    pairs = std::max(pairs, s.pairs);
  }
};

// Steady: nothing is more than in some step before.
static void check_steady_steps_allocate_nothing(const std::string &keywords)
{
  Random random(3);
  Scene scene = bed(random);
  Step step(settings(keywords + " unconverged ignore maxiter 100" + box_walls(10, 17)));
  Sizes most;
  int steady_steps = 0;
  for (int k = 0; k < 300; ++k) {
    const std::size_t before = heap().allocations;
    scene.accelerate({0, 0, -10});
    scene.advance(step, 0.01);
    const std::size_t after = heap().allocations;
    const Sizes now(step.state());
    const bool steady = k >= 100 && now.within(most);
    if (steady) CHECK(after == before);
    steady_steps += steady;
    most.widen(now);
  }
  CHECK(most.contacts > 300);
  CHECK(steady_steps > 150);
}

TEST(steady_steps_allocate_nothing)
{
  for (const auto &law : nscd::laws())
    for (const auto &solver : nscd::solvers())
      for (const char *e : {"0", "0.5"})
        check_steady_steps_allocate_nothing("law " + std::string(law.name) + " solver " + std::string(solver.name) +
                                            " restitution " + e);
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
static std::size_t bytes_in_use(int n, bool touching, const std::string &keywords)
{
  Scene scene;
  std::vector<std::vector<int>> neighbors(n + 1);
  for (int i = 0; i <= n; ++i) {
    scene.add({(touching ? 2.0 : 3.0) * i, 0, 0}, 1, 1, {-1e-3 * i, 0, 0});
    if (i > 0) neighbors[i].push_back(i - 1);
  }
  scene.list_pairs(neighbors);
  Step step(settings(keywords + " unconverged ignore maxiter 10"));
  const nscd::PairList pairs = scene.pairs();
  const std::size_t before = heap().bytes;
  step.advance(scene.grains(), pairs, 1e-3);
  CHECK(step.report().contacts == (touching ? n : 0));
  return heap().bytes - before;
}

// Contacts, their infos, the hash table of the warm start, the workspace of the solver and of the law, with what
// vectors and table hold in reserve: over a factor of two in n, so that the least favorable n is there.
TEST(a_contact_takes_at_most_200_bytes)
{
  for (const auto &law : nscd::laws()) {
    const std::string keywords = "solver ebp restitution 0.5 law " + std::string(law.name);
    double most = 0, least = 1e9;
    for (int n = 1000; n <= 2000; n += 50) {
      const double each = double(bytes_in_use(n, true, keywords) - bytes_in_use(n, false, keywords)) / n;
      most = std::max(most, each);
      least = std::min(least, each);
    }
    std::printf("law %s: %.0f to %.0f bytes per contact\n", law.name.data(), least, most);
    CHECK(most <= 200);
  }
}
