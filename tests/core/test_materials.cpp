// SPDX-License-Identifier: GPL-2.0-or-later
// Which numbers a contact has: of its pair of types, of its wall, or of all contacts.
#include "check.hpp"
#include "scene.hpp"
#include "scene/contact_materials.hpp"
#include "settings/told_pairs.hpp"
#include "step/report.hpp"

using nscd::Material;
using nscd::Materials;

static Material of_pair(const std::string &words, int types, int a, int b)
{
  const Materials materials(settings(words), types);
  return materials[materials.of_pair(a, b)];
}

TEST(a_pair_has_what_names_it_and_the_rest_from_all_contacts)
{
  const std::string words = "friction 0.5 restitution 0.2 material 1 2 friction 0.1 material 2 2 restitution 0.9 stick";
  CHECK(of_pair(words, 2, 1, 1).friction == 0.5 && of_pair(words, 2, 1, 1).restitution == 0.2);
  for (const auto &[a, b] : {std::pair{1, 2}, std::pair{2, 1}})
    CHECK(of_pair(words, 2, a, b).friction == 0.1 && of_pair(words, 2, a, b).restitution == 0.2);
  CHECK(of_pair(words, 2, 2, 2).friction == nscd::stick && of_pair(words, 2, 2, 2).restitution == 0.9);
}

TEST(ranges_of_types_are_those_of_lammps)
{
  for (const std::string all : {"*", "1*", "*4", "1*4"})
    for (int a = 1; a <= 4; ++a) CHECK(of_pair("material " + all + " 3 friction 1", 4, a, 3).friction == 1);
  CHECK(of_pair("material 2*3 4 friction 1", 4, 1, 4).friction == 0);
  CHECK(of_pair("material 2*3 4 friction 1", 4, 4, 3).friction == 1);
  CHECK(of_pair("material * * friction 1 material 2 3 friction 2", 3, 3, 2).friction == 2);   // the later one
  CHECK(of_pair("material * * friction 1 restitution 0.5 material 2 3 friction 2", 3, 3, 2).restitution == 0.5);
}

TEST(types_are_looked_at_only_where_pairs_differ)
{
  CHECK(!Materials(settings("friction 0.5 wall plane 0 0 0 0 0 1 friction 0.1"), 3).by_type());
  CHECK(!Materials(settings("material * * friction 0.5"), 3).by_type());
  CHECK(Materials(settings("material 1 1 friction 0.5"), 2).by_type());
  const Materials walls(settings("friction 0.5 wall plane 0 0 0 0 0 1 wall plane 0 0 9 0 0 -1 restitution 0.5"), 1);
  CHECK(walls.of_wall(0) == walls.of_pairs() && walls[walls.of_wall(1)].restitution == 0.5);
  CHECK(walls[walls.of_wall(1)].friction == 0.5 && walls.all().size() == 2);
}

TEST(restitutions_that_may_make_energy_are_known)
{
  const auto may = [](const std::string &words) { return Materials(settings(words), 2).may_make_energy(); };
  CHECK(!may("restitution 0.5") && !may("friction 0.5 restitution 0.5 e_t 0.5"));
  CHECK(may("friction 0.5 restitution 0.5") && may("restitution 0.5 material 1 1 restitution 0"));
  CHECK(may("restitution 0.5 wall plane 0 0 0 0 0 1 restitution 0.4"));
  CHECK(!may("friction 0.5 material 1 1 friction 0.1"));
}

TEST(materials_that_cannot_be_are_refused)
{
  CHECK_ERROR(settings("material 1"), "keyword material needs a value");
  CHECK_ERROR(settings("material 1 2"), "material 1 2: behind the two types stand friction, restitution or e_t");
  CHECK_ERROR(settings("material 1 2 tol 1e-3"), "behind the two types stand friction, restitution or e_t");
  for (const char *types : {"0", "-1", "x", "1.5", "**", "0*2"})
    CHECK_ERROR(settings("material 1 " + std::string(types) + " friction 1"), "names no types of atoms");
  CHECK_ERROR(settings("material 3*2 1 friction 1"), "the range '3*2' has no types in it");
  CHECK_ERROR(nscd::checked(settings("material 1 2* friction -1")), "material 1 2*: friction = -1 must be >= 0");
  CHECK_ERROR(nscd::checked(settings("material 1 1 restitution 2")), "restitution = 2 is outside [0, 1]");
  CHECK_ERROR(Materials(settings("material 1 1 e_t 0.5"), 1), "material 1 1: e_t = 0.5 has no effect without friction");
  CHECK_ERROR(Materials(settings("material 1 1 friction 0 e_t 0.5 material 2 2 friction 1 material 1 2 friction 1"), 2),
              "material 1 1: e_t = 0.5 has no effect");
  CHECK_ERROR(Materials(settings("friction 1 wall plane 0 0 0 0 0 1 friction 0 e_t 0.5"), 1),
              "wall 1: e_t = 0.5 has no");
  CHECK_ERROR(nscd::checked(settings("wall plane 0 0 0 0 0 1 restitution -1")), "wall 1: restitution = -1");
  CHECK_ERROR(Materials(settings("material 1 3 friction 1"), 2), "there is no atom type 3, the largest is 2");
  CHECK_ERROR(Materials(settings("material 1 1 friction 1 material 2 2 friction 2"), 2), "give `material 1 2` too");
  CHECK_ERROR(nscd::Step(settings("material 2 2 friction 1")), "there is no atom type 2");
}

TEST(materials_that_others_hide_are_refused)
{
  const auto given = [](const std::string &words) { return Materials(settings(words), 3); };
  CHECK_ERROR(given("material 1 1 friction 0.9 material * * friction 0.1"), "material * * stands behind material 1 1");
  CHECK_ERROR(given("material 1 2 friction 0.1 material 2 1 friction 0.5"), "material 2 1 stands behind material 1 2");
  CHECK_ERROR(given("material 1 2* friction 0.1 material 1* 2 friction 0.5 material * 1* friction 1"), "and takes all");
  given("material * * friction 0.1 restitution 0.1 material 1 1 friction 0.9");
  given("material 1 1 friction 0.9 material * * restitution 0.1");   // each says what the other does not
  given("material 1* 1 friction 0.9 material 1 2* friction 0.1 material 1 1 friction 0.2 material 2* 2* friction 1 "
        "material 2 3 friction 1");
  Materials(settings("material * * friction 0.5 material 1 1 friction 0.1"), 1);   // for scenes of more types too
}

TEST(walls_that_lack_what_types_have_are_doubted)
{
  const auto doubts = [](const std::string &words) { return nscd::doubts(settings(words)); };
  const std::string wall = " wall plane 0 0 0 0 0 1";
  CHECK(doubts("friction 0.5" + wall).empty() && doubts("friction 0.3 material 1 1 friction 0.5" + wall).empty());
  const auto said = doubts("material * * friction 0.5 restitution 0.5" + wall + " restitution 0" + wall);
  CHECK(said.size() == 2);
  CHECK_SAYS(said[0], "no friction on wall 1, wall 2, and grains have theirs by types alone");
  CHECK_SAYS(said[1], "no restitution on wall 2, and grains");
}

TEST(types_without_a_material_of_their_pair_are_mixed_if_asked)
{
  nscd::Settings s = settings("restitution 0.5 material 1 1 friction 0.2 material 2 2 friction 0.8 restitution 0.32 "
                              "material 3 3 stick material 4 4 friction 0 material 1 3 friction 0.7");
  s.mixing = nscd::Mixing::geometric;
  const Materials geometric(s, 4);
  const auto pair = [](const Materials &of, int a, int b) { return of[of.of_pair(a, b)]; };
  CHECK_NEAR(pair(geometric, 1, 2).friction, 0.4, 1e-15);
  CHECK_NEAR(pair(geometric, 2, 1).restitution, 0.4, 1e-15);   // of what all have, 0.5, and its own
  CHECK(pair(geometric, 1, 3).friction == 0.7 && pair(geometric, 3, 2).friction == nscd::stick);
  CHECK(pair(geometric, 3, 4).friction == 0 && pair(geometric, 1, 1).friction == 0.2);
  s.mixing = nscd::Mixing::arithmetic;
  const Materials arithmetic(s, 4);
  CHECK_NEAR(pair(arithmetic, 1, 2).friction, 0.5, 1e-15);
  CHECK_NEAR(pair(arithmetic, 1, 2).restitution, 0.41, 1e-15);
}

TEST(materials_may_change_between_runs_if_the_unknowns_stay)
{
  nscd::Step step(settings("material 1 1 friction 0.2"), {}, 3, nullptr, 1);
  step.change_materials(settings("material 1 1 friction 0.9").pairs, nscd::Mixing::none);
  CHECK(step.settings().pairs[0].own.value(0) == 0.9);
  CHECK_ERROR(step.change_materials(settings("material 1 1 friction 0").pairs, nscd::Mixing::none), "define it anew");
  CHECK_ERROR(step.change_materials(settings("material 1 1 friction 1 restitution 1").pairs, nscd::Mixing::none),
              "whether any contact has friction, or restitution, has changed");
}

TEST(words_of_a_material_are_read_and_written)
{
  using Words = std::vector<std::string>;
  const auto again = [](const Words &words) { return written(nscd::read_own_material(words)); };
  CHECK(again({"restitution", "0.25", "friction", "0.5"}) == "friction 0.5 restitution 0.25");
  CHECK(again({"stick"}) == "friction stick" && again({}).empty());
  CHECK_ERROR(nscd::read_own_material({"mu", "0.5"}), "unknown keyword 'mu': choose one of friction, restitution, e_t");
  CHECK_ERROR(nscd::read_own_material({"friction", "1", "friction", "2"}), "friction is given twice");
  CHECK_ERROR(nscd::read_own_material({"friction", "glue"}), "'glue' is not a number, nor stick");
}

// What one door tells the other, to the last bit.
TEST(told_materials_are_read_back_as_they_were)
{
  const double mu = 0.1 + 0.2;   // no short number
  nscd::Settings given;
  given.pairs = {{"1 1", {1, 1}, {1, 1}, nscd::read_own_material({"stick", "e_t", "0.25"})},
                 {"1 2", {1, 1}, {2, 2}, {}},
                 {"2 2", {2, 2}, {2, 2}, {}}};
  given.pairs[2].own.set(0, mu);
  const std::string told = nscd::told(given.pairs, nscd::Mixing::arithmetic);
  nscd::Settings read = settings("friction 0.5");
  nscd::take_told(read, told);
  CHECK(nscd::told(read.pairs, read.mixing) == told);
  CHECK(read.mixing == nscd::Mixing::arithmetic && read.material.friction == 0.5);
  CHECK(read.pairs.size() == 3 && read.pairs[1].types == "1 2" && read.pairs[2].own.value(0) == mu);
  CHECK(nscd::told({}, nscd::Mixing::geometric) == "mix geometric");
  CHECK_ERROR(nscd::take_told(read, "mix sixthpower"), "mixed by 'sixthpower', an unknown way");
  CHECK_ERROR(nscd::take_told(read, "mix geometric\nfriction 0.5"), "does not begin with two types");
  CHECK_ERROR(nscd::require_no_pairs(given, "`materials`"), "use `pair_coeff 1 1 friction stick e_t 0.25` in place of");
}

// A scene of types whose atoms say nothing of theirs would be a scene of others.
TEST(types_that_are_needed_have_to_be_there)
{
  Scene scene;
  scene.add({0, 0, 0}, 1);
  nscd::Step step(settings("material 1 1 friction 1 material 1 2 friction 2"), {}, 3, nullptr, 2);
  CHECK_ERROR(scene.advance(step, 1e-3), "materials differ by type");
}

TEST(the_description_names_the_materials)
{
  const std::string words = "friction 0.3 restitution 0.5 material 1 2* stick wall plane 0 0 0 0 0 1 restitution 0.1";
  const std::string text = nscd::describe(nscd::Step(settings(words), {}, 3, nullptr, 2));
  for (const char *part : {"friction 0.3, stick of types 1 2*", "restitution 0.5, 0.1 on wall 1", "tangential 0"})
    CHECK_SAYS(text, part);
}
