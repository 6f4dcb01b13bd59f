// Registers PDAS in NLGS; the law is in pdas.hpp, since APGS (solvers/apgs.cpp) visits by it too.
#include "solver/local/pdas.hpp"

#include "solver/nlgs.hpp"

namespace nscd {

static const RegisterSolver pdas(local_law<Pdas>(50, "pdas", "PDAS", "gamma", 1.0));

}    // namespace nscd
