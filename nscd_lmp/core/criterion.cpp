#include "criterion.hpp"
#include "hot.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

NSCD_HOT Criterion measure(const Problem &problem, const double *local_velocity)
{
  Criterion sum;
  double natural = 0;
  const Body *bodies = problem.bodies.data();
  const std::size_t n = problem.contacts.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Contact &c = problem.contacts[k];
    const double v = normal_velocity(c, bodies) + c.bias;
    const double w = 1 / c.w_inverse;
    sum.bipotential += std::abs(v * c.impulse) + w * std::max(0.0, -c.impulse);
    sum.penetration += std::max(0.0, -v);
    const double residual = w * (c.impulse - std::max(0.0, c.impulse - v * c.w_inverse));
    natural += residual * residual;
    if (local_velocity) sum.motion += std::abs(local_velocity[k] - v);
  }
  if (n == 0) return sum;
  const double scale = 1 / (double(n) * (1 + problem.restitution));
  sum.motion *= scale;
  sum.bipotential *= scale;
  sum.penetration *= scale;
  if (natural == 0) return sum;
  // If nothing drives the contacts, what start impulses have left over is all there is: 1.
  sum.relative = problem.free_norm > 0 ? std::sqrt(natural) / problem.free_norm : 1;
  return sum;
}

}    // namespace nscd
