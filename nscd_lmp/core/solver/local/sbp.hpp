// SPDX-License-Identifier: GPL-2.0-or-later
// SBP: standard bipotential, one Uzawa step a visit (Barboteu & Dumont 2017, section 4.2; Fortin et al. 2005).
//
//   tau = p - rho (v~ + mu |u_t| n),   p <- proj(tau, K_mu),   K_mu = { |p_t| <= mu p_n }
//
// The term mu |u_t| (de Saxce & Feng) makes the fixed point Coulomb's law with v_n = 0; without it, it is the convex
// relaxation, in which sliding grains lift with v_n = mu |u_t|. For stick K is a half-space and the term is left out.
// Makes exact: p in K_mu. The contact's own error shrinks by |1 - rho W~_nn| a visit, so rho decides.
// Default rho = 4/9 of 1/W~_nn: the best fixed step on a sphere's whole contact block W~_nn diag(1, 7/2, 7/2),
// 2 / (1 + 7/2); the normal direction alone would take 1 and be PDAS.
// Fails: diverges for rho >= 2/W~_nn (7/2 times earlier under friction), crawls for small rho.
// Without friction K_0 and SAL's half-cylinder are the same half-line: SBP and SAL give the same iterates.
#pragma once

#include "solver/local/disc_cone.hpp"
#include "solver/nlgs.hpp"

#include <algorithm>

namespace nscd {

struct Sbp {
  static constexpr bool carries_velocity = false;
  static Local visit(Local now, double v, double w_inverse, double rho)
  {
    const double tau = now.impulse - rho * w_inverse * v;
    return {std::max(0.0, tau), 0.0};
  }

  template <class Tangent>
  NSCD_INLINE static FrictionalLocal<Tangent> visit(const FrictionalLocal<Tangent> &now, const Split<Tangent> &v,
                                                    const OwnBlock<Tangent> &own, double rho)
  {
    const double step = rho * own.w_inverse;
    FrictionalLocal<Tangent> next;
    std::array<double, disc_count<Tangent>> lengths;
    double lift = 0;
    bool inside = true;
    for_each_disc([&](std::size_t d, const auto &u) NSCD_INLINED {
      if (!std::isinf(own.discs[d].mu)) lift = lift + own.discs[d].mu * length(u);
    }, v.t);
    const double tau = now.p.n - step * (v.n + lift);
    for_each_disc([&](std::size_t d, const auto &p, const auto &u, auto &to) NSCD_INLINED {
      to = p - u * step;
      lengths[d] = length(to);
      inside &= lengths[d] <= own.discs[d].mu * tau;   // an infinite mu bounds nothing where tau > 0
    }, now.p.t, v.t, next.p.t);
    next.p.n = tau;
    if (tau > 0 && inside) return next;
    const DiscCone<Tangent> cone(tau, lengths, own);
    next.p.n = cone.sum() / (1 + cone.squares());
    if (!(next.p.n > 0)) return {};
    for_each_disc([&](std::size_t d, auto &to) NSCD_INLINED {
      if (cone.is_outside(d)) to = to * (own.discs[d].mu * next.p.n / lengths[d]);
    }, next.p.t);
    return next;
  }
};

}    // namespace nscd
