// SPDX-License-Identifier: GPL-2.0-or-later
#include "check.hpp"
#include "scheme/scheme.hpp"
#include "solver/solver.hpp"

#include <cmath>

TEST(solvers_are_listed_in_legend_order)
{
  const std::vector<std::string> expected{"sbp", "sal", "ebp", "eal", "pdas"};
  CHECK(nscd::solvers().size() >= expected.size());
  std::size_t found = 0;
  for (std::size_t k = 0; k < nscd::solvers().size(); ++k) {
    const auto &entry = nscd::solvers()[k];
    if (k > 0) CHECK(nscd::solvers()[k - 1].order < entry.order);
    if (found < expected.size() && entry.name == expected[found]) ++found;
  }
  CHECK(found == expected.size());
}

TEST(every_solver_entry_is_complete)
{
  for (const auto &entry : nscd::solvers()) {
    CHECK(&nscd::find_solver(entry.name) == &entry);
    CHECK(!entry.title.empty());
    CHECK(entry.kind == "local law" || entry.kind == "global");
    if (entry.kind == "local law") CHECK(entry.parameter == "rho" || entry.parameter == "gamma");
    else CHECK(entry.parameter == "");
    if (!entry.parameter.empty()) CHECK(entry.default_parameter > 0 && std::isfinite(entry.default_parameter));
    CHECK(entry.solve != nullptr);
    CHECK(entry.solve_global != nullptr);
  }
}

TEST(every_scheme_entry_is_complete)
{
  CHECK(nscd::schemes().size() >= 2);
  for (const auto &entry : nscd::schemes()) {
    CHECK(&nscd::find_scheme(entry.name) == &entry);
    CHECK(!entry.title.empty());
    CHECK(entry.make(nscd::Settings{}) != nullptr);
  }
}

TEST(unknown_names_are_refused_with_all_choices)
{
  CHECK_ERROR(nscd::find_solver("newton"), "unknown solver 'newton'");
  CHECK_ERROR(nscd::find_scheme("hertz"), "unknown law 'hertz'");
  for (const auto &entry : nscd::solvers()) CHECK_ERROR(nscd::find_solver("PDAS"), std::string(entry.name));
  for (const auto &entry : nscd::schemes()) CHECK_ERROR(nscd::find_scheme(""), std::string(entry.name));
}
