// SPDX-License-Identifier: GPL-2.0-or-later
// What a step refuses, and that nothing is lost then: the arrays stay as they are, and a repaired scene goes on.
#include "check.hpp"
#include "scene.hpp"

#include <cmath>
#include <cstring>
#include <functional>

using nscd::Step;

static bool same_bits(const std::vector<double> &a, const std::vector<double> &b)
{
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

// Two grains that fall onto the floor, and one in the air.
static Scene three_grains()
{
  Scene scene;
  scene.add({0, 0, 1}, 1, 1, {0, 0, -1});
  scene.add({3, 0, 1}, 1, 2, {0, 0, -1});
  scene.add({0, 0, 9}, 1, 3, {1, 0, 0});
  scene.accelerate({0, 0, -10});
  return scene;
}

static void refuses(const std::string &keywords, const std::function<void(Scene &)> &spoil, const std::string &part)
{
  for (const char *law : {"law moreau ", "law gap "}) {
    Scene scene = three_grains();
    spoil(scene);
    const Scene before = scene;
    Step step(settings(law + keywords + " wall plane 0 0 0 0 0 1"));
    CHECK_ERROR(scene.advance(step, 0.01), part);
    CHECK(same_bits(scene.x, before.x) && same_bits(scene.v, before.v) && same_bits(scene.f, before.f));
    CHECK(same_bits(scene.omega, before.omega) && same_bits(scene.torque, before.torque));
  }
}

TEST(positions_velocities_and_forces_that_are_not_finite_are_refused)
{
  for (const double bad : {double(NAN), double(INFINITY), -double(INFINITY)})
    for (const int at : {5, 6}) {  // of a grain in contact and of one in free flight
      refuses("", [=](Scene &s) { s.x[at] = bad; }, "not a finite number");
      refuses("", [=](Scene &s) { s.v[at] = bad; }, "not a finite number");
      refuses("", [=](Scene &s) { s.f[at] = bad; }, "not a finite number");
    }
}

// Of a grain in contact, of one in free flight and of an obstacle.
TEST(angular_velocities_and_torques_that_are_not_finite_are_refused)
{
  const std::string part = " has an angular velocity or torque that is not a finite number";
  for (const double bad : {double(NAN), double(INFINITY), -double(INFINITY)})
    for (const int at : {5, 6}) {
      const std::string message = "grain " + std::to_string(at / 3 + 1) + part;
      refuses("friction 0.5", [=](Scene &s) { s.omega[at] = bad; }, message);
      refuses("friction 0.5", [=](Scene &s) { s.torque[at] = bad; }, message);
      refuses("friction 0.5", [=](Scene &s) { s.omega[at] = bad; s.mask[at / 3] = 2; }, message);
    }
}

TEST(the_grain_that_is_not_finite_is_named)
{
  refuses("", [](Scene &s) { s.v[7] = NAN; }, "grain 3 ");
}

TEST(radii_that_are_not_positive_are_refused)
{
  for (const double bad : {0.0, -1.0, double(NAN), double(INFINITY)})
    refuses("", [=](Scene &s) { s.radius[2] = bad; }, "grain 3 has radius ");
}

TEST(masses_that_are_not_positive_are_refused)
{
  for (const double bad : {0.0, -1.0, double(NAN), double(INFINITY)})
    for (const double force : {0.0, 5.0})
      refuses("", [=](Scene &s) { s.mass[2] = bad; s.f[8] = force; }, "grain 3 has mass ");
}

TEST(masses_of_obstacles_do_not_matter)
{
  Scene scene = three_grains();
  scene.mass[1] = 0;
  scene.mask[1] = 2;
  Step step(settings(""));
  scene.advance(step, 0.01);
  CHECK(scene.x[3] == 3 && std::isfinite(scene.v[2]));
}

TEST(overlaps_beyond_a_radius_are_refused)
{
  refuses("", [](Scene &s) { s.x[0] = 2.2; }, "grains 1 and 2 overlap by 1.2");
  refuses("", [](Scene &s) { s.x[2] = -0.5; }, "inside wall 1");
}

TEST(lists_that_lack_pairs_that_touch_are_refused)
{
  refuses("", [](Scene &s) { s.reach = -1; }, "1 less than the largest diameter: raise the cutoff");
}

TEST(a_step_that_is_not_solved_is_an_error_if_asked)
{
  const auto crowd = [](Scene &s) { s.x[3] = 1.99; s.v[3] = -1; };
  refuses("solver sal criterion paper tol 1e-7 maxiter 1 unconverged error", crowd,
          "step not solved: criterion (42) is ");
  refuses("solver sal maxiter 1 unconverged error friction 0.5", crowd, "step not solved: criterion natural is ");
  Scene scene = three_grains();
  crowd(scene);
  Step step(settings("solver sal maxiter 1 unconverged ignore wall plane 0 0 0 0 0 1"));
  CHECK(!scene.advance(step, 0.01).converged && step.report().unconverged == 1);
}

TEST(an_exception_of_a_custom_solver_reaches_the_caller)
{
  for (const char *law : {"law moreau", "law gap"}) {
    Scene scene = three_grains();
    const Scene before = scene;
    Step step(settings(std::string(law) + " wall plane 0 0 0 0 0 1"),
              [](const auto &, const auto &, auto) { nscd::fail("mine"); });
    CHECK_ERROR(scene.advance(step, 0.01), "mine");
    CHECK(same_bits(scene.x, before.x) && same_bits(scene.v, before.v) && same_bits(scene.f, before.f));
  }
}

TEST(impulses_of_a_custom_solver_that_are_not_numbers_are_refused)
{
  Scene scene = three_grains();
  const Scene before = scene;
  Step step(settings("law moreau wall plane 0 0 0 0 0 1"), [](const auto &, const auto &, auto p) { p[0] = NAN; });
  CHECK_ERROR(scene.advance(step, 0.01), "not a finite number");
  CHECK(same_bits(scene.x, before.x) && same_bits(scene.v, before.v));
  for (const std::size_t component : {1, 2}) {
    Step sliding(settings("law moreau friction 0.5 wall plane 0 0 0 0 0 1"),
                 [=](const auto &, const auto &, auto p) { p[component] = INFINITY; });
    CHECK_ERROR(scene.advance(sliding, 0.01), "not a finite number");
    CHECK(same_bits(scene.omega, before.omega) && same_bits(scene.torque, before.torque));
  }
}

TEST(timesteps_that_are_not_positive_are_refused)
{
  for (const char *law : {"law moreau", "law gap"})
    for (const double dt : {0.0, -0.01, double(NAN), double(INFINITY)}) {
      Scene scene = three_grains();
      const Scene before = scene;
      Step step(settings(std::string(law) + " wall plane 0 0 0 0 0 1"));
      CHECK_ERROR(scene.advance(step, dt), "timestep");
      CHECK(same_bits(scene.x, before.x) && same_bits(scene.v, before.v) && same_bits(scene.f, before.f));
    }
}

TEST(a_repaired_scene_goes_on_as_if_nothing_had_been)
{
  for (const char *law : {"law moreau", "law gap"}) {
    Scene scene = three_grains(), reference = three_grains();
    const nscd::Settings chosen = settings(std::string(law) + " wall plane 0 0 0 0 0 1");
    Step step(chosen), clean(chosen);
    for (int k = 0; k < 3; ++k) {
      scene.advance(step, 0.01);
      reference.advance(clean, 0.01);
      scene.accelerate({0, 0, -10});
      reference.accelerate({0, 0, -10});
      const double kept = scene.x[2];
      scene.x[2] = -5;
      CHECK_ERROR(scene.advance(step, 0.01), "inside wall");
      scene.x[2] = kept;
    }
    CHECK(same_bits(scene.x, reference.x) && same_bits(scene.v, reference.v) && same_bits(scene.f, reference.f));
    CHECK(step.report().dissipated == clean.report().dissipated);
  }
}
