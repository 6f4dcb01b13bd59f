// SPDX-License-Identifier: GPL-2.0-or-later
// What must hold of the neighbor list: no contact missed, none counted twice.
#include "check.hpp"
#include "scene.hpp"

using nscd::Step;

// Grain 1 moves up at 1 m/s; grain 2 is `gap` ahead of it, and not listed.
static Scene follower(double gap, double reach)
{
  Scene scene;
  scene.add({0, 0, 5}, 1, 1, {0, 0, 1});
  scene.add({0, 0, 7 + gap}, 1);
  scene.reach = reach;
  scene.list_pairs({{}, {}});
  return scene;
}

TEST(moves_since_the_list_was_built_count_towards_missed_contacts)
{
  Scene scene = follower(0.29, 0.25);
  Step step(settings("law gap"));
  for (int k = 0; k < 4; ++k) {
    scene.advance(step, 0.05);
    CHECK(!step.wants_rebuild());
    scene.just_built = false;
  }
  scene.advance(step, 0.05);
  CHECK(step.wants_rebuild());    // 0.04 ahead, dt v = 0.05
  CHECK(scene.advance(step, 0.05).contacts == 1);   // 0.04 apart, 0.05 of approach: found without the list
  CHECK_NEAR(step.report().cutoff_to_list, 2.34, 1e-2);
  scene.list_all_pairs();
  scene.just_built = true;
  CHECK(scene.advance(step, 0.05).contacts == 1 && step.report().cutoff_to_list == 0);
}

// Law moreau looks half a step ahead, law gap a whole one.
TEST(what_a_step_looks_ahead_for_is_found_if_the_list_lacks_it)
{
  for (const double gap : {0.09, 0.11}) {
    Scene scene = follower(0.5 * gap, 0);
    Step moreau(settings("law moreau"));
    CHECK(scene.advance(moreau, 0.1).contacts == (gap < 0.1));
    CHECK((moreau.report().cutoff_to_list > 0) == (gap < 0.1));
    scene = follower(gap, 0);
    Step law_gap(settings("law gap"));
    CHECK(scene.advance(law_gap, 0.1).contacts == (gap < 0.1));
    CHECK((law_gap.report().cutoff_to_list > 0) == (gap < 0.1));
  }
}

TEST(a_new_run_may_bring_a_new_list)
{
  Scene scene;
  scene.add({0, 0, 0}, 1);
  scene.add({0, 0, 5}, 1);
  scene.reach = 0.25;
  scene.just_built = false;
  Step step(settings("law gap"));
  scene.advance(step, 0.05);
  scene.x[5] = 2 - 1e-6;  // moved by hand between two runs
  step.begin_run(false);
  scene.list_pairs({{}, {}});
  CHECK(scene.advance(step, 0.05).contacts == 1 && step.report().cutoff_to_list > 0);
  scene.list_all_pairs();
  step.begin_run(true);
  CHECK(scene.advance(step, 0.05).contacts == 1 && step.report().cutoff_to_list == 0);
}

TEST(images_may_change_with_each_new_list)
{
  Scene scene;
  scene.add({0.5, 0, 0}, 1);
  scene.add({5, 0, 0}, 1);
  scene.add({8.6, 0, 0}, 1);
  Step step(settings("law moreau"));
  CHECK(scene.advance(step, 1e-9).contacts == 0);
  scene.add_image(1, {10, 0, 0});
  const int image = scene.add_image(2, {-10, 0, 0});
  scene.list_all_pairs();
  CHECK(scene.advance(step, 1e-9).contacts == 1);
  CHECK(find_contact(step.state(), 0, image) != nullptr);
  CHECK(step.state().atoms.owner[image] == 2);
}

TEST(a_full_list_is_refused)
{
  Scene scene;
  for (int i = 0; i < 3; ++i) scene.add({1.9 * i, 0, 0}, 1);
  scene.list_pairs({{1}, {0, 2}, {1}});
  Step step(settings(""));
  CHECK_ERROR(scene.advance(step, 1e-3), "full");
}

TEST(a_list_that_names_atoms_in_any_order_is_read_the_same)
{
  Scene plain, shuffled;
  for (Scene *scene : {&plain, &shuffled})
    for (int i = 0; i < 4; ++i) scene->add({1.9 * i, 0, 0}, 1, 1 + i, {i % 2 ? -1.0 : 1.0, 0, 0});
  plain.list_pairs({{1, 2, 3}, {2, 3}, {3}, {}});
  shuffled.list_pairs({{}, {0}, {1, 0}, {0, 2, 1}});
  const std::string words = "law moreau criterion paper tol 1e-13 maxiter 100000";
  Step a(settings(words)), b(settings(words));
  CHECK(plain.advance(a, 1e-6).contacts == 3);
  CHECK(shuffled.advance(b, 1e-6).contacts == 3);
  for (std::size_t d = 0; d < plain.v.size(); ++d) CHECK_NEAR(shuffled.v[d], plain.v[d], 1e-11);
}

TEST(a_list_without_pairs_leaves_walls)
{
  Scene scene;
  scene.add({0, 0, 0.9}, 1);
  scene.list_pairs({{}});
  Step step(settings("law moreau wall plane 0 0 0 0 0 1"));
  CHECK(scene.advance(step, 1e-6).contacts == 1);
}
