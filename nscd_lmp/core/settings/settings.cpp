// SPDX-License-Identifier: GPL-2.0-or-later
#include "settings/settings.hpp"

#include "base/error.hpp"
#include "parallel/team.hpp"
#include "settings/schemes.hpp"
#include "solver/solver.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

// tol of the velocities that the step would have without contacts, overlap of the smaller radius, budget in sweeps, of
// scenes with friction. What they buy is measured: docs/benchmarks.md, docs/friction_accuracy.md.
struct OfAccuracy {
  const char *name;
  double tol, overlap;
  int budget;
};
constexpr OfAccuracy accuracies[] = {{"loose", 1e-2, 1e-3, 10}, {"normal", 1e-3, 5e-4, 30}, {"tight", 1e-4, 1e-4, 300}};

constexpr double tol_of_paper = 1e-7;   // m/s

Unconverged parse_unconverged(const std::string &word)
{
  for (const auto policy : {Unconverged::ignore, Unconverged::warn, Unconverged::error})
    if (word == name(policy)) return policy;
  fail("unknown unconverged policy '", word, "': choose one of ignore, warn, error");
}

const char *name(Unconverged policy)
{
  switch (policy) {
    case Unconverged::ignore: return "ignore";
    case Unconverged::warn: return "warn";
    case Unconverged::error: return "error";
  }
  return "";
}

Stop parse_stop(const std::string &word)
{
  if (word == "paper") return Stop::paper;
  if (word == "natural") return Stop::natural;
  fail("unknown criterion '", word, "': choose one of paper, natural");
}

Accuracy parse_accuracy(const std::string &word)
{
  for (std::size_t k = 0; k < std::size(accuracies); ++k)
    if (word == accuracies[k].name) return Accuracy(k);
  fail("unknown accuracy '", word, "': choose one of loose, normal, tight");
}

static const OfAccuracy &numbers(const Settings &s) { return accuracies[int(s.accuracy.value_or(Accuracy::normal))]; }

static void require_range(const char *what, double value, double lo, double hi)
{
  if (!(value >= lo && value <= hi))
    fail(what, " = ", value, " is outside [", lo, ", ", hi, "]");
}

double solver_parameter(const Settings &s, const SolverEntry &solver)
{
  if (solver.parameter.empty()) return 0;
  return (solver.parameter == "rho" ? s.rho : s.gamma).value_or(solver.default_parameter);
}

static void check_parameter(const char *keyword, std::optional<double> value, const SolverEntry &solver)
{
  if (!value) return;
  if (!(*value > 0 && std::isfinite(*value)))
    fail(keyword, " = ", *value, " must be > 0: it is a multiple of 1/W_nn, and the default is a good start");
  if (solver.parameter != keyword)
    fail("keyword ", keyword, " is not a parameter of solver ", solver.name, ", which takes ",
         solver.parameter.empty() ? "none" : solver.parameter);
}

bool Settings::frictional() const
{
  return friction > 0 || std::any_of(walls.begin(), walls.end(), [](const Plane &w) { return w.friction > 0.0; });
}

// mu^2 must leave room beside 1 in a double.
constexpr double largest_coefficient = 1e6;

static void check_coefficient(const std::string &whose, double mu)
{
  if (!(mu >= 0))
    fail(whose, "friction = ", mu, " must be >= 0, or `stick` for contacts that do not slip");
  if (mu > largest_coefficient && mu != stick)
    fail(whose, "friction = ", mu, " is more than ", largest_coefficient,
         ": use `stick` for contacts that do not slip");
}

static void check_friction(const Settings &s)
{
  check_coefficient("", s.friction);
  for (std::size_t k = 0; k < s.walls.size(); ++k)
    check_coefficient("wall " + std::to_string(k + 1) + ": ", s.wall_friction(k));
  require_range("e_t", s.e_t, 0, 1);
  if (s.frictional()) return;
  if (s.e_t > 0) fail("e_t = ", s.e_t, " has no effect without friction: give `friction`, or leave e_t out");
  if (s.inertia)
    fail("inertia has no effect without friction: grains do not spin; give `friction`, or leave inertia out");
}

static void normalise(Plane &wall, std::size_t index)
{
  double *n = wall.normal;
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (double component : {length, wall.point[0], wall.point[1], wall.point[2]})
    if (!std::isfinite(component))
      fail("wall ", index + 1, ": point and normal must be finite numbers");
  if (!(length > 0))
    fail("wall ", index + 1, ": the normal is (0, 0, 0); give a vector that points into the free side");
  for (int d = 0; d < 3; ++d) n[d] /= length;
}

static void check_dimension(const Settings &s, int dimension)
{
  if (dimension != 2) {
    if (s.inertia == Inertia::disc) fail("inertia disc needs `dimension 2`: grains in space are spheres");
    return;
  }
  for (std::size_t k = 0; k < s.walls.size(); ++k)
    if (s.walls[k].normal[2] != 0)
      fail("wall ", k + 1, ": its normal has a z component, but the scene is planar (dimension 2): make it 0, or use "
           "dimension 3");
}

void follow_paper(Settings &s)
{
  s.solver = "pdas";
  s.law = "moreau";
  s.criterion = Stop::paper;
  s.tol = tol_of_paper;
  s.warmstart = false;
}

// Every impact makes or takes energy by up to tol of it, most of them make. Isolated ones are exact after a visit, so
// asking for more costs little; without friction only, where sweeps get there.
static double tol_of_accuracy(const Settings &s, bool looks_ahead)
{
  const bool impacts = s.restitution > 0 && !s.frictional() && !looks_ahead;
  return numbers(s).tol * (impacts ? tol_of_impacts : 1);
}

// A tol has the unit of its criterion, and giving one does not choose another criterion.
static void choose_tolerance(Settings &s)
{
  if (!s.criterion) s.criterion = Stop::natural;
  const bool of_scene = *s.criterion == Stop::natural;
  const bool looks_ahead = find_scheme(s.law).looks_ahead;
  if (of_scene && !s.overlap && looks_ahead) s.overlap = numbers(s).overlap;
  if (!of_scene && s.accuracy)
    fail("accuracy goes with criterion natural: a tol of criterion paper is in m/s, so no word says what it is worth");
  if (!s.tol) s.tol = of_scene ? tol_of_accuracy(s, looks_ahead) : tol_of_paper;
  if (!(*s.tol > 0 && std::isfinite(*s.tol)))
    fail("tol = ", *s.tol, " must be > 0: it is the value of the criterion at which a step is solved");
  if (s.criterion == Stop::natural && *s.tol > residual_worth_saying)
    fail("tol = ", *s.tol, " must be <= ", residual_worth_saying, " with criterion natural: it is a share of the "
         "velocities that contacts have to stop. A tolerance in velocity units has `criterion paper` beside it");
}

Budget budget_of(const Settings &s)
{
  constexpr double contacts = 2000;   // more than that cost what they cost
  if (s.budget) return {*s.budget, 0, s.maxiter};
  if (!s.frictional() || s.criterion != Stop::natural) return {};
  return {numbers(s).budget, contacts * numbers(s).budget, s.maxiter};
}

static void check_budget(const Settings &s)
{
  if (!s.budget) return;
  if (*s.budget < 0)
    fail("budget = ", *s.budget, " must be at least 0: sweeps after which a step may be accepted, 0 for never");
  if (*s.budget > 0 && s.criterion != Stop::natural)
    fail("budget goes with criterion natural: criterion paper does not say how good an answer is");
}

static void check_overlap(const Settings &s)
{
  if (!s.overlap) return;
  if (!(*s.overlap > 0 && *s.overlap <= 1))
    fail("overlap = ", *s.overlap, " is outside (0, 1]: it is a share of the smaller radius of a contact");
  if (!find_scheme(s.law).looks_ahead)
    fail("overlap is a condition of law gap: law ", s.law, " sees contacts only once they overlap");
}

Settings checked(Settings s, int dimension)
{
  const SolverEntry &solver = find_solver(s.solver);
  find_scheme(s.law);
  require_range("restitution", s.restitution, 0, 1);
  check_friction(s);
  require_range("theta", s.theta, 0, 1);
  require_range("recovery", s.recovery, 0, 1);
  choose_tolerance(s);
  check_budget(s);
  check_overlap(s);
  if (s.maxiter < 1) fail("maxiter = ", s.maxiter, " must be at least 1");
  if (s.frictional() && !solver.friction)
    fail("solver ", solver.name, " is for contacts without friction: choose another, or leave friction out");
  if (s.threads < 1 || s.threads > most_threads)
    fail("threads = ", s.threads, " is outside [1, ", most_threads, "]: they are of each rank, and share its contacts");
  check_parameter("rho", s.rho, solver);
  check_parameter("gamma", s.gamma, solver);
  for (std::size_t k = 0; k < s.walls.size(); ++k) normalise(s.walls[k], k);
  check_dimension(s, dimension);
  return s;
}

}    // namespace nscd
