// SPDX-License-Identifier: GPL-2.0-or-later
#include "check.hpp"
#include "obstacle/plane.hpp"
#include "scene.hpp"
#include "settings/keyword.hpp"
#include "step/report.hpp"

#include <cmath>

static nscd::Settings checked(const std::string &keywords) { return nscd::checked(settings(keywords)); }

static const nscd::Plane &plane(const nscd::Settings &s, std::size_t wall)
{
  return dynamic_cast<const nscd::Plane &>(*s.walls[wall].shape);
}

TEST(keywords_set_what_they_name)
{
  const nscd::Settings s = settings(
      "solver sal law moreau restitution 0.5 tol 1e-9 maxiter 7 warmstart no rho 0.25 theta 0.75 recovery 0.1 "
      "unconverged error wall plane 1 2 3 0 0 4 wall plane 0 0 0 0 1 0");
  CHECK(s.solver == "sal" && s.law == "moreau" && s.maxiter == 7 && !s.warmstart);
  CHECK(s.material.restitution == 0.5 && s.tol == 1e-9 && s.rho == 0.25 && s.theta == 0.75 && s.recovery == 0.1);
  CHECK(!s.gamma && s.unconverged == nscd::Unconverged::error);
  CHECK(s.walls.size() == 2 && plane(s, 0).point()[1] == 2 && plane(s, 0).normal()[2] == 1);
  CHECK(plane(s, 1).normal()[1] == 1);
  CHECK(settings("solver pdas gamma 2").gamma == 2);
}

TEST(no_keywords_leave_the_defaults)
{
  const nscd::Settings s = checked("");
  CHECK(s.solver == "auto" && s.law == "gap" && s.material.restitution == 0 && s.maxiter == 1000);
  CHECK(s.overlap == 5e-4 && !checked("law moreau").overlap && !checked("criterion paper").overlap);
  CHECK(s.tol == 1e-3 && s.criterion == nscd::Stop::natural && s.threads == 1);
  CHECK(s.warmstart && s.unconverged == nscd::Unconverged::warn && s.walls.empty());
  CHECK(!s.rho && !s.gamma);
}

TEST(the_settings_of_the_paper_are_one_keyword_away)
{
  const nscd::Settings s = checked("paper yes");
  CHECK(s.solver == "pdas" && s.law == "moreau" && !s.warmstart);
  CHECK(s.tol == 1e-7 && s.criterion == nscd::Stop::paper);
  CHECK(checked("paper yes solver sbp").solver == "sbp");
  CHECK(checked("paper no").solver == checked("").solver);
}

// The same scene a thousand times as large, under a gravity a thousand times as strong.
TEST(the_default_tolerance_follows_the_scene)
{
  int iterations[2];
  for (const bool large : {false, true}) {
    const double scale = large ? 1000 : 1;
    Scene scene;
    for (int i = 0; i < 10; ++i) scene.add({0, 0, scale * (1 + 2.0 * i)}, scale, scale * scale * scale);
    nscd::Step step(settings("solver pdas wall plane 0 0 0 0 0 1"));
    scene.accelerate({0, 0, -10 * scale});
    scene.advance(step, 1e-3);
    CHECK(step.report().converged);
    const nscd::State &s = step.state();
    CHECK_NEAR(nscd::tolerance(s.scales, nscd::worth(s.table.infos[0])), 1e-3 * 10 * scale * 1e-3, 1e-12 * scale);
    iterations[large] = step.report().iterations;
  }
  CHECK(iterations[0] == iterations[1] && iterations[0] > 10);
}

TEST(a_keyword_is_given_once)
{
  CHECK_ERROR(settings("tol 1e-3 tol 1e-5"), "keyword tol is given twice");
  CHECK_ERROR(settings("friction 0.3 stick"), "keyword stick is a friction, which is given twice");
  CHECK_ERROR(settings("tol 1e-6 paper yes"), "keyword paper behind tol would override it: give paper first");
  CHECK(settings("paper yes tol 1e-6").tol == 1e-6);
  CHECK(settings("wall plane 0 0 0 0 0 1 wall plane 0 0 9 0 0 -1").walls.size() == 2);
}

TEST(what_a_wall_has_already_is_refused_behind_it)
{
  CHECK_ERROR(settings("wall plane 0 0 0 0 0 1 restitution 0.5 restitution 0.2"), "has its restitution already");
  CHECK_ERROR(settings("wall plane 0 0 0 0 0 1 e_t 0.1 friction 0.3 e_t 0.5"), "give that before walls and materials");
  CHECK_ERROR(settings("material 1 1 friction 0.5 stick"), "the material has its friction already");
  CHECK_ERROR(settings("wall plane 0 0 0 0 0 1 friction 0.7 friction 0.2"), "the wall has its friction already");
  CHECK_ERROR(settings("wall plane 0 0 0 0 0 1 stick stick"), "the wall has its friction already");
  CHECK(settings("restitution 0.5 wall plane 0 0 0 0 0 1").material.restitution == 0.5);
}

TEST(numbers_are_those_of_lammps)
{
  CHECK(settings("restitution +0.5").material.restitution == 0.5 && settings("maxiter +7").maxiter == 7);
  CHECK(plane(settings("wall plane +0 -0 +.5 0 0 +1e0"), 0).point()[2] == 0.5);
  for (const char *wrong : {"+", "++0.5", "+-0.5", "-+0.5", "+ 0.5"})
    CHECK_ERROR(settings("restitution " + std::string(wrong)), "is not a number");
}

TEST(a_tol_keeps_its_unit)
{
  const nscd::Settings plain = checked(""), given = checked("tol 1e-3"), said = checked("criterion natural tol 1e-3");
  for (const nscd::Settings &s : {plain, given, said})
    CHECK(s.criterion == nscd::Stop::natural && s.tol == 1e-3 && s.overlap == 5e-4);
  const nscd::Settings paper = checked("criterion paper tol 1e-6");
  CHECK(paper.criterion == nscd::Stop::paper && paper.tol == 1e-6 && !paper.overlap);
  CHECK(checked("criterion paper").tol == 1e-7 && checked("paper yes tol 1e-6").criterion == nscd::Stop::paper);
  CHECK_ERROR(checked("tol 0.2"), "criterion paper");  // as it is in no share of velocities
}

TEST(yes_and_no_are_spelled_as_in_lammps)
{
  for (const char *yes : {"yes", "on", "true"}) CHECK(settings(std::string("warmstart ") + yes).warmstart);
  for (const char *no : {"no", "off", "false"}) CHECK(!settings(std::string("warmstart ") + no).warmstart);
  CHECK_ERROR(settings("warmstart 1"), "keyword warmstart: '1' is neither yes nor no");
}

TEST(malformed_keywords_are_refused_by_name)
{
  CHECK_ERROR(settings("cohesion 0.3"), "unknown keyword 'cohesion'");
  CHECK_ERROR(settings("cohesion 0.3"), "restitution");  // the choices
  CHECK_ERROR(settings("tol"), "keyword tol needs a value");
  CHECK_ERROR(settings("tol small"), "keyword tol: 'small' is not a number");
  CHECK_ERROR(settings("tol 1e-7x"), "'1e-7x' is not a number");
  CHECK_ERROR(settings("maxiter 1e3"), "keyword maxiter: '1e3' is not a whole number");
  CHECK_ERROR(settings("maxiter 99999999999"), "99999999999");
  CHECK_ERROR(settings("unconverged stop"), "choose one of ignore, warn, error");
  CHECK_ERROR(settings("wall sphere 0 0 0 1"), "unknown wall 'sphere'");
  CHECK_ERROR(settings("wall plane 0 0 0 0 1"), "keyword wall needs a value");
}

TEST(values_out_of_range_are_refused_with_value_and_limit)
{
  CHECK_ERROR(checked("restitution -0.1"), "restitution = -0.1 is outside [0, 1]");
  CHECK_ERROR(checked("restitution 1.5"), "restitution = 1.5 is outside [0, 1]");
  CHECK_ERROR(checked("restitution nan"), "restitution");
  CHECK_ERROR(checked("theta 2"), "theta = 2 is outside");
  CHECK_ERROR(checked("recovery 2"), "recovery = 2 is outside [0, 1]");
  CHECK_ERROR(checked("tol 0"), "tol = 0 must be > 0");
  CHECK_ERROR(checked("tol inf"), "tol = inf");
  CHECK_ERROR(checked("tol nan"), "tol");
  CHECK_ERROR(checked("maxiter 0"), "maxiter = 0 must be at least 1");
  CHECK_ERROR(checked("gamma 0"), "gamma = 0 must be > 0");
  CHECK_ERROR(checked("solver sbp rho inf"), "rho = inf must be > 0");
  CHECK_ERROR(checked("solver sbp rho nan"), "rho");
  CHECK_ERROR(checked("solver newton"), "unknown solver 'newton'");
  CHECK_ERROR(checked("law hertz"), "unknown law 'hertz'");
  CHECK_ERROR(settings("criterion energy"), "unknown criterion 'energy': choose one of paper, natural");
}

TEST(a_parameter_of_another_solver_is_refused)
{
  for (const auto &solver : nscd::solvers()) {
    const std::string other = solver.parameter == "rho" ? "gamma" : "rho";
    const std::string words = "solver " + std::string(solver.name) + " " + other + " 1";
    CHECK_ERROR(checked(words), "keyword " + other + " is not a parameter of solver " + std::string(solver.name));
  }
}

TEST(wall_normals_become_unit_vectors)
{
  const nscd::Settings s = checked("wall plane 0 0 0 3 0 4");
  CHECK_NEAR(plane(s, 0).normal()[0], 0.6, 1e-16);
  CHECK_NEAR(plane(s, 0).normal()[2], 0.8, 1e-16);
}

TEST(walls_without_a_direction_or_a_place_are_refused)
{
  CHECK_ERROR(checked("wall plane 0 0 0 1 0 0 wall plane 0 0 0 0 0 0"), "wall 2: the normal is (0, 0, 0)");
  CHECK_ERROR(checked("wall plane 0 0 inf 0 0 1"), "wall 1: point and normal must be finite");
  CHECK_ERROR(checked("wall plane 0 0 0 nan 0 1"), "wall");
}

TEST(a_step_refuses_bad_settings_at_once)
{
  CHECK_ERROR(nscd::Step(settings("restitution 2")), "restitution = 2");
}

TEST(friction_keywords_set_what_they_name)
{
  const nscd::Settings s = settings(
      "friction 0.3 e_t 0.25 wall plane 0 0 0 0 0 1 friction 0.7 wall plane 0 0 9 0 0 -1 friction stick "
      "wall plane 0 0 0 1 0 0 stick wall plane 9 0 0 -1 0 0 inertia sphere wall plane 0 0 0 0 1 0 friction 0");
  CHECK(s.material.friction == 0.3 && s.material.e_t == 0.25 && s.inertia == nscd::Inertia::sphere && s.frictional());
  const double expected[] = {0.7, nscd::stick, nscd::stick, 0.3, 0};
  CHECK(s.walls.size() == 5);
  const nscd::Materials materials(s, 1);
  for (std::size_t k = 0; k < 5; ++k) CHECK(materials[materials.of_wall(int(k))].friction == expected[k]);
  CHECK(!s.walls[3].own.has(0) && s.walls[4].own.has(0) && s.walls[4].own.value(0) == 0);
  for (const char *words : {"stick", "friction stick", "friction inf"})
    CHECK(settings(words).material.friction == nscd::stick);
  CHECK(settings("inertia disc").inertia == nscd::Inertia::disc && !settings("").inertia);
}

// Right behind a wall a `friction` is the wall's; anywhere else it is that of pairs, and of walls without their own.
TEST(friction_belongs_to_the_wall_it_stands_behind)
{
  const auto on_wall = [](const nscd::Settings &s) {
    const nscd::Materials materials(s, 1);
    return materials[materials.of_wall(0)].friction;
  };
  const nscd::Settings walls_own = checked("wall plane 0 0 0 0 0 1 friction 0.7");
  CHECK(walls_own.material.friction == 0 && walls_own.frictional() && on_wall(walls_own) == 0.7);
  const nscd::Settings pairs = checked("wall plane 0 0 0 0 0 1 tol 1e-9 friction 0.7");
  CHECK(pairs.material.friction == 0.7 && !pairs.walls[0].own.has(0) && on_wall(pairs) == 0.7);
  const nscd::Settings both = checked("friction 0.2 wall plane 0 0 0 0 0 1 friction 0.7");
  CHECK(both.material.friction == 0.2 && on_wall(both) == 0.7);
  const nscd::Settings smooth = checked("friction 0.5 wall plane 0 0 0 0 0 1 friction 0");
  CHECK(on_wall(smooth) == 0 && smooth.frictional());
}

TEST(coefficients_of_zero_are_no_friction)
{
  CHECK(!checked("").frictional() && !checked("friction 0").frictional());
  CHECK(!checked("friction 0 wall plane 0 0 0 0 0 1 friction 0").frictional());
  CHECK(checked("friction 1e-300").frictional() && checked("stick").frictional());
}

TEST(bad_friction_is_refused_with_value_and_remedy)
{
  CHECK_ERROR(settings("friction"), "keyword friction needs a value");
  CHECK_ERROR(settings("friction rough"), "keyword friction: 'rough' is not a number");
  CHECK_ERROR(settings("wall plane 0 0 0 0 0 1 friction glue"),
              "keyword wall friction: 'glue' is not a number, nor stick");
  CHECK_ERROR(settings("wall plane 0 0 0 0 0 1 friction"), "keyword wall friction needs a value");
  CHECK_ERROR(settings("stick 0.5"), "unknown keyword '0.5'");
  CHECK_ERROR(nscd::checked(settings("friction 1e7")), "is more than 1e+06: use `stick`");
  CHECK_ERROR(settings("inertia ring"), "unknown inertia 'ring': choose one of sphere, disc");
  CHECK_ERROR(checked("friction -0.5"), "friction = -0.5 must be >= 0, or `stick` for contacts that do not slip");
  CHECK_ERROR(checked("friction nan"), "friction = nan must be >= 0");
  CHECK_ERROR(checked("wall plane 0 0 0 0 0 1 wall plane 0 0 9 0 0 -1 friction -1"),
              "wall 2: friction = -1 must be >= 0");
  CHECK_ERROR(checked("friction 0.5 e_t 1.5"), "e_t = 1.5 is outside [0, 1]");
  CHECK_ERROR(checked("friction 0.5 e_t nan"), "e_t = nan is outside [0, 1]");
  CHECK_ERROR(checked("e_t 0.5"), "e_t = 0.5 has no effect without friction");
  CHECK_ERROR(checked("friction 0 e_t 0.5 wall plane 0 0 0 0 0 1"), "e_t = 0.5 has no effect without friction");
  CHECK_ERROR(checked("inertia sphere"), "inertia has no effect without friction");
  CHECK_ERROR(checked("friction 0.5 inertia disc"), "inertia disc needs `dimension 2`");
}

TEST(defaults_of_rho_know_of_friction)
{
  for (const auto &solver : nscd::solvers()) {
    const std::string words = "solver " + std::string(solver.name);
    CHECK(nscd::solver_parameter(settings(words), solver) == solver.default_parameter);
    CHECK(nscd::solver_parameter(settings(words + " friction 0.1"), solver) == solver.default_parameter);
    if (!solver.friction)
      CHECK_ERROR(checked(words + " friction 0.1"), "solver " + std::string(solver.name) + " is for contacts without");
    if (solver.parameter.empty()) continue;
    const std::string own = words + " friction 0.1 " + std::string(solver.parameter) + " 0.125";
    CHECK(nscd::solver_parameter(settings(own), solver) == 0.125);
  }
}

TEST(the_description_names_what_was_chosen)
{
  const std::string words = "solver sal law moreau restitution 0.5 rho 0.3 wall plane 0 0 0 0 0 1";
  const std::string text = nscd::describe(nscd::Step(checked(words)));
  for (const char *part : {"moreau", "SAL", "rho = 0.3/W_nn", "1 wall", "restitution 0.5", "tol 1e-06 (natural map)"})
    CHECK_SAYS(text, part);
}

// What has no words of its own there is told as a script gives it, where it is not the default.
TEST(the_description_names_all_that_is_not_the_default)
{
  const std::string text = nscd::describe(nscd::Step(checked("maxiter 7 recovery 0.1 warmstart no accuracy tight")));
  for (const char *part : {"; maxiter 7", "; recovery 0.1", "; warmstart no", "; accuracy tight"})
    CHECK_SAYS(text, part);
  const std::string plain = nscd::describe(nscd::Step(checked("")));
  for (const nscd::Keyword &keyword : nscd::keywords())
    if (!keyword.described) CHECK(plain.find("; " + std::string(keyword.name)) == plain.npos);
}

// The table is what the reader reads: every keyword of it takes its own default, and tells it back.
TEST(every_keyword_reads_what_it_writes)
{
  for (const nscd::Keyword &keyword : nscd::keywords()) {
    if (!keyword.value.write) continue;
    const std::string value = keyword.value.write({});
    if (value.empty()) continue;
    nscd::Settings read = settings(std::string(keyword.name) + " " + value);
    CHECK(keyword.value.write(read) == value);
    for (const std::string &choice : keyword.value.choices ? keyword.value.choices() : std::vector<std::string>{})
      CHECK(keyword.value.write(settings(std::string(keyword.name) + " " + choice)) == choice);
  }
}

TEST(report_columns_have_names_and_values)
{
  nscd::StepReport report;
  report.contacts = 1;
  report.iterations = 2;
  report.criterion = {4, 5, 6, 7};
  report.largest_overlap = 8;
  report.dissipated = 9;
  report.largest_overlap_ratio = 10;
  report.unconverged = 11;
  report.energy_limited = 12;
  const double expected[nscd::report_columns] = {1, 2, 15, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  for (int c = 0; c < nscd::report_columns; ++c) CHECK(nscd::report_column(report, c) == expected[c]);
}
