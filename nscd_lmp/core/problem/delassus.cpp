// SPDX-License-Identifier: GPL-2.0-or-later
#include "problem/delassus_of.hpp"

namespace nscd {

BlockMatrix delassus(const Problem &grains)
{
  return with_mechanics(grains, [&](const auto &mechanics) { return delassus(grains, mechanics); });
}

#define NSCD_ASSEMBLES(M) \
  template AssembledProblem::AssembledProblem(const Problem &, const M &); \
  template void AssembledProblem::write_back(Problem &, const M &) const

NSCD_ASSEMBLES(Frictionless);
NSCD_ASSEMBLES(Frictional<Planar>);
NSCD_ASSEMBLES(Frictional<Spatial>);

}    // namespace nscd
