// SPDX-License-Identifier: GPL-2.0-or-later
// EBP: enhanced bipotential, a Newton step a visit on the unknown chi = (p, v~)
// (Barboteu & Dumont 2017, section 4.2, equations (30)-(36); Dumont 2013).
//
//   f(chi) = ( v~ - v~_m(p) ;  p - proj(tau, K_mu) ),  tau = p - rho (v~ + mu |u_t| n),    df/dchi Delta chi = -f
//   tau in the polar cone of K_mu (open):  p <- 0,   v~ <- velocity without this impulse
//   tau in K_mu (stick):                   v~ <- 0,  p <- p - W~^-1 v~_m
//   otherwise (slip), t = tau_t/|tau_t|, h = u_t/|u_t| of chi:
//     p_t.t <- mu p_n,   v_n + mu (h + t).u_t <- 0,   and a Newton step across t
//     where that leaves u_t along t: stick;   where it leaves p_n <= 0: open
// The paper prints tau without the term mu |u_t|, which would be the convex relaxation; see SBP. It gives A_c and B_c
// without friction; with friction, in three dimensions, they are derived in docs/friction.md.
//
// chi is carried from visit to visit and starts at v~ = 0. Deviation: one Newton step a visit; the
// paper loops to local convergence, which without friction is PDAS, iterate for iterate, and could not give
// the 2 iterations of its Table 1.
// Makes exact: the motion of the contact at each visit. Fails: the status lags a visit behind, so p < 0 can
// stand for a sweep. rho only weighs p against v~ in the status: too small is deaf to v~, hence slow.
// With friction plain Newton steps can alternate between two statuses forever, a quarter of all single contacts with
// rho = 1/W_nn. So a slip is checked: if the new u_t points along t, friction would drive it, and the contact sticks
// instead; if it would pull (p_n <= 0), it opens, without which several contacts with mu > 3 run away together. Then
// every contact of tests/core/test_one_frictional_contact.cpp is solved.
#pragma once

#include "solver/local/disc_cone.hpp"
#include "solver/local/newton_slip.hpp"

namespace nscd {

struct Ebp {
  static constexpr bool carries_velocity = true;
  static Local visit(Local chi, double v, double w_inverse, double rho)
  {
    const double exact = chi.impulse - v * w_inverse;
    const double tau = chi.impulse - rho * w_inverse * chi.velocity;
    if (tau > 0) return {exact, 0.0};
    return {0.0, v - chi.impulse / w_inverse};
  }

  template <class Tangent>
  NSCD_INLINE static FrictionalLocal<Tangent> visit(const FrictionalLocal<Tangent> &chi, const Split<Tangent> &v,
                                                    const OwnBlock<Tangent> &own, double rho)
  {
    const double step = rho * own.w_inverse;
    std::array<double, disc_count<Tangent>> lengths;
    double lift = 0;
    bool inside = true;
    for_each_disc([&](std::size_t d, const auto &mine) NSCD_INLINED {
      if (!std::isinf(own.discs[d].mu)) lift = lift + own.discs[d].mu * length(mine);
    }, chi.v.t);
    const double tau = chi.p.n - step * (chi.v.n + lift);
    for_each_disc([&](std::size_t d, const auto &p, const auto &mine) NSCD_INLINED {
      const auto tau_t = p - mine * step;
      const double mu = own.discs[d].mu;
      lengths[d] = inner(tau_t, tau_t);   // squared
      inside &= lengths[d] <= mu * mu * tau * tau;   // an infinite mu bounds nothing where tau > 0
    }, chi.p.t, chi.v.t);
    if (tau > 0 && inside) return stuck(chi, v, own);
    for (double &length : lengths) length = std::sqrt(length);
    DiscCone<Tangent> cone(tau, lengths, own);
    if (!(cone.sum() > 0)) return opened(chi, v, own);
    const double height = 1 / (1 + cone.squares()), sum = cone.sum();
    while (cone.any_outside()) {
      const FrictionalLocal<Tangent> next = slipped(chi, v, own, rho, sum, height, lengths, cone);
      if (!(next.p.n > 0)) return opened(chi, v, own);
      if (!leave_driven(chi, next, lengths, step, cone)) return next;
    }
    return stuck(chi, v, own);
  }

 private:
  // The Newton step with the discs that are outside the cone; the others stick.
  template <class Tangent>
  NSCD_INLINE static FrictionalLocal<Tangent> slipped(const FrictionalLocal<Tangent> &chi, const Split<Tangent> &v,
                                                      const OwnBlock<Tangent> &own, double rho, double sum,
                                                      double height,
                                                      const std::array<double, disc_count<Tangent>> &lengths,
                                                      const DiscCone<Tangent> &cone)
  {
    const double step = rho * own.w_inverse;
    FrictionalLocal<Tangent> next = stuck(chi, v, own);
    Tangent changes{};
    double slips = 0, stiffness = 0;
    for_each_disc([&](std::size_t d, const auto &p, const auto &mine, const auto &u, auto &change) NSCD_INLINED {
      if (!cone.is_outside(d)) return;
      const Disc &disc = own.discs[d];
      const double mu = disc.mu, inverse = 1 / lengths[d], slip = length(mine);
      const auto t = (p - mine * step) * inverse;
      const auto h = slip > 0 ? mine * (1 / slip) : -t;
      const double m = mu * sum * height * inverse;
      change = step_across(t, p, u, m, rho, own.w_inverse, disc);
      const double along = inner(p, t), aligned = 1 + inner(h, t);
      slips = slips + mu * (inner(h + t, u) * own.w_inverse +
                            disc.ratio * (aligned * (mu * chi.p.n - along) + inner(h, change)));
      stiffness = stiffness + mu * mu * disc.ratio * aligned;
    }, chi.p.t, chi.v.t, v.t, changes);
    const double dp = -(v.n * own.w_inverse + slips) / (1 + stiffness);
    next.p.n = chi.p.n + dp;
    next.v.n = v.n + dp * own.w;
    for_each_disc([&](std::size_t d, const auto &p, const auto &mine, const auto &u, const auto &change, auto &to,
                      auto &left) NSCD_INLINED {
      if (!cone.is_outside(d)) return;
      const auto t = (p - mine * step) * (1 / lengths[d]);
      to = t * (own.discs[d].mu * next.p.n) + (p - t * inner(p, t)) + change;
      left = u + (to - p) * own.discs[d].w;
    }, chi.p.t, chi.v.t, v.t, changes, next.p.t, next.v.t);
    return next;
  }

  // Slips that friction would drive stick instead. Returns whether there are any.
  template <class Tangent>
  NSCD_INLINE static bool leave_driven(const FrictionalLocal<Tangent> &chi, const FrictionalLocal<Tangent> &next,
                                       const std::array<double, disc_count<Tangent>> &lengths, double step,
                                       DiscCone<Tangent> &cone)
  {
    bool any = false;
    for_each_disc([&](std::size_t d, const auto &p, const auto &mine, const auto &left) NSCD_INLINED {
      if (!cone.is_outside(d) || !(inner(left, (p - mine * step) * (1 / lengths[d])) > 0)) return;
      cone.leave(d);
      any = true;
    }, chi.p.t, chi.v.t, next.v.t);
    return any;
  }
};

}    // namespace nscd
