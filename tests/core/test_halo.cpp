// SPDX-License-Identifier: GPL-2.0-or-later
// The halo, between ranks that are threads of this program: any number of them gives the velocities of one.
#include "check.hpp"
#include "scene.hpp"
#include "settings/schemes.hpp"
#include "thread_ranks.hpp"

#include <cmath>

using nscd::Step;

// A heap in a box: the grains of rank r of `count` lie in its part of the x axis, all others are images.
static Scene part_of_heap(int rank, int count)
{
  const int side = 6;
  Random random(11);
  Scene all;
  for (int i = 0; i < side * side * side; ++i) {
    const Point centre{1 + 1.999 * (i % side), 1 + 1.999 * (i / side % side), 0.999 + 1.999 * (i / (side * side))};
    const Point velocity{random(-1, 1), random(-1, 1), random(-1, 1)};
    all.add(centre, 1, random(0.5, 1.5), velocity);
  }
  return part_of_rank(all, rank, [&](int i) { return std::min(count - 1, int(all.x[3 * i] / (2.0 * side) * count)); });
}

// Velocities and spins by tag after a step, and behind them the largest overlap.
static std::vector<double> velocities(const std::string &words, int count)
{
  std::vector<double> found(6 * 217 + 1);
  on_ranks(count, [&](ThreadRanks &ranks) {
    Scene scene = part_of_heap(ranks.rank(), count);
    Step step(settings(words + " maxiter 100000 wall plane 0 0 0 0 0 1"), {}, 3, &ranks);
    scene.accelerate({0, 0, -10});
    const nscd::StepReport &report = scene.advance(step, 1e-3);
    if (ranks.rank() == count - 1) found.back() = report.largest_overlap;
    for (int i = 0; i < scene.owned; ++i)
      for (int d = 0; d < 3; ++d) {
        found[6 * scene.tag[i] + d] = scene.v[3 * i + d];
        found[6 * scene.tag[i] + 3 + d] = scene.omega[3 * i + d];
      }
  });
  return found;
}

static void check_ranks(const std::string &words, double tolerance)
{
  const std::vector<double> one = velocities(words, 1);
  for (const int count : {2, 3, 4}) {
    const std::vector<double> several = velocities(words, count);
    CHECK(velocities(words, count) == several);
    for (std::size_t k = 0; k < one.size(); ++k) CHECK_NEAR(several[k], one[k], tolerance);
  }
}

TEST(any_number_of_ranks_gives_the_velocities_of_one)
{
  for (const char *solver : {"pdas", "apgs", "auto"})
    check_ranks(std::string("criterion paper tol 1e-10 solver ") + solver, 1e-6);
}

// The overlap, since grains of other ranks are moved by the law too. It may be g dt^2 / 2 off: law gap moves a grain by
// its mean velocity or by that at the end, which may be chosen by what a solve is off.
TEST(any_number_of_ranks_gives_the_velocities_and_overlaps_of_one_under_every_law)
{
  for (const nscd::SchemeEntry &law : nscd::schemes())
    check_ranks("criterion paper tol 1e-10 restitution 0.5 solver apgs law " + std::string(law.name), 1e-6);
}

TEST(any_number_of_ranks_gives_the_velocities_of_one_with_a_little_friction)
{
  check_ranks("criterion paper tol 1e-9 friction 0.01 solver apgs", 1e-5);
}

TEST(a_factorising_solver_is_the_inner_one_of_each_rank)
{
  const std::vector<double> one = velocities("criterion paper tol 1e-8 solver active_set", 1);
  const std::vector<double> two = velocities("criterion paper tol 1e-8 solver active_set", 2);
  for (std::size_t k = 0; k < one.size(); ++k) CHECK_NEAR(two[k], one[k], 1e-4);
}

// The error is thrown on all ranks, and nobody waits.
TEST(what_fails_on_one_rank_fails_on_all)
{
  std::vector<std::string> told(3);
  on_ranks(3, [&](ThreadRanks &ranks) {
    Scene scene = part_of_heap(ranks.rank(), 3);
    if (ranks.rank() == 2) scene.v[0] = NAN;
    Step step(settings("wall plane 0 0 0 0 0 1"), {}, 3, &ranks);
    scene.accelerate({0, 0, -10});
    try {
      scene.advance(step, 1e-3);
    } catch (const nscd::Error &error) {
      told[ranks.rank()] = error.what();
    }
  });
  CHECK(told[0] == told[2] && told[1] == told[2]);
  CHECK_SAYS(told[0], "not a finite number");
}
