// SPDX-License-Identifier: GPL-2.0-or-later
// PDAS: primal-dual active set (Barboteu & Dumont 2017, section 4.3, equations (37)-(41)).
//
//   tau = p - gamma v~
//   tau >= 0 (active):    v~ = 0,  p <- p - v~ / W~_nn
//   tau <  0 (inactive):  p <- 0
//
// With friction, which the paper leaves open, the active set is split by tau_t = p_t - gamma_t u_t, gamma_t the same
// multiple of 1/W_tt: a semismooth Newton step on Alart & Curnier's complementarity function, as Hueber & Wohlmuth
// (2005) and Kunisch & Stadler (2005) take it for deformable bodies (docs/friction.md):
//   |tau_t| <= mu p_n (stick):  u_t = 0,  p_t <- p_t - u_t / W_tt
//   otherwise (slip):           p_t <- mu p_n t + (what is left across t),  t = tau_t / |tau_t|
//
// Makes exact: the contact law of one contact, in one visit, when gamma = 1/W~_nn (the default, multiple 1):
// then tau is the exact impulse and the visit is its projection on p >= 0, and tau_t that of a sticking contact.
// Fails: gamma below 1/W~_nn keeps contacts active that pull (p < 0 for a sweep); above it drops contacts that
// push. Both heal in later sweeps unless the status flips forever: in the paper's sedimentation gamma from 0.05 to 2
// works, and 10 leaves a fifth of the steps unconverged, which they report.
#pragma once

#include "solver/visit.hpp"

#include <cmath>

namespace nscd {

struct Pdas {
  static constexpr bool carries_velocity = false;
  static Local visit(Local now, double v, double w_inverse, double gamma)
  {
    const double exact = now.impulse - v * w_inverse;
    const double tau = now.impulse - gamma * v * w_inverse;
    return {__builtin_expect_with_probability(tau >= 0, 1, 0.5) ? exact : 0.0, 0.0};
  }

  template <class Tangent>
  NSCD_INLINE static FrictionalLocal<Tangent> visit(const FrictionalLocal<Tangent> &now, const Split<Tangent> &v,
                                                    const OwnBlock<Tangent> &own, double gamma)
  {
    const double tau = now.p.n - gamma * v.n * own.w_inverse;
    if (!(tau >= 0)) return {};
    FrictionalLocal<Tangent> next;
    next.p.n = now.p.n - v.n * own.w_inverse;
    for_each_disc([&](std::size_t d, const auto &p, const auto &u, auto &to) NSCD_INLINED {
      const Disc &disc = own.discs[d];
      to = in_disc(p, u, disc, coulomb_radius(disc.mu, next.p.n), gamma);
    }, now.p.t, v.t, next.p.t);
    return next;
  }

 private:
  template <class Vector>
  NSCD_INLINE static Vector in_disc(const Vector &p, const Vector &u, const Disc &disc, double radius, double gamma)
  {
    const Vector tau = p - u * (gamma * disc.w_inverse);
    const double length2 = inner(tau, tau);
    if (length2 <= radius * radius) return p - u * disc.w_inverse;
    const double m = radius / std::sqrt(length2);
    if (gamma == 1) return tau * m;
    const Vector across = p - tau * (inner(p, tau) / length2);
    return tau * m + across * (1 - 1 / (1 - m + m * gamma));
  }
};

}    // namespace nscd
