// SPDX-License-Identifier: GPL-2.0-or-later
// look_closer() of any mechanics.
#pragma once

#include "base/hot.hpp"
#include "problem/closer_look.hpp"
#include "problem/natural_map.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

// Of velocities, squared: what round-off leaves of bodies' speeds, and of what impulses do to them, is no residual.
constexpr double round_off2 = 1e-25;

// Of squares.
struct Look {
  double of_kicks2 = 0, worst2 = 0;

  // `push` is W_nn p. Returns the square of the residual, less round-off.
  NSCD_INLINE double add(const ContactInfo &info, double residual2, double push, double speed2)
  {
    constexpr double least = 1e-300;
    const double kick2 = info.kick * info.kick;
    const double left2 = std::max(0.0, residual2 - round_off2 * (speed2 + push * push));
    worst2 = std::max(worst2, left2 / (kick2 + info.free2 + push * push + least));
    of_kicks2 += kick2 > 0 ? left2 / kick2 : 0.0;
    return left2;
  }
};

// Puts together what all ranks have looked at. Collective.
void judge(const Problem &problem, const Look &look, Criterion &seen);

// Normal velocity, and the square of the natural map.
struct ResidualOfContact {
  double v, square;
};

template <class M>
NSCD_INLINE ResidualOfContact residual_of(const M &mechanics, const Contact &c, std::size_t k, double w)
{
  const auto v = mechanics.velocity(c, k);
  const double off = natural_normal(w, c.impulse, v.n);
  double square = off * off;
  if constexpr (M::parts > 0) {
    const auto own = mechanics.own(c, k, w);
    for_each_disc([&](std::size_t d, const auto &pt, const auto &vt) NSCD_INLINED {
      const Disc &disc = own.discs[d];
      const double slips = natural_tangential(disc.w, coulomb_radius(disc.mu, c.impulse), pt, vt);
      square += slips * slips;
    }, mechanics.impulse(c, k).t, v.t);
  }
  return {v.n, square};
}

// Looks at every contact and keeps those that do something in problem.workspace.joined, for their islands.
template <class M>
NSCD_HOT Look look_at_contacts(const Problem &problem, const M &given)
{
  const M mechanics = given;
  std::vector<Joined> &joined = problem.workspace.joined;
  joined.resize(problem.contacts.size() + 1);
  Look look;
  std::size_t count = 0;
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    const Contact &c = problem.contacts[k];
    const ContactInfo &info = problem.infos[k];
    fetch_bodies(problem.contacts[std::min(k + fetch_ahead, problem.contacts.size() - 1)], problem.bodies.data());
    const Body &bi = problem.bodies[c.i], &bj = problem.bodies[c.j];
    const double w = 1 / c.w_inverse, push = w * c.impulse;
    const ResidualOfContact residual = residual_of(mechanics, c, k, w);
    const double left2 = look.add(info, residual.square, push, speed2(bi) + speed2(bj));
    const double stake2 = info.free2 + info.kick * info.kick;
    joined[count] = {bi[3] > 0 ? c.i : c.j, bj[3] > 0 ? c.j : c.i, left2, push > 0 ? stake2 : -1};
    count += (push > 0) | (residual.v < 0);   // no branch, which would be mispredicted
  }
  joined.resize(count);
  return look;
}

template <class M>
void look_closer(const Problem &problem, const M &mechanics, Criterion &seen)
{
  judge(problem, look_at_contacts(problem, mechanics), seen);
}

}    // namespace nscd
