// SPDX-License-Identifier: GPL-2.0-or-later
// Walls that move, and cylinders: closed forms.
#include "check.hpp"
#include "obstacle/moved.hpp"
#include "scene.hpp"
#include "step/report.hpp"

#include <cmath>
#include <vector>

using nscd::Step;
using nscd::Vec4;

namespace {

constexpr double weight = 10;
const std::string well_solved = " criterion paper tol 1e-12 maxiter 10000 ";

void fall_on(Step &step, Scene &scene, double dt)
{
  scene.accelerate({0, 0, -weight});
  scene.advance(step, dt);
  scene.just_built = false;
}

// The period of x[0], from its downward passages through 0, s.
double period_of(Step &step, Scene &scene, double dt, int swings)
{
  std::vector<double> passages;
  for (double time = 0; int(passages.size()) <= swings; time += dt) {
    const double before = scene.x[0];
    fall_on(step, scene, dt);
    if (before > 0 && scene.x[0] <= 0) passages.push_back(time + dt * before / (before - scene.x[0]));
    if (time > 1e3) break;
  }
  return (passages.back() - passages.front()) / swings;
}

}    // namespace

// A small swing in a level cylinder: a pendulum of length R - r, of 7/5 of its inertia if it rolls.
TEST(a_ball_swings_in_a_cylinder)
{
  for (const bool rolls : {false, true}) {
    const double path = 4, angle = 0.1, dt = 2e-3;
    Scene scene;
    scene.add({path * std::sin(angle), 0, -path * std::cos(angle)}, 1, 2);
    Step step(settings((rolls ? "stick " : "") + std::string("wall ycylinder 5") + well_solved));
    const double expected = 2 * M_PI * std::sqrt((rolls ? 1.4 : 1) * path / weight) * (1 + angle * angle / 16);
    CHECK_NEAR(period_of(step, scene, dt, 5), expected, 2e-4 * expected);
    CHECK(step.report().largest_overlap < 1e-4);
  }
}

// A ball that spins as the surface of a turning cylinder runs stays at its bottom.
TEST(a_ball_spins_at_the_bottom_of_a_drum)
{
  const double runs = 5 * M_PI;   // m/s: once round in 2 s
  Scene scene;
  scene.add({0, 0, -4}, 1, 2);
  scene.omega[1] = runs;
  Step step(settings("friction 0.5 wall ycylinder 5 rotate 2 0 0 0 0 1 0" + well_solved));
  for (int k = 0; k < 2000; ++k) fall_on(step, scene, 1e-3);
  CHECK(std::abs(scene.x[0]) < 1e-6 && std::abs(scene.v[0]) < 1e-6);
  CHECK_NEAR(scene.omega[1], runs, 1e-6);
  CHECK(step.report().largest_overlap < 1e-9);
}

// Below Gamma = 1 a plate that shakes never loses the ball, and pushes it with m (weight - A w^2 cos w t).
TEST(a_plate_that_shakes_gently_keeps_its_ball)
{
  const double amplitude = 0.09, period = 2 * M_PI / 10, dt = 1e-3, mass = 2;   // w = 10: Gamma = 0.9
  Scene scene;
  scene.add({0, 0, 1}, 1, mass);
  Step step(settings("wall zplane 0 NULL wiggle z 0.09 " + std::to_string(period) + well_solved));
  for (int k = 0; k < 2000; ++k) {
    fall_on(step, scene, dt);
    const auto &table = step.state().table;
    CHECK(table.size() == 1 && table.contacts[0].impulse > 0);
    if (k == 0) continue;   // the plate begins with a jolt, w^2 A
    const double time = (k + 0.5) * dt - 0.5 * dt, w = 2 * M_PI / period;
    const double force = mass * (weight + amplitude * w * w * std::cos(w * time));
    CHECK_NEAR(table.contacts[0].impulse / dt, force, 2e-2 * mass * weight);
    // Within a step the ball moves with the mean of two velocities, the plate with its own.
    CHECK(std::abs(scene.x[2] - 1 - amplitude * (1 - std::cos(w * (k + 1) * dt))) < amplitude * w * w * dt * dt);
  }
}

// Above, the ball leaves where the plate falls as fast as it does, flies a parabola, and lands where that meets it.
TEST(a_plate_that_shakes_throws_its_ball)
{
  const double amplitude = 0.2, period = 2 * M_PI / 10, w = 10;   // Gamma = 2
  const auto plate = [&](double t) { return amplitude * (1 - std::cos(w * t)); };
  const double leaves = std::acos(-0.5) / w, up = amplitude * w * std::sin(w * leaves);
  double lands = leaves + 0.05;
  while (plate(leaves) + up * (lands - leaves) - 0.5 * weight * (lands - leaves) * (lands - leaves) > plate(lands))
    lands += 1e-6;
  for (const double dt : {1e-3, 2.5e-4}) {
    Scene scene;
    scene.add({0, 0, 1}, 1, 2);
    Step step(settings("wall zplane 0 NULL wiggle z 0.2 " + std::to_string(period) + well_solved));
    double left = 0, landed = 0;
    for (double time = 0; time < 0.8; time += dt) {
      fall_on(step, scene, dt);
      const auto &table = step.state().table;
      const bool touches = table.size() == 1 && table.contacts[0].impulse > 0;
      if (!touches && left == 0) left = time + 0.5 * dt;
      if (touches && left > 0 && landed == 0) landed = time + 0.5 * dt;
      CHECK(step.report().largest_overlap < 1e-9);
    }
    CHECK_NEAR(left, leaves, 1.1 * dt);
    CHECK_NEAR(landed, lands, 2 * dt);
  }
}

// A belt of speed V drags a ball for 2 V / (7 mu weight) and leaves it at 2/7 V, whatever mu.
TEST(a_belt_drags_a_ball)
{
  for (const double mu : {0.1, 0.4}) {
    const double speed = 3, dt = 1e-4, slips = 2 * speed / (7 * mu * weight);
    Scene scene;
    scene.add({0, 0, 1}, 1, 2);
    Step step(settings("friction " + std::to_string(mu) + " wall plane 0 0 0 0 0 1 shear x 3" + well_solved));
    const int steps = int(slips / dt);
    for (int k = 0; k < steps; ++k) fall_on(step, scene, dt);
    CHECK_NEAR(scene.v[0], mu * weight * steps * dt, 1e-9);
    for (int k = 0; k < 1000; ++k) fall_on(step, scene, dt);
    CHECK_NEAR(scene.v[0], 2 * speed / 7, 1e-9);
    CHECK(std::abs(scene.x[2] - 1) < 1e-9);
  }
}

// A ball that rolls without slip on a turntable runs on a circle with 2/7 of its angular speed.
TEST(a_ball_circles_on_a_turntable)
{
  const double omega = 2, dt = 1e-3, circle = 2 * M_PI / (2.0 / 7 * omega);
  Scene scene;
  scene.add({3, 0, 1}, 1, 2);
  scene.v[1] = 1;
  // It rolls from the start: the surface runs with omega x r there.
  scene.omega[0] = (3 * omega - 1);
  Step step(settings("stick wall plane 0 0 0 0 0 1 rotate " + std::to_string(2 * M_PI / omega) + " 0 0 0 0 0 1" +
                     well_solved));
  const int steps = int(std::lround(circle / dt));
  double farthest = 0;
  for (int k = 0; k < steps; ++k) {
    fall_on(step, scene, dt);
    farthest = std::max(farthest, std::hypot(scene.x[0] - 3, scene.x[1]));
  }
  CHECK_NEAR(scene.x[0], 3, 0.02);
  CHECK_NEAR(scene.x[1], 0, 0.02);
  CHECK_NEAR(farthest, 2 * 1 / (2.0 / 7 * omega), 0.02);
}

// A blade that sweeps round pushes what is before it, and nothing sinks into it: its normal turns within the step.
TEST(a_blade_that_turns_keeps_the_promise_on_overlap)
{
  for (const double dt : {1e-3, 4e-3}) {
    Scene scene;
    for (int k = 1; k <= 6; ++k) scene.add({2.5 * k, 1.2, 0}, 1, 1 + k % 3);
    Step step(settings("law gap wall plane 0 0 0 0 1 0 rotate 2 0 0 0 0 0 1" + well_solved));
    double overlap = 0;
    for (int k = 0; k < int(0.3 / dt); ++k) {
      scene.accelerate({0, 0, 0});
      scene.advance(step, dt);
      scene.just_built = false;
      overlap = std::max(overlap, step.report().largest_overlap_ratio);
    }
    CHECK(overlap < 5e-4);
    CHECK(scene.v[1] > 5);
  }
}

TEST(words_of_walls_that_move)
{
  CHECK_ERROR(settings("wall zplane NULL NULL"), "wall 1: both sides are NULL: give one of them a place");
  CHECK_ERROR(settings("wall zplane 1 0"), "wall 1: lo = 1 must be below hi = 0");
  CHECK_ERROR(settings("wall zplane 0 up"), "keyword wall: 'up' is not a number or NULL");
  CHECK_ERROR(settings("wall zcylinder 0"), "wall 1: the radius 0 must be > 0");
  CHECK_ERROR(settings("wall zplane 0 1 wiggle w 1 1"), "wall 1: wiggle: 'w' is no direction: give x, y or z");
  CHECK_ERROR(settings("wall zplane 0 1 wiggle z 1 0"), "wall 1: wiggle: the period 0 must be > 0");
  CHECK_ERROR(settings("wall zplane 0 1 wiggle z 1 1 wiggle z 1 1"), "wall 1: wiggle is given twice: give it once");
  CHECK_ERROR(settings("wall zplane 0 1 rotate 1 0 0 0 0 0 0"),
              "wall 1: rotate: the axis must be a vector other than (0, 0, 0)");
  CHECK_ERROR(settings("wall zplane 0 1 wiggle z 1"), "too few words: give `wiggle dim A T`");
  CHECK_ERROR(settings("wall zplane 0 1 shear x"), "too few words: give `shear dim V`");
  CHECK_ERROR(settings("wall zplane 0 1 rotate 1 0 0 0 0 0"), "too few words: give `rotate T x y z ax ay az`");
  const nscd::Settings two = settings("wall zplane 0 1 wiggle z 1 1 friction 0.5 shear x 2 wall xcylinder 3");
  CHECK(two.walls.size() == 2 && two.walls[0].own.has(0) && two.walls[1].name == "wall 2");
}
