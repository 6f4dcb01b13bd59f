// SPDX-License-Identifier: GPL-2.0-or-later
// What users are told at the end of a run: of steps that were taken and yet are not what they may be taken for.
#pragma once

#include "settings/settings.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace nscd {

struct StepReport;

// What a step is told of whose obstacles leave no way out, and what to do.
constexpr std::string_view nothing_gives_way =
    "contacts with obstacles or walls approach and nothing can give way, so no impulses stop them: leave the grains "
    "room, or stop the obstacle (a load instead of a motion: give it to fix nscd's group, and a force)";

class Remarks {
 public:
  // `stop`: the criterion of its solves.
  void add(const StepReport &report, Stop stop);
  // A sentence, with its remedy, for each thing worth saying of the steps added since the last call. `looks_ahead`: as
  // the contact law does.
  std::vector<std::string> take(const Settings &settings, bool looks_ahead);
  // Whether there is, or was, something to say of torques: it is said once.
  bool tell_of_torque() const { return torque_ || told_of_torque_; }

 private:
  long steps_ = 0;
  long unconverged_ = 0;        // given up
  double off_ = 0;              // by how much, at most
  long jammed_ = 0;             // not counted above
  long misjudged_ = 0;          // called solved, and off by more than residual_worth_saying
  double worst_residual_ = 0;   // of those
  long impacts_left_ = 0;
  double overlap_ratio_ = 0;    // the largest
  double move_ratio_ = 0;       // the largest
  long short_lists_ = 0;        // steps whose neighbor list lacked pairs
  double cutoff_to_list_ = 0;   // m, the largest
  long passing_ = 0;            // steps with more than passing_worth_saying
  double pushed_ = 0, passed2_ = 0;   // in these, as a step reports them
  bool torque_ = false;
  bool told_of_torque_ = false;
};

}    // namespace nscd
