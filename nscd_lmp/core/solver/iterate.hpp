// SPDX-License-Identifier: GPL-2.0-or-later
// Sweeps until the criterion is met: the loop that all solvers by sweeps share, on grains and on matrices.
#pragma once

#include "solver/solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace nscd {

// What a sweep did: the sum over the contacts of the velocity that each visit corrected, m/s, and, with momentum, the
// product that Momentum looks at.
struct Swept {
  double corrected = 0;
  double against = 0;
};

struct Extent {
  std::size_t contacts;
  double free_norm;  // m/s
};

// What a sweep must have corrected for the criterion to be certainly above tol: (42), the mean over the contacts, is
// bounded by about the mean correction, and the 2-norm of the natural map by about the sum.
inline double surely_above(const Extent &extent, const SolverOptions &options)
{
  const double n = double(extent.contacts);
  return 4 * options.tol * (options.stop == Stop::paper ? n : std::sqrt(n) * extent.free_norm);
}

// Sweeps that threw impulses about before they came down again: the round-off of what they corrected stays in the
// velocities, where the criterion does not see it.
class RunAway {
 public:
  // `above`: as surely_above has it.
  explicit RunAway(double above) : above_(above) {}

  void look(double corrected)
  {
    if (most_ == 0) first_ = corrected;
    most_ = std::max(most_, corrected);
  }
  bool has_happened() const { return most_ > 1e12 * first_ && most_ * round_off > above_; }

 private:
  static constexpr double round_off = 1e-15;
  const double above_;
  double first_ = 0, most_ = 0;
};

// Whether sweeps are worth going on with, by what they correct: it falls about geometrically, with ripples under
// momentum, so the least of the sweeps from s/2 to s is held against the least of those from s/4 to s/2, s = first, 2
// first, ...
class Outlook {
 public:
  // `goal`: the correction at which the criterion is about met.
  Outlook(double alternative, double goal) : alternative_(alternative), goal_(goal), end_(first(alternative)) {}

  void aim(double goal) { goal_ = std::min(goal_, goal); }

  bool is_worse_than_alternative(double corrected)
  {
    if (alternative_ == 0) return false;
    if (++sweeps_ > end_ / 4) (sweeps_ > end_ / 2 ? least_ : least_before_).add(corrected);
    if (sweeps_ < end_) return false;
    const double a_sweep = std::log(least_before_.value / least_.value) / (end_ / 4 + end_ / 8);
    const double left = std::log(least_.value / goal_);
    end_ *= 2;
    least_before_ = least_;
    least_ = {};
    return left > 0 && !(left < alternative_ * a_sweep);
  }

 private:
  struct Least {
    double value = INFINITY;
    void add(double v) { value = std::min(value, v); }
  };
  static int first(double alternative) { return std::max(8, int(alternative / 4)); }

  const double alternative_;
  double goal_;
  int sweeps_ = 0, end_;
  Least least_{}, least_before_{};
};

// When to measure the criterion, which costs about half a sweep: rarely far from convergence, but so that the sweeps
// hardly overshoot. All times are sweeps.
class Looks {
 public:
  // `above`: as surely_above has it. The paper counts the visits of a few contacts, so its criterion is taken after
  // each of the first. `spent`: sweeps that came before in the same step.
  Looks(double above, Stop stop, int budget, int spent) :
      above_(above), always_(stop == Stop::paper ? 4 : 1), budget_(budget), spent_(spent)
  {
  }

  // Iterates that do not get better all the time are looked at in fixed intervals too, whatever there is to be seen, so
  // that the best of them is known. More sweeps look at what fewer look at.
  void at_intervals() { interval_ = std::max(2, spent_ / 8); }

  bool is_due(int s, double corrected) const
  {
    return s <= always_ || s == interval_ || s == budget_ || corrected <= (s >= latest_ ? above_ : enough_);
  }

  // After any look.
  void have_looked(int s)
  {
    if (s == interval_) interval_ += s < 32 ? s : s / 8;
  }

  // After a look at sweep s, whose worst is `excess` times too large. What all contacts have left over goes with what
  // sweeps correct.
  void were_all_off(int s, double corrected, double excess)
  {
    constexpr double above_goal = 1.3;   // what is left over falls faster than corrections at times
    enough_ = above_goal * corrected / excess;
    if (s < budget_ || budget_ == 0) enough_ = std::min(enough_, above_);
    latest_ = s + 1 + (s + spent_) / 4;
  }

  // The same where single contacts or small islands are what is left: sweeps do not show it. It falls about
  // geometrically.
  void were_some_off(int s, double excess)
  {
    const double left = std::log(excess), a_sweep = (left_before_ - left) / (s - before_);
    const double rest = a_sweep > 0 ? left / a_sweep : INFINITY;
    left_before_ = left;
    before_ = s;
    const double all = s + spent_;
    latest_ = s + 1 + int(std::clamp(0.75 * rest - 1, all / 16, all / 8));
    enough_ = 0;
  }

 private:
  const double above_;
  const int always_, budget_, spent_;
  double enough_ = 0, left_before_ = INFINITY;
  int latest_ = 1, before_ = 0, interval_ = 0;
};

// For iterates of which each is better than the one before, or so it is meant.
struct KeepNone {
  static constexpr bool keeps = false;
  void keep() {}
  void restore() {}
};

// `once()` sweeps and returns the sum over the contacts of the velocity that each visit corrected, m/s; `look(goal)`
// measures, single contacts and islands where the sums meet the goal. `best` keeps the iterate that was the best at a
// look, and restores it where none was good enough: more sweeps never leave a worse one than fewer.
template <class Sweep, class Look, class Best = KeepNone>
SolverReport iterate(const Extent &extent, const SolverOptions &options, Sweep once, Look look, Best &&best = {})
{
  using Keeps = std::remove_reference_t<Best>;
  SolverReport report;
  if (extent.contacts == 0) return report;
  const double above = surely_above(extent, options);
  Outlook outlook(options.alternative, above / 4);
  RunAway run_away(above);
  const int budget = options.budget.of(extent.contacts);
  Looks looks(above, options.stop, budget, options.budget.spent);
  const bool keeps = Keeps::keeps && !options.goes_on;
  if (keeps) looks.at_intervals();
  Criterion seen;
  bool any = false;
  report.converged = false;
  const auto judge = [&](const Goal &goal) {
    report.criterion = look(goal);
    report.converged = meets(report.criterion, goal);
    report.accepted = report.converged && !solved(report.criterion, options);
    if (options.history) options.history->push_back(report);
  };
  for (int s = 1; s <= options.maxiter; ++s) {
    const double corrected = once();
    run_away.look(corrected);
    report.iterations = s;
    const bool last = s == options.maxiter || outlook.is_worse_than_alternative(corrected);
    const bool broken = !std::isfinite(corrected);   // nothing good can be restored from what is no number
    if (!broken && !looks.is_due(s, corrected) && (!last || keeps)) {
      if (last) break;
      continue;
    }
    looks.have_looked(s);
    const bool accepts = budget > 0 && s >= budget;
    const Goal goal = accepts ? options.accepted_goal() : options.goal();
    report.ran_away = run_away.has_happened();
    judge(goal);
    const Criterion now = report.criterion;
    const bool better = !any || is_better(now, seen, options);
    if (better || !keeps) seen = now;
    any = true;
    if (report.converged || broken) return report;
    if (better && keeps) best.keep();
    if (last || report.ran_away) break;
    const double over = excess(now, goal);
    if (!is_met_by_sums(now, goal)) {
      looks.were_all_off(s, corrected, over);
      continue;
    }
    if (options.stop == Stop::natural) outlook.aim(corrected * goal.tol / now.island);
    looks.were_some_off(s, over);
  }
  if (keeps) best.restore();
  report.criterion = seen;
  // What was looked at before the budget, or is too fast along the normals alone, may be good enough.
  if (keeps && budget > 0 && report.iterations >= budget && !report.ran_away) judge(options.accepted_goal());
  return report;
}

// Sees sweeps that get nowhere: the mean correction of the sweeps from s/2 to s is about that of the sweeps from s/4 to
// s/2, s = 256, 512, ... Slow convergence, as 1/s or 1/sqrt(s), is left alone.
class Plateau {
 public:
  bool is_reached(double corrected)
  {
    sum_ += corrected;
    if (++sweeps_ < end_) return false;
    const double mean = sum_ / (end_ - begin_);
    const bool reached = mean > no_better * mean_before_;
    mean_before_ = mean;
    sum_ = 0;
    begin_ = end_;
    end_ *= 2;
    return reached;
  }

 private:
  static constexpr double no_better = 0.9;
  int sweeps_ = 0, begin_ = 0, end_ = 128;  // the window of sweeps that is averaged now
  double sum_ = 0, mean_before_ = INFINITY;
};

// Lets the visits of sweeps that go to and fro do a part of their step.
class Relaxation {
 public:
  double share() const { return share_; }
  void look(double corrected)
  {
    if (plateau_.is_reached(corrected) && share_ > least_share) share_ /= 2;
  }

 private:
  static constexpr double least_share = 0.25;
  double share_ = 1;
  Plateau plateau_;
};

}    // namespace nscd
