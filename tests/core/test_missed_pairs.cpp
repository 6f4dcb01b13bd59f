// SPDX-License-Identifier: GPL-2.0-or-later
// Pairs that the neighbor list lacks: judged by their own approach, and found where a solve drives them together.
#include "check.hpp"
#include "scene.hpp"
#include "scene/list/cell_grid.hpp"
#include "thread_ranks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

using nscd::Step;
using nscd::Vec4;

TEST(cells_have_every_point_that_is_near)
{
  Random random(3);
  nscd::AlignedVector<Vec4> points;
  for (int k = 0; k < 400; ++k) points.push_back(Vec4{random(-1, 1), random(-1, 1), random(-1, 1), 0});
  for (const double far : {1e9, -1e300}) points.push_back(Vec4{far, 0, far, 0});
  nscd::CellGrid grid;
  for (const double edge : {1e-3, 0.3, 100.0}) {
    grid.fill(points, edge);
    for (const double reach : {0.0, 0.2, 3.0, 1e10})
      for (const Vec4 &centre : points) {
        std::vector<int> times(points.size(), 0);
        grid.near(centre, reach, [&](int k, const Vec4 &) { ++times[k]; });
        for (std::size_t k = 0; k < points.size(); ++k) {
          bool within = true;
          for (int d = 0; d < 3; ++d) within &= std::abs(points[k][d] - centre[d]) <= reach;
          CHECK(times[k] <= 1 && times[k] >= within);
        }
      }
  }
}

// Layers that slide over each other: all at 15 and more, neighbors differ by 1. The list has no pair.
TEST(grains_that_move_together_need_no_longer_list)
{
  Scene scene;
  for (int layer = 0; layer < 5; ++layer)
    for (int k = 0; k < 5; ++k) scene.add({2.03 * k, 0, 2.03 * layer}, 1, 1, {15.0 + layer, 0, 0});
  scene.list_pairs(std::vector<std::vector<int>>(25));
  scene.reach = 0.025;
  Step step(settings("law gap"));
  for (int k = 0; k < 10; ++k) {
    CHECK(scene.advance(step, 0.01).contacts == 0);
    CHECK(!step.wants_rebuild());
    scene.just_built = false;
  }
  scene.v[0] += 4;   // 0.03 ahead
  scene.advance(step, 0.01);
  CHECK(find_contact(step.state(), 0, 1) && step.state().search.unlisted.size() == 1);
}

TEST(obstacles_cannot_meet_each_other)
{
  Scene scene;
  scene.add({0, 0, 0}, 1);
  for (const double x : {10.0, 12.1}) scene.add_obstacle({x, 0, 0}, 1);
  scene.list_pairs({{}, {}, {}});
  scene.reach = 0;
  scene.v[3] = 50;   // as fix move says
  Step step(settings("law gap"));
  scene.advance(step, 0.1);
  scene.just_built = false;
  scene.x[3] += 5;
  scene.advance(step, 0.1);
  scene.v[3] = -150;
  scene.x[3] = 0;    // where it ends the step that it starts at 15
  scene.advance(step, 0.1);   // the grain and it are 13 apart and approach by 15
  CHECK(step.state().search.unlisted.size() == 1 && scene.x[0] < -1.9);
}

// Two heavy grains close in on a light one, which leaves at c / h = 22 times their speed. A far one is in its way.
static Scene nipped()
{
  const double h = 0.05, c = std::sqrt(1.1 * 1.1 - h * h);
  Scene scene;
  scene.add({-c, 0, 0}, 1, 10, {0.9, 0, 0});
  scene.add({c, 0, 0}, 1, 10, {-0.9, 0, 0});
  scene.add({0, h, 0}, 0.1, 1e-3);
  scene.add({0, 2.65, 0}, 1, 1e6);
  scene.list_pairs({{1, 2}, {2}, {}, {}});
  scene.reach = 0.3;
  return scene;
}
constexpr const char *exact = "law gap tol 1e-10 maxiter 100000 solver ";

TEST(grains_that_a_solve_drives_beyond_the_list_are_found)
{
  for (const char *solver : {"pdas", "apgs", "auto", "active_set", "pdas restitution 0.5"}) {
    Scene scene = nipped();
    Step step(settings(std::string(exact) + solver));
    scene.advance(step, 0.1);
    CHECK(find_contact(step.state(), 2, 3) != nullptr);
    CHECK(step.report().largest_overlap < 1e-8);
    CHECK(scene.x[3 * 3 + 1] - scene.x[3 * 2 + 1] > 1.1 - 1e-8);
    const bool bounces = step.settings().restitutive();   // and leaves at once
    CHECK(bounces || step.wants_rebuild());
  }
}

TEST(excluded_pairs_are_not_brought_in)
{
  Scene scene = nipped();
  Step step(settings(std::string(exact) + "pdas"));
  nscd::PairList pairs = scene.pairs();
  pairs.excludes = true;
  CHECK_ERROR(step.advance(scene.grains(), pairs, 0.1), "contacts could be missed: grains 3 and 4");
}

TEST(a_grain_that_can_meet_one_without_an_image_is_refused)
{
  Scene scene = nipped();
  scene.images = 2.5;
  Step step(settings(std::string(exact) + "pdas"));
  CHECK_ERROR(scene.advance(step, 0.1), "can meet one that was ");
  for (nscd::PairList pairs : {scene.pairs(), scene.pairs()}) {
    pairs.images.boxed = true;
    std::fill(pairs.images.lo, pairs.images.lo + 3, -20);
    std::fill(pairs.images.hi, pairs.images.hi + 3, 20);
    CHECK(step.advance(scene.grains(), pairs, 1e-3).contacts == 2);
  }
}

// Raised behind a loop that is compiled for several processors, through callers with something to destroy.
TEST(motion_that_is_too_much_to_look_at_is_refused)
{
  Scene scene;
  constexpr int grains = 8000;
  for (int i = 0; i < grains; ++i) scene.add({3.0 * i, 0, 0}, 1, 1, {i % 2 ? 1e6 : -1e6, 0, 0});
  scene.list_pairs(std::vector<std::vector<int>>(grains));
  scene.reach = 0.3;
  Step step(settings("law gap"));
  CHECK_ERROR(scene.advance(step, 0.1), "many times the distance of its neighbors");
}

// At most those that are listed when it is built.
static void list_within(Scene &scene)
{
  std::vector<std::vector<int>> neighbors(scene.owned);
  const double cutoff = scene.reach + 2 * *std::max_element(scene.radius.begin(), scene.radius.end());
  for (int i = 0; i < scene.owned; ++i)
    for (int j = i + 1; j < scene.owned; ++j) {
      double distance2 = 0;
      for (int d = 0; d < 3; ++d) distance2 += std::pow(scene.x[3 * i + d] - scene.x[3 * j + d], 2);
      if (distance2 <= cutoff * cutoff) neighbors[i].push_back(j);
    }
  scene.list_pairs(neighbors);
}

static double true_overlap(const Scene &scene)
{
  double largest = 0;
  for (int i = 0; i < scene.owned; ++i)
    for (int j = i + 1; j < scene.owned; ++j) {
      double distance2 = 0;
      for (int d = 0; d < 3; ++d) distance2 += std::pow(scene.x[3 * i + d] - scene.x[3 * j + d], 2);
      largest = std::max(largest, scene.radius[i] + scene.radius[j] - std::sqrt(distance2));
    }
  return largest;
}

// Masses of 1 to 1e6, so that impulses make grains fast. Returns in how many of 1600 steps the list lacked pairs; it is
// rebuilt when a step asks for it, or never.
static int steps_with_short_lists(bool rebuilds)
{
  int completed = 0, rebuilt = 0;
  for (int seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    Scene scene = random_scene(random, 40, 1, 0.12, 5);
    for (double &mass : scene.mass) mass = std::pow(10, random(0, 6));
    scene.reach = 0.005;
    list_within(scene);
    Step step(settings("law gap criterion natural tol 1e-8 maxiter 100000 solver active_set" + box_walls(1, 1)));
    for (int k = 0; k < 40; ++k) {
      const double dt = 2e-3;
      scene.accelerate({});
      scene.advance(step, dt);
      completed += step.report().cutoff_to_list > 0;
      CHECK(true_overlap(scene) < 3e-5);   // what planes may leave: half of overlap, of a radius of 0.12
      CHECK_NEAR(step.report().largest_overlap, true_overlap(scene), 1e-6);
      scene.just_built = rebuilds && step.wants_rebuild();
      rebuilt += scene.just_built;
      if (scene.just_built) list_within(scene);
    }
  }
  CHECK(rebuilt < 1200);
  return completed;
}

TEST(no_pair_is_missed_by_short_lists)
{
  const int rebuilt = steps_with_short_lists(true), kept = steps_with_short_lists(false);
  std::printf("%d steps with rebuilt lists that lack pairs, %d with kept ones, of 1600\n", rebuilt, kept);
  CHECK(rebuilt > 0 && rebuilt < 50 && kept > 1000);
}

// Rank 0 has the two heavy grains and the light one, rank 1 the one in its way; which finds the pair is its choice.
TEST(ranks_find_pairs_beyond_the_list_together)
{
  Scene alone = nipped();
  Step one(settings(std::string(exact) + "apgs"));
  alone.advance(one, 0.1);
  std::vector<double> v(12);
  on_ranks(2, [&](ThreadRanks &ranks) {
    const Scene all = nipped();
    Scene mine;
    mine.reach = all.reach;
    const auto place = [&](int i) { return Point{all.x[3 * i], all.x[3 * i + 1], all.x[3 * i + 2]}; };
    const auto rank_of = [](int i) { return i == 3 ? 1 : 0; };
    for (int i = 0; i < 4; ++i)
      if (rank_of(i) == ranks.rank())
        mine.tag[mine.add(place(i), all.radius[i], all.mass[i], {all.v[3 * i], 0, 0})] = i + 1;
    for (int i = 0; i < 4; ++i)
      if (rank_of(i) != ranks.rank()) mine.add_foreign_image(place(i), all.radius[i], i + 1, rank_of(i));
    if (ranks.rank() == 0) mine.list_pairs({{1, 2}, {2}, {}});
    else mine.list_pairs({{}});
    Step step(settings(std::string(exact) + "apgs"), {}, 3, &ranks);
    mine.advance(step, 0.1);
    CHECK(step.wants_rebuild());
    for (int i = 0; i < mine.owned; ++i)
      for (int d = 0; d < 3; ++d) v[3 * (mine.tag[i] - 1) + d] = mine.v[3 * i + d];
  });
  for (int k = 0; k < 12; ++k) CHECK_NEAR(v[k], alone.v[k], 1e-6);
}
