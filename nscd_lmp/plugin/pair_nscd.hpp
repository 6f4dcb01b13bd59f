// SPDX-License-Identifier: GPL-2.0-or-later
// pair_style nscd: the materials of pairs of types, and the neighbor list that fix nscd takes its contacts from. It
// computes no force.
#pragma once

#include "settings/materials.hpp"

#include <pair.h>

#include <string>
#include <vector>

namespace LAMMPS_NS {

class PairNscd : public Pair {
 public:
  explicit PairNscd(LAMMPS *lmp);
  ~PairNscd() override;
  void compute(int eflag, int vflag) override;
  void settings(int narg, char **arg) override;
  void coeff(int narg, char **arg) override;
  void init_style() override;
  double init_one(int i, int j) override;
  void write_restart(FILE *file) override;
  void read_restart(FILE *file) override;
  void write_data(FILE *file) override;
  void write_data_all(FILE *file) override;
  void *extract(const char *what, int &dim) override;
  double memory_usage() override;

  // As they were given, a type with itself or a larger one.
  std::vector<nscd::PairMaterial> materials() const;
  // How the others come about, as `pair_modify mix` says.
  nscd::Mixing mixing() const;
  // All of that in words, as settings/told_pairs.hpp has them; never empty.
  std::string described() const;

 private:
  void allocate();
  void set(int i, int j, const nscd::OwnMaterial &own);
  nscd::OwnMaterial &own(int i, int j) { return own_[std::size_t(i) * (types_ + 1) + j]; }
  const nscd::OwnMaterial &own(int i, int j) const { return own_[std::size_t(i) * (types_ + 1) + j]; }
  void measure_radii();
  void choose_list();
  double approach_in_step() const;
  std::vector<double> intervals() const;

  std::size_t types_ = 0;
  std::vector<nscd::OwnMaterial> own_;     // (types + 1, types + 1), upper half
  std::vector<double> largest_radius_;     // (types + 1), m, of atoms that are there or that a fix will insert
  double mean_radius_ = 0;                 // m
  std::string told_materials_;             // for extract, as is the list
  std::vector<double> told_list_;
  double chosen_skin_ = -1;                // m
  bool chosen_multi_ = false;
};

}    // namespace LAMMPS_NS
