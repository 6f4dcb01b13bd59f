// SPDX-License-Identifier: GPL-2.0-or-later
// Grains that leave the box: LAMMPS drops them when it builds a new list, and `thermo_modify lost` says whether they
// may.
#pragma once

#include "mpi_ranks.hpp"

#include <pointers.h>

#include <string>
#include <vector>

namespace LAMMPS_NS {

class LostGrains : protected Pointers {
 public:
  LostGrains(LAMMPS *lmp, nscd::MpiRanks &ranks) : Pointers(lmp), ranks_(ranks) {}

  // At every new list, on all ranks. Of those that have left since the last one returns nothing with `lost ignore`, a
  // warning with `lost warn`, and raises nscd::Error otherwise.
  std::string check();

 private:
  enum class Lost { ignore, warn, error };
  Lost mode() const;
  std::vector<tagint> gone() const;

  nscd::MpiRanks &ranks_;
  std::vector<tagint> before_;   // tags of this rank at the last list
  bigint known_ = 0;             // how many are missing that were told of
};

}    // namespace LAMMPS_NS
