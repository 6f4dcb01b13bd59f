// EAL: enhanced augmented Lagrangian, a Newton step a visit on the unknown chi = (p, v~)
// (Barboteu & Dumont 2017, section 4.1, equation (26); Alart & Curnier 1991; Dumont 2013).
//
//   f~(chi) = ( v~ - v~_m(p) ;  p - proj(p - rho v~, R+ x B(0, mu p)) ),   df~/dchi Delta chi = -f~
//   inside the half-cylinder (contact):  v~ <- 0,  p <- p - v~_m / W~_nn
//   outside:                             p <- 0,   v~ <- velocity without this impulse
//
// Carried unknown, start and deviation as in EBP. Makes exact: the motion of the contact at each visit.
// Fails: as EBP. Without friction the half-cylinder is EBP's half-line and the iterates are the same.
#include "../nlgs.hpp"

namespace nscd {

struct Eal {
  static constexpr bool carries_velocity = true;
  static Local visit(Local chi, double v, double w_inverse, double rho)
  {
    const bool inside = chi.impulse > rho * w_inverse * chi.velocity;
    if (inside) return {chi.impulse - v * w_inverse, 0.0};
    return {0.0, v - chi.impulse / w_inverse};
  }
};

static const RegisterSolver eal({40, "eal", "EAL", "rho", 1.0, nlgs<Eal>});

}    // namespace nscd
