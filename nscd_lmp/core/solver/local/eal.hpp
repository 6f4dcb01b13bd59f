// SPDX-License-Identifier: GPL-2.0-or-later
// EAL: enhanced augmented Lagrangian, a Newton step a visit on the unknown chi = (p, v~)
// (Barboteu & Dumont 2017, section 4.1, equation (26); Alart & Curnier 1991; Dumont 2013).
//
//   f~(chi) = ( v~ - v~_m(p) ;  p - proj(tau, R+ x B(0, mu tau_n)) ),  tau = p - rho v~,   df~/dchi Delta chi = -f~
//   outside the half-cylinder (open):    p <- 0,   v~ <- velocity without this impulse
//   inside (stick):                      v~ <- 0,  p <- p - W~^-1 v~_m
//   on its mantle (slip):                v_n <- 0,  p_t.t <- mu p_n, and a Newton step across t = tau_t/|tau_t|;
//                                        where that leaves u_t along t: stick (see EBP)
// The matrices A_c and B_c in three dimensions, and how these lines follow: docs/friction.md.
//
// Carried unknown, start and deviation as in EBP. Makes exact: the motion of the contact at each visit.
// Fails: as EBP. Without friction the half-cylinder is EBP's half-line and the iterates are the same.
#pragma once

#include "solver/local/newton_slip.hpp"

namespace nscd {

struct Eal {
  static constexpr bool carries_velocity = true;
  static Local visit(Local chi, double v, double w_inverse, double rho)
  {
    const bool inside = chi.impulse > rho * w_inverse * chi.velocity;
    if (inside) return {chi.impulse - v * w_inverse, 0.0};
    return {0.0, v - chi.impulse / w_inverse};
  }

  template <class Tangent>
  NSCD_INLINE static FrictionalLocal<Tangent> visit(const FrictionalLocal<Tangent> &chi, const Split<Tangent> &v,
                                                    const OwnBlock<Tangent> &own, double rho)
  {
    const double step = rho * own.w_inverse, tau = chi.p.n - step * chi.v.n;
    if (!(tau > 0)) return opened(chi, v, own);
    FrictionalLocal<Tangent> next = stuck(chi, v, own);
    for_each_disc([&](std::size_t d, const auto &p, const auto &mine, const auto &u, auto &to,
                      auto &left) NSCD_INLINED {
      const Disc &disc = own.discs[d];
      const auto tau_t = p - mine * step;
      const double length2 = inner(tau_t, tau_t), radius = disc.mu * tau;
      if (length2 <= radius * radius) return;
      const double inverse = 1 / std::sqrt(length2);
      const auto t = tau_t * inverse;
      const auto change = step_across(t, p, u, radius * inverse, rho, own.w_inverse, disc);
      const auto slipped = t * (disc.mu * next.p.n) + (p - t * inner(p, t) + change);
      const auto slip = u + (slipped - p) * disc.w;
      if (inner(slip, t) > 0) return;  // friction would drive the slip
      to = slipped;
      left = slip;
    }, chi.p.t, chi.v.t, v.t, next.p.t, next.v.t);
    return next;
  }
};

}    // namespace nscd
