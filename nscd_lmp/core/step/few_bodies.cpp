// SPDX-License-Identifier: GPL-2.0-or-later
#include "step/few_bodies.hpp"

#include <utility>

namespace nscd {

int FewBodies::number(const State &s, int body)
{
  if (numbers_[std::size_t(body)] < 0) {
    numbers_[std::size_t(body)] = int(bodies_.size());
    bodies_.push_back(body);
    few_.push_back(s.motion.bodies[body]);
    if (!s.motion.spins.empty()) few_spins_.push_back(s.motion.spins[body]);
  }
  return numbers_[std::size_t(body)];
}

void FewBodies::take(State &s, std::size_t count)
{
  numbers_.resize(s.motion.bodies.size(), -1);   // all are -1 between two calls
  bodies_.clear(), few_.clear(), few_spins_.clear();
  for (std::size_t k = 0; k < count; ++k) {
    Contact &c = s.table.contacts[k];
    c.i = number(s, c.i);
    c.j = number(s, c.j);
  }
  std::swap(s.motion.bodies, few_);
  std::swap(s.motion.spins, few_spins_);
}

void FewBodies::give_back(State &s, std::size_t count)
{
  std::swap(s.motion.bodies, few_);
  std::swap(s.motion.spins, few_spins_);
  for (std::size_t k = 0; k < count; ++k) {
    Contact &c = s.table.contacts[k];
    c.i = bodies_[std::size_t(c.i)];
    c.j = bodies_[std::size_t(c.j)];
  }
  for (std::size_t few = 0; few < bodies_.size(); ++few) {
    const int body = bodies_[few];
    s.motion.bodies[body] = few_[few];
    if (!s.motion.spins.empty()) s.motion.spins[body] = few_spins_[few];
    numbers_[std::size_t(body)] = -1;
  }
}

}    // namespace nscd
