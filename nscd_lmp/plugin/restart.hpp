// SPDX-License-Identifier: GPL-2.0-or-later
// The warm start in LAMMPS' restart files: every grain's record holds the impulses of its contacts, so they are read by
// whatever ranks read the grains.
#pragma once

#include "step/step.hpp"

#include <cstdint>
#include <map>
#include <vector>

namespace nscd {

// A record: its length, the unknowns of a contact, and the words of WarmStart, contact after contact.
class RestartRecords {
 public:
  // Sorts what is remembered to the grains of this rank, a contact to one of its two if they are there.
  void collect(Step &step, int owned, const std::int32_t *tag);

  int size(std::int32_t tag) const;
  int largest() const;
  // Writes the record of a grain; returns its length.
  int pack(std::int32_t tag, double *to) const;
  // Takes records as pack wrote them, and clears them; those of a scene with other unknowns are left alone.
  static void give(Step &step, std::vector<double> &records);

 private:
  static constexpr int head = 2;
  int unknowns_ = 1;
  std::map<std::int32_t, std::vector<double>> of_grain_;
};

}    // namespace nscd
