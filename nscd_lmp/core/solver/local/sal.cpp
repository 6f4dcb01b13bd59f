// SPDX-License-Identifier: GPL-2.0-or-later
// Registers SAL in NLGS; the law is in sal.hpp, for whoever solves other mechanics than a scene's by it.
#include "solver/local/sal.hpp"

namespace nscd {

static const RegisterSolver sal(local_law<Sal>(
    {.order = 20, .name = "sal", .title = "SAL", .parameter = "rho", .default_parameter = 4.0 / 9.0}));

}    // namespace nscd
