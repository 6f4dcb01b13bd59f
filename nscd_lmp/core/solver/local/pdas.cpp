// SPDX-License-Identifier: GPL-2.0-or-later
// Registers PDAS in NLGS; the law is in pdas.hpp, since APGS (global/apgs.cpp) visits by it too.
#include "solver/local/pdas.hpp"

#include "solver/nlgs.hpp"

namespace nscd {

static const RegisterSolver pdas(local_law<Pdas>(
    {.order = 50, .name = "pdas", .title = "PDAS", .parameter = "gamma", .default_parameter = 1.0}));

}    // namespace nscd
