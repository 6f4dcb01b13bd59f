// SPDX-License-Identifier: GPL-2.0-or-later
// Which contacts a step sees, and their normals, gaps and speeds. Law moreau, dt so small that nothing moves,
// unless a test says otherwise.
#include "check.hpp"
#include "scene.hpp"

#include <cmath>

using nscd::Contact;
using nscd::Step;

constexpr double instant = 1e-9;  // s

static const nscd::ContactInfo &info_of(const Step &step, const Contact *contact)
{
  return step.state().table.infos[std::size_t(contact - step.state().table.contacts.data())];
}

TEST(spheres_that_overlap_are_a_contact_with_its_geometry)
{
  Scene scene;
  scene.add({0, 0, 0}, 1, 2, {1, 0, 0});
  scene.add({1.2, 0, 1.6}, 1.5, 3, {0, 5, 0});  // distance 2, radii 2.5
  scene.add({0, 9, 0}, 1);
  Step step(settings("law moreau"));
  scene.advance(step, instant);
  CHECK(step.report().contacts == 1);
  const Contact *c = find_contact(step.state(), 0, 1);
  CHECK(c != nullptr);
  if (!c) return;
  CHECK_NEAR(c->normal[0], -0.6, 1e-8);  // from j to i
  CHECK_NEAR(c->normal[2], -0.8, 1e-8);
  CHECK(c->normal[3] == 0);
  CHECK_NEAR(1 / c->w_inverse, 1 / 2.0 + 1 / 3.0, 1e-15);
  CHECK_NEAR(info_of(step, c).gap, -0.5, 1e-8);
  CHECK_NEAR(info_of(step, c).speed_before, -0.6, 1e-8);
}

TEST(spheres_apart_are_no_contact)
{
  Scene scene;
  scene.add({0, 0, 0}, 1);
  scene.add({2 + 1e-9, 0, 0}, 1);
  Step step(settings("law moreau"));
  CHECK(scene.advance(step, instant).contacts == 0);
}

// (18): contacts are sought at q_k + dt/2 v_k.
TEST(law_moreau_looks_at_the_midpoint)
{
  for (const double speed : {1.9, 2.1}) {
    Scene scene;
    scene.add({0, 0, 0}, 1);
    scene.add({2.1, 0, 0}, 1, 1, {-speed, 0, 0});
    Step step(settings("law moreau"));
    CHECK(scene.advance(step, 0.1).contacts == (speed > 2));
  }
}

TEST(the_flag_bits_of_a_neighbor_index_are_ignored)
{
  Scene scene;
  scene.add({0, 0, 0}, 1);
  scene.add({1.9, 0, 0}, 1);
  scene.list_pairs({{int(1u | (3u << 30))}, {}});
  Step step(settings("law moreau"));
  CHECK(scene.advance(step, instant).contacts == 1);
}

TEST(a_wall_is_a_contact_of_every_grain_that_touches_it)
{
  Scene scene;
  scene.add({0, 0, 0.9}, 1, 1, {0, 0, -2});
  scene.add({5, 0, 1.1}, 1);
  scene.add({9, 0, 0.4}, 0.5);
  Step step(settings("law moreau wall plane 0 0 -7 0 0 1 wall plane 3 3 0 0 0 2"));
  scene.advance(step, instant);
  CHECK(step.report().contacts == 2);
  const Contact *c = find_contact(step.state(), 0, -2);
  CHECK(c && find_contact(step.state(), 2, -2));
  if (!c) return;
  CHECK(c->normal[2] == 1 && c->w_inverse == 1);
  CHECK_NEAR(info_of(step, c).gap, -0.1, 1e-8);
  CHECK_NEAR(info_of(step, c).speed_before, -2, 1e-15);
}

TEST(atoms_outside_the_group_are_obstacles)
{
  Scene scene;
  scene.add_obstacle({0, 0, 0}, 1);
  scene.add_obstacle({1.5, 0, 0}, 1);   // two obstacles may overlap
  scene.add_obstacle({0.1, 0, 0}, 1);   // whatever their overlap
  scene.add({0, 1.9, 0}, 1, 4, {0, -1, 0});
  Step step(settings("law moreau wall plane 0 0 0 0 0 1"));  // obstacles and walls ignore each other
  const std::vector<double> x = scene.x;
  scene.advance(step, instant);
  const Contact *c = find_contact(step.state(), 0, 3);
  CHECK(c && c->w_inverse == 4);
  CHECK(!find_contact(step.state(), 0, 1) && !find_contact(step.state(), 0, 2) && !find_contact(step.state(), 0, -1));
  for (int d = 0; d < 9; ++d) CHECK(scene.x[d] == x[d] && scene.v[d] == 0);
  CHECK_NEAR(scene.v[10], 0, 1e-15);
}

// Nothing integrates it, so the door leaves its place alone; but it may carry a velocity, as a moving wall does.
TEST(an_obstacle_that_moves_pushes)
{
  Scene scene;
  scene.add_obstacle({0, 0, 0}, 1);
  scene.v[0] = 3;
  scene.add({1.99, 0, 0}, 1);
  Step step(settings("law moreau"));
  scene.advance(step, instant);
  CHECK_NEAR(scene.v[3], 3, 1e-15);
  CHECK(scene.v[0] == 3 && scene.x[0] == 0);
}

// A row of three across the periodic boundary of a box of length 10: 1 touches 2, 3 touches 1's image.
static Scene periodic_row(bool newton)
{
  Scene scene;
  scene.newton = newton;
  scene.add({0.5, 0, 0}, 1, 1, {-1, 0, 0});
  scene.add({2.4, 0, 0}, 1, 1, {-1, 0, 0});
  scene.add({8.6, 0, 0}, 1, 1, {0, 0, 0});
  scene.add_image(0, {10, 0, 0});
  scene.add_image(1, {10, 0, 0});
  scene.add_image(2, {-10, 0, 0});
  return scene;
}

TEST(an_image_is_in_contact_as_its_owner)
{
  Scene scene = periodic_row(true);
  Step step(settings("law moreau criterion paper tol 1e-7"));
  CHECK(scene.advance(step, instant).contacts == 2);
  // 1 and 2 run into 3: all three go on at the mean velocity.
  for (int i = 0; i < 3; ++i) CHECK_NEAR(scene.v[3 * i], -2.0 / 3, 1e-6);
}

TEST(newton_off_lists_a_pair_twice_and_it_counts_once)
{
  Scene on = periodic_row(true), off = periodic_row(false);
  Step a(settings("law moreau")), b(settings("law moreau"));
  CHECK(on.advance(a, instant).contacts == 2);
  CHECK(off.advance(b, instant).contacts == 2);
  for (int d = 0; d < 9; ++d) CHECK_NEAR(off.v[d], on.v[d], 1e-6);
}

TEST(a_grain_is_not_in_contact_with_its_own_image)
{
  for (const bool newton : {true, false}) {
    Scene scene;
    scene.newton = newton;
    scene.add({0, 0, 0}, 1, 1, {1, 0, 0});
    scene.add_image(0, {2, 0, 0});
    scene.add_image(0, {-2, 0, 0});
    scene.list_pairs({{1, 2}});
    Step step(settings("law moreau"));
    CHECK(scene.advance(step, instant).contacts == 0);
    CHECK(scene.v[0] == 1);
  }
}

TEST(a_box_narrower_than_a_grain_is_refused)
{
  Scene scene;
  scene.add({0, 0, 0}, 1, 1);
  scene.add_image(0, {1.9, 0, 0});
  scene.list_pairs({{1}});
  Step step(settings("law moreau"));
  CHECK_ERROR(scene.advance(step, instant), "overlaps its own periodic image by 0.1");
}

// Two grains fill a periodic box of length 4: they touch on both sides.
TEST(a_pair_that_touches_twice_has_two_contacts)
{
  Scene scene;
  scene.add({0, 0, 0}, 1.01, 1, {1, 0, 0});
  scene.add({2, 0, 0}, 1.01, 1, {-1, 0, 0});
  scene.add_image(1, {-4, 0, 0});
  scene.list_pairs({{1, 2}, {}});
  Step step(settings("law moreau"));
  for (int k = 0; k < 3; ++k) {
    scene.accelerate({double(k), 0, 0});
    CHECK(scene.advance(step, instant).contacts == 2);
    CHECK_NEAR(scene.v[0], scene.v[3], 1e-6);
    CHECK(find_contact(step.state(), 0, 1) && find_contact(step.state(), 0, 2));
  }
}

TEST(an_image_without_its_grain_is_refused)
{
  Scene scene;
  scene.add({0, 0, 0}, 1);
  scene.add_image(0, {10, 0, 0});
  scene.tag[1] = 77;
  Step step(settings(""));
  CHECK_ERROR(scene.advance(step, instant), "image of grain 77 has no grain on this rank");
}

TEST(an_overlap_beyond_the_smaller_radius_is_refused_by_tag)
{
  Scene scene;
  scene.add({0, 0, 0}, 1);
  scene.add({0, 0, 0.95}, 0.5);
  for (const char *law : {"law moreau", "law gap"}) {
    Step step(settings(law));
    CHECK_ERROR(scene.advance(step, instant), "grains 1 and 2 overlap by 0.55, more than the smaller radius 0.5");
  }
}

TEST(coincident_centres_are_refused)
{
  Scene scene;
  scene.add({1, 1, 1}, 1);
  scene.add({1, 1, 1}, 1);
  Step step(settings("law moreau"));
  CHECK_ERROR(scene.advance(step, instant), "overlap by 2");
}

TEST(a_grain_behind_a_wall_is_refused)
{
  Scene scene;
  scene.add({0, 0, -0.2}, 1);
  Step step(settings("law moreau wall plane 0 0 -9 0 0 1 wall plane 0 0 0 0 0 1"));
  CHECK_ERROR(scene.advance(step, instant), "grain 1 is 1.2 inside wall 2, more than its radius 1");
}

TEST(an_overlap_just_below_the_smaller_radius_is_solved)
{
  Scene scene;
  scene.add({0, 0, 0}, 1);
  scene.add({0, 0, 1.01}, 0.5);
  for (const char *law : {"law moreau", "law gap"}) {
    Step step(settings(law));
    CHECK(scene.advance(step, 1e-6).contacts == 1);
  }
}

// Law gap: contacts are sought within dt (speed_i + speed_j), with free or present speed, whichever is larger.
TEST(law_gap_looks_ahead_by_the_speeds)
{
  for (const double gap : {0.29, 0.31}) {
    Scene scene;
    scene.add({0, 0, 0}, 1, 1, {1, 0, 0});
    scene.add({2 + gap, 0, 0}, 1, 1, {-2, 0, 0});
    Step step(settings("law gap"));
    CHECK(scene.advance(step, 0.1).contacts == (gap < 0.3));
  }
}

TEST(law_gap_foresees_what_forces_do)
{
  Scene scene;
  scene.add({0, 0, 1.09}, 1);
  scene.accelerate({0, 0, -10});
  Step step(settings("law gap wall plane 0 0 0 0 0 1"));
  CHECK(scene.advance(step, 0.1).contacts == 1);
  CHECK_NEAR(scene.v[2], -0.9, 1e-12);
}

// The first grain drives the light one, at rest and hence without a reach of its own, into the third and the wall.
TEST(watched_pairs_join_when_the_solution_drives_them_together)
{
  for (const char *obstacle : {"grain", "wall"}) {
    const bool wall = obstacle == std::string("wall");
    Scene scene;
    scene.add({0, 0, 0}, 1, 10, {1, 0, 0});
    scene.add({2.01, 0, 0}, 1, 1);
    if (!wall) scene.add({4.05, 0, 0}, 1, 1e6);
    const std::string words = "law gap criterion paper tol 1e-7";
    Step step(settings(wall ? words + " wall plane 3.05 0 0 -1 0 0" : words));
    CHECK(scene.advance(step, 0.1).contacts == 2);
    CHECK(find_contact(step.state(), 1, wall ? -1 : 2) != nullptr);
    CHECK(step.report().largest_overlap < 1e-7);
    CHECK(scene.x[3] - scene.x[0] > 2 - 1e-7);
    CHECK((wall ? 4.05 : scene.x[6]) - scene.x[3] > 2 - 1e-7);
  }
}

// Within reach of each other, and apart all the way; solvers to which another round costs as much take them at once.
TEST(grains_that_fall_side_by_side_are_watched)
{
  const std::pair<const char *, int> all[] = {{"solver pdas", 0}, {"solver apgs", 0}, {"solver auto", 0},
                                              {"solver active_set", 1}, {"restitution 0.5", 1}};
  for (const auto &[words, contacts] : all) {
    Scene scene;
    for (double x : {0.0, 2.4}) scene.add({x, 0, 0}, 1, 1, {0, 0, -5});
    Step step(settings(std::string("law gap ") + words));
    CHECK(scene.advance(step, 0.1).contacts == contacts);
    CHECK(scene.v[2] == -5 && scene.v[5] == -5);
  }
}

// The floor brakes the lower grain, and that the upper one, which would have fallen beside it.
TEST(watched_pairs_within_reach_join_when_one_of_them_is_stopped)
{
  for (const char *solver : {"pdas", "apgs", "auto", "active_set"}) {
    Scene scene;
    scene.add({0, 0, 1.1}, 1, 1, {0, 0, -5});
    scene.add({0, 0, 3.45}, 1, 1, {0, 0, -5});
    Step step(settings(std::string("law gap criterion paper tol 1e-9 wall plane 0 0 0 0 0 1 solver ") + solver));
    CHECK(scene.advance(step, 0.1).contacts == 2);
    CHECK_NEAR(scene.v[2], -1, 1e-7);     // 0.1 above the floor, in 0.1 s
    CHECK_NEAR(scene.v[5], -4.5, 1e-7);   // 0.35 above the other, which moves by 0.1
    CHECK(scene.x[5] - scene.x[2] > 2 - 1e-7);
  }
}

// One step of a cloud that lands, at once with all pairs within reach and in rounds with those that are foreseen.
TEST(rounds_with_foreseen_contacts_give_the_velocities_of_all_contacts)
{
  for (const char *words : {"", "friction 0.2 "}) {
    const bool frictional = words[0] != 0;
    std::vector<double> v[2];
    std::int64_t contacts[2];
    const char *solvers[] = {"pdas", frictional ? "interior_point" : "active_set"};
    for (int k = 0; k < 2; ++k) {
      Random random(5);
      Scene scene = random_scene(random, 60, 1, 0.1, 1);
      for (std::size_t i = 2; i < scene.v.size(); i += 3) scene.v[i] -= 20;
      Step step(settings("law gap criterion paper tol 1e-10 maxiter 100000 " + std::string(words) + "solver " +
                         solvers[k] +
                         box_walls(1, 1)));
      CHECK(scene.advance(step, 5e-3).converged);
      v[k] = scene.v;
      contacts[k] = step.report().contacts;
    }
    CHECK(contacts[0] < contacts[1]);
    for (std::size_t i = 0; i < v[0].size(); ++i) CHECK_NEAR(v[0][i], v[1][i], 1e-7);
  }
}

TEST(tangential_and_receding_grains_keep_their_velocity)
{
  Scene scene;
  scene.add({0, 0, 0}, 1, 1, {0, 3, 0});
  scene.add({2 - 1e-6, 0, 0}, 1, 1, {1, -3, 0});
  Step step(settings("law moreau"));
  CHECK(scene.advance(step, instant).contacts == 1);
  CHECK(scene.v[1] == 3 && scene.v[3] == 1 && scene.v[4] == -3);
}
