// SPDX-License-Identifier: GPL-2.0-or-later
#include "problem/closer_look.hpp"

#include "base/hot.hpp"
#include "parallel/halo.hpp"
#include "problem/natural_map.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

// Of velocities, squared: what round-off leaves of bodies' speeds, and of what impulses do to them, is no residual.
constexpr double round_off2 = 1e-25;

// Of squares.
struct Look {
  double of_kicks2 = 0, worst2 = 0;

  // `push` is W_nn p. Returns the square of the residual, less round-off.
  NSCD_INLINE double add(const ContactInfo &info, double residual2, double push, double speed2)
  {
    constexpr double least = 1e-300;
    const double kick2 = info.kick * info.kick;
    const double left2 = std::max(0.0, residual2 - round_off2 * (speed2 + push * push));
    worst2 = std::max(worst2, left2 / (kick2 + info.free2 + push * push + least));
    of_kicks2 += kick2 > 0 ? left2 / kick2 : 0.0;
    return left2;
  }
};

// Normal velocity, and the square of the natural map.
struct Residual {
  double v, square;
};

NSCD_INLINE Residual frictionless(const Problem &problem, const Contact &c, double w)
{
  const double v = normal_velocity(c, problem.bodies.data()) + c.bias, off = natural_normal(w, c.impulse, v);
  return {v, off * off};
}

template <class M>
NSCD_INLINE Residual frictional(const Problem &problem, const Contact &c, double w, std::size_t k)
{
  const auto &slide = problem.sliding.template slides<M>()[k];
  const auto u = velocity<M>(c, problem.bodies.data(), problem.sliding.spins);
  const double v = u.n + c.bias, off = natural_normal(w, c.impulse, v);
  const double wt = (1 + problem.sliding.spin_response) * w, radius = coulomb_radius(slide.mu, c.impulse);
  const double slips = natural_tangential<typename M::Tangent>(wt, radius, slide.impulse, u.t + bias(slide));
  return {v, off * off + slips * slips};
}

// Looks at every contact and keeps those that do something in problem.workspace.joined, for their islands.
template <class ResidualOf>
NSCD_HOT Look look_at_contacts(const Problem &problem, ResidualOf residual_of)
{
  std::vector<Joined> &joined = problem.workspace.joined;
  joined.resize(problem.contacts.size() + 1);
  Look look;
  std::size_t count = 0;
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    const Contact &c = problem.contacts[k];
    const ContactInfo &info = problem.infos[k];
    fetch_bodies(problem.contacts[std::min(k + fetch_ahead, problem.contacts.size() - 1)], problem.bodies.data());
    const Body &bi = problem.bodies[c.i], &bj = problem.bodies[c.j];
    const double w = 1 / c.w_inverse, push = w * c.impulse;
    const Residual residual = residual_of(c, w, k);
    const double left2 = look.add(info, residual.square, push, speed2(bi) + speed2(bj));
    const double stake2 = info.free2 + info.kick * info.kick;
    joined[count] = {bi[3] > 0 ? c.i : c.j, bj[3] > 0 ? c.j : c.i, left2, push > 0 ? stake2 : -1};
    count += (push > 0) | (residual.v < 0);   // no branch, which would be mispredicted
  }
  joined.resize(count);
  return look;
}

Look look_at_contacts(const Problem &problem)
{
  Look look;
  if (problem.sliding.model == Model::frictionless)
    look = look_at_contacts(problem, [&](const Contact &c, double w, std::size_t) {
      return frictionless(problem, c, w);
    });
  with_friction(problem.sliding.model, [&]<class M>(M) {
    look = look_at_contacts(problem, [&](const Contact &c, double w, std::size_t k) {
      return frictional<M>(problem, c, w, k);
    });
  });
  return look;
}

// The natural map of the island where it is largest.
NSCD_HOT double worst_island(const Problem &problem)
{
  Workspace &w = problem.workspace;
  w.islands.find(problem.bodies.size(), w.joined, problem.halo);
  w.islands.clear_sums();
  for (const Joined &contact : w.joined) {
    w.islands.add(contact.i, {contact.residual2, std::max(0.0, contact.stake2)});
    if (!contact.connects()) w.islands.add(contact.j, {contact.residual2, 0});
  }
  if (problem.halo) problem.halo->sum(w.islands.sum(0));
  double worst = 0;
  for (int island = 0; island < w.islands.count(); ++island) {
    const auto [residual2, stake2] = w.islands.sum(island);
    // without a stake there is but a contact that does not push, which is judged by its own
    if (stake2 > 0) worst = std::max(worst, std::sqrt(residual2 / stake2));
  }
  return problem.halo ? problem.halo->max(worst) : worst;
}

}    // namespace

void look_closer(const Problem &problem, Criterion &seen)
{
  const Look look = look_at_contacts(problem);
  double sums[] = {look.of_kicks2, double(problem.contacts.size())};
  if (problem.halo) problem.halo->sum(sums);
  seen.worst = std::sqrt(problem.halo ? problem.halo->max(look.worst2) : look.worst2);
  seen.typical = sums[1] > 0 ? std::sqrt(sums[0] / sums[1]) : 0;
  if (seen.worst > problem.goal.worst || !problem.judges_islands) return;
  seen.island = std::max(seen.relative, worst_island(problem));
}

}    // namespace nscd
