// SPDX-License-Identifier: GPL-2.0-or-later
#include "settings/settings.hpp"

#include "base/error.hpp"
#include "settings/keyword.hpp"
#include "settings/schemes.hpp"
#include "solver/solver.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

// tol of the velocities that the step would have without contacts, overlap of the smaller radius, budget in sweeps, of
// scenes with friction. What they buy is measured: docs/benchmarks.md, docs/friction_accuracy.md.
struct OfAccuracy {
  double tol, overlap;
  int budget;
};
constexpr OfAccuracy accuracies[] = {{1e-2, 1e-3, 10}, {1e-3, 5e-4, 30}, {1e-4, 1e-4, 300}};   // loose, normal, tight

constexpr double tol_of_paper = 1e-7;   // m/s

static const OfAccuracy &numbers(const Settings &s) { return accuracies[int(s.accuracy.value_or(Accuracy::normal))]; }

// What a range asks for, as an error says it.
static std::string asked_for(const Limits &range, bool whole)
{
  std::ostringstream text;
  if (range.hi < std::numeric_limits<double>::max())
    text << " is outside " << (range.lo_is_in ? "[" : "(") << range.lo << ", " << range.hi << "]";
  else if (whole) text << " must be at least " << range.lo;
  else text << " must be " << (range.lo_is_in ? ">= " : "> ") << range.lo;
  return text.str();
}

static void require_in_range(const Keyword &keyword, double value, const std::string &whose = "")
{
  if (keyword.range.has(value)) return;
  const bool whole = keyword.value.kind == "whole number";
  fail(whose, keyword.name, " = ", value, asked_for(keyword.range, whole), keyword.reason);
}

static void check_ranges(const Settings &s)
{
  for (const Keyword &keyword : keywords()) {
    const auto value = keyword.value.number ? keyword.value.number(s) : std::nullopt;
    if (value) require_in_range(keyword, *value);
  }
}

double solver_parameter(const Settings &s, const SolverEntry &solver)
{
  if (solver.parameter.empty()) return 0;
  return (solver.parameter == "rho" ? s.rho : s.gamma).value_or(solver.default_parameter);
}

static void check_parameter(const char *keyword, std::optional<double> value, const SolverEntry &solver)
{
  if (value && solver.parameter != keyword)
    fail("keyword ", keyword, " is not a parameter of solver ", solver.name, ", which takes ",
         solver.parameter.empty() ? "none" : solver.parameter);
}

// Calls f(material, whose) for what contacts have: those without their own, pairs, walls.
template <class F>
static void for_each_material(const Settings &s, F f)
{
  f(s.material, std::string());
  for (const PairMaterial &pair : s.pairs) f(pair.own.over({}), "material " + pair.types + ": ");
  for (const Wall &wall : s.walls) f(wall.own.over({}), wall.name + ": ");
}

static bool any_has(const Settings &s, double Material::*part)
{
  const auto has = [part](const auto &of) { return of.own.over({}).*part > 0; };
  return s.material.*part > 0 || std::any_of(s.pairs.begin(), s.pairs.end(), has) ||
      std::any_of(s.walls.begin(), s.walls.end(), has);
}

bool Settings::frictional() const { return any_has(*this, &Material::friction); }

bool Settings::restitutive() const
{
  return any_has(*this, &Material::restitution) || any_has(*this, &Material::e_t);
}

std::vector<std::string> doubts(const Settings &s)
{
  std::vector<std::string> said;
  for (std::size_t part = 0; part < material_parts.size(); ++part) {
    const auto has = [part](const PairMaterial &pair) { return pair.own.has(part) && pair.own.value(part) > 0; };
    const MaterialPart &of = material_parts[part];
    if (s.material.*of.value > 0 || std::none_of(s.pairs.begin(), s.pairs.end(), has)) continue;
    std::string walls;
    for (const Wall &wall : s.walls)
      if (!wall.own.has(part)) walls += (walls.empty() ? "" : ", ") + wall.name;
    if (!walls.empty())
      said.push_back("no " + std::string(of.name) + " on " + walls + ", and grains have theirs by types alone: give " +
                     "walls their own behind them, 0 if it is to be none");
  }
  return said;
}

// mu^2 must leave room beside 1 in a double.
constexpr double largest_coefficient = 1e6;

static void check_materials(const Settings &s)
{
  for_each_material(s, [&](const Material &material, const std::string &whose) {
    for (const MaterialPart &part : material_parts)
      require_in_range(find_keyword(part.name), material.*part.value, whose);
    const double mu = material.friction;
    if (mu > largest_coefficient && mu != stick)
      fail(whose, "friction = ", mu, " is more than ", largest_coefficient,
           ": use `stick` for contacts that do not slip");
  });
  if (s.material.e_t > 0 && !s.frictional())
    fail("e_t = ", s.material.e_t, " has no effect without friction: give `friction`, or leave e_t out");
  if (s.inertia && !s.frictional())
    fail("inertia has no effect without friction: grains do not spin; give `friction`, or leave inertia out");
}

void require_walls_repeat(std::span<const Wall> walls, const BoxEdges &box)
{
  for (const Wall &wall : walls) wall.shape->require_repeats(wall.name, box);
}

static void check_dimension(const Settings &s, int dimension)
{
  if (dimension != 2) {
    if (s.inertia == Inertia::disc) fail("inertia disc needs `dimension 2`: grains in space are spheres");
    return;
  }
  for (const Wall &wall : s.walls) wall.shape->require_planar(wall.name);
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
  const bool impacts = s.restitutive() && !s.frictional() && !looks_ahead;
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
  if (s.budget && *s.budget > 0 && s.criterion != Stop::natural)
    fail("budget goes with criterion natural: criterion paper does not say how good an answer is");
}

static void check_min_bounce(const Settings &s)
{
  if (s.min_bounce == 0) return;
  if (!s.restitutive()) fail("min_bounce = ", s.min_bounce, " has no effect without restitution: leave it out");
  if (!find_scheme(s.law).looks_ahead)
    fail("min_bounce goes with law gap: law ", s.law, " gives back e of the velocities at the start of a step");
}

static void check_overlap(const Settings &s)
{
  if (s.overlap && !find_scheme(s.law).looks_ahead)
    fail("overlap is a condition of law gap: law ", s.law, " sees contacts only once they overlap");
}

Settings checked(Settings s, int dimension)
{
  if (s.walls.size() > most_walls) fail(s.walls.size(), " walls are more than ", most_walls, ": join some in a mesh");
  const SolverEntry &solver = find_solver(s.solver);
  find_scheme(s.law);
  check_ranges(s);
  check_materials(s);
  choose_tolerance(s);
  check_budget(s);
  check_overlap(s);
  check_min_bounce(s);
  if (s.frictional() && !solver.friction)
    fail("solver ", solver.name, " is for contacts without friction: choose another, or leave friction out");
  check_parameter("rho", s.rho, solver);
  check_parameter("gamma", s.gamma, solver);
  check_dimension(s, dimension);
  return s;
}

}    // namespace nscd
