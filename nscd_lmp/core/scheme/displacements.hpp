// SPDX-License-Identifier: GPL-2.0-or-later
// How grains move under law gap, once their velocities are known.
//
// dt v_{k+1} is what the gap constraint is about, but it is only first order in free flight and loses energy in
// impacts. So every grain takes the midpoint displacement dt (v_k + v_{k+1}) / 2: an impulse then acts half-way through
// the step, where the normals of lasting contacts are taken (moment.hpp). Impacts with restitution act when they meet.
// Where that would drive a contact into overlap
//   1. its own impulse acts earlier: contacts that grains run into without restitution, so that they touch in the end,
//   2. both grains take dt v_{k+1}, until all contacts are open. It ends: grains only change in that direction, and if
//      all have changed the solver's own constraint holds.
#pragma once

#include "scene/state.hpp"

#include <cstdint>
#include <vector>

namespace nscd {

class Displacements {
 public:
  // Fills motion.displacement from the velocities in motion.bodies. Returns whether pairs are driven into overlap since
  // they have not gone where their planes were taken, and the step has to be solved on: with planes of the start of the
  // step or, where courses relied on what contacts stop, with those of straight courses. Not for
  // `jammed` ones, as Scheme::displace has it. Collective.
  bool fill(State &state, std::span<const char> jammed);

 private:
  NSCD_INLINE double rate(const State &s, std::size_t k) const;
  NSCD_INLINE bool is_open(const State &s, std::size_t k, double rate) const;
  void start_half_way(const State &s);
  void add_shift(const State &s);
  void find_suspects(const State &s);
  void act_earlier(const State &s);
  NSCD_INLINE bool open_contact(const State &s, std::uint32_t k);
  bool open_suspects(const State &s);
  void find_neighbors(const State &s);
  void open_contacts(const State &s);
  bool straighten_broken(State &s, std::span<const char> jammed);
  bool turn_back_broken(State &s, std::span<const char> jammed);

  AlignedVector<Vec4> mean_;      // per body: mean velocity of its way
  std::vector<char> before_;      // what was straight
  static constexpr char lately = 3;   // in the pass before
  std::vector<char> final_;       // per body: 1, or lately, if it moves with v_{k+1}
  std::vector<std::uint32_t> suspects_;   // contacts that may be driven into overlap
};

}    // namespace nscd
