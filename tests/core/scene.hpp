// SPDX-License-Identifier: GPL-2.0-or-later
// Grains and a pair list made by hand, as LAMMPS would hand them to the core.
#pragma once

#include "step/step.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

using Point = std::array<double, 3>;

struct Scene {
  std::vector<double> x, v, f, omega, torque, radius, mass;
  std::vector<std::int32_t> tag;
  std::vector<int> mask;  // 1: moves, 2: an obstacle
  std::vector<int> type;  // from 1; empty where there is one
  std::vector<int> home;  // of images: rank that owns the grain; empty on one rank
  int owned = 0;
  bool newton = true;
  double reach = 1e9;     // the list below has all pairs
  double images = INFINITY;   // and all atoms are here
  bool just_built = true;

  // Returns the grain's index; images come after all grains.
  int add(const Point &centre, double r, double m = 1, const Point &velocity = {});
  int add_obstacle(const Point &centre, double r);
  int add_image(int of, const Point &shift);
  // Of a grain of another rank.
  int add_foreign_image(const Point &centre, double r, std::int32_t its_tag, int rank);

  // Sets the forces of the next step: m a on every grain, no torques.
  void accelerate(const Point &a);

  // Half list: pairs of grains once, pairs with an image once (newton) or from both sides.
  void list_all_pairs();
  void list_pairs(const std::vector<std::vector<int>> &neighbors_of);

  nscd::Grains grains();
  nscd::PairList pairs();
  // With the forces that are in f, where a step leaves its contact forces. Lists all pairs if there is no list yet.
  const nscd::StepReport &advance(nscd::Step &step, double dt);

 private:
  bool is_listed(int i, int j) const;

  std::vector<int> atoms_, counts_;
  std::vector<std::vector<int>> neighbors_;
  std::vector<const int *> first_;
};

// Settings from keywords, as fix nscd takes them.
nscd::Settings settings(const std::string &keywords);

// Six walls round the box [0, l] x [0, l] x [0, height], as keywords.
std::string box_walls(double l, double height);

// The contact of these two atoms or of atom i and wall -1 - j, in any order; null if there is none.
const nscd::Contact *find_contact(const nscd::State &state, int i, int j);

// What one rank has of a scene: its own grains, and images of all others. `owner` is the rank of a grain.
Scene part_of_rank(const Scene &all, int rank, const std::function<int(int grain)> &owner);

// Numbers in [lo, hi) that are the same on every machine, which the standard's distributions are not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double operator()(double lo = 0, double hi = 1);

 private:
  std::mt19937_64 engine_;
};

// n grains in [0, l]^3, no two of which overlap, radii up to `largest` and 4 times smaller, random velocities.
Scene random_scene(Random &random, int n, double l, double largest, double speed);
