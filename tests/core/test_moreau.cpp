// SPDX-License-Identifier: GPL-2.0-or-later
// Law moreau on scenes small enough to be worked out by hand.
#include "check.hpp"
#include "scene.hpp"

#include <cmath>

using nscd::Step;

TEST(moreau_free_flight_is_the_parabola)
{
  Scene scene;
  scene.add({1, 2, 3}, 0.1, 2, {1, -2, 3});
  Step step(settings("law moreau"));
  const double dt = 0.01, g = -9.81;
  for (int k = 0; k < 100; ++k) {
    scene.accelerate({0, 0, g});
    CHECK(scene.advance(step, dt).contacts == 0);
  }
  CHECK_NEAR(scene.x[0], 2, 1e-13);
  CHECK_NEAR(scene.x[1], 0, 1e-13);
  CHECK_NEAR(scene.x[2], 3 + 3 + g / 2, 1e-12);
  CHECK_NEAR(scene.v[2], 3 + g, 1e-12);
  for (const double force : scene.f) CHECK_NEAR(force, 0, 1e-10);  // the mean contact force of the step
}

// (18) and its end: x = q_k + (1 - theta) dt v_k + theta dt v_{k+1}.
TEST(theta_weighs_old_and_new_velocity)
{
  for (const double theta : {0.0, 0.5, 0.75, 1.0}) {
    Scene scene;
    scene.add({0, 0, 0}, 0.1, 1, {0, 0, 3});
    scene.accelerate({0, 0, 10});
    Step step(settings("law moreau theta " + std::to_string(theta)));
    scene.advance(step, 0.1);
    CHECK_NEAR(scene.v[2], 4, 1e-15);
    CHECK_NEAR(scene.x[2], 0.1 * ((1 - theta) * 3 + theta * 4), 1e-15);
  }
}

// (21): v+ = -e v-; impulse, mean force and energy follow.
TEST(moreau_impact_on_a_wall_rebounds_at_its_restitution)
{
  for (const double e : {0.0, 0.5, 1.0}) {
    Scene scene;
    scene.add({0, 0, 1}, 1, 2, {5, 0, -3});
    Step step(settings("law moreau restitution " + std::to_string(e) + " wall plane 0 0 0 0 0 1"));
    scene.advance(step, 0.01);
    CHECK_NEAR(scene.v[2], 3 * e, 1e-14);
    CHECK(scene.v[0] == 5);
    CHECK_NEAR(scene.x[2], 1 + 0.005 * (-3 + 3 * e), 1e-15);
    CHECK_NEAR(scene.f[2], 2 * 3 * (1 + e) / 0.01, 1e-10);
    CHECK_NEAR(step.report().dissipated, 0.5 * 2 * 9 * (1 - e * e), 1e-13);
    CHECK_NEAR(step.report().largest_overlap, e < 1 ? 0.015 * (1 - e) : 0, 1e-15);
    CHECK_NEAR(step.report().largest_overlap_ratio, step.report().largest_overlap, 1e-15);
    CHECK_NEAR(step.state().table.contacts[0].impulse, 6 * (1 + e), 1e-14);
  }
}

// Masses 1 and 3 meet at 4 m/s: v+ from momentum and restitution.
TEST(moreau_impact_of_two_grains_keeps_momentum)
{
  for (const double e : {0.0, 0.5, 1.0}) {
    Scene scene;
    scene.add({0, 0, 0}, 1, 1, {3, 0, 0});
    scene.add({2, 0, 0}, 1, 3, {-1, 0, 0});
    Step step(settings("law moreau restitution " + std::to_string(e)));
    scene.advance(step, 0.01);
    CHECK_NEAR(scene.v[0] + 3 * scene.v[3], 0, 1e-14);
    CHECK_NEAR(scene.v[3] - scene.v[0], 4 * e, 1e-14);
    CHECK_NEAR(step.report().dissipated, 0.5 * 0.75 * 16 * (1 - e * e), 1e-13);
  }
}

TEST(a_resting_grain_is_held_by_its_weight)
{
  Scene scene;
  scene.add({0, 0, 1}, 1, 2);
  Step step(settings("law moreau wall plane 0 0 0 0 0 1"));
  for (int k = 0; k < 10; ++k) {
    scene.accelerate({0, 0, -9.81});
    scene.advance(step, 0.01);
    CHECK(scene.v[2] == 0 && scene.x[2] == 1);
    CHECK_NEAR(scene.f[2], 2 * 9.81, 1e-12);
    CHECK_NEAR(step.state().table.contacts[0].impulse, 2 * 9.81 * 0.01, 1e-15);
    CHECK(step.report().dissipated == 0);
  }
}

// In a column of three at rest the impulses are the weights above.
TEST(a_column_carries_its_weight)
{
  for (const auto &solver : nscd::solvers()) {
    Scene scene;
    for (int i = 0; i < 3; ++i) scene.add({0, 0, 1 + 2.0 * i}, 1, 2);
    scene.accelerate({0, 0, -10});
    const std::string words = "law moreau criterion paper tol 1e-10 wall plane 0 0 0 0 0 1 solver ";
    Step step(settings(words + std::string(solver.name)));
    scene.advance(step, 0.01);
    CHECK(step.report().converged);
    CHECK_NEAR(find_contact(step.state(), 0, -1)->impulse, 0.6, 1e-8);
    CHECK_NEAR(find_contact(step.state(), 1, 0)->impulse, 0.4, 1e-8);
    CHECK_NEAR(find_contact(step.state(), 2, 1)->impulse, 0.2, 1e-8);
  }
}

TEST(a_warm_start_saves_the_iterations_of_a_resting_column)
{
  int iterations[2];
  for (const bool warm : {false, true}) {
    Scene scene;
    for (int i = 0; i < 10; ++i) scene.add({0, 0, 0.999 + 1.999 * i}, 1, 2);
    const std::string words = "solver pdas law moreau criterion paper tol 1e-7 wall plane 0 0 0 0 0 1 warmstart ";
    Step step(settings(words + (warm ? "yes" : "no")));
    for (int k = 0; k < 3; ++k) {
      scene.accelerate({0, 0, -10});
      scene.advance(step, 0.01);
    }
    iterations[warm] = step.report().iterations;
  }
  CHECK(iterations[0] > 20);
  CHECK(iterations[1] <= 3);
}

TEST(a_step_is_the_same_to_the_last_bit_each_time)
{
  Random first(5), second(5);
  Scene a = random_scene(first, 40, 1, 0.1, 3), b = random_scene(second, 40, 1, 0.1, 3);
  const nscd::Settings chosen = settings("law moreau restitution 0.5" + box_walls(1, 1));
  Step one(chosen), two(chosen);
  for (int k = 0; k < 50; ++k) {
    a.accelerate({0, 0, -10});
    b.accelerate({0, 0, -10});
    a.advance(one, 0.002);
    b.advance(two, 0.002);
  }
  CHECK(one.report().contacts > 0);
  CHECK(a.x == b.x && a.v == b.v && a.f == b.f);
}

TEST(ftm2v_scales_forces_to_accelerations)
{
  Scene scene;
  scene.add({0, 0, 1}, 1, 2, {0, 0, 0});
  scene.accelerate({1, 0, -1});
  scene.list_all_pairs();
  nscd::Grains grains = scene.grains();
  grains.force_to_acceleration = 10;
  Step step(settings("law moreau wall plane 0 0 0 0 0 1"));
  step.advance(grains, scene.pairs(), 0.1);
  CHECK_NEAR(scene.v[0], 1, 1e-15);
  CHECK(scene.v[2] == 0);
  CHECK_NEAR(scene.f[2], 2, 1e-14);  // the contact force balances the weight, in the same unit
}

TEST(a_custom_solver_is_handed_the_problem_and_its_impulses_are_used)
{
  Scene scene;
  scene.add({0, 0, 1}, 1, 2, {0, 0, -3});
  int calls = 0;
  Step step(settings("law moreau wall plane 0 0 0 0 0 1"), [&](const nscd::State &state, std::size_t n, auto p) {
    ++calls;
    const auto &c = state.table.contacts[0];
    CHECK(n == 1 && state.table.infos.size() == 1 && p.size() == 1 && p[0] == 0);
    p[0] = -nscd::normal_velocity(c, state.motion.bodies.data()) * c.w_inverse;
  });
  scene.advance(step, 0.01);
  CHECK(calls == 1 && scene.v[2] == 0);
  CHECK(step.report().converged && step.report().iterations == 1);
}

TEST(energy_and_unconverged_steps_count_from_the_start_of_a_run)
{
  Scene scene;
  for (int i = 0; i < 5; ++i) scene.add({0, 0, 1 + 2.0 * i}, 1, 2, {0, 0, -1});
  Step step(settings("law moreau maxiter 1 warmstart no wall plane 0 0 0 0 0 1"));
  scene.advance(step, 0.001);
  scene.accelerate({});
  scene.advance(step, 0.001);
  CHECK(step.report().unconverged == 2 && !step.report().converged && step.report().dissipated > 0);
  step.begin_run(true);
  CHECK(step.report().unconverged == 0 && step.report().dissipated == 0);
  scene.accelerate({});
  scene.advance(step, 0.001);
  CHECK(step.report().unconverged == 1);
}
