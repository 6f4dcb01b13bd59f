#include "normal_sweeps.hpp"

#include "body_momentum.hpp"
#include "hot.hpp"
#include "local/pdas.hpp"
#include "momentum.hpp"
#include "nlgs.hpp"

#include <algorithm>

namespace nscd {

namespace {

// An exact visit along the normal that leaves the impulse as large as the tangential one needs it.
struct AtLeast : Pdas {
  static constexpr bool carries_velocity = true;
  static Local visit(Local now, double v, double w_inverse, double)
  {
    return {std::max(now.velocity, now.impulse - v * w_inverse), now.velocity};
  }
};

template <class M>
void find_least_normals(const Problem &problem, double *least)
{
  const auto *const slides = problem.sliding.slides<M>();
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    const double needed = slides[k].mu > 0 ? length(slides[k].impulse) / slides[k].mu : 0;
    least[k] = std::min(needed, problem.contacts[k].impulse);
  }
}

NSCD_HOT double largest_approach(const Problem &problem)
{
  double largest = 0;
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    const Contact &c = problem.contacts[k];
    largest = std::max(largest, -(normal_velocity(c, problem.bodies.data()) + c.bias) * problem.per_approach[k]);
  }
  return problem.halo ? problem.halo->max(largest) : largest;
}

}    // namespace

int part_normals(Problem &problem)
{
  constexpr int most = 300, looked_every = 8;
  const std::size_t n = problem.contacts.size();
  std::vector<double> &numbers = problem.workspace.normals;   // impulses before the last sweep, and the least ones
  numbers.resize(2 * n);
  double *const least = numbers.data() + n;
  for (std::size_t k = 0; k < n; ++k) numbers[k] = problem.contacts[k].impulse;
  with_friction(problem.sliding.model, [&]<class M>(M) { find_least_normals<M>(problem, least); });
  Pace pace(false);
  pace.momentum.previous = numbers.data();
  BodyMomentum bodies(problem, problem.workspace.more_vectors);
  int sweeps = 0;
  const auto some = [&](const Range &range) { return sweep<AtLeast, true>(problem, range, least, 1, pace.momentum); };
  do {
    for (int k = 0; k < looked_every; ++k, ++sweeps) {
      bodies.extrapolate(pace.momentum.share());
      pace.look(sweep_across(problem, some));
    }
  } while (sweeps < most && !(largest_approach(problem) <= 1));
  return sweeps;
}

}    // namespace nscd
