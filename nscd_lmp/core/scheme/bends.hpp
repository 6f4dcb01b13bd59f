// SPDX-License-Identifier: GPL-2.0-or-later
// The courses of grains through a step with impacts: straight between impacts, each of which acts when its pair meets.
//
// So that no impact bends a course earlier than one that was found before it, a round takes of the meetings of every
// grain only the first. What is a hundredth of the step apart counts as at once.
//
// Behind its last impact, at t, a grain moves as if it came straight from courses.start = -sum t dv: the plane of a
// contact and the gap constraint look from there. Found too late are impacts that others behind them cause: where such
// courses contradict each other, and their constraints would push grains apart that part already, their impacts act
// half-way.
#pragma once

#include "problem/islands.hpp"
#include "scene/state.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace nscd {

class Bends {
 public:
  // Whether contact k, which meets with u (m/s, negative when closing), is an impact.
  using IsImpact = std::function<bool(std::size_t k, double u)>;

  // Starts anew. Bodies have the velocities of the middle of the step.
  void begin(State &state);
  // Finds the impacts that are to come as bodies move now, and fills impact_moment and impact_kick of theirs. Contacts
  // that their planes stop are given the plane of the moment when they meet, or of the end of the step if they do not.
  // On one rank only contacts of bodies that have changed since the last look are looked at again: few, in most rounds.
  void look(State &state, const IsImpact &is_impact);
  // Of them those that are the first of both their grains, by contact. Collective.
  const std::vector<std::size_t> &first_meetings(State &state);
  // These have acted, the impulses of the first `count` contacts. Collective.
  void act(State &state, std::size_t count);
  // Takes back courses that contradict each other. Returns whether there are any, anywhere. Collective.
  bool straighten(State &state);
  // Takes back the courses of all grains that contacts connect with impacts that are left, the first `count` contacts:
  // what takes these as inelastic knows nothing of courses. Collective.
  void straighten_connected(State &state, std::size_t count);

 private:
  using Parts = std::vector<char>;   // (bodies) hundredths of the step
  bool is_seen(const State &state, const Contact &contact) const;
  void find_starts(State &state) const;
  double last_struck(const State &state, const Contact &contact) const;
  std::optional<double> meet(State &state, std::size_t k) const;
  // How long behind `struck`, s.
  std::optional<double> meet_plane(const State &state, std::size_t k, double struck) const;
  std::optional<double> meet_grain(State &state, std::size_t k, double struck) const;
  double kick_until(const State &state, std::size_t k, double moment) const;
  void find_contradictions(State &state);
  void take_back(State &state);

  std::vector<std::size_t> meetings_;   // contacts
  Islands islands_;
  std::vector<Islands::Pair> joined_;
  Parts before_;      // what was straight
  Parts struck_;      // when each body was last
  Parts sooner_;      // parts of the step that are left when each body is next
  Parts changed_;     // whether each body has changed since the last look
  bool all_changed_ = true;
};

}    // namespace nscd
