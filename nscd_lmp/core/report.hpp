// The tables that users see: the columns of a step's report and the rows of its contacts.
#pragma once

#include "step.hpp"

#include <array>
#include <string>
#include <string_view>

namespace nscd {

// f_ID[1..] of fix nscd; the first columns of .stats.
constexpr std::array<std::string_view, 11> report_column_names{
    "contacts", "iterations", "criterion", "motion", "bipotential", "penetration",
    "relative_residual", "largest_overlap", "dissipated_energy", "largest_overlap_ratio", "unconverged_steps"};
constexpr int report_columns = int(report_column_names.size());
double report_column(const StepReport &report, int column);

// f_ID[1][1..] of fix nscd: totals since the fix was made. Not for thermo output: they hold seconds.
constexpr std::array<std::string_view, 8> totals_column_names{
    "steps", "seconds_contacts", "seconds_solver", "worst_overlap", "worst_overlap_ratio", "iterations",
    "unconverged_steps", "dissipated_energy"};
constexpr int totals_columns = int(totals_column_names.size());

class Totals {
 public:
  void add(const StepReport &report);
  double column(int column) const { return values_[column]; }

 private:
  std::array<double, totals_columns> values_{};
};

// Rows of `dump local`: a wall contact has -1 - wall (walls count from 0) as its second tag.
constexpr std::array<std::string_view, 10> contact_column_names{"tag_i", "tag_j", "x", "y", "z",
                                                                "nx", "ny", "nz", "gap", "impulse"};
constexpr int contact_columns = int(contact_column_names.size());

// Writes contacts x contact_columns doubles: the contacts of the step at q_{k+1}, m and N s.
void fill_contact_rows(const State &state, double *rows);

// One line: what was chosen for the scene.
std::string describe(const Settings &settings);

}    // namespace nscd
