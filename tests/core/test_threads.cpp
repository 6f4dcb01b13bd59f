// SPDX-License-Identifier: GPL-2.0-or-later
// Threads of a rank: parts that are swept at the same time share no body, and any number of threads gives the
// velocities of one. Worth most under the thread sanitizer.
#include "check.hpp"
#include "parallel/team.hpp"
#include "scene.hpp"

#include <cmath>
#include <set>

using nscd::Parts;
using nscd::Step;

// A crystal of side^3 grains that is pressed into the floor and into itself; every fifth is an obstacle if asked for.
static Scene crystal(int side, bool obstacles = false)
{
  Scene scene;
  Random random(7);
  for (int i = 0; i < side * side * side; ++i) {
    const int place[] = {i % side, i / side % side, i / (side * side)};
    Point centre, velocity;
    for (int d = 0; d < 3; ++d) {
      centre[d] = 1 + 2 * place[d];
      velocity[d] = random(-1, 1);
    }
    scene.add(centre, 1, random(0.5, 1.5), velocity);
    if (obstacles && i % 5 == 0) {
      scene.mask[i] = 2;
      for (int d = 0; d < 3; ++d) scene.v[3 * i + d] = 0;
    }
  }
  return scene;
}

// Neighbors on the lattice.
static void list_neighbors(Scene &scene, int side)
{
  std::vector<std::vector<int>> neighbors(scene.owned);
  const int stride[] = {1, side, side * side};
  for (int i = 0; i < scene.owned; ++i)
    for (int d = 0; d < 3; ++d)
      if (i / stride[d] % side + 1 < side) neighbors[i].push_back(i + stride[d]);
  scene.list_pairs(neighbors);
}

static const std::string floor_and_settings =
    " wall plane 0 0 0 0 0 1 criterion paper tol 1e-9 maxiter 20000 unconverged error solver ";

static Scene solved(Scene scene, int side, const std::string &words, int threads, int steps = 1)
{
  list_neighbors(scene, side);
  Step step(settings(words + " threads " + std::to_string(threads)));
  for (int k = 0; k < steps; ++k) {
    scene.accelerate({0, 0, -10});
    scene.advance(step, 1e-3);
    scene.just_built = false;
  }
  return scene;
}

static double largest_difference(const std::vector<double> &a, const std::vector<double> &b)
{
  double largest = 0;
  for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, std::abs(a[k] - b[k]));
  return largest;
}

TEST(every_thread_of_a_team_works_once_a_task)
{
  for (const int threads : {1, 2, 5}) {
    nscd::Team team(threads);
    std::vector<int> done(threads, 0);
    for (int task = 0; task < 200; ++task) team.run([&](int t) { done[t] += t + 1; });
    for (int t = 0; t < threads; ++t) CHECK(done[t] == 200 * (t + 1));
  }
}

TEST(team_wakes_after_a_rest)
{
  nscd::Team team(2);
  int done[2] = {0, 0};
  for (int task = 0; task < 3; ++task) {
    team.run([&](int t) { ++done[t]; });
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  CHECK(done[0] == 3 && done[1] == 3);
}

// The invariant that makes sweeps of threads those of Gauss-Seidel.
static void check_parts(const nscd::State &s, int threads)
{
  const Parts &parts = s.exec.slabs.parts();
  std::size_t seen = 0;
  for (int part = 0; part < parts.count(); ++part) seen += parts.range(part).size();
  CHECK(seen == s.table.contacts.size());
  for (int phase = 0; phase < Parts::phases; ++phase) {
    std::set<int> taken;
    for (int t = 0; t < threads; ++t) {
      const int part = parts.of(phase, t);
      if (part < 0) continue;
      std::set<int> touched;
      for (std::size_t k = parts.range(part).first; k < parts.range(part).last; ++k)
        for (const int body : {s.table.contacts[k].i, s.table.contacts[k].j}) touched.insert(body);
      for (const int body : touched) CHECK(taken.insert(body).second);
    }
  }
}

TEST(parts_that_are_swept_at_the_same_time_share_no_body)
{
  const int side = 12;
  for (const int threads : {2, 3, 4}) {
    Scene scene = crystal(side, true);
    list_neighbors(scene, side);
    Step step(settings(floor_and_settings + "pdas threads " + std::to_string(threads)));
    scene.accelerate({0, 0, -10});
    scene.advance(step, 1e-3);
    CHECK(step.report().contacts > 1000 * threads);
    check_parts(step.state(), threads);
    const Parts &parts = step.state().exec.slabs.parts();
    for (int t = 0; t < threads; ++t) CHECK(parts.range(t).size() > step.state().table.contacts.size() / (2 * threads));
  }
}

// Round a periodic box, the last slab meets the first.
TEST(parts_know_slabs_that_meet_round_a_box)
{
  const Parts even(4), odd(3);
  CHECK(even.between(0, 3) == even.between(3, 0));
  CHECK(even.between(0, 3) == even.of(2, 3));
  CHECK(odd.between(0, 2) == odd.of(3, 0));
  CHECK(even.between(0, 2) == even.of(3, 0));
  CHECK(Parts(2).between(0, 1) == Parts(2).of(1, 0));
}

TEST(any_number_of_threads_gives_the_velocities_of_one)
{
  const int side = 12;
  const Scene start = crystal(side, true);
  for (const char *solver : {"sbp rho 0.5", "sal", "ebp", "eal", "pdas", "apgs", "auto"}) {
    const Scene one = solved(start, side, floor_and_settings + solver, 1);
    for (const int threads : {2, 3, 4})
      CHECK(largest_difference(solved(start, side, floor_and_settings + solver, threads).v, one.v) < 1e-5);
  }
}

// With friction 0.1 and law gap this crystal has several solutions, which differ by 1e-4.
TEST(threads_give_the_velocities_of_one_with_friction_and_impacts)
{
  const int side = 12;
  const Scene start = crystal(side);
  // Whether two impacts are a hundredth of the step apart, and so one after another, is a matter of round-off here.
  for (const auto &[words, within] : {std::pair{" friction 0.01", 1e-5}, std::pair{" restitution 0.5", 1e-4},
                                      std::pair{" law moreau restitution 0.5 friction 0.1", 1e-5}}) {
    const std::string all = words + floor_and_settings + "apgs";
    const Scene one = solved(start, side, all, 1);
    CHECK(largest_difference(solved(start, side, all, 3).v, one.v) < within);
  }
}

TEST(same_number_of_threads_gives_the_same_bits)
{
  const int side = 12;
  const Scene start = crystal(side);
  const std::string words = " friction 0.1 restitution 0.3" + floor_and_settings + "apgs";
  const Scene first = solved(start, side, words, 4, 3), second = solved(start, side, words, 4, 3);
  CHECK(first.v == second.v && first.x == second.x && first.omega == second.omega);
}

TEST(threads_out_of_range_are_refused)
{
  CHECK_ERROR(Step(settings("threads 0")), "threads = 0 is outside [1, 64]");
  CHECK_ERROR(Step(settings("threads 65")), "threads = 65 is outside [1, 64]");
  CHECK(nscd::crowding(1, nullptr).empty());
  CHECK(nscd::crowding(10000, nullptr).find("they will wait for each other") != std::string::npos);
}
