// SPDX-License-Identifier: GPL-2.0-or-later
// A contact problem of grains, made from arrays instead of a step.
#pragma once

#include "problem/problem.hpp"

#include <vector>

namespace nscd {

// As nscd_lmp.ContactProblem.from_spheres takes them; n contacts, m bodies, dim unknowns a contact.
struct GrainArrays {
  std::size_t contacts, bodies, dim;
  const double *inverse_mass;        // (m)
  const std::int32_t *body_i, *body_j;  // (n), -1 for an obstacle
  const double *normal;              // (n, 3)
  const double *tangents;            // (n, dim - 1, 3)
  const double *q;                   // (n, dim)
  const double *mu;                  // (n), or null
  const double *start;               // (n, dim)
  double spin_response;
};

class GrainProblem {
 public:
  explicit GrainProblem(const GrainArrays &arrays);
  GrainProblem(const GrainProblem &) = delete;
  GrainProblem &operator=(const GrainProblem &) = delete;

  Problem &problem() { return problem_; }
  // Bodies from their impulses alone, so that velocities() has no round-off of the way there.
  void rebuild_bodies();
  std::vector<double> impulses() const;    // (n, dim) along normal and tangents
  std::vector<double> velocities() const;  // the same, q included

 private:
  Vec4 direction(std::size_t k, std::size_t along) const;
  Vec4 tangential(std::size_t k, const double *components) const;

  const GrainArrays arrays_;
  AlignedVector<Body> bodies_;
  AlignedVector<Vec4> spins_;
  std::vector<Contact> contacts_;
  AlignedVector<Slide<Planar>> planar_;
  AlignedVector<Slide<Spatial>> spatial_;
  Workspace workspace_;
  Problem problem_;
};

}    // namespace nscd
