// SPDX-License-Identifier: GPL-2.0-or-later
// What a tangential impulse does to two spheres or discs, written out: momentum, and spins about the contact's normal
// direction (contact/spheres.hpp has the equations).
#pragma once

#include "contact/mechanics.hpp"

#include <span>

template <class Space>
void push_by_hand(const nscd::Contact &c, const typename Space::Tangent &impulse, double spin_response,
                  std::span<nscd::Body> bodies, std::span<nscd::Vec4> spins)
{
  const nscd::Vec4 push = Space::in_space(c.normal, impulse), turn = nscd::cross(c.normal, push) * spin_response;
  for (const int b : {c.i, c.j}) {
    const double mobility = bodies[b][3];
    bodies[b] += push * (b == c.i ? mobility : -mobility);
    spins[b] -= turn * mobility;
  }
}
