// What a solver of the contact problem is, and the one list of them.
//
// A solver is a function; its file registers it, and every choice list (fix nscd, attach, the command line),
// test and legend reads the registry. Adding one means adding one file to local/ (a law inside NLGS).
#pragma once

#include "criterion.hpp"

#include <string_view>
#include <vector>

namespace nscd {

struct SolverOptions {
  double tol = 1e-7;     // on criterion (42), m/s
  int maxiter = 1000;
  double parameter = 1;  // rho or gamma as a multiple of 1/W_nn
};

struct SolverReport {
  int iterations = 0;
  bool converged = true;
  Criterion criterion;
};

struct SolverEntry {
  int order;                    // place in choice lists and legends
  std::string_view name;        // keyword
  std::string_view title;       // for legends
  std::string_view parameter;   // "rho" or "gamma"
  double default_parameter;     // multiple of 1/W_nn
  SolverReport (*solve)(Problem &, const SolverOptions &);
};

const std::vector<SolverEntry> &solvers();

// Raises Error naming the choices.
const SolverEntry &find_solver(std::string_view name);

struct RegisterSolver {
  explicit RegisterSolver(const SolverEntry &entry);
};

}    // namespace nscd
