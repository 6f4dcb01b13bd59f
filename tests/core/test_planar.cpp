// SPDX-License-Identifier: GPL-2.0-or-later
// Planar scenes (`dimension 2`), spins in and out of the arrays, and obstacles that drive grains.
#include "check.hpp"
#include "scene.hpp"
#include "scene/slides.hpp"
#include "step/report.hpp"

#include <cmath>
#include <functional>

using nscd::Step;
using nscd::Vec4;

static const std::string ground = " wall plane 0 0 0 0 1 0";

// A disc that rests on the ground, and one in the air.
static Scene two_discs(double z = 0)
{
  Scene scene;
  scene.add({0, 0.5, z}, 0.5, 2);
  scene.add({3, 4, z}, 0.5, 1);
  return scene;
}

static void refuses_in_the_plane(const std::function<void(Scene &)> &spoil, const std::string &message)
{
  for (const char *keywords : {"law moreau", "law gap", "law gap friction 0.5"}) {
    Scene scene = two_discs();
    spoil(scene);
    const Scene before = scene;
    Step step(settings(keywords + ground), {}, 2);
    CHECK_ERROR(scene.advance(step, 0.01), message);
    CHECK(scene.x == before.x && scene.v == before.v && scene.f == before.f && scene.omega == before.omega);
    Step space(settings(keywords + ground));
    scene.advance(space, 0.01);
  }
}

TEST(grains_off_the_plane_are_refused)
{
  refuses_in_the_plane([](Scene &s) { s.x[5] = 0.25; }, "grain 2 is at z = 0.25, off the plane z = 0 of a planar scene "
                       "(dimension 2): use `set group all z 0`, or dimension 3");
}

TEST(motion_across_the_plane_is_refused)
{
  const std::string remedy =
      " along z in a planar scene (dimension 2): add `fix ID all enforce2d`, or use dimension 3";
  refuses_in_the_plane([](Scene &s) { s.v[2] = 0.5; }, "grain 1 has a velocity 0.5 or force 0" + remedy);
  refuses_in_the_plane([](Scene &s) { s.f[5] = -2; }, "grain 2 has a velocity 0 or force -2" + remedy);
}

// An obstacle does not move by its velocity or force, and the plane may be any z = const.
TEST(obstacles_may_have_any_velocity_and_the_plane_any_height)
{
  Scene scene = two_discs(7);
  scene.mask[1] = 2;
  scene.v[5] = 3;
  scene.f[5] = 4;
  Step step(settings("friction 0.5" + ground), {}, 2);
  CHECK(scene.advance(step, 0.01).converged && scene.x[2] == 7);
}

TEST(settings_that_do_not_fit_the_dimension_are_refused)
{
  CHECK_ERROR(Step(settings("wall plane 0 0 0 0 1 0 wall plane 0 0 0 0 3 4"), {}, 2),
              "wall 2: its normal has a z component, but the scene is planar (dimension 2): make it 0, or use "
              "dimension 3");
  CHECK_ERROR(Step(settings("friction 0.5 inertia disc")),
              "inertia disc needs `dimension 2`: grains in space are spheres");
  Step(settings("friction 0.5 inertia sphere wall plane 0 0 0 1 1 0"), {}, 2);
}

TEST(the_description_names_the_model)
{
  const auto text = [](const char *words, int dimension) {
    return nscd::describe(Step(settings(words), {}, dimension));
  };
  CHECK_SAYS(text("", 2), "frictionless: 1 unknown per contact, no spins");
  CHECK_SAYS(text("friction 0.5", 2), "friction 0.5; planar: 2 unknowns per contact, spins about z of discs");
  CHECK_SAYS(text("stick", 3), "friction stick; spatial: 3 unknowns per contact, spins of spheres");
  CHECK_SAYS(text("friction 0.5 inertia sphere wall plane 0 0 0 0 1 0 stick", 2),
             "friction 0.5, stick on wall 1; planar: 2 unknowns per contact, spins about z of spheres");
  CHECK_SAYS(text("friction 0.5 restitution 0.5 e_t 0.25", 3), "restitution 0.5, tangential 0.25");
}

// A disc set down sliding rolls at 2/3 v0 in the end (a sphere at 5/7): v = v0 / (1 + 1/k).
static void check_rolling(const char *law, int dimension, const char *inertia, double share)
{
  Scene scene;
  scene.add({0, 0.5, 0}, 0.5, 2, {3, 0, 0});
  const std::string words = "friction 0.3 criterion paper tol 1e-12 law ";
  Step step(settings(words + law + inertia + ground), {}, dimension);
  for (int k = 0; k < 100; ++k) {
    scene.accelerate({0, -10, 0});
    scene.advance(step, 0.01);
    const double slides_until = 3 * (1 - share) / 3;
    if (0.01 * (k + 1) < slides_until) {
      CHECK_NEAR(scene.v[0], 3 - 0.3 * 10 * 0.01 * (k + 1), 1e-10);
      CHECK_NEAR(scene.f[0], -0.3 * 20, 1e-8);
      CHECK_NEAR(scene.torque[2], -0.5 * 0.3 * 20, 1e-8);
    }
  }
  CHECK_NEAR(scene.v[0], share * 3, 1e-9);
  CHECK_NEAR(scene.omega[2], -share * 3 / 0.5, 1e-8);
  CHECK_NEAR(scene.torque[2], 0, 1e-8);
  CHECK_NEAR(step.report().dissipated, 0.5 * 2 * 9 * (1 - share), 1e-8);
}

TEST(a_sliding_disc_rolls_in_the_end_at_two_thirds_of_its_speed)
{
  for (const char *law : {"moreau", "gap"}) {
    check_rolling(law, 2, "", 2.0 / 3);
    check_rolling(law, 2, " inertia sphere", 5.0 / 7);
    check_rolling(law, 3, "", 5.0 / 7);
  }
}

// Smooth torques spin a grain up by T dt k / (m r^2) and leave no contact torque; x and y have no part in the plane.
TEST(torques_spin_free_grains)
{
  for (const int dimension : {2, 3}) {
    Scene scene = two_discs();
    scene.torque[5] = 3;
    Step step(settings("friction 0.5"), {}, dimension);
    scene.advance(step, 0.1);
    CHECK_NEAR(scene.omega[5], 0.1 * 3 * (dimension == 2 ? 2 : 2.5) / 0.25, 1e-13);
    CHECK_NEAR(scene.torque[5], 0, 1e-12);
    CHECK(scene.omega[2] == 0 && scene.omega[3] == 0);
  }
}

// I dw/dt = T_smooth + T_contact, m dv/dt = f_smooth + f_contact in the units of LAMMPS, whatever ftm2v is.
TEST(torques_out_are_the_mean_contact_torques)
{
  for (const char *law : {"law moreau ", "law gap "}) {
    Scene scene;
    scene.add({0, 0.5, 0}, 0.5, 2, {3, 0, 0});
    scene.accelerate({0.4, -2, 0});
    scene.torque[2] = 1.5;
    scene.list_all_pairs();
    nscd::Grains grains = scene.grains();
    grains.force_to_acceleration = 5;
    Step step(settings(law + ("friction 0.3" + ground)), {}, 2);
    step.advance(grains, scene.pairs(), 0.01);
    CHECK_NEAR(scene.f[0], -0.3 * 4, 1e-12);
    CHECK_NEAR(scene.torque[2], -0.5 * 0.3 * 4, 1e-12);
    CHECK_NEAR(scene.omega[2], 5 * 0.01 * (1.5 - 0.6) / (0.5 * 2 * 0.25), 1e-12);
    CHECK_NEAR(scene.v[0], 3 + 5 * 0.01 * (0.8 - 1.2) / 2, 1e-12);
  }
}

TEST(torques_may_be_absent_where_there_is_friction)
{
  Scene scene = two_discs();
  scene.v[0] = 1;
  scene.accelerate({0, -10, 0});
  scene.list_all_pairs();
  nscd::Grains grains = scene.grains();
  grains.torque = nullptr;
  Step step(settings("friction 0.1" + ground), {}, 2);
  step.advance(grains, scene.pairs(), 0.01);
  CHECK_NEAR(scene.v[0], 0.99, 1e-12);
  CHECK_NEAR(scene.omega[2], -0.01 * 2 / 0.5, 1e-12);
  CHECK(scene.torque[2] == 0);
}

TEST(without_friction_omega_and_torque_are_left_alone)
{
  for (const char *law : {"law moreau", "law gap"})
    for (const int dimension : {2, 3}) {
      Scene scene = two_discs(), bare = two_discs();
      scene.omega = {1, NAN, 3, 4, 5, 6};
      scene.torque = {7, 8, INFINITY, 9, 10, 11};
      const Scene before = scene;
      bare.list_all_pairs();
      nscd::Grains grains = bare.grains();
      grains.omega = grains.torque = nullptr;
      Step one(settings(law + ground), {}, dimension), two(settings(law + ground), {}, dimension);
      scene.advance(one, 0.01);
      two.advance(grains, bare.pairs(), 0.01);
      CHECK(std::isnan(scene.omega[1]) && scene.omega[0] == 1 && scene.omega[5] == 6);
      CHECK(scene.torque == before.torque);
      CHECK(scene.x == bare.x && scene.v == bare.v && scene.f == bare.f);
    }
}

// A belt of obstacles that turn: their surfaces move at r omega, and the grain on top ends at that speed, not rolling.
// An obstacle with a velocity carries likewise. Neither changes.
TEST(obstacles_drive_grains_by_spin_and_by_velocity)
{
  const std::string moreau = "moreau";
  for (const std::string law : {"moreau", "gap"})
    for (const int dimension : {2, 3})
      for (const bool spinning : {false, true}) {
        Scene scene;
        scene.add({0, law == moreau ? 1000.4999 : 1000.5, 0}, 0.5, 2);  // in touch, and no overlap to give back
        scene.add_obstacle({0, 0, 0}, 1000);
        if (spinning) scene.omega[5] = -2e-3;
        else scene.v[3] = 2;
        Step step(settings("friction 0.4 criterion paper tol 1e-11 law " + law), {}, dimension);
        for (int k = 0; k < 60; ++k) {
          scene.accelerate({0, -10, 0});
          scene.advance(step, 1e-3);
          CHECK_NEAR(scene.v[0], 0.4 * 10 * 1e-3 * (k + 1), 1e-4);  // slips: the drive is mu m g
          CHECK_NEAR(scene.f[0], 0.4 * 20, 1e-2);
        }
        CHECK(scene.omega[2] > 0 && scene.x[3] == 0 && scene.x[4] == 0);
        CHECK(scene.omega[5] == (spinning ? -2e-3 : 0) && scene.v[3] == (spinning ? 0 : 2) && scene.torque[5] == 0);
      }
}

// Gear wheels: a driven obstacle turns a grain held between walls the other way, at the same speed of the surfaces.
TEST(a_turning_obstacle_turns_a_caged_grain)
{
  Scene scene;
  scene.add({0, 3, 0}, 1, 2);
  scene.add_obstacle({0, 0, 0}, 2);
  scene.omega[5] = 3;
  const std::string cage = " wall plane 1 0 0 -1 0 0 friction 0 wall plane -1 0 0 1 0 0 friction 0";
  Step step(settings("law moreau friction 0.5 criterion paper tol 1e-12" + cage), {}, 2);
  for (int k = 0; k < 300; ++k) {
    scene.accelerate({0, -10, 0});
    scene.advance(step, 1e-2);
  }
  CHECK_NEAR(scene.omega[2], -3 * 2, 1e-6);
  CHECK_NEAR(scene.v[0], 0, 1e-9);
}

TEST(rows_of_contacts_with_friction_have_the_tangential_impulse)
{
  for (const int dimension : {2, 3}) {
    Scene scene;
    scene.add({0, 0.5, 0}, 0.5, 2, {3, 0, 0});
    scene.accelerate({0, -10, 0});
    const nscd::Settings chosen = settings("friction 0.3" + ground);
    Step step(chosen, {}, dimension);
    scene.advance(step, 0.01);
    double row[13];
    CHECK(nscd::contact_columns(chosen) == 13 && nscd::contact_columns(settings("")) == 10);
    nscd::fill_contact_rows(step.state(), row);
    CHECK_NEAR(row[9], 0.2, 1e-13);
    CHECK_NEAR(row[10], -0.06, 1e-13);
    CHECK(std::abs(row[11]) < 1e-15 && row[12] == 0);
  }
}
