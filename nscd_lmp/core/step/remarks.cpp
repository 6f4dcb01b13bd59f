// SPDX-License-Identifier: GPL-2.0-or-later
#include "step/remarks.hpp"

#include "step/step.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace nscd {

namespace {

constexpr double overlap_worth_saying = 0.01;
// Two of the smallest grains, each moved by its diameter, can have passed each other.
constexpr double move_worth_saying = 2;

// How far pairs that push each other pass each other in a step, over their diameter, root of the mean square. On a
// rough incline of 12 layers 0.013 is no slower than less, 0.025 is slower by some 10 % (docs/how_large_a_step.md). It
// has to last: grains that land pass each other by more for a while.
constexpr double passing_worth_saying = 0.018;
constexpr long steps_of_a_flow = 100;
// A look at all grains costs about as much as a new list; now and then it is nothing to change a script for.
constexpr long short_lists_worth_saying = 100;

template <class... Parts>
std::string sentence(const Parts &...parts)
{
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

// Two digits of what was measured.
std::string rounded(double value)
{
  std::ostringstream text;
  text.precision(2);
  text << value;
  return text.str();
}

// What is wrong with the steps that were given up, and what to do.
std::string told_unconverged(const Settings &s, long unconverged, long steps, double off)
{
  const std::string bounds = s.overlap ? sentence(*s.tol, " or overlap ", *s.overlap) : sentence(*s.tol);
  const std::string what = s.criterion == Stop::natural
      ? sentence("their velocities and forces are off by up to ", rounded(off), " of what contacts had to stop")
      : sentence("their velocities at contacts are off by up to ", rounded(off), " in the mean");
  return sentence(unconverged, " of ", steps, " steps were given up above tol ", bounds, ", and ", what,
                  ": take a smaller timestep, or raise maxiter (now ", s.maxiter,
                  s.overlap ? "), tol or overlap" : ") or tol");
}

std::string told_passing(long passing, long steps, double by)
{
  return sentence("in ", passing, " of ", steps, " steps grains that push each other pass each other by more than ",
                  passing_worth_saying, " of a diameter, by ", rounded(by), " in the mean, and a flow comes out too ",
                  "slow by 10 % and more: use a timestep ", rounded(by / passing_worth_saying), " times smaller where ",
                  "that matters");
}

}    // namespace

void Remarks::add(const StepReport &r, Stop stop)
{
  ++steps_;
  const bool given_up = !r.converged && !r.jammed;
  unconverged_ += given_up;
  const double off = stop == Stop::paper ? r.criterion.total() : std::max(r.criterion.relative, r.criterion.island);
  if (given_up) off_ = std::max(off_, off);
  jammed_ += r.jammed;
  if (r.converged && r.criterion.typical > residual_worth_saying) {
    ++misjudged_;
    worst_residual_ = std::max(worst_residual_, r.criterion.typical);
  }
  impacts_left_ += r.impacts_left;
  overlap_ratio_ = std::max(overlap_ratio_, r.largest_overlap_ratio);
  move_ratio_ = std::max(move_ratio_, r.largest_move_ratio);
  short_lists_ += r.cutoff_to_list > 0;
  cutoff_to_list_ = std::max(cutoff_to_list_, r.cutoff_to_list);
  if (r.passed2 > passing_worth_saying * passing_worth_saying * r.pushed) {
    ++passing_;
    pushed_ += r.pushed;
    passed2_ += r.passed2;
  }
  torque_ = torque_ || r.unread_torque;
}

std::vector<std::string> Remarks::take(const Settings &s, bool looks_ahead)
{
  std::vector<std::string> said;
  const bool of_solver = s.unconverged != Unconverged::ignore;
  if (of_solver && unconverged_ > 0) said.push_back(told_unconverged(s, unconverged_, steps_, off_));
  if (of_solver && jammed_ > 0) said.push_back(sentence("in ", jammed_, " of ", steps_, " steps ", nothing_gives_way));
  if (of_solver && misjudged_ > 0 && s.criterion == Stop::paper)
    said.push_back(sentence(misjudged_, " of ", steps_, " steps met tol ", *s.tol, " of criterion (42) with ",
                            "velocities that are off by up to ", rounded(worst_residual_), " of what a step changes: ",
                            "use criterion natural, or a smaller tol"));
  if (impacts_left_ > 0)
    said.push_back(sentence("in ", impacts_left_, " of ", steps_, " steps more impacts followed each other than law ",
                            s.law, " takes one after another, and the rest gave no energy back: let slow ones stop, ",
                            "`min_bounce`, use law moreau, or a smaller timestep if the grains do not touch yet"));
  if (overlap_ratio_ > std::max(overlap_worth_saying, s.overlap.value_or(0)))
    said.push_back(sentence("grains overlap by up to ", rounded(overlap_ratio_), " of the smaller radius: ",
                            looks_ahead ? "start without overlap, lower tol, or move obstacles by less a step"
                                        : "use law gap or a smaller timestep"));
  if (!looks_ahead && move_ratio_ > move_worth_saying)
    said.push_back(sentence("grains move by up to ", rounded(move_ratio_), " of the smallest radius in a step, and ",
                            "law ", s.law, " does not see them pass each other: use law gap or a smaller timestep"));
  if (short_lists_ > std::max(short_lists_worth_saying, steps_ / 10))
    said.push_back(sentence("in ", short_lists_, " of ", steps_, " steps the neighbor list lacked pairs that meet, ",
                            "and all grains were looked at to find them, which takes time: raise the cutoff of the ",
                            "pair style, to ", rounded(cutoff_to_list_), " at most, or build the list more often"));
  if (looks_ahead && !s.restitutive() && passing_ > std::max(steps_of_a_flow, steps_ / 2))
    said.push_back(told_passing(passing_, steps_, std::sqrt(passed2_ / pushed_)));
  if (torque_)
    said.push_back("torques act on grains without friction, which have no spins: give the fix a friction (0.0001 will "
                   "do where its own contacts are to have none), or leave out what makes them");
  const bool told_of_torque = tell_of_torque();
  *this = {};
  told_of_torque_ = told_of_torque;
  return said;
}

}    // namespace nscd
