// SPDX-License-Identifier: GPL-2.0-or-later
// How far the run of this process is and what its steps have cost so far, for a program around LAMMPS to read.
//
// LAMMPS' C interface does not serve for that: a second thread that asks it for a fix can meet `unfix` or `clear` just
// as they take the fix, or all of LAMMPS, apart; and what a fix has summed up is gone with it. These numbers stay, and
// may be read, or set to 0 between runs, from any thread; the fixes nscd are the only other writers.
#pragma once

#include "step/report.hpp"

#include <atomic>

namespace nscd {

// The program reads this as an array of doubles, in this order.
struct Progress {
  using Number = std::atomic<double>;
  static_assert(Number::is_always_lock_free && sizeof(Number) == sizeof(double));

  BasicTotals<Number> totals;    // of all fixes nscd of the process; a step of two fixes counts once

  // of the run that is on, or the last one; `run ... start ... stop` widens first and last step
  Number first_step{0}, last_step{0}, step{0}, time{0};
  Number step_contacts{0}, step_iterations{0};

  void begin_run(double first, double last, double now)
  {
    first_step = first;
    last_step = last;
    step = now;
  }

  void add(const StepReport &report, double now, double time_now)
  {
    totals.add(report, step != now);
    step = now;
    time = time_now;
    step_contacts = report.contacts;
    step_iterations = report.iterations;
  }
};

}    // namespace nscd

extern "C" __attribute__((visibility("default"))) nscd::Progress nscd_progress;
