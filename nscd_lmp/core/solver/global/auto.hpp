// SPDX-License-Identifier: GPL-2.0-or-later
// AUTO: sweeps with momentum, and what comes after them where they would take longer than something else.
//
// APGS; where it seems to need more sweeps than factorisations cost (columns, mass ratios, last digits of small beds)
// the active set takes over from its iterate, with friction the interior point. Should that not end either, APGS goes
// on, and where it foresees no end, plain NLGS, which alone solves what is far from symmetric. The choice counts sweeps
// and contacts, never seconds: the same input gives the same bits.
//
// The cost of the active set in sweeps is that of a packing in space, n / 3 for n contacts (measured: 520 sweeps at
// 1,500 contacts, 14,000 at 32,000). With hardly more contacts than bodies they make columns and trees, which have no
// fill: then it is that of an assembly. The 20 or so factorisations of the interior point cost 14 n sweeps (18,000 at
// 1,300 contacts).
#pragma once

#include "solver/global/active_set.hpp"
#include "solver/global/apgs.hpp"
#include "solver/global/interior_point.hpp"
#include "solver/global/on_grains.hpp"
#include "solver/iterate_kept.hpp"
#include "solver/local/pdas.hpp"
#include "solver/nlgs.hpp"

#include <algorithm>
#include <type_traits>
#include <vector>

namespace nscd {

inline std::size_t touching_bodies(const Problem &problem)
{
  std::vector<char> &touches = problem.workspace.marks;
  touches.assign(problem.bodies.size(), 0);
  for (const Contact &c : problem.contacts)
    for (const int b : {c.i, c.j}) touches[b] = problem.bodies[b][3] > 0;
  return std::size_t(std::count(touches.begin(), touches.end(), 1));
}

// Whether the graph of the contacts is one without loops, or nearly.
inline bool is_thin(const Problem &problem)
{
  return double(problem.contacts.size()) < 1.2 * double(touching_bodies(problem));
}
inline bool is_thin(const GlobalProblem &problem)
{
  return double(problem.w.column.size()) < 4 * double(problem.contacts());
}

inline std::size_t count(const Problem &problem) { return problem.contacts.size(); }
inline std::size_t count(const GlobalProblem &problem) { return problem.contacts(); }

template <class AnyProblem>
double active_set_in_sweeps(const AnyProblem &problem)
{
  constexpr double assembly = 60;
  return is_thin(problem) ? assembly : std::max(assembly, double(count(problem)) / 3);
}

template <class AnyProblem>
double interior_point_in_sweeps(const AnyProblem &problem)
{
  return std::max(300.0, 14 * double(count(problem)));
}

// There only sweeps go on, which know of other ranks.
inline bool on_several_ranks(const Problem &problem) { return problem.halo; }
inline bool on_several_ranks(const GlobalProblem &) { return false; }

// One solver after another on the same iterate; iterations add up.
// `Contacts` is a mechanics, or the frame of a matrix.
template <class AnyProblem, class Contacts>
class Relay {
 public:
  Relay(AnyProblem &problem, const Contacts &contacts, const SolverOptions &options) :
      problem_(problem), contacts_(contacts), left_(options)
  {
    report_.converged = false;
  }

  template <class Solver>
  void hand_to(double alternative = 0)
  {
    if (is_over()) return;
    left_.alternative = alternative;
    left_.parameter = Solver::default_parameter;
    const std::size_t first = left_.history ? left_.history->size() : 0;
    const SolverReport done = Solver::solve(problem_, contacts_, left_);
    for (std::size_t k = first; left_.history && k < left_.history->size(); ++k)
      (*left_.history)[k].iterations += report_.iterations;
    report_.iterations += done.iterations;
    report_.criterion = done.criterion;
    report_.converged = done.converged;
    report_.accepted = done.accepted;
    report_.at_round_off = done.at_round_off;
    report_.ran_away |= done.ran_away;
    left_.maxiter -= done.iterations;
    left_.budget.spent += done.iterations;
  }

  // A factorisation that does not end is of no use to those that go on: where nothing can give way its impulses are as
  // large as round-off lets them be.
  template <class Solver>
  void try_factorising()
  {
    if (is_over()) return;
    IterateKept before;
    before.keep(problem_, contacts_);
    const Criterion seen = report_.criterion;
    hand_to<Solver>();
    const bool better = judged(report_.criterion, left_) < judged(seen, left_);
    if (report_.converged || (report_.at_round_off && better)) return;
    before.restore(problem_, contacts_);
    report_.criterion = seen;
    report_.at_round_off = false;
  }

  double sweeps_left() const { return left_.maxiter; }
  const SolverReport &report() const { return report_; }

 private:
  bool is_over() const { return report_.converged || report_.at_round_off || left_.maxiter < 1; }

  AnyProblem &problem_;
  const Contacts &contacts_;
  SolverOptions left_;
  SolverReport report_;
};

// The frame of contacts, or of what a mechanics makes of them.
template <class Contacts>
struct FrameOfContacts {
  using type = Contacts;
};
template <class Dynamics, class... Parts>
struct FrameOfContacts<Mechanics<Dynamics, Parts...>> {
  using type = typename Mechanics<Dynamics, Parts...>::Frame;
};

struct Auto {
  template <class AnyProblem, class Contacts>
  static SolverReport solve(AnyProblem &problem, const Contacts &contacts, const SolverOptions &options)
  {
    using F = typename FrameOfContacts<Contacts>::type;
    constexpr bool friction = F::dim > 1;
    using Factorising = std::conditional_t<friction, InteriorPoint, FactorisedFaces>;
    Relay<AnyProblem, Contacts> relay(problem, contacts, options);
    if (!on_several_ranks(problem)) {
      relay.template hand_to<Apgs>(friction ? interior_point_in_sweeps(problem) : active_set_in_sweeps(problem));
      relay.template try_factorising<Assembled<Factorising>>();
    }
    relay.template hand_to<Apgs>(relay.sweeps_left() / 2);
    relay.template hand_to<Nlgs<Pdas>>();
    return relay.report();
  }
};

}    // namespace nscd
