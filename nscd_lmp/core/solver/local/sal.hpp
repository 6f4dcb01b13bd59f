// SPDX-License-Identifier: GPL-2.0-or-later
// SAL: standard augmented Lagrangian, one projected gradient step a visit
// (Barboteu & Dumont 2017, section 4.1, equations (23)-(25); Alart & Curnier 1991).
//
//   tau = p - rho v~,   p <- proj(tau, R+ x B(0, mu p_n))      with the new p_n
//
// Makes exact: p in the half-cylinder. Convergence as SBP: a factor |1 - rho W~_nn| a visit on its own contact;
// the default rho = 4/9 of 1/W~_nn has the same reason. Fails: diverges for rho >= 2/W~_nn (with friction 2/W_tt),
// crawls for small. Without friction the half-cylinder is a half-line, and SAL's iterates are SBP's.
#pragma once

#include "solver/nlgs.hpp"

#include <algorithm>

namespace nscd {

struct Sal {
  static constexpr bool carries_velocity = false;
  static Local visit(Local now, double v, double w_inverse, double rho)
  {
    const double augmented = now.impulse - rho * w_inverse * v;
    return {std::max(0.0, augmented), 0.0};
  }

  template <class Tangent>
  NSCD_INLINE static FrictionalLocal<Tangent> visit(const FrictionalLocal<Tangent> &now, const Split<Tangent> &v,
                                                    const OwnBlock<Tangent> &own, double rho)
  {
    const double step = rho * own.w_inverse;
    FrictionalLocal<Tangent> next;
    next.p.n = std::max(0.0, now.p.n - step * v.n);
    for_each_disc([&](std::size_t d, const auto &p, const auto &u, auto &to) NSCD_INLINED {
      to = onto_ball(p - u * step, coulomb_radius(own.discs[d].mu, next.p.n));
    }, now.p.t, v.t, next.p.t);
    return next;
  }
};

}    // namespace nscd
