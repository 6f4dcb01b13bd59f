#include "check.hpp"
#include "core/report.hpp"
#include "scene.hpp"

#include <cmath>

static nscd::Settings checked(const std::string &keywords) { return nscd::checked(settings(keywords)); }

TEST(keywords_set_what_they_name)
{
  const nscd::Settings s = settings(
      "solver sal law moreau restitution 0.5 tol 1e-9 maxiter 7 warmstart no rho 0.25 theta 0.75 recovery 0.1 "
      "unconverged error wall plane 1 2 3 0 0 4 wall plane 0 0 0 0 1 0");
  CHECK(s.solver == "sal" && s.law == "moreau" && s.maxiter == 7 && !s.warmstart);
  CHECK(s.restitution == 0.5 && s.tol == 1e-9 && s.rho == 0.25 && s.theta == 0.75 && s.recovery == 0.1);
  CHECK(!s.gamma && s.unconverged == nscd::Unconverged::error);
  CHECK(s.walls.size() == 2 && s.walls[0].point[1] == 2 && s.walls[0].normal[2] == 4 && s.walls[1].normal[1] == 1);
  CHECK(settings("solver pdas gamma 2").gamma == 2);
}

TEST(no_keywords_leave_the_defaults)
{
  const nscd::Settings s = checked("");
  CHECK(s.solver == "pdas" && s.law == "gap" && s.restitution == 0 && s.tol == 1e-7 && s.maxiter == 1000);
  CHECK(s.warmstart && s.unconverged == nscd::Unconverged::warn && s.walls.empty());
  CHECK(!s.rho && !s.gamma);
}

TEST(a_later_keyword_overrides_an_earlier_one)
{
  CHECK(settings("tol 1e-3 tol 1e-5").tol == 1e-5);
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
  const nscd::Plane wall = checked("wall plane 0 0 0 3 0 4").walls[0];
  CHECK_NEAR(wall.normal[0], 0.6, 1e-16);
  CHECK_NEAR(wall.normal[2], 0.8, 1e-16);
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

TEST(the_description_names_what_was_chosen)
{
  const std::string words = "solver sal law moreau restitution 0.5 rho 0.3 wall plane 0 0 0 0 0 1";
  const std::string text = nscd::describe(nscd::Step(checked(words)));
  for (const char *part : {"moreau", "SAL", "rho = 0.3/W_nn", "1 wall", "restitution 0.5", "tol 1e-07"})
    check::says(__FILE__, __LINE__, text, part);
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
  const double expected[nscd::report_columns] = {1, 2, 15, 4, 5, 6, 7, 8, 9, 10, 11};
  for (int c = 0; c < nscd::report_columns; ++c) CHECK(nscd::report_column(report, c) == expected[c]);
}
