// SPDX-License-Identifier: GPL-2.0-or-later
// What the user chooses, and the checks on it: one place for both doors.
#pragma once

#include "contact/material.hpp"
#include "obstacle/obstacle.hpp"
#include "settings/materials.hpp"
#include "solver/solver.hpp"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace nscd {

// Moment of inertia: 2/5 m r^2 of a sphere, 1/2 m r^2 of a disc.
enum class Inertia { sphere, disc };

enum class Unconverged { ignore, warn, error };

// How good the answers of steps are with criterion natural, where tol, overlap and budget are not given.
enum class Accuracy { loose, normal, tight };

struct Wall {
  std::shared_ptr<const Obstacle> shape;
  OwnMaterial own{};   // what it has not is that of contacts without a material of their own
  int groups = 0;      // bits of those whose grains it touches; 0: all
  std::string name{};  // what messages call it
};

struct Settings {
  std::string solver = "auto";
  std::string law = "gap";
  Material material{};             // of contacts where pair or wall have none of their own
  std::vector<PairMaterial> pairs{};   // of later ones what they give holds
  Mixing mixing = Mixing::none;        // of pairs of types without a material, as pair_style nscd has it
  std::optional<Inertia> inertia{};    // none: disc in dimension 2, sphere otherwise
  std::optional<Accuracy> accuracy{};  // none: normal
  // On the criterion. None: natural, relative to the scene's own velocities; a tol of criterion paper is in m/s.
  std::optional<double> tol{};
  std::optional<Stop> criterion{};
  std::optional<double> overlap{};  // of the smallest radius: what a contact may be driven into another in a step
  int maxiter = 1000;
  std::optional<int> budget{};   // sweeps after which a step with friction may be accepted above tol; 0: never
  bool warmstart = true;
  std::optional<double> rho{};   // multiple of 1/W_nn; none: the solver's own default
  std::optional<double> gamma{};
  double theta = 0.5;            // law moreau
  double min_bounce = 0;         // law gap: pairs that meet slower than this stop, m/s
  double recovery = 0.2;         // law gap: share of an overlap given back per step, speed-limited
  Unconverged unconverged = Unconverged::warn;
  int threads = 1;               // of each rank
  std::vector<Wall> walls{};

  // Whether any contact has friction; whether any gives back what it stops.
  bool frictional() const;
  bool restitutive() const;
};

// Reads `keyword value ...` as fix nscd takes them; raises Error for an unknown keyword, one that is given twice or
// stands where it would not mean what it seems to, or a value that is no number.
void parse_keywords(Settings &settings, const std::vector<std::string> &words);

// A single contact of a solved step misses the mean criterion by about so many times `tol`.
constexpr double tolerances = 10;

// A residual over the velocities that matter, be it those that contacts have to stop or those that a step adds, beyond
// which what is solved is not to be trusted, whatever the criterion says.
constexpr double residual_worth_saying = 0.1;
// Of the bound on overlaps, by how much planes of lasting contacts may be nearer than the surface.
constexpr double share_of_planes = 0.5;
// Of tol, what impacts under restitution are solved to.
constexpr double tol_of_impacts = 1e-3;

// rho or gamma, whichever the solver takes, as a multiple of 1/W_nn; 0 if it takes none.
double solver_parameter(const Settings &settings, const SolverEntry &solver);

// When a step may be accepted.
Budget budget_of(const Settings &settings);

// The settings of Barboteu & Dumont (2017): `paper yes`.
void follow_paper(Settings &settings);

// Raises Error (value, limit, remedy) for anything out of range or that does not fit the dimension; fills in tol,
// criterion and overlap.
Settings checked(Settings settings, int dimension = 3);

// What is likely to be a mistake, though it is not refused: a wall that lacks what grains have by their types.
std::vector<std::string> doubts(const Settings &settings);

// Raises Error for a wall that is another one in the next image of the box.
void require_walls_repeat(std::span<const Wall> walls, const BoxEdges &box);

}    // namespace nscd
