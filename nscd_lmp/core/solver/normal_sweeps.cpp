// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/normal_sweeps_of.hpp"

namespace nscd {

template int part_normals(Problem &, const Frictional<Planar> &);
template int part_normals(Problem &, const Frictional<Spatial> &);

}    // namespace nscd
