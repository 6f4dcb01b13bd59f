// SPDX-License-Identifier: GPL-2.0-or-later
// The data that a sweep touches, laid out for it.
//
// A sweep visits contacts one after another and is bound by latency, not by arithmetic. Hence:
// one contact is one cache line (64 B), one body is one 32 B vector that brings its inverse mass along,
// and obstacles (walls, atoms outside the group) are bodies of infinite mass, so the loop has no branches.
#pragma once

#include "base/hot.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace nscd {

// Four doubles the compiler keeps in vector registers (two SSE2, one AVX).
using Vec4 = double __attribute__((vector_size(32)));

// Of members: AVX2 code (hot.hpp) takes all of them to lie like this, the baseline instruction set asks for 16 B.
constexpr std::size_t vec4_alignment = 32;

// {vx, vy, vz, 1/m}: velocity in m/s, inverse mass in 1/kg, 0 for an obstacle.
using Body = Vec4;

// One frictionless contact. The unknown is the normal impulse p >= 0 (N s) that pushes body i along the
// unit normal, which points from j to i; the contact law asks for
//     v = n.(v_i - v_j) + bias >= 0,  p >= 0,  v p = 0.
// `bias` is what the scheme adds: e v_n^k (Newton's impact law) or gap/dt (law gap).
struct alignas(64) Contact {
  alignas(vec4_alignment) Vec4 normal;   // unit, fourth component 0 so that a body's inverse mass is left alone
  double bias;      // m/s
  double w_inverse; // 1 / W_nn, W_nn = 1/m_i + 1/m_j, kg
  double impulse;   // N s
  std::int32_t i, j;
};
static_assert(sizeof(Contact) == 64);

// A pair of atoms, indices into the arrays of all atoms (ghosts too), or an atom and wall -1 - atom_j.
struct Candidate {
  std::int32_t atom_i, atom_j;
};

// A candidate that is no contact, and how far apart it was where contacts were sought, m.
struct Watched {
  Candidate pair;
  double gap;
};

// What a contact needs outside the sweep.
struct ContactInfo {
  double gap = 0;           // m, negative when overlapping; at detection, then at the end of the step
  double speed_before = 0;  // n.(v_i - v_j), drift included, at the start of the step, m/s
  std::uint64_t key = 0;    // identifies the contact across steps
  std::int32_t atom_i = 0, atom_j = 0;  // as in Candidate
  double radius = 0;        // of the smaller grain, m
  double kick = 0;          // what the smooth forces change of its grains' velocities, the larger of the two, m/s
  double free2 = 0;         // square of its velocity without impulses, biases and slip included, (m/s)^2
  double curve = 0;         // m, <= 0: by how much the plane of the contact is nearer than the gap (moment.hpp)
};

// What the velocities of a contact are worth, m/s: what forces give its grains in a step or, where none act, a small
// part of the speed at which they meet.
NSCD_INLINE double worth(const ContactInfo &info) { return std::max(info.kick, 1e-3 * std::abs(info.speed_before)); }

inline double dot(const Vec4 &a, const Vec4 &b)
{
  const Vec4 c = a * b;
  return (c[0] + c[1]) + (c[2] + c[3]);
}

// Square of a body's speed, (m/s)^2.
inline double speed2(const Vec4 &v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

// A grain of the contact; the other body may be an obstacle.
inline int grain_of(const Contact &c, const Body *bodies) { return bodies[c.i][3] > 0 ? c.i : c.j; }

// Asks for what a visit of the contact will need of its bodies: where they do not fit the cache, a sweep would wait for
// each of them. Always inlined: GCC drops the call of a function that does nothing but this, as one without effect.
NSCD_INLINE void fetch_bodies(const Contact &c, const Body *bodies)
{
  __builtin_prefetch(bodies + c.i, 1);
  __builtin_prefetch(bodies + c.j, 1);
}

// So many contacts ahead of the visit.
constexpr std::size_t fetch_ahead = 8;

// Normal relative velocity of the contact's bodies, m/s, > 0 when separating.
inline double normal_velocity(const Contact &c, const Body *bodies)
{
  return dot(c.normal, bodies[c.i] - bodies[c.j]);
}

// Hands the impulse `dp` (N s) to both bodies.
inline void apply_impulse(const Contact &c, double dp, Body *bodies)
{
  const Body bi = bodies[c.i], bj = bodies[c.j];
  bodies[c.i] = bi + c.normal * (dp * bi[3]);
  bodies[c.j] = bj - c.normal * (dp * bj[3]);
}

}    // namespace nscd
