// SPDX-License-Identifier: GPL-2.0-or-later
// Nonlinear Gauss-Seidel over the rows of a Delassus matrix: what nlgs.hpp does where there are no bodies.
//
// Local laws take a contact's own block as diag(W_nn, W_tt[, W_tt]), which is exact for spheres and discs. Where it is
// not, they get a diagonal that is larger than the block (majorant.hpp) and visit the contact again, with the
// block itself for the velocities, until a visit changes little: a proximal iteration inside the visit.
#pragma once

#include "contact/frame.hpp"
#include "solver/best_impulses.hpp"
#include "solver/iterate.hpp"
#include "solver/visit.hpp"

#include <algorithm>

namespace nscd {

template <class Law, class F>
class MatrixSweeps {
 public:
  using Tangent = typename F::Tangent;
  using Vector = Split<Tangent>;

  MatrixSweeps(GlobalProblem &problem, double parameter) :
      problem_(problem), parameter_(parameter), u_(problem.q.size())
  {
    if constexpr (Law::carries_velocity) carried_.assign(problem.contacts() * F::carried, 0.0);
  }

  // One sweep from p; returns the sum of the velocities that the visits corrected.
  double sweep(double share)
  {
    double corrected = 0;
    for (std::size_t k = 0; k < problem_.contacts(); ++k)
      if (problem_.diagonals[k].w > 0) corrected += visit(k, share);
    return corrected;
  }

  Criterion look()
  {
    problem_.w.multiply(problem_.p.data(), u_.data());
    for (std::size_t i = 0; i < u_.size(); ++i) u_[i] += problem_.q[i];
    return measure(problem_, F{}, u_.data(), Law::carries_velocity ? carried_.data() : nullptr);
  }

 private:
  Vector velocity(std::size_t k) const
  {
    const BlockMatrix &w = problem_.w;
    double v[F::dim];
    for (int i = 0; i < F::dim; ++i) v[i] = problem_.q[k * F::dim + i];
    for (auto at = w.row_start[k]; at < w.row_start[k + 1]; ++at) {
      const double *block = &w.block[std::size_t(at) * F::dim * F::dim];
      const double *p = &problem_.p[std::size_t(w.column[at]) * F::dim];
      for (int i = 0; i < F::dim; ++i)
        for (int j = 0; j < F::dim; ++j) v[i] += block[F::dim * i + j] * p[j];
    }
    return F::load(v);
  }

  // What the contact's own block makes of a change of its impulse.
  static Vector response(const double *block, const Vector &dp)
  {
    double in[F::dim], out[F::dim] = {};
    F::store(in, dp);
    for (int i = 0; i < F::dim; ++i)
      for (int j = 0; j < F::dim; ++j) out[i] += block[F::dim * i + j] * in[j];
    return F::load(out);
  }

  FrictionalLocal<Tangent> apply_law(const FrictionalLocal<Tangent> &now, const Vector &v, const OwnBlock<Tangent> &own,
                                     double share) const
  {
    if constexpr (F::dim > 1) {
      return visit_partly<Law>(now, v, own, parameter_, share);
    } else {
      const Local next = Law::visit(Local{now.p.n, now.v.n}, v.n, own.w_inverse, parameter_);
      return {{next.impulse, {}}, {next.velocity, {}}};
    }
  }

  double visit(std::size_t k, double share)
  {
    const bool exact = problem_.diagonals[k].exact;
    const OwnBlock<Tangent> own = own_block<F>(problem_, k);
    const Vector start = F::load(&problem_.p[k * F::dim]);
    Vector v = velocity(k);
    FrictionalLocal<Tangent> now{start, {}};
    if constexpr (Law::carries_velocity) now.v = load_carried<Tangent>(&carried_[k * F::carried]);
    double first = 0;
    for (int times = 0; times < (exact ? 1 : most_visits); ++times) {
      const FrictionalLocal<Tangent> next = apply_law(now, v, own, share);
      const Vector dp{next.p.n - now.p.n, next.p.t - now.p.t};
      now = next;
      const double change = most_of(own, dp);
      if (times == 0) first = change;
      if (exact || !(change > 1e-2 * first)) break;
      const Vector dv = response(problem_.w.diagonal(k), dp);
      v = {v.n + dv.n, v.t + dv.t};
    }
    if constexpr (Law::carries_velocity) store_carried<Tangent>(&carried_[k * F::carried], now.v);
    F::store(&problem_.p[k * F::dim], now.p);
    return first;
  }

  GlobalProblem &problem_;
  const double parameter_;
  std::vector<double> u_, carried_;
};

template <class Law>
struct MatrixNlgs {
  template <class F>
  static SolverReport solve(GlobalProblem &problem, const F &, const SolverOptions &options)
  {
    find_diagonals<F>(problem);
    MatrixSweeps<Law, F> sweeps(problem, options.parameter);
    Relaxation relaxation;
    const auto once = [&] {
      const double share = F::dim > 1 ? relaxation.share() : 1;
      const double corrected = sweeps.sweep(share) / share;
      relaxation.look(corrected);
      return corrected;
    };
    const auto look = [&](const Goal &) { return sweeps.look(); };
    const Extent all{problem.contacts(), free_norm(problem)};
    if constexpr (F::dim > 1) return iterate(all, options, once, look, BestMatrixImpulses(problem));
    else return iterate(all, options, once, look);
  }
};

}    // namespace nscd
