// SPDX-License-Identifier: GPL-2.0-or-later
// How far the neighbor list of a LAMMPS reaches whose C interface does not tell the cutoffs of pairs of types.
#pragma once

#include "parallel/ranks.hpp"
#include "scene/list/told_list.hpp"
#include "scene/views.hpp"

#include <string>
#include <vector>

namespace nscd {

// As nscd_lmp/door/inspection.py finds it.
struct ListedPairs {
  std::string pair_style;              // whose list is taken: of a hybrid one a sub-style
  double cutoff = 0;                   // pair cutoff plus skin, m, of the pair of types that has the largest
  std::vector<double> shorter{};       // (types, types), m, by which those of others are shorter; empty: all are equal
  bool cutoffs_known = true;           // otherwise every list is audited
};

class ListReach {
 public:
  void set(ListedPairs listed) { listed_ = std::move(listed), told_ = {}; }
  // What the pair style itself tells, in place of that; returns the list's number.
  int take(ToldList told);
  double told_images() const { return told_.images; }
  const std::string &pair_style() const { return listed_.pair_style; }
  double cutoff() const { return listed_.cutoff; }

  // Of a new list: the surface distance up to which it has all pairs of which one moves. `type`: (owned) from 1.
  double measure(const Grains &grains, const int *type, int types, Ranks *ranks) const;

  // The cutoffs of centres, beside a list's reach. `type` as above, of images too; both have to outlive the list.
  void tell_cutoffs(PairList &pairs, const int *type, int types);

  void begin_run() { next_audit_ = 0; }
  // Whether lists of the run leave out pairs nearer than `reach`, seen at a new one; `atoms`: of all ranks. Raises
  // Error if they do, unless the cutoffs are known, so that it is on purpose.
  bool leaves_out_pairs(const Grains &grains, const PairList &pairs, std::int64_t timestep, double atoms, Ranks *ranks);

 private:
  double cutoff_of(int a, int b, int types) const;

  ListedPairs listed_;
  ToldList told_;
  std::vector<double> cutoffs_;   // (types + 1, types + 1); LAMMPS counts types from 1
  std::int64_t next_audit_ = 0;   // timestep; 0: the run begins
  bool leaves_out_ = false;
};

}    // namespace nscd
