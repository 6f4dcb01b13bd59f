// Everything one step works on: the arrays it was handed, and its own, kept from step to step.
#pragma once

#include "aligned.hpp"
#include "contact.hpp"
#include "settings.hpp"
#include "views.hpp"

#include <span>
#include <vector>

namespace nscd {

// Centre and radius of an atom where contacts are sought; `reach` widens the search, 0 for law moreau.
struct alignas(32) Sphere {
  Vec4 centre;  // fourth component 0
  double radius;
  double reach;
};

// A pair, or an atom and wall -1 - atom_j, too far apart for a contact but near enough to watch.
struct NearPair {
  int atom_i, atom_j;
};

struct State {
  const Settings &settings;
  Grains grains;
  double dt = 0;

  std::vector<Sphere> spheres;      // (owned + ghosts)
  std::vector<int> owner;           // (owned + ghosts) index of the body that an atom is (an image of)
  AlignedVector<Body> bodies;        // (owned + obstacle_copies)
  std::vector<Contact> contacts;
  std::vector<ContactInfo> infos;   // beside contacts
  std::vector<NearPair> found;           // listed pairs that are near enough, the first found_count entries
  std::size_t found_count = 0;
  std::vector<double> impact_impulse;    // N s per contact, of impacts resolved ahead of the contacts; or empty
  std::vector<Contact> listed_contacts;  // as found, before they are brought into the order of the sweep
  std::vector<ContactInfo> listed_infos;
  std::vector<NearPair> near;       // watched by law gap: made contacts if the solution drives them together
  AlignedVector<Vec4> displacement;  // (owned) from where contacts were sought to q_{k+1}

  double watch = 0;                 // surface distance within which pairs are watched, m
  double smooth_kick = 0;           // largest |dt f / m| of the step, m/s
};

// Walls are bodies of infinite mass. Several copies, used in turn: consecutive wall contacts then do not wait
// for each other's store to the same body.
constexpr int obstacle_copies = 16;

}    // namespace nscd
