// SPDX-License-Identifier: GPL-2.0-or-later
// Law gap on scenes small enough to be worked out by hand.
#include "check.hpp"
#include "scene.hpp"
#include "step/report.hpp"

#include <cmath>

using nscd::Step;

static const std::string floor_wall = " wall plane 0 0 0 0 0 1";

TEST(gap_free_flight_is_the_parabola)
{
  Scene scene;
  scene.add({0, 0, 9}, 0.1, 2, {1, -2, 3});
  Step step(settings("law gap"));
  for (int k = 0; k < 100; ++k) {
    scene.accelerate({0, 0, -9.81});
    scene.advance(step, 0.01);
  }
  CHECK_NEAR(scene.x[0], 1, 1e-13);
  CHECK_NEAR(scene.x[2], 12 - 9.81 / 2, 1e-12);
}

// v_n + gap/dt = 0: the grain lands on the surface, neither above nor below.
TEST(gap_landing_ends_on_the_surface)
{
  Scene scene;
  scene.add({0, 0, 1.05}, 1, 2, {1, 0, -3});
  Step step(settings("law gap" + floor_wall));
  scene.advance(step, 0.1);
  CHECK_NEAR(scene.v[2], -0.5, 1e-14);
  CHECK_NEAR(scene.x[2], 1, 1e-14);
  CHECK(scene.v[0] == 1);
  CHECK_NEAR(scene.f[2], 2 * 2.5 / 0.1, 1e-11);
  CHECK(step.report().largest_overlap < 1e-14);
  scene.accelerate({});
  scene.advance(step, 0.1);
  CHECK_NEAR(scene.v[2], 0, 1e-13);
}

TEST(a_grain_that_falls_short_of_the_surface_is_left_alone)
{
  Scene scene;
  scene.add({0, 0, 1.31}, 1, 2, {0, 0, -3});
  Step step(settings("law gap" + floor_wall));
  scene.advance(step, 0.1);
  CHECK(scene.v[2] == -3);
  CHECK_NEAR(scene.x[2], 1.01, 1e-15);
}

// The start of an impact is where the grain is; the rebound has Newton's speed whatever the gap.
TEST(gap_impact_rebounds_at_its_restitution)
{
  for (const double e : {0.5, 1.0})
    for (const double gap : {0.0, 0.01, 0.2}) {
      Scene scene;
      scene.add({0, 0, 1 + gap}, 1, 2, {0, 0, -3});
      Step step(settings("law gap restitution " + std::to_string(e) + floor_wall));
      scene.advance(step, 0.1);
      CHECK_NEAR(scene.v[2], 3 * e, 1e-14);
      CHECK(scene.x[2] >= 1 - 1e-14);
      CHECK_NEAR(step.report().dissipated, 0.5 * 2 * 9 * (1 - e * e), 1e-13);
    }
}

TEST(gap_impact_of_two_grains_keeps_momentum)
{
  for (const double e : {0.0, 0.5, 1.0}) {
    Scene scene;
    scene.add({0, 0, 0}, 1, 1, {3, 0, 0});
    scene.add({2, 0, 0}, 1, 3, {-1, 0, 0});
    Step step(settings("law gap restitution " + std::to_string(e)));
    scene.advance(step, 0.01);
    CHECK_NEAR(scene.v[0] + 3 * scene.v[3], 0, 1e-14);
    CHECK_NEAR(scene.v[3] - scene.v[0], 4 * e, 1e-14);
  }
}

TEST(a_resting_grain_stays_at_rest_whatever_its_restitution)
{
  for (const double e : {0.0, 0.5, 1.0}) {
    Scene scene;
    scene.add({0, 0, 1}, 1, 2);
    Step step(settings("law gap restitution " + std::to_string(e) + floor_wall));
    for (int k = 0; k < 100; ++k) {
      scene.accelerate({0, 0, -9.81});
      scene.advance(step, 0.01);
      CHECK_NEAR(scene.v[2], 0, 1e-13);
      CHECK_NEAR(scene.x[2], 1, 1e-13);
      CHECK_NEAR(scene.f[2], 2 * 9.81, 1e-9);
    }
  }
}

// v_n = min(recovery |gap| / dt, a tenth of the smooth velocity change + tol).
TEST(an_overlap_is_given_back_slowly)
{
  const double dt = 0.01, g = 10;
  for (const double overlap : {1e-5, 1e-2}) {
    Scene scene;
    scene.add({0, 0, 1 - overlap}, 1, 2);
    scene.accelerate({0, 0, -g});
    Step step(settings("law gap recovery 0.2 criterion paper tol 1e-7" + floor_wall));
    scene.advance(step, dt);
    const double speed = std::min(0.2 * overlap / dt, 0.1 * g * dt + 1e-7);
    CHECK_NEAR(scene.v[2], speed, 1e-14);
    CHECK_NEAR(step.report().largest_overlap, overlap - dt * speed / 2, 1e-14 + dt * speed / 2);
  }
}

TEST(recovery_zero_gives_nothing_back)
{
  Scene scene;
  scene.add({0, 0, 0.99}, 1, 2);
  scene.accelerate({0, 0, -10});
  Step step(settings("law gap recovery 0" + floor_wall));
  scene.advance(step, 0.01);
  CHECK_NEAR(scene.v[2], 0, 1e-15);
}

TEST(an_overlapping_start_gives_energy_to_nobody)
{
  for (const double overlap : {0.01, 0.3, 0.9}) {
    Scene scene;
    scene.add({0, 0, 0}, 1);
    scene.add({2 - overlap, 0, 0}, 1);
    Step step(settings("law gap"));
    for (int k = 0; k < 100; ++k) {
      scene.accelerate({});
      scene.advance(step, 0.001);
    }
    CHECK(std::abs(scene.v[0]) < 1e-6 && std::abs(scene.v[3]) < 1e-6);
  }
}

// The fall from height h: no step ever overlaps, and the grain comes to rest on the floor.
TEST(a_falling_grain_never_overlaps)
{
  for (const double dt : {1e-3, 1e-2, 0.1}) {
    Scene scene;
    scene.add({0, 0, 2}, 1, 2);
    Step step(settings("law gap" + floor_wall));
    for (int k = 0; k < 1 + int(1 / dt); ++k) {
      scene.accelerate({0, 0, -10});
      scene.advance(step, dt);
      CHECK(step.report().largest_overlap < 1e-12);
    }
    CHECK_NEAR(scene.x[2], 1, 1e-12);
    CHECK_NEAR(scene.v[2], 0, 1e-10);
  }
}

// Each in turn, as no contact but the first is closed when it starts: the last grain leaves with all of the speed.
TEST(a_row_with_gaps_hands_an_elastic_impact_on)
{
  Scene scene;
  for (int i = 0; i < 4; ++i) scene.add({2.3 * i, 0, 0}, 1, 1, {i == 0 ? 1.0 : 0, 0, 0});
  Step step(settings("law gap restitution 1"));
  for (int k = 0; k < 200; ++k) {
    scene.accelerate({});
    scene.advance(step, 0.01);
  }
  for (int i = 0; i < 4; ++i) CHECK_NEAR(scene.v[3 * i], i == 3, 1e-12);
}

// Normals, points, gaps and impulses of two known contacts, as `dump local` shows them.
TEST(contact_rows_show_the_contacts_at_the_end_of_the_step)
{
  Scene scene;
  scene.add({0, 0, 1}, 1, 2);
  scene.add({0, 0, 2.5}, 0.5, 1);
  scene.accelerate({0, 0, -10});
  Step step(settings("law gap criterion paper tol 1e-12" + floor_wall));
  scene.advance(step, 0.01);
  double rows[2][10];
  CHECK(step.report().contacts == 2);
  if (step.report().contacts != 2) return;
  nscd::fill_contact_rows(step.state(), rows[0]);
  const int wall = rows[0][1] < 0 ? 0 : 1;
  const double *w = rows[wall], *p = rows[1 - wall];
  CHECK(w[0] == 1 && w[1] == -1 && w[7] == 1);
  CHECK_NEAR(w[4], 0, 1e-12);
  CHECK_NEAR(w[8], 0, 1e-12);
  CHECK_NEAR(w[9], 0.3, 1e-10);
  CHECK(p[0] + p[1] == 3 && std::abs(p[7]) == 1);
  CHECK_NEAR(p[4], 2, 1e-12);
  CHECK_NEAR(p[9], 0.1, 1e-10);
}
