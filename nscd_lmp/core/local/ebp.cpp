// EBP: enhanced bipotential, a Newton step a visit on the unknown chi = (p, v~)
// (Barboteu & Dumont 2017, section 4.2, equations (30)-(36); Dumont 2013).
//
//   f(chi) = ( v~ - v~_m(p) ;  p - proj(p - rho v~, K_mu) ),     df/dchi Delta chi = -f
//   tau = p - rho v~ > 0 (contact):  v~ <- 0,  p <- p - v~_m / W~_nn
//   otherwise:                       p <- 0,   v~ <- velocity without this impulse
//
// chi is carried from visit to visit and starts at P = 0, v~ = 0. Deviation: one Newton step a visit; the
// paper loops to local convergence, which without friction is PDAS, iterate for iterate, and could not give
// the 2 iterations of its Table 1.
// Makes exact: the motion of the contact at each visit. Fails: the status lags a visit behind, so p < 0 can
// stand for a sweep. rho only weighs p against v~ in the status: too small is deaf to v~, hence slow.
#include "../nlgs.hpp"

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
};

static const RegisterSolver ebp({30, "ebp", "EBP", "rho", 1.0, nlgs<Ebp>});

}    // namespace nscd
