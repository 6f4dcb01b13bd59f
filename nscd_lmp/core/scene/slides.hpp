// SPDX-License-Identifier: GPL-2.0-or-later
// The tangential side of a step's contacts, over the whole state.
#pragma once

#include "contact/tangents.hpp"
#include "scene/spins.hpp"
#include "scene/state.hpp"

#include <span>

namespace nscd {

// Frictionless, planar or spatial: what the settings and the dimension of the scene ask for.
Model choose_model(const Settings &settings, int dimension);

// Biases of the contacts from `first` on: what drifts and, with restitution, e_t u_t, u_t at the start of the step.
void set_tangential_bias(State &state, std::size_t first, bool restitution);

// Keeps the velocities of the contacts [first, last), biases included, with the bodies as they are, as those without
// impulses (ContactInfo::free2); returns their 2-norm, m/s. In a frictionless scene these are the normal ones.
double keep_free_velocities(State &state, std::size_t first, std::size_t last);

// Sum of p_t (u_t^k + u_t^{k+1}) over the contacts, J: twice what friction gives to the grains.
double tangential_work(const State &state);

// Tangential impulse on body i of contact k, N s.
Vec4 tangential_impulse(const State &state, std::size_t k);

// Adds tangential impulses, one a contact or none at all, to those of the contacts; the bodies have them already.
void add_slide_impulses(State &state, std::span<const Vec4> impulses);

// Adds an impulse along the normal and a tangential one, in space, to contact k and its bodies, N s.
void add_impulse(State &state, std::size_t k, double normal, const Vec4 &tangential);

// The impulse of contact k along N, T1[, T2] of tangents(): reads it; takes it from contact and bodies; gives it to a
// contact that has none, and its bodies.
void read_impulse(const State &state, std::size_t k, double *components);
void remove_impulse(State &state, std::size_t k);
void write_impulse(State &state, std::size_t k, const double *components);

// What a solver sees.
Sliding sliding(State &state);

// Tangential velocity of contact k at the start of the step.
template <class M>
NSCD_INLINE typename M::Tangent slip_at_start(const State &s, std::size_t k)
{
  const Contact &c = s.table.contacts[k];
  alignas(vec4_alignment) Vec4 difference{}, spins{};
  for (const int b : {c.i, c.j}) {
    difference += start_velocity(s, b) * (b == c.i ? 1.0 : -1.0);
    if (b < s.moving()) spins += start_spin(s, b);
  }
  return M::slip(c.normal, difference, dot(c.normal, difference), M::spin(spins));
}

}    // namespace nscd
