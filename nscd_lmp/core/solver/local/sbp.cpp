// SPDX-License-Identifier: GPL-2.0-or-later
// Registers SBP in NLGS; the law is in sbp.hpp, for whoever solves other mechanics than a scene's by it.
#include "solver/local/sbp.hpp"

namespace nscd {

static const RegisterSolver sbp(local_law<Sbp>(
    {.order = 10, .name = "sbp", .title = "SBP", .parameter = "rho", .default_parameter = 4.0 / 9.0}));

}    // namespace nscd
