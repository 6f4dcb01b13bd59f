// SPDX-License-Identifier: GPL-2.0-or-later
// The Delassus matrix of any mechanics.
#pragma once

#include "contact/tangents.hpp"
#include "problem/delassus.hpp"

#include <algorithm>
#include <utility>

namespace nscd {

// Which contacts a body has: contact[start[b]] to contact[start[b + 1]]. Obstacles have none.
struct ContactsOfBodies {
  std::vector<std::int32_t> start, contact;

  explicit ContactsOfBodies(const Problem &grains) : start(grains.bodies.size() + 1)
  {
    const auto each = [&](auto f) {
      for (std::size_t k = 0; k < grains.contacts.size(); ++k)
        for (const int b : {grains.contacts[k].i, grains.contacts[k].j})
          if (grains.bodies[b][3] > 0) f(b, std::int32_t(k));
    };
    each([&](int b, std::int32_t) { ++start[b + 1]; });
    for (std::size_t b = 0; b + 1 < start.size(); ++b) start[b + 1] += start[b];
    contact.resize(start.back());
    std::vector<std::int32_t> next(start.begin(), start.end() - 1);
    each([&](int b, std::int32_t k) { contact[next[b]++] = k; });
  }
};

// Assembles W row by row.
template <class M>
class Assembly {
  using Wrench = typename M::Wrench;
  static constexpr int dim = M::Frame::dim;

 public:
  Assembly(const Problem &problem, const M &mechanics) :
      problem_(problem), mechanics_(mechanics), unit_(problem.contacts.size() * dim), of_bodies_(problem),
      place_(problem.contacts.size(), -1)
  {
    w_.dim = dim;
    for (std::size_t k = 0; k < problem.contacts.size(); ++k) find_units(k);
  }

  BlockMatrix take()
  {
    for (std::size_t k = 0; k < problem_.contacts.size(); ++k) add_row(std::int32_t(k));
    return std::move(w_);
  }

 private:
  // What a unit impulse along each axis of the contact comes to.
  void find_units(std::size_t k)
  {
    const Contact &c = problem_.contacts[k];
    const Axes axes(c.normal);
    const auto pair = mechanics_.load(c, k);
    for (int a = 0; a < dim; ++a) {
      double along[dim] = {};
      along[a] = 1;
      unit_[k * dim + a] = mechanics_.wrench(c, k, pair, axes.vector<typename M::Tangent>(along));
    }
  }

  void add_row(std::int32_t k)
  {
    const std::int64_t first = w_.row_start.back();
    const Contact &c = problem_.contacts[k];
    const auto each = [&](auto f) {
      for (const int b : {c.i, c.j})
        if (problem_.bodies[b][3] > 0)
          for (auto at = of_bodies_.start[b]; at < of_bodies_.start[b + 1]; ++at) f(b, of_bodies_.contact[at]);
    };
    each([&](int, std::int32_t l) {
      if (place_[l] >= first) return;
      place_[l] = std::int64_t(w_.column.size());
      w_.column.push_back(l);
    });
    std::sort(w_.column.begin() + first, w_.column.end());
    for (auto at = first; at < std::int64_t(w_.column.size()); ++at) place_[w_.column[at]] = at;
    w_.row_start.push_back(std::int64_t(w_.column.size()));
    w_.block.resize(w_.column.size() * dim * dim);
    each([&](int b, std::int32_t l) { add_block(k, l, b, &w_.block[std::size_t(place_[l]) * dim * dim]); });
  }

  // What an impulse at contact l does to contact k through body b.
  void add_block(std::int32_t k, std::int32_t l, int b, double *block) const
  {
    const bool k_first = problem_.contacts[k].i == b, l_first = problem_.contacts[l].i == b;
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        block[dim * i + j] +=
            mechanics_.dynamics().inner(b, unit_[k * dim + i], k_first, unit_[l * dim + j], l_first);
  }

  const Problem &problem_;
  const M &mechanics_;
  AlignedVector<Wrench> unit_;       // (contacts, dim)
  const ContactsOfBodies of_bodies_;
  std::vector<std::int64_t> place_;  // of a contact in w_.column, if the row at hand has it
  BlockMatrix w_;
};

template <class M>
BlockMatrix delassus(const Problem &problem, const M &mechanics)
{
  return Assembly<M>(problem, mechanics).take();
}

template <class M>
AssembledProblem::AssembledProblem(const Problem &grains, const M &mechanics) :
    w_(delassus(grains, mechanics)), problem_{.w = w_, .q = {}, .mu = {}, .p = {}}
{
  constexpr int dim = M::Frame::dim;
  q_.resize(grains.contacts.size() * dim);
  p_.resize(q_.size());
  for (std::size_t k = 0; k < grains.contacts.size(); ++k) {
    const Contact &c = grains.contacts[k];
    const Axes axes(c.normal);
    axes.read(mechanics.velocity(c, k), &q_[k * dim]);
    axes.read(mechanics.impulse(c, k), &p_[k * dim]);
    mechanics.each_coefficient(k, [&](double mu) { mu_.push_back(mu); });
  }
  start_ = p_;
  std::vector<double> given(p_.size());
  w_.multiply(p_.data(), given.data());
  for (std::size_t i = 0; i < q_.size(); ++i) q_[i] -= given[i];
  problem_.q = q_;
  problem_.mu = mu_;
  problem_.p = p_;
  problem_.per_approach = grains.per_approach;
  problem_.restitution = grains.restitution;
}

template <class M>
void AssembledProblem::write_back(Problem &grains, const M &mechanics) const
{
  using Vector = typename M::Vector;
  constexpr int dim = M::Frame::dim;
  for (std::size_t k = 0; k < grains.contacts.size(); ++k) {
    Contact &c = grains.contacts[k];
    const Vector now = mechanics.impulse(c, k), next = Axes(c.normal).vector<typename M::Tangent>(&p_[k * dim]);
    mechanics.push(c, k, {p_[k * dim] - start_[k * dim], next.t - now.t});
    mechanics.set_impulse(c, k, next);
  }
}

}    // namespace nscd
