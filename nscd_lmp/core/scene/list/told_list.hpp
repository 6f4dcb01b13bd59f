// SPDX-License-Identifier: GPL-2.0-or-later
// What one door tells the other of a neighbor list, as numbers: LAMMPS' C interface hands over nothing richer.
#pragma once

#include <cstddef>
#include <vector>

namespace nscd {

struct ToldList {
  int number = -1;                // among LAMMPS' lists; below 0: there is none
  int types = 0;                  // of atoms
  double beyond_radii = 0;        // as PairList has it, m
  double images = 0;              // up to which images of atoms are there, m; 0: not known, infinite: all
  std::vector<double> cutoffs{};  // (types + 1, types + 1) of centres, m

  std::vector<double> packed() const
  {
    std::vector<double> numbers{double(number), double(types), beyond_radii, images};
    numbers.insert(numbers.end(), cutoffs.begin(), cutoffs.end());
    return numbers;
  }
  static ToldList unpacked(const double *numbers)
  {
    ToldList told{int(numbers[0]), int(numbers[1]), numbers[2], numbers[3]};
    const std::size_t width = std::size_t(told.types) + 1;
    told.cutoffs.assign(numbers + 4, numbers + 4 + width * width);
    return told;
  }
};

}    // namespace nscd
