// SPDX-License-Identifier: GPL-2.0-or-later
// Registers APGS, which is in apgs.hpp, since AUTO (auto.hpp) begins with it.
#include "solver/global/apgs.hpp"

namespace nscd {

namespace {

const RegisterSolver registered({.order = 60,
                                 .name = "apgs",
                                 .title = "APGS",
                                 .kind = "global",
                                 .friction = true,
                                 .ranks = true,
                                 .solve = on_any_grains<Apgs>,
                                 .solve_global = on_any_matrix<Apgs>});

}    // namespace

}    // namespace nscd
