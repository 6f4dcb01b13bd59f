// SPDX-License-Identifier: GPL-2.0-or-later
// What fix nscd asks of the scene beside the contacts: round atoms, no second integrator, walls that fit the box.
#pragma once

#include "mpi_ranks.hpp"
#include "scene/views.hpp"
#include "settings/settings.hpp"

#include <pointers.h>

#include <set>
#include <string>

namespace LAMMPS_NS {

// Functions that require something raise nscd::Error, on all ranks.
class SceneChecks : protected Pointers {
 public:
  SceneChecks(LAMMPS *lmp, class Fix *fix, nscd::MpiRanks &ranks) : Pointers(lmp), fix_(fix), ranks_(ranks) {}

  void require_spheres(bool frictional) const;
  // At every new list: atoms may have come in, or into groups.
  void require_sole_integrator();
  void require_bonds_listed(const nscd::Grains &grains);
  // At a run's start.
  void require_steps() const;
  void require_walls_repeat(const nscd::Settings &settings);
  void require_future_bonds_listed() const;

  void tell_of_other_fixes_nscd() const;
  void tell_of_soft_contacts();
  void tell_of_soft_walls();
  // nscd_lmp.scene() leaves its walls in a variable; a fix that has none has forgotten them, or so it seems.
  void tell_of_forgotten_walls(const nscd::Settings &settings) const;
  // Again when atoms have come in; each fix once.
  void tell_of_force_holders();
  // What neigh_modify exclude leaves out of what could be contacts; empty if nothing.
  std::string exclusions(const nscd::Grains &grains);
  // Bits of the groups that fix freeze holds.
  int held_groups() const;
  // Bits of the groups of fixes nscd that come in a step before this one, and after it.
  struct OtherGroups {
    int earlier = 0, later = 0;
  };
  OtherGroups groups_of_other_fixes_nscd() const;
  // Whether something may read the contacts' rows at any step.
  bool rows_may_be_read() const;

 private:
  template <class First, class Second>
  bool can_meet(const nscd::Grains &grains, First first, Second second);
  bool lists_pairs(int bonds) const;
  bool moves_atoms_of(const class Fix &other, int held);

  class Fix *fix_;
  nscd::MpiRanks &ranks_;
  std::set<std::string> holders_told_of_, soft_walls_told_of_;   // IDs of fixes
  std::set<std::string> walls_told_of_;
  bool told_of_soft_contacts_ = false;
};

}    // namespace LAMMPS_NS
