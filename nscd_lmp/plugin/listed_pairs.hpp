// SPDX-License-Identifier: GPL-2.0-or-later
// The pairs that the steps of a run take from LAMMPS' neighbor list, and how far that list reaches.
#pragma once

#include "contact_list.hpp"
#include "mpi_ranks.hpp"

#include <pointers.h>

#include <vector>

namespace LAMMPS_NS {

class ListedPairs : protected Pointers {
 public:
  ListedPairs(LAMMPS *lmp, nscd::MpiRanks &ranks) : Pointers(lmp), ranks_(ranks) {}

  // At a run's start, since another pair style or other cutoffs may have come since the last. Returns false if the
  // pair style has no list.
  bool begin_run();
  // In a step, of a fix whose group has these bits. Collective at new lists.
  nscd::PairList pairs(int group);

 private:
  void measure_reach(int group);

  nscd::MpiRanks &ranks_;
  ContactList found_;
  double reach_ = 0;               // surface distance up to which all pairs were listed at the last build, m
  std::vector<double> cutoffs_;    // (types + 1, types + 1) of centres, m; empty: to be measured
  nscd::Images images_;
};

}    // namespace LAMMPS_NS
