// SPDX-License-Identifier: GPL-2.0-or-later
#include "problem/criterion_of.hpp"

namespace nscd {

bool is_met_by_sums(const Criterion &criterion, const Goal &goal)
{
  return (goal.stop == Stop::paper ? criterion.total() : criterion.relative) < goal.tol;
}

Criterion measure(const Problem &problem, const double *local_velocity)
{
  return with_mechanics(problem, [&](const auto &mechanics) { return measure(problem, mechanics, local_velocity); });
}

template Criterion measure(const Problem &, const Frictionless &, const double *);
template Criterion measure(const Problem &, const Frictional<Planar> &, const double *);
template Criterion measure(const Problem &, const Frictional<Spatial> &, const double *);
template Criterion measure(const GlobalProblem &, const Frame<> &, const double *, const double *);
template Criterion measure(const GlobalProblem &, const Frame<1> &, const double *, const double *);
template Criterion measure(const GlobalProblem &, const Frame<2> &, const double *, const double *);

}    // namespace nscd
