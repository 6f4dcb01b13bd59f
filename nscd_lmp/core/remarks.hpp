// What users are told at the end of a run: of steps that were taken and yet are not what they may be taken for.
#pragma once

#include "settings.hpp"

#include <string>
#include <vector>

namespace nscd {

struct StepReport;

class Remarks {
 public:
  void add(const StepReport &report);
  // A sentence, with its remedy, for each thing worth saying of the steps added since the last call. `looks_ahead`: as
  // the contact law does.
  std::vector<std::string> take(const Settings &settings, bool looks_ahead);
  // Whether there is, or was, something to say of torques: it is said once.
  bool tell_of_torque() const { return torque_ || told_of_torque_; }

 private:
  long steps_ = 0;
  long unconverged_ = 0;
  long misjudged_ = 0;          // called solved, and off by more than residual_worth_saying
  double worst_residual_ = 0;   // of those
  double overlap_ratio_ = 0;    // the largest
  double move_ratio_ = 0;       // the largest
  bool torque_ = false;
  bool told_of_torque_ = false;
};

}    // namespace nscd
