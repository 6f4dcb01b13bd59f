// SPDX-License-Identifier: GPL-2.0-or-later
// Registers AUTO, which is in auto.hpp.
#include "solver/global/auto.hpp"

namespace nscd {

namespace {

const RegisterSolver registered({.order = 100,
                                 .name = "auto",
                                 .title = "auto",
                                 .kind = "global",
                                 .friction = true,
                                 .ranks = true,
                                 .solve = on_any_grains<Auto>,
                                 .solve_global = on_any_matrix<Auto>});

}    // namespace

}    // namespace nscd
