// The contact law of the time-stepping scheme: where contacts are sought, what velocity they must respect,
// and how grains move. One file each; they register themselves as solvers do.
//
// Not to be confused with the local laws in solver/local/, which are ways to solve one contact.
#pragma once

#include "scene/state.hpp"
#include "scheme/impacts.hpp"
#include "settings/laws.hpp"

#include <memory>

namespace nscd {

class Law {
 public:
  virtual ~Law() = default;
  // Contacts are sought at q_k + prediction dt v_k.
  virtual double prediction(const Settings &) const { return 0; }
  // Lasting contacts act `moment` dt after that, along the normal that their pair has then.
  virtual double moment() const { return 0; }
  // Whether impacts are resolved ahead of the contacts, from the free velocities of the bodies.
  virtual bool resolves_impacts(const Settings &) const { return false; }
  // Returns whether some were left that matter, to be taken as inelastic.
  virtual bool impacts(State &, const SolvePart &) { return false; }
  // Fills the biases of the contacts from `first` on. Bodies have the velocities without these contacts,
  // state.grains.v has v_k.
  virtual void set_bias(State &, std::size_t first) = 0;
  // The restitution that the biases contain, for the criterion's v~ = v / (1 + e).
  virtual double restitution_in_bias(const Settings &) const { return 0; }
  // The same of the tangential biases, which are e_t times the tangential velocity at the start of the step.
  virtual double tangential_restitution_in_bias(const Settings &) const { return 0; }
  // Fills state.displacement, from where contacts were sought to q_{k+1}; bodies have v_{k+1}. Returns whether the
  // step has to be solved again, with what the law has changed; the same on all ranks. `jammed`: of the moving bodies,
  // or empty; contacts of these have no solution, and nothing is changed for them.
  virtual bool displace(State &, std::span<const char> jammed) = 0;
};

}    // namespace nscd
