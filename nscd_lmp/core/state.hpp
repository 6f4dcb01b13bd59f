// Everything one step works on: the arrays it was handed, and its own, kept from step to step.
#pragma once

#include "storage.hpp"
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

struct State {
  const Settings &settings;
  Grains grains;
  double dt = 0;

  std::vector<Sphere> spheres{};         // (owned + ghosts)
  std::vector<int> owner{};              // (owned + ghosts) index of the body that an atom is (an image of)
  AlignedVector<Body> bodies{};          // (owned + obstacle_copies)
  AlignedVector<Vec4> displacement{};    // (owned) from where contacts were sought to q_{k+1}
  std::vector<Contact> contacts{};
  std::vector<ContactInfo> infos{};      // beside contacts
  std::vector<double> impact_impulse{};  // beside contacts, N s, of impacts resolved ahead of them; or empty

  std::vector<Candidate> found{};        // listed pairs that are near enough to watch, the first found_count
  std::size_t found_count = 0;
  std::vector<Candidate> touching{};     // contacts-to-be, in list order
  std::vector<Candidate> near{};         // watched by law gap: made contacts if the solution drives them together

  double watch = 0;                    // surface distance within which pairs are watched, m
  double smooth_kick = 0;              // largest |dt f / m| of the step, m/s
};

// Walls are bodies of infinite mass. Several copies, used in turn: consecutive wall contacts then do not wait
// for each other's store to the same body.
constexpr int obstacle_copies = 16;

}    // namespace nscd
