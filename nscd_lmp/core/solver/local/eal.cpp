// SPDX-License-Identifier: GPL-2.0-or-later
// Registers EAL in NLGS; the law is in eal.hpp, for whoever solves other mechanics than a scene's by it.
#include "solver/local/eal.hpp"

namespace nscd {

static const RegisterSolver eal(local_law<Eal>(
    {.order = 40, .name = "eal", .title = "EAL", .parameter = "rho", .default_parameter = 1.0}));

}    // namespace nscd
