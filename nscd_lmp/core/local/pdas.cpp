// PDAS: primal-dual active set (Barboteu & Dumont 2017, section 4.3, equations (37)-(41)).
//
//   tau = p - gamma v~
//   tau >= 0 (active):    v~ = 0,  p <- p - v~ / W~_nn
//   tau <  0 (inactive):  p <- 0
//
// Makes exact: the contact law of one contact, in one visit, when gamma = 1/W~_nn (the default, multiple 1):
// then tau is the exact impulse and the visit is its projection on p >= 0.
// Fails: gamma below 1/W~_nn keeps contacts active that pull (p < 0 for a sweep); above it drops contacts that
// push. Both heal in later sweeps unless the status flips forever: in the paper's sedimentation gamma from 0.05 to 2
// works, and 10 leaves a fifth of the steps unconverged, which they report.
#include "../nlgs.hpp"

namespace nscd {

struct Pdas {
  static constexpr bool carries_velocity = false;
  static Local visit(Local now, double v, double w_inverse, double gamma)
  {
    const double exact = now.impulse - v * w_inverse;
    const double tau = now.impulse - gamma * v * w_inverse;
    return {__builtin_expect_with_probability(tau >= 0, 1, 0.5) ? exact : 0.0, 0.0};
  }
};

static const RegisterSolver pdas({50, "pdas", "PDAS", "gamma", 1.0, nlgs<Pdas>});

}    // namespace nscd
