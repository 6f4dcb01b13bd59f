// SPDX-License-Identifier: GPL-2.0-or-later
// The Python door: a whole step inside `fix external` or `fix python/invoke`, on LAMMPS' own arrays.
#pragma once

#include "library.hpp"
#include "list_reach.hpp"
#include "obstacle/obstacle.hpp"
#include "python_ranks.hpp"
#include "scene/wall_touches.hpp"
#include "step/report.hpp"
#include "step/step.hpp"
#include "told_pair.hpp"

#include <nanobind/nanobind.h>

#include <exception>
#include <memory>
#include <utility>
#include <vector>

namespace nscd {

// A row of .stats.
struct StatsRow {
  std::int64_t step;
  double columns[report_columns];
  double seconds_contacts, seconds_solver;
};

class ExternalFix {
 public:
  // `ranks`: as PythonRanks takes it, and `find_homes` a function of images' places and tags and of owned tags
  // (nscd_lmp/door/ghost_homes.py); None on one rank.
  ExternalFix(const Library &library, const std::string &id, int group_bit, const Settings &settings,
              Step::CustomSolver custom, nanobind::object ranks, nanobind::object find_homes);

  // Called by LAMMPS with the step's arrays: the signature of FixExternalFnPtr.
  static void callback(void *self, std::int64_t timestep, int owned, int *tags, double **x, double **f_external);
  // Called by fix python/invoke, as a Python function, with the LAMMPS object and its virial flag; raises nothing.
  void invoke(nanobind::handle lammps, int vflag);

  const Step &step() const { return step_; }
  // Of the last step that was taken, contact after contact, as fill_contact_rows has them.
  const std::vector<double> &contact_rows() const { return contact_rows_; }
  // Of the same step, wall after wall, over all ranks, all of which have to ask.
  std::vector<WallLoad> wall_loads() const;
  // Hands over the rows since the last call.
  std::vector<StatsRow> take_stats() { return std::exchange(stats_, {}); }
  std::vector<std::string> take_remarks();
  std::vector<std::string> doubts() const;  // about a scene before its first step
  // Before runs. `held`: bits of the groups of fix freeze; `movers`: fixes move grains that do not integrate them.
  void set_listed_pairs(ListedPairs listed);
  void set_fixes(int held, bool movers) { held_ = held, movers_ = movers; }
  // Communication cutoff, m, up to which there are images; if it is not known they reach as far as the list.
  void set_image_cutoff(double cutoff) { image_cutoff_ = cutoff; }

  // What stopped the run; empty if nothing did. Reading it forgets it.
  std::exception_ptr take_failure() { return std::exchange(failure_, nullptr); }
  bool failed() const { return bool(failure_); }

 private:
  void guarded(int first_call);
  void begin_run(int first_call);
  void advance(double elapsed);
  void require_next_step(double elapsed);
  void forget_places(double elapsed);
  BoxEdges box() const;
  void require_bonds_listed(const Grains &grains);
  int setting(const char *name) const;
  void require_atoms() const;
  void require_last() const;
  void take_materials();
  void find_list();
  Grains arrays();
  Grains grains();
  void look_at_box();
  void require_all_grains(int owned);
  void find_homes(const Grains &grains);
  PairList pairs(const Grains &grains);
  Images find_images() const;
  void record(std::int64_t timestep);
  void record_walls(const State &state);
  std::int64_t timestep() const;

  Library library_;
  std::string id_;
  int group_bit_;
  ToldPair pair_;
  std::string materials_;                // of pair style nscd, as the step has them
  std::unique_ptr<PythonRanks> ranks_;   // none on one rank
  nanobind::object find_homes_;
  Step step_;
  int list_ = -1;
  std::vector<int> atoms_, counts_, homes_;
  std::vector<int *> first_;
  std::vector<double> masses_;
  Box box_;
  std::vector<StatsRow> stats_;
  std::vector<double> contact_rows_;
  std::vector<WallTouch> wall_touches_;
  std::vector<WallLoad> wall_loads_;     // of this rank
  ListReach reach_;
  double list_reach_ = 0;
  bool new_list_ = true;              // a run has begun with one
  bool leaves_out_pairs_ = false;
  int held_ = 0;
  bool movers_ = false;
  BoxEdges last_box_{};
  std::int64_t last_step_ = 0;
  double image_cutoff_ = 0;
  Images images_;
  std::exception_ptr failure_;
};

}    // namespace nscd
