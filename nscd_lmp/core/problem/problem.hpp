// SPDX-License-Identifier: GPL-2.0-or-later
// The velocity-level contact problem of one step, equation (17): what every solver is handed.
#pragma once

#include "base/storage.hpp"
#include "contact/contact.hpp"
#include "contact/mechanics.hpp"
#include "contact/material.hpp"
#include "problem/islands.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace nscd {

// A contact that pushes, or would have to, as its island sees it: two grains, or a grain twice, and (m/s)^2.
struct Joined {
  std::int32_t i, j;
  double residual2;
  double stake2;   // negative: it does not push, so it connects nothing, and is off in both of its islands
  bool connects() const { return stake2 >= 0; }
};

// A solver's own unknowns; kept between steps, so a steady step allocates nothing.
struct Workspace {
  std::vector<double> numbers{};
  std::vector<double> best{};  // impulses to come back to
  std::vector<double> normals{}, numbers_of_normals{};   // of sweeps along normals alone
  AlignedVector<Vec4> vectors{}, more_vectors{};
  std::vector<char> marks{};   // of bodies
  std::vector<std::int32_t> nearby{};   // contacts
  std::vector<Joined> joined{};
  Islands islands{};
};

// What the stopping rule compares `tol` with: criterion (42) in m/s, or the natural map over what velocities are worth.
enum class Stop { paper, natural };

// By the natural map no contact of a solved problem is off by more than this share of what it has at stake, and of an
// accepted one none by more than that.
constexpr double off_of_solved = 0.1, off_of_accepted = 1;

struct Goal {
  Stop stop = Stop::paper;
  double tol = 0;
  double worst = off_of_solved;
};

class Parts;
class Team;

struct Problem {
  std::span<Body> bodies;       // 32 B aligned; in: free velocities plus what the start impulses gave; out: solution
  std::span<Contact> contacts;  // in: start impulses; out: solution
  double free_norm = 0;         // ||v_free + bias||_2 over the contacts, the scale of the relative residual, m/s
  Workspace &workspace;
  Sliding sliding{};            // tangential impulses and spins, in and out as these; nothing in a frictionless scene
  Halo *halo = nullptr;         // bodies that contacts of other ranks touch too; none on one rank
  Team *team = nullptr;         // threads; none: the caller's alone
  const Parts *parts = nullptr;   // in which the contacts are ordered, for the team
  double round_off = 0;         // m/s: a residual of less a contact is none
  // What every contact has at stake, beside the contacts; then each is judged by its own (closer_look.hpp) once the
  // sums over all have met the goal.
  std::span<const ContactInfo> infos{};
  // Beside the contacts, where their biases hold restitution: scales v to v~ = v / (1 + e) in criterion (42); or empty.
  MaterialsOf restitution{};
  std::span<const double> per_approach{};   // beside the contacts, 1 / the approach that may be left, s/m; or empty
  bool judges_contacts = false;  // whether there are infos; the same on all ranks
  bool judges_islands = false;
  bool sums_paper = true;   // whether (42) is wanted beside the natural map, which looks on the way can do without
  Goal goal{};
};

// Calls f with the mechanics of the problem's contacts.
template <class Function>
auto with_mechanics(const Problem &problem, Function f)
{
  return with_mechanics(problem.sliding, problem.bodies.data(), f);
}

}    // namespace nscd
