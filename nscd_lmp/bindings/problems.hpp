// SPDX-License-Identifier: GPL-2.0-or-later
// Contact problems without LAMMPS, for nscd_lmp.solve.
#pragma once

#include <nanobind/nanobind.h>

namespace nscd {

void bind_problems(nanobind::module_ &module);

}    // namespace nscd
