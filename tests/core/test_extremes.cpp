// SPDX-License-Identifier: GPL-2.0-or-later
// Scenes without anything, and scenes with a lot of it.
#include "check.hpp"
#include "scene.hpp"
#include "step/report.hpp"

#include <ctime>
#include <cmath>

using nscd::Step;

TEST(a_step_without_grains_does_nothing)
{
  for (const char *law : {"law moreau", "law gap", "law gap friction 0.5 restitution 1", "law moreau stick e_t 1"}) {
    Step step(settings(law + box_walls(1, 1)));
    step.begin_run(true);
    for (int k = 0; k < 3; ++k) CHECK(step.advance({}, {.reach = 1}, 1e-3).contacts == 0);
    CHECK(step.report().converged && step.report().iterations == 0 && step.report().largest_overlap == 0);
    CHECK(step.report().dissipated == 0 && step.report().criterion.relative == 0);
    nscd::fill_contact_rows(step.state(), nullptr);
  }
}

TEST(a_step_without_contacts_reports_none)
{
  for (const auto &solver : nscd::solvers())
    for (const std::string law : {"law moreau ", "law gap ", "law gap friction 0.5 restitution 1 "}) {
      if (!solver.friction && law.find("friction") != std::string::npos) continue;
      Scene scene;
      scene.add({0, 0, 0}, 1, 1, {1, 2, 3});
      Step step(settings(law + "solver " + std::string(solver.name)));
      scene.advance(step, 0.5);
      CHECK(scene.x == std::vector<double>({0.5, 1, 1.5}) && step.report().contacts == 0);
      CHECK(step.report().converged && step.report().criterion.total() == 0);
    }
}

TEST(contacts_that_all_vanish_leave_nothing_behind)
{
  Scene scene;
  scene.add({0, 0, 1}, 1, 1, {0, 0, -1});
  Step step(settings("law moreau restitution 1 wall plane 0 0 0 0 0 1"));
  CHECK(scene.advance(step, 0.01).contacts == 1);
  scene.accelerate({});
  CHECK(scene.advance(step, 0.01).contacts == 0);
  CHECK(step.report().criterion.total() == 0 && step.report().largest_overlap == 0);
}

static Scene chain(int grains, bool backwards)
{
  Scene scene;
  std::vector<std::vector<int>> neighbors(grains);
  for (int i = 0; i < grains; ++i) {
    scene.add({2.0 * (backwards ? grains - 1 - i : i), 0, 0}, 1);
    if (i > 0) neighbors[i].push_back(i - 1);
  }
  scene.list_pairs(neighbors);
  return scene;
}

// 100,000 contacts: nothing may recurse, and nothing may take longer than in proportion. That is seconds of processor
// time at most, under sanitizers too; what grows with the square takes many minutes.
static void check_long_chain(const std::string &keywords, bool backwards)
{
  Scene scene = chain(100001, backwards);
  scene.v[0] = backwards ? -1 : 1;
  Step step(settings("maxiter 5 unconverged ignore " + keywords));
  const std::clock_t start = std::clock();
  for (int k = 0; k < 2; ++k) {
    scene.accelerate({});
    scene.advance(step, 0.001);
  }
  const double took = double(std::clock() - start) / CLOCKS_PER_SEC;
  CHECK(step.report().contacts > 99990);   // an impact may leave a gap
  CHECK(std::isfinite(step.report().criterion.total()));
  CHECK(took < 20);
}

TEST(a_long_chain_is_no_problem_for_law_moreau)
{
  for (const bool backwards : {false, true}) check_long_chain("law moreau restitution 0.5", backwards);
}

TEST(a_long_chain_is_no_problem_for_law_gap)
{
  for (const bool backwards : {false, true})
    for (const char *e : {"0", "1"}) check_long_chain("law gap restitution " + std::string(e), backwards);
}

TEST(a_long_chain_with_friction_is_no_problem)
{
  for (const char *words : {"friction 0.5 law moreau restitution 0.5", "friction 0.5 law gap", "stick law gap e_t 0.5"})
    check_long_chain(words, false);
}

// Free fall under gravity in a gap-closing crowd makes one grain after another change its update; the passes over
// the contacts that this takes must not grow with the chain.
TEST(a_long_chain_that_closes_up_is_no_problem_for_law_gap)
{
  for (const bool backwards : {false, true}) {
    Scene scene = chain(100001, backwards);
    for (int i = 0; i < scene.owned; ++i) scene.v[3 * i] = -1e-3 * scene.x[3 * i] / scene.owned;
    Step step(settings("law gap maxiter 5 unconverged ignore"));
    const std::clock_t start = std::clock();
    for (int k = 0; k < 2; ++k) {
      scene.accelerate({});
      scene.advance(step, 0.1);
    }
    const double took = double(std::clock() - start) / CLOCKS_PER_SEC;
    CHECK(took < 20);
  }
}

TEST(extreme_mass_ratios_keep_the_arrays_finite)
{
  for (const auto &solver : nscd::solvers())
    for (const char *law : {"law moreau", "law gap"}) {
      Scene scene;
      scene.add({0, 0, 1}, 1, 1e-12);
      scene.add({0, 0, 3}, 1, 1e12, {0, 0, -1});
      const std::string words = std::string(law) + " unconverged ignore solver " + std::string(solver.name);
      Step step(settings(words + box_walls(9, 9)));
      scene.x[0] = scene.x[1] = scene.x[3] = scene.x[4] = 5;
      for (int k = 0; k < 10; ++k) {
        scene.accelerate({});
        scene.advance(step, 1e-3);
      }
      for (const double v : scene.v) CHECK(std::isfinite(v));
    }
}

// From coefficients that round to none to ones that round to stick, slip from the smallest number on: no overflow, and
// the arrays stay finite.
TEST(extreme_friction_keeps_the_arrays_finite)
{
  for (const auto &solver : nscd::frictional_solvers())
    for (const char *mu : {"friction 1e-300", "friction 1e-12", "friction 1e3", "friction 1e6", "stick"})
      for (const double slip : {0.0, 5e-324, 1e-160, 1e9}) {
        Scene scene;
        scene.add({5, 5, 1}, 1, 1e-12, {slip, 0, -1});
        scene.add({5, 5, 3}, 1, 1e12, {0, slip, -1});
        scene.omega[0] = slip;
        const std::string words = std::string(mu) + " law moreau unconverged ignore solver " + std::string(solver.name);
        Step step(settings(words + " wall plane 0 0 0 0 0 1"));
        for (int k = 0; k < 3; ++k) {
          scene.accelerate({});
          scene.advance(step, 1e-12);
        }
        for (const double value : scene.v) CHECK(std::isfinite(value));
        for (const double value : scene.omega) CHECK(std::isfinite(value));
      }
}

// Nothing falls, nothing moves: v_free = 0, and the impulses of the step before are all there is.
TEST(a_bed_whose_weight_is_switched_off_has_a_finite_residual)
{
  for (const char *law : {"law moreau", "law gap"}) {
    Scene scene;
    for (int i = 0; i < 5; ++i) scene.add({0, 0, 1 + 2.0 * i}, 1, 1 + i);
    Step step(settings(std::string(law) + " wall plane 0 0 0 0 0 1"));
    for (const double g : {-10.0, -10.0, 0.0, 0.0}) {
      scene.v.assign(scene.v.size(), 0);
      scene.accelerate({0, 0, g});
      scene.advance(step, 0.01);
      CHECK(std::isfinite(step.report().criterion.relative));
    }
  }
}
