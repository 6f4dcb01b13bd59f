// The two stopping rules of a step: criterion (42) in m/s, and the natural map relative to the free velocities.
#include "check.hpp"
#include "core/step.hpp"
#include "scene.hpp"

#include <string>

namespace {

// A few steps of grains that fall into a box; returns the last report.
nscd::StepReport fall(const std::string &words)
{
  Random random(5);
  Scene scene = random_scene(random, 40, 1, 0.12, 1);
  nscd::Step step(settings("law gap maxiter 100000 " + words + box_walls(1, 1)));
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
      CHECK(fall(words + " tol 1e-6").criterion.total() < 1e-6);
      CHECK(fall(words + " criterion paper tol 1e-5").criterion.total() < 1e-5);
      CHECK(fall(words + " criterion natural tol 1e-4").criterion.relative < 1e-4);
    }
}

TEST(a_step_that_misses_the_natural_criterion_says_so)
{
  CHECK_ERROR(fall("solver sbp rho 0.01 criterion natural tol 1e-9 maxiter 2 unconverged error"),
              "step not solved: criterion natural is ");
}
