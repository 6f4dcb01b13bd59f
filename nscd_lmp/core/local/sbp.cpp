// SBP: standard bipotential, one Uzawa step a visit (Barboteu & Dumont 2017, section 4.2; Fortin et al. 2005).
//
//   tau = p - rho v~,   p <- proj(tau, K_mu),   K_0 = { p_n >= 0, p_t = 0 }
//
// Makes exact: p in K_mu. The contact's own error shrinks by |1 - rho W~_nn| a visit, so rho decides.
// Default rho = 4/9 of 1/W~_nn: the best fixed step on a sphere's whole contact block W~_nn diag(1, 7/2, 7/2),
// 2 / (1 + 7/2), which is what friction will need; the normal direction alone would take 1 and be PDAS.
// Fails: diverges for rho >= 2/W~_nn (7/2 times earlier under friction), crawls for small rho.
// Without friction K_0 and SAL's half-cylinder are the same half-line: SBP and SAL give the same iterates.
#include "../nlgs.hpp"

#include <algorithm>

namespace nscd {

struct Sbp {
  static constexpr bool carries_velocity = false;
  static Local visit(Local now, double v, double w_inverse, double rho)
  {
    const double tau = now.impulse - rho * w_inverse * v;
    return {std::max(0.0, tau), 0.0};
  }
};

static const RegisterSolver sbp({10, "sbp", "SBP", "rho", 4.0 / 9.0, nlgs<Sbp>});

}    // namespace nscd
