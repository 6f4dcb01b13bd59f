// SPDX-License-Identifier: GPL-2.0-or-later
// The neighbor list of the pair style that has all pairs of grains, and the images that were there when it was built.
#pragma once

#include "scene/views.hpp"

#include <lammps.h>
#include <neigh_list.h>

#include <vector>

namespace LAMMPS_NS {

struct ContactList {
  NeighList *list = nullptr;   // none: the pair style has no list
  double limit = 0;            // surface distance, m, beyond which it lists no pair, whatever the cutoffs
};

// Which atoms had images on this rank when the list was built: all within the communication cutoff of its part of the
// box. Along an axis that is not periodic there is nothing beyond the outermost parts.
nscd::Images images_of(LAMMPS *lmp);

// Of a hybrid pair style the list that those of its sub-styles are taken from.
ContactList find_contact_list(LAMMPS *lmp);

// (types + 1, types + 1) of centres, m: pair cutoffs plus skin, as lists are built with.
std::vector<double> list_cutoffs(LAMMPS *lmp);

// The list, cutoffs and images in numbers, as nscd::ToldList has them.
std::vector<double> told_list(LAMMPS *lmp);

}    // namespace LAMMPS_NS
