// SPDX-License-Identifier: GPL-2.0-or-later
// Registers EBP in NLGS; the law is in ebp.hpp, for whoever solves other mechanics than a scene's by it.
#include "solver/local/ebp.hpp"

namespace nscd {

static const RegisterSolver ebp(local_law<Ebp>(
    {.order = 30, .name = "ebp", .title = "EBP", .parameter = "rho", .default_parameter = 1.0}));

}    // namespace nscd
