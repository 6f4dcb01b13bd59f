// SPDX-License-Identifier: GPL-2.0-or-later
// The scheme of time stepping, which users choose with `law`: where contacts are sought, what velocity they must
// respect, and how grains move. One file each; they register themselves as solvers do.
#pragma once

#include "scene/state.hpp"
#include "scheme/impacts.hpp"
#include "settings/schemes.hpp"

#include <memory>
#include <span>

namespace nscd {

class Scheme {
 public:
  // What it is, known with its settings.
  struct Constants {
    double prediction = 0;        // contacts are sought at q_k + prediction dt v_k
    double moment = 0;            // lasting contacts act moment dt after that, along the normal of their pair then
    bool impacts_first = false;   // impacts are resolved ahead of the contacts, from the free velocities of the bodies
    bool restitution = false;     // the biases hold that of the contacts, from the velocities at the start of the step
  };

  explicit Scheme(const Constants &of_scheme) : constants(of_scheme) {}
  virtual ~Scheme() = default;
  Scheme(const Scheme &) = delete;
  Scheme &operator=(const Scheme &) = delete;

  const Constants constants;

  // Returns whether some were left that matter, to be taken as inelastic.
  virtual bool impacts(State &, const SolvePart &) { return false; }
  // Fills the biases of the contacts from `first` on. Bodies have the velocities without these contacts,
  // state.in.grains.v has v_k.
  virtual void set_bias(State &, std::size_t first) = 0;
  // Fills motion.displacement, from where contacts were sought to q_{k+1}; bodies have v_{k+1}. Returns whether the
  // step has to be solved again, with what the scheme has changed; the same on all ranks. `jammed`: of the moving
  // bodies, or empty; contacts of these have no solution, and nothing is changed for them.
  virtual bool displace(State &, std::span<const char> jammed) = 0;
};

}    // namespace nscd
