// SPDX-License-Identifier: GPL-2.0-or-later
#include "problem/delassus.hpp"

#include "contact/tangents.hpp"

#include <algorithm>

namespace nscd {

namespace {

// The directions of a contact in space, and what an impulse along them does to spins.
struct Directions {
  Vec4 along[3], turned[3];
};

std::vector<Directions> directions(const Problem &grains)
{
  const Model model = grains.sliding.model;
  std::vector<Directions> all(grains.contacts.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Vec4 n = grains.contacts[k].normal;
    all[k].along[0] = n;
    if (model == Model::frictionless) continue;
    const Tangents t = tangents(n, model);
    all[k].along[1] = t.first;
    all[k].along[2] = t.second;
    for (int a = 1; a < 3; ++a) all[k].turned[a] = cross(n, all[k].along[a]);
  }
  return all;
}

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
class Assembly {
 public:
  explicit Assembly(const Problem &grains) :
      grains_(grains), all_(directions(grains)), of_bodies_(grains), place_(grains.contacts.size(), -1)
  {
    w_.dim = unknowns(grains.sliding.model);
  }

  BlockMatrix take()
  {
    for (std::size_t k = 0; k < all_.size(); ++k) add_row(std::int32_t(k));
    return std::move(w_);
  }

 private:
  void add_row(std::int32_t k)
  {
    const std::int64_t first = w_.row_start.back();
    const Contact &c = grains_.contacts[k];
    const auto each = [&](auto f) {
      for (const int b : {c.i, c.j})
        if (grains_.bodies[b][3] > 0)
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
    w_.block.resize(w_.column.size() * w_.dim * w_.dim);
    each([&](int b, std::int32_t l) { add_block(k, l, b, &w_.block[std::size_t(place_[l]) * w_.dim * w_.dim]); });
  }

  // What an impulse at contact l does to contact k through body b.
  void add_block(std::int32_t k, std::int32_t l, int b, double *block) const
  {
    const double mobility = grains_.bodies[b][3], response = grains_.sliding.spin_response;
    const bool same_side = (grains_.contacts[k].i == b) == (grains_.contacts[l].i == b);
    const double push = same_side ? mobility : -mobility, turn = mobility * response;
    for (int i = 0; i < w_.dim; ++i)
      for (int j = 0; j < w_.dim; ++j)
        block[w_.dim * i + j] += push * dot(all_[k].along[i], all_[l].along[j]) +
            turn * dot(all_[k].turned[i], all_[l].turned[j]);
  }

  const Problem &grains_;
  const std::vector<Directions> all_;
  const ContactsOfBodies of_bodies_;
  std::vector<std::int64_t> place_;  // of a contact in w_.column, if the row at hand has it
  BlockMatrix w_;
};

// Velocities with the impulses as they are, biases included, along the frames.
std::vector<double> velocities(const Problem &grains)
{
  const int dim = unknowns(grains.sliding.model);
  std::vector<double> u(grains.contacts.size() * dim);
  for (std::size_t k = 0; k < grains.contacts.size(); ++k) {
    const Contact &c = grains.contacts[k];
    u[k * dim] = normal_velocity(c, grains.bodies.data()) + c.bias;
    with_friction(grains.sliding.model, [&]<class M>(M) {
      const auto &slide = grains.sliding.slides<M>()[k];
      const auto slip = velocity<M>(c, grains.bodies.data(), grains.sliding.spins).t + bias(slide);
      const Tangents t = tangents(c.normal, grains.sliding.model);
      u[k * dim + 1] = dot(t.first, M::in_space(c.normal, slip));
      if (dim == 3) u[k * dim + 2] = dot(t.second, M::in_space(c.normal, slip));
    });
  }
  return u;
}

void read_impulses(const Problem &grains, std::vector<double> &p, std::vector<double> &mu)
{
  const int dim = unknowns(grains.sliding.model);
  p.resize(grains.contacts.size() * dim);
  for (std::size_t k = 0; k < grains.contacts.size(); ++k) {
    const Contact &c = grains.contacts[k];
    p[k * dim] = c.impulse;
    with_friction(grains.sliding.model, [&]<class M>(M) {
      const auto &slide = grains.sliding.slides<M>()[k];
      mu.push_back(slide.mu);
      const Tangents t = tangents(c.normal, grains.sliding.model);
      p[k * dim + 1] = dot(t.first, M::in_space(c.normal, slide.impulse));
      if (dim == 3) p[k * dim + 2] = dot(t.second, M::in_space(c.normal, slide.impulse));
    });
  }
}

}    // namespace

BlockMatrix delassus(const Problem &grains) { return Assembly(grains).take(); }

AssembledProblem::AssembledProblem(const Problem &grains) :
    w_(delassus(grains)), q_(velocities(grains)), problem_{.w = w_, .q = {}, .mu = {}, .p = {}}
{
  read_impulses(grains, p_, mu_);
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

void AssembledProblem::write_back(Problem &grains) const
{
  const int dim = w_.dim;
  for (std::size_t k = 0; k < grains.contacts.size(); ++k) {
    Contact &c = grains.contacts[k];
    const double *p = &p_[k * dim], *start = &start_[k * dim];
    apply_impulse(c, p[0] - start[0], grains.bodies.data());
    c.impulse = p[0];
    with_friction(grains.sliding.model, [&]<class M>(M) {
      const Tangents t = tangents(c.normal, grains.sliding.model);
      auto &slide = grains.sliding.slides<M>()[k];
      const Vec4 along = t.first * p[1] + t.second * (dim == 3 ? p[2] : 0.0);
      const auto next = M::from_space(c.normal, along);
      apply_tangential<M>(c, next - slide.impulse, grains.sliding.spin_response, grains.bodies.data(),
                          grains.sliding.spins);
      slide.impulse = next;
    });
  }
}

}    // namespace nscd
