// The velocity-level contact problem of one step, equation (17): what every solver is handed.
#pragma once

#include "contact.hpp"
#include "friction.hpp"
#include "storage.hpp"

#include <span>
#include <vector>

namespace nscd {

// A solver's own unknowns; kept between steps, so a steady step allocates nothing.
struct Workspace {
  std::vector<double> numbers{};
  AlignedVector<Vec4> vectors{};
  std::vector<char> marks{};   // of bodies
};

class Halo;
class Parts;
class Team;

struct Problem {
  std::span<Body> bodies;       // 32 B aligned; in: free velocities plus what the start impulses gave; out: solution
  std::span<Contact> contacts;  // in: start impulses; out: solution
  double restitution = 0;       // e of (21); scales v to v~ = v / (1 + e) in the criterion
  double free_norm = 0;         // ||v_free + bias||_2 over the contacts, the scale of the relative residual, m/s
  Workspace &workspace;
  Sliding sliding{};            // tangential impulses and spins, in and out as these; nothing in a frictionless scene
  Halo *halo = nullptr;         // bodies that contacts of other ranks touch too; none on one rank
  Team *team = nullptr;         // threads; none: the caller's alone
  const Parts *parts = nullptr;   // in which the contacts are ordered, for the team
  double round_off = 0;         // m/s: a residual of less a contact is none
  bool approach_matters = false;   // whether the criterion has to know that of other ranks
};

}    // namespace nscd
