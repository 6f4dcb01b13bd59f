// SPDX-License-Identifier: GPL-2.0-or-later
// The tables that users see: the columns of a step's report and the rows of its contacts.
#pragma once

#include "step/step.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace nscd {

// f_ID[1..] of fix nscd; the first columns of .stats.
constexpr std::array<std::string_view, 14> report_column_names{
    "contacts", "iterations", "criterion", "motion", "bipotential", "penetration",
    "relative_residual", "largest_overlap", "dissipated_energy", "largest_overlap_ratio", "unconverged_steps",
    "energy_limited_steps", "worst_residual", "accepted_steps"};
constexpr int report_columns = int(report_column_names.size());
double report_column(const StepReport &report, int column);

// f_ID[1][1..] of fix nscd: totals since the fix was made. Not for thermo output: they hold seconds.
constexpr std::array<std::string_view, 9> totals_column_names{
    "steps", "seconds_contacts", "seconds_solver", "worst_overlap", "worst_overlap_ratio", "iterations",
    "unconverged_steps", "dissipated_energy", "accepted_steps"};
constexpr int totals_columns = int(totals_column_names.size());

template <class Number>
class BasicTotals {
 public:
  // A step in which another total has its part already counts 0 steps.
  void add(const StepReport &r, double new_steps = 1)
  {
    auto &[steps, contacts, solver, overlap, ratio, iterations, unconverged, dissipated, accepted] = values_;
    steps = steps + new_steps;
    contacts = contacts + r.seconds_contacts;
    solver = solver + r.seconds_solver;
    overlap = std::max<double>(overlap, r.largest_overlap);
    ratio = std::max<double>(ratio, r.largest_overlap_ratio);
    iterations = iterations + r.iterations;
    unconverged = unconverged + !r.converged;
    dissipated = dissipated + r.dissipated_in_step;
    accepted = accepted + (r.converged && r.accepted);
  }
  double column(int column) const { return values_[column]; }

 private:
  std::array<Number, totals_columns> values_{};
};
using Totals = BasicTotals<double>;

// Rows of `dump local`: a wall contact has -1 - wall (walls count from 0) as its second tag.
constexpr std::array<std::string_view, 13> contact_column_names{
    "tag_i", "tag_j", "x", "y", "z", "nx", "ny", "nz", "gap", "impulse", "impulse_tx", "impulse_ty", "impulse_tz"};
constexpr int tangential_columns = 3;  // the last ones, with friction only
int contact_columns(const Settings &settings);

// Writes contacts x columns doubles: the contacts of the step at q_{k+1}, m and N s (force times time); zeros where
// there are more columns than these have.
void fill_contact_rows(const State &state, double *rows, int columns);
inline void fill_contact_rows(const State &state, double *rows)
{
  fill_contact_rows(state, rows, contact_columns(state.in.settings));
}

// One line: what was chosen for the scene.
std::string describe(const Step &step);

}    // namespace nscd
