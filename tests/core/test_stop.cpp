// SPDX-License-Identifier: GPL-2.0-or-later
// The two stopping rules of a step: criterion (42) in m/s, and the natural map relative to the free velocities.
#include "check.hpp"
#include "scene.hpp"
#include "solver/iterate.hpp"
#include "step/step.hpp"

#include <algorithm>
#include <string>

namespace {

// A few steps of grains that fall into a box; returns the last report.
nscd::StepReport fall(const std::string &words, int maxiter = 100000)
{
  Random random(5);
  Scene scene = random_scene(random, 40, 1, 0.12, 1);
  nscd::Step step(settings("law gap maxiter " + std::to_string(maxiter) + " " + words + box_walls(1, 1)));
  nscd::StepReport report;
  for (int k = 0; k < 30; ++k) {
    scene.accelerate({0, 0, -1});
    report = scene.advance(step, 5e-3);
    CHECK(report.converged);
  }
  CHECK(report.contacts > 5);
  return report;
}

}    // namespace

TEST(tol_is_compared_with_the_criterion_that_was_chosen)
{
  for (const std::string friction : {"", "friction 0.1 "})
    for (const auto &solver : friction.empty() ? nscd::solvers() : nscd::frictional_solvers()) {
      const std::string words = friction + "solver " + std::string(solver.name);
      CHECK(fall(words + " tol 1e-6").criterion.relative < 1e-6);
      CHECK(fall(words + " criterion paper tol 1e-5").criterion.total() < 1e-5);
      CHECK(fall(words + " criterion natural tol 1e-4").criterion.relative < 1e-4);
    }
}

TEST(a_step_that_misses_the_natural_criterion_says_so)
{
  CHECK_ERROR(fall("solver sbp rho 0.01 criterion natural tol 1e-9 unconverged error", 2),
              "step not solved: criterion natural is ");
}

// The mean over the contacts does not see the front of an impact; this does.
TEST(overlap_bounds_what_any_contact_is_driven_into_another)
{
  for (const double bound : {1e-3, 1e-5}) {
    Random random(5);
    Scene scene = random_scene(random, 40, 1, 0.12, 1);
    const std::string words = "criterion natural tol 0.1 maxiter 100000 overlap " + std::to_string(bound);
    nscd::Step step(settings("law gap " + words + box_walls(1, 1)));
    for (int k = 0; k < 30; ++k) {
      scene.accelerate({0, 0, -1});
      CHECK(scene.advance(step, 5e-3).converged);
      CHECK(step.report().criterion.approach <= 1);
      CHECK(step.report().largest_overlap_ratio <= 1.02 * bound);   // 0.01 of it a step where there is no more room
    }
    CHECK(step.report().contacts > 5);
  }
}

TEST(overlap_needs_law_gap_and_a_share)
{
  CHECK_ERROR(nscd::Step(settings("law moreau overlap 0.1")), "overlap is a condition of law gap");
  CHECK_ERROR(nscd::Step(settings("overlap 0")), "overlap = 0 is outside (0, 1]");
}

// Impulses of 1e30 times what they should be leave velocities that no longer are those of the impulses.
TEST(sweeps_that_ran_away_are_not_taken_as_solved)
{
  nscd::RunAway far(1e-6), near(1e-6), large(1e-6);
  for (const double corrected : {1.0, 1e30, 1e-9}) far.look(corrected);
  for (const double corrected : {1.0, 50.0, 1e-9}) near.look(corrected);
  for (const double corrected : {1e20, 1e-9}) large.look(corrected);
  CHECK(far.has_happened());
  CHECK(!near.has_happened() && !large.has_happened());
}

// Grains that touch and move on together: what is left to do is round-off, and so is what the criterion divides by.
TEST(round_off_is_no_residual)
{
  alignas(64) nscd::Body bodies[] = {{-1e-16, 0, 0, 1}, {0, 0, 0, 0}};
  nscd::Contact contacts[] = {{{1, 0, 0, 0}, 0, 1, 0, 0, 1}};
  nscd::Workspace workspace;
  nscd::Problem problem{bodies, contacts, 1e-16, workspace};
  CHECK_NEAR(measure(problem).relative, 1, 1e-12);
  problem.round_off = 1e-14;   // of grains as fast as 1 m/s
  CHECK(measure(problem).relative == 0);
  bodies[0][0] = NAN;
  CHECK(!(measure(problem).relative == 0));
}

TEST(a_budget_is_of_visits_where_contacts_are_few_and_ends_with_the_sweeps_that_there_may_be)
{
  const nscd::Budget of_preset{30, 60000, 1000};
  CHECK(of_preset.of(5000) == 30);
  CHECK(of_preset.of(200) == 300);
  CHECK(of_preset.of(10) == 1000);
  CHECK((nscd::Budget{.sweeps = 30}.of(10) == 30));
  CHECK((nscd::Budget{.sweeps = 0, .visits = 60000}.of(10) == 0));
  // of what comes after other sweeps of the step
  CHECK((nscd::Budget{30, 60000, 1000, 100}.of(200) == 200));
  CHECK((nscd::Budget{30, 0, 1000, 100}.of(200) == 1));
}
