// Everything one step works on: the arrays it was handed, and its own, kept from step to step.
#pragma once

#include "storage.hpp"
#include "contact.hpp"
#include "friction.hpp"
#include "hot.hpp"
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

// What scenes with friction have beside bodies and contacts; empty otherwise.
struct Friction {
  Model model = Model::frictionless;
  double spin_response = 0;                 // m r^2 / I
  AlignedVector<Vec4> spins{};              // (bodies) surface velocity r omega, m/s; walls 0
  AlignedVector<Planar::Slide> planar{};    // beside contacts, one of the two
  AlignedVector<Spatial::Slide> spatial{};
  AlignedVector<Vec4> impact_impulse{};     // beside contacts, tangential, N s, of impacts; or empty

  template <class M>
  auto &slides()
  {
    if constexpr (std::is_same_v<M, Planar>) return planar;
    else return spatial;
  }
  template <class M>
  const auto &slides() const
  {
    return const_cast<Friction *>(this)->slides<M>();
  }
};

struct State {
  const Settings &settings;
  Grains grains;
  int dimension = 3;                     // 2: all grains in a plane z = const
  double dt = 0;

  std::vector<Sphere> spheres{};         // (owned + ghosts)
  std::vector<int> owner{};              // (owned + ghosts) index of the body that an atom is (an image of)
  AlignedVector<Body> bodies{};          // (owned + obstacle_copies)
  AlignedVector<Vec4> displacement{};    // (owned) from where contacts were sought to q_{k+1}
  std::vector<Contact> contacts{};
  std::vector<ContactInfo> infos{};      // beside contacts
  std::vector<double> impact_impulse{};  // beside contacts, N s, of impacts resolved ahead of them; or empty

  Friction friction{};

  std::vector<Candidate> found{};        // listed pairs that are near enough to watch, the first found_count
  std::size_t found_count = 0;
  std::vector<Candidate> touching{};     // contacts-to-be, in list order
  std::vector<Candidate> near{};         // watched by law gap: made contacts if the solution drives them together

  double watch = 0;                    // surface distance within which pairs are watched, m
  double smooth_kick = 0;              // largest |dt f / m| of the step, m/s
};

// Velocity of atom i at the start of the step, m/s.
NSCD_INLINE Vec4 start_velocity(const State &s, int i)
{
  const double *v = s.grains.v + 3 * std::size_t(i);
  return Vec4{v[0], v[1], v[2], 0};
}

// Walls are bodies of infinite mass. Several copies, used in turn: consecutive wall contacts then do not wait
// for each other's store to the same body.
constexpr int obstacle_copies = 16;

}    // namespace nscd
