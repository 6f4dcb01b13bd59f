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
                                                    const OwnBlock &own, double rho)
  {
    const double step = rho * own.w_inverse, mu = own.mu;
    if (std::isinf(mu)) return chi.p.n - step * chi.v.n > 0 ? stuck(chi, v, own) : opened(chi, v, own);
    const double slip = length(chi.v.t), tau = chi.p.n - step * (chi.v.n + mu * slip);
    const Tangent tau_t = chi.p.t - chi.v.t * step;
    const double length2 = inner(tau_t, tau_t);
    if (tau > 0 && length2 <= mu * mu * tau * tau) return stuck(chi, v, own);
    const double tangential = std::sqrt(length2);
    if (!(tau + mu * tangential > 0)) return opened(chi, v, own);
    const double inverse = 1 / tangential, cone = 1 / (1 + mu * mu);
    const Tangent t = tau_t * inverse;
    const Tangent h = slip > 0 ? chi.v.t * (1 / slip) : -t;
    const double m = mu * (tau + mu * tangential) * cone * inverse;
    const Tangent change = step_across(t, chi.p.t, v.t, m, rho, own);
    const double along = inner(chi.p.t, t), aligned = 1 + inner(h, t);
    const double slips = inner(h + t, v.t) * own.w_inverse +
        own.ratio * (aligned * (mu * chi.p.n - along) + inner(h, change));
    const double dp = -(v.n * own.w_inverse + mu * slips) / (1 + mu * mu * own.ratio * aligned);
    const double normal = chi.p.n + dp;
    if (!(normal > 0)) return opened(chi, v, own);
    const Tangent p_t = t * (mu * normal) + (chi.p.t - t * along) + change;
    const Tangent u_t = v.t + (p_t - chi.p.t) * own.wt;
    if (inner(u_t, t) > 0) return stuck(chi, v, own);  // friction would drive the slip
    return {{normal, p_t}, {v.n + dp * own.w, u_t}};
  }
};

static const RegisterSolver ebp(local_law<Ebp>(
    {.order = 30, .name = "ebp", .title = "EBP", .parameter = "rho", .default_parameter = 1.0}));

}    // namespace nscd
