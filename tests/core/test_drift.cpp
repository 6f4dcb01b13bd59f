// SPDX-License-Identifier: GPL-2.0-or-later
// What a contact's velocity has besides its bodies': radii that grow, images and grains that move with the box.
#include "check.hpp"
#include "scene.hpp"
#include "scene/drift/box_motion.hpp"

#include <cmath>

using nscd::Box;
using nscd::Step;

namespace {

constexpr double step_length = 1e-3;

Box cube(double side)
{
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.edges[k] = side;
    box.periodic[k] = true;
  }
  return box;
}

// Two grains of radius 1/2 that touch across the y face of a box with sides of 10.
struct AcrossTheFace {
  Scene scene;
  Box box = cube(10);

  AcrossTheFace()
  {
    scene.add({0, 0.5, 0}, 0.5, 1);
    scene.add({0, 9.5, 0}, 0.5, 1);
    scene.add_image(1, {});
    place_image();
  }
  // The upper grain's image is below the lower grain.
  void place_image()
  {
    scene.x[6] = scene.x[3] - box.edges[5];
    scene.x[7] = scene.x[4] - box.edges[1];
    scene.x[8] = scene.x[5];
  }
  const nscd::StepReport &advance(Step &step)
  {
    place_image();
    scene.accelerate({});
    if (scene.pairs().count == 0) scene.list_all_pairs();
    nscd::Grains grains = scene.grains();
    grains.box = &box;
    return step.advance(grains, scene.pairs(), step_length);
  }
};

}    // namespace

TEST(grains_that_grow_part_at_their_growth)
{
  for (const std::string law : {"gap", "moreau"})
    for (const double e : {0.0, 1.0}) {
      Scene scene;
      scene.add({0, 0, 0}, 0.5, 1);
      scene.add({1, 0, 0}, 0.5, 1);
      Step step(settings("tol 1e-12 law " + law + " restitution " + std::to_string(e)));
      step.begin_run(true);
      step.see(scene.grains());
      for (int k = 1; k <= 5; ++k) {
        for (double &radius : scene.radius) radius = 0.5 + 0.01 * step_length * k;
        scene.accelerate({});
        scene.advance(step, step_length);
      }
      CHECK_NEAR(scene.v[3] - scene.v[0], 0.02 * (1 + e), 0.01 * e + 1e-9);
      CHECK(step.report().largest_overlap < 0.04 * step_length);
    }
}

TEST(a_radius_that_jumps_has_no_velocity)
{
  Scene scene;
  scene.add({0, 0, 0}, 0.5, 1);
  scene.add({1, 0, 0}, 0.5, 1);
  Step step(settings("law gap recovery 0.2"));
  for (int k = 1; k <= 100; ++k) {
    if (k == 51) scene.radius[0] += 1e-4;
    scene.accelerate({});
    scene.advance(step, step_length);
    // Given back over the 50 steps (51 with the first) that nothing had changed for.
    CHECK_NEAR(scene.v[3] - scene.v[0], k > 50 ? 1e-4 / (51 * step_length) : 0, 1e-4);
  }
  CHECK_NEAR(step.report().largest_overlap, 0, 3e-6);
}

// The rate is known from the first change on: the box moves at the end of the first step.
TEST(grains_part_across_a_face_that_closes)
{
  for (const std::string law : {"gap", "moreau"})
    for (const double e : {0.0, 1.0}) {
      AcrossTheFace pair;
      Step step(settings("tol 1e-12 law " + law + " restitution " + std::to_string(e)));
      for (int k = 0; k < 5; ++k) {
        pair.advance(step);
        pair.box.edges[1] -= 0.2 * step_length;
      }
      CHECK_NEAR(pair.scene.v[1], 0.1 * (1 + e), 1e-9);
      CHECK_NEAR(pair.scene.v[4], -0.1 * (1 + e), 1e-9);
      CHECK(step.report().largest_overlap < 0.41 * step_length);
    }
}

// With a rate that the door knows there is no overlap at all.
TEST(a_known_rate_leaves_no_overlap)
{
  AcrossTheFace pair;
  pair.box.rate_known = pair.box.changes_now = true;
  pair.box.rate[1] = -0.2;
  Step step(settings("law gap"));
  for (int k = 0; k < 5; ++k) {
    CHECK(pair.advance(step).largest_overlap < 1e-13);
    pair.box.edges[1] -= 0.2 * step_length;
  }
  CHECK_NEAR(pair.scene.v[1], 0.1, 1e-9);
}

// A box that moves every 10th step moves evenly for the contacts.
TEST(grains_part_evenly_in_a_box_that_moves_now_and_then)
{
  AcrossTheFace pair;
  Step step(settings("law gap"));
  for (int k = 1; k <= 40; ++k) {
    pair.advance(step);
    if (k > 10) CHECK_NEAR(pair.scene.v[1], 0.1, 1e-3);
    if (k % 10 == 0) pair.box.edges[1] -= 10 * 0.2 * step_length;
  }
}

// mu 0.3 and a normal impulse of 1/2: 0.15 of velocity, 2.5 * 0.15 / r of spin.
TEST(a_sheared_box_makes_grains_slip_across_its_face)
{
  for (const std::string law : {"gap", "moreau"}) {
    AcrossTheFace pair;
    pair.scene.v = {0, -0.5, 0, 0, 0.5, 0};
    pair.scene.x[1] = 0.501;
    pair.scene.x[4] = 9.501;
    pair.box.rate_known = true;
    pair.box.rate[5] = -5;
    Step step(settings("tol 1e-12 friction 0.3 law " + law));
    pair.advance(step);
    if (law == "moreau") pair.advance(step);
    // The image has moved by 5e-3 of the distance in a step, and the normal with it.
    CHECK_NEAR(pair.scene.v[0], 0.15, 4e-3);
    CHECK_NEAR(pair.scene.v[3], -0.15, 4e-3);
    CHECK_NEAR(std::abs(pair.scene.omega[2]), 0.75, 1e-2);
  }
}

// The lattice of images stays what it is when its tilt is taken back by a whole edge.
TEST(a_box_that_flips_has_not_moved)
{
  Box before = cube(10), after = cube(10);
  before.edges[5] = 5.0;
  after.edges[5] = -5.0;
  const nscd::BoxChange change = nscd::change_between(before, after);
  for (const double edge : change.edges) CHECK_NEAR(edge, 0, 1e-14);
}

// What it has made of overlap is given back over the time of the run before.
TEST(a_box_that_moved_between_runs_has_no_velocity)
{
  for (const double change : {1.0, -0.01}) {
    AcrossTheFace pair;
    Step step(settings("law gap restitution 1"));
    step.begin_run(true);
    for (int k = 0; k < 100; ++k) pair.advance(step);
    pair.box.edges[1] += change;
    step.begin_run(true);
    for (int k = 0; k < 10; ++k) pair.advance(step);
    CHECK_NEAR(pair.scene.v[1], change < 0 ? 0.005 / (100 * step_length) : 0, 1e-6);
  }
}
