// SPDX-License-Identifier: GPL-2.0-or-later
#include "problems.hpp"

#include "arrays.hpp"
#include "grain_arrays.hpp"
#include "settings/settings.hpp"
#include "solver/solver.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <chrono>
#include <cmath>

namespace nb = nanobind;
using namespace nb::literals;

namespace nscd {

namespace {

template <class T>
using Array = nb::ndarray<const T, nb::c_contig, nb::device::cpu>;

struct Request {
  const SolverEntry &solver;
  SolverOptions options;
};

Request make_request(const std::string &solver, double tol, int maxiter, int budget, const std::string &criterion,
                     std::optional<double> parameter, std::vector<SolverReport> &history)
{
  const SolverEntry &entry = find_solver(solver);
  SolverOptions options;
  options.tol = tol;
  options.maxiter = maxiter;
  options.budget.sweeps = budget;
  options.parameter = parameter.value_or(entry.default_parameter);
  Settings settings;
  parse_keywords(settings, {"criterion", criterion});
  options.stop = *settings.criterion;
  options.history = &history;
  return {entry, options};
}

const char *status(const SolverReport &report, double residual)
{
  if (report.ran_away || !std::isfinite(residual)) return "diverged";
  if (report.accepted) return "accepted";
  return report.converged ? "solved" : "stalled";
}

// Runs it without the interpreter's lock and puts the outcome into a dictionary, but for impulse and velocity.
template <class Solve>
nb::dict outcome(const Request &request, Solve solve)
{
  SolverReport report;
  const auto start = std::chrono::steady_clock::now();
  {
    nb::gil_scoped_release unlocked;
    report = solve();
  }
  nb::dict d;
  d["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  d["iterations"] = report.iterations;
  const double residual = judged(report.criterion, request.options);
  d["status"] = status(report, residual);
  d["residual"] = residual;
  const std::vector<SolverReport> &rows = *request.options.history;
  d["history"] = make_array<double>(rows.size(), 6, [&](auto r, auto c) {
    const Criterion &at = rows[r].criterion;
    const double row[] = {double(rows[r].iterations), at.total(), at.motion, at.bipotential, at.penetration,
                          at.relative};
    return row[c];
  });
  return d;
}

void add_solution(nb::dict &d, std::size_t n, std::size_t dim, const std::vector<double> &impulse,
                  const std::vector<double> &velocity)
{
  d["impulse"] = make_array<double>(n, dim, [&](auto r, auto c) { return impulse[r * dim + c]; });
  d["velocity"] = make_array<double>(n, dim, [&](auto r, auto c) { return velocity[r * dim + c]; });
}

nb::dict solve_matrix(Array<std::int64_t> row_start, Array<std::int32_t> column, Array<double> block, Array<double> q,
                      Array<double> mu, Array<double> start, const std::string &solver, double tol, int maxiter,
                      int budget, const std::string &criterion, std::optional<double> parameter)
{
  const std::size_t n = q.shape(0), dim = q.shape(1);
  BlockMatrix w;
  w.dim = int(dim);
  w.row_start.assign(row_start.data(), row_start.data() + row_start.size());
  w.column.assign(column.data(), column.data() + column.size());
  w.block.assign(block.data(), block.data() + block.size());
  std::vector<double> p(start.data(), start.data() + start.size()), u(p.size());
  GlobalProblem problem{.w = w, .q = {q.data(), q.size()}, .mu = {mu.data(), mu.size()}, .p = p};
  std::vector<SolverReport> history;
  const Request request = make_request(solver, tol, maxiter, budget, criterion, parameter, history);
  nb::dict d = outcome(request, [&] { return request.solver.solve_global(problem, request.options); });
  w.multiply(p.data(), u.data());
  for (std::size_t i = 0; i < u.size(); ++i) u[i] += problem.q[i];
  add_solution(d, n, dim, p, u);
  return d;
}

// Bodies that many sweeps have changed carry round-off: where that hides what is left of the residual, sweeps go on
// from bodies that carry just the impulses.
SolverReport solve_on_grains(GrainProblem &grains, const Request &request)
{
  constexpr int most_times = 4;
  SolverReport report;
  SolverOptions options = request.options;
  for (int times = 0; times < most_times && options.maxiter > 0; ++times) {
    const int before = times > 0 ? report.iterations : 0;
    const std::size_t rows = options.history->size();
    report = request.solver.solve(grains.problem(), options);
    const bool met = report.converged;
    options.maxiter -= report.iterations;
    options.budget.spent += report.iterations;
    report.iterations += before;
    for (std::size_t row = rows; row < options.history->size(); ++row) (*options.history)[row].iterations += before;
    grains.rebuild_bodies();
    report.criterion = measure(grains.problem());
    const bool is_solved = solved(report.criterion, request.options);
    report.accepted = report.accepted && !is_solved && meets(report.criterion, request.options.accepted_goal());
    report.converged = is_solved || report.accepted;
    if (report.converged || !met) break;
  }
  return report;
}

nb::dict solve_spheres(Array<double> inverse_mass, Array<std::int32_t> body_i, Array<std::int32_t> body_j,
                       Array<double> normal, Array<double> tangents, Array<double> q, Array<double> mu,
                       Array<double> start, double spin_response, const std::string &solver, double tol, int maxiter,
                       int budget, const std::string &criterion, std::optional<double> parameter)
{
  const std::size_t n = q.shape(0), dim = q.shape(1);
  GrainProblem grains({n, inverse_mass.size(), dim, inverse_mass.data(), body_i.data(), body_j.data(), normal.data(),
                       tangents.data(), q.data(), mu.size() ? mu.data() : nullptr, start.data(), spin_response});
  std::vector<SolverReport> history;
  const Request request = make_request(solver, tol, maxiter, budget, criterion, parameter, history);
  nb::dict d = outcome(request, [&] { return solve_on_grains(grains, request); });
  add_solution(d, n, dim, grains.impulses(), grains.velocities());
  return d;
}

}    // namespace

void bind_problems(nb::module_ &m)
{
  m.def("solve_matrix", &solve_matrix, "row_start"_a, "column"_a, "block"_a, "q"_a, "mu"_a, "start"_a, nb::kw_only(),
        "solver"_a, "tol"_a, "maxiter"_a, "budget"_a, "criterion"_a, "parameter"_a.none());
  m.def("solve_spheres", &solve_spheres, "inverse_mass"_a, "body_i"_a, "body_j"_a, "normal"_a, "tangents"_a, "q"_a,
        "mu"_a, "start"_a, "spin_response"_a, nb::kw_only(), "solver"_a, "tol"_a, "maxiter"_a, "budget"_a,
        "criterion"_a, "parameter"_a.none());
}

}    // namespace nscd
