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
                                                    const OwnBlock &own, double rho)
  {
    const double step = rho * own.w_inverse, tau = chi.p.n - step * chi.v.n;
    if (!(tau > 0)) return opened(chi, v, own);
    const Tangent tau_t = chi.p.t - chi.v.t * step;
    const double length2 = inner(tau_t, tau_t), radius = own.mu * tau;
    if (length2 <= radius * radius) return stuck(chi, v, own);
    const double inverse = 1 / std::sqrt(length2);
    const Tangent t = tau_t * inverse;
    const double normal = chi.p.n - v.n * own.w_inverse;
    const Tangent change = step_across(t, chi.p.t, v.t, radius * inverse, rho, own);
    const Tangent across = chi.p.t - t * inner(chi.p.t, t) + change;
    const Tangent p_t = t * (own.mu * normal) + across;
    const Tangent u_t = v.t + (p_t - chi.p.t) * own.wt;
    if (inner(u_t, t) > 0) return stuck(chi, v, own);  // friction would drive the slip
    return {{normal, p_t}, {0.0, u_t}};
  }
};

static const RegisterSolver eal(local_law<Eal>(
    {.order = 40, .name = "eal", .title = "EAL", .parameter = "rho", .default_parameter = 1.0}));

}    // namespace nscd
