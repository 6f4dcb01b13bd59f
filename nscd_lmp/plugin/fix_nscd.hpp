// SPDX-License-Identifier: GPL-2.0-or-later
// fix nscd: the script door. LAMMPS arrays in, velocities out; no numerics.
#pragma once

#include "listed_pairs.hpp"
#include "lost_grains.hpp"
#include "mpi_ranks.hpp"
#include "restart.hpp"
#include "scene/wall_touches.hpp"
#include "scene_checks.hpp"
#include "step/report.hpp"
#include "step/step.hpp"

#include <fix.h>

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {

class FixNscd : public Fix {
 public:
  FixNscd(LAMMPS *lmp, int narg, char **arg);
  ~FixNscd() override;
  int setmask() override;
  void init() override;
  void setup(int vflag) override;
  void final_integrate() override;
  void post_run() override;
  double compute_scalar() override;
  double compute_vector(int n) override;
  double compute_array(int row, int column) override;
  double memory_usage() override;
  void write_restart(FILE *file) override;
  void restart(char *) override {}
  int maxsize_restart() override;
  int size_restart(int atom_index) override;
  int pack_restart(int atom_index, double *to) override;
  void unpack_restart(int atom_index, int nth) override;
  int pack_forward_comm(int count, int *list, double *to, int pbc_flag, int *pbc) override;
  void unpack_forward_comm(int count, int first, double *from) override;

  // A fix wall/nscd has come or goes: the next init takes the others.
  void forget_walls() { walls_.clear(), knows_walls_ = false; }

 private:
  class PairNscd *pair() const;
  nscd::Settings with_pair(nscd::Settings settings) const;
  std::unique_ptr<nscd::Step> make_step(const nscd::Settings &settings);
  void take_scene();
  void require_own_walls_stand() const;
  void begin_walls();
  void give_to_walls();
  void check_run();
  void tell_of_exclusions();
  void find_list();
  void tell_doubts();
  nscd::Grains grains();
  void look_at_box();
  nscd::PairList pairs();
  void find_homes();
  void fill_local();
  bool local_rows_wanted() const;

  nscd::MpiRanks ranks_;
  SceneChecks checks_;
  LostGrains lost_;
  ListedPairs listed_;
  nscd::Settings keywords_;             // its own, without what the pair style and fixes wall/nscd add
  std::unique_ptr<nscd::Step> step_;
  std::vector<int> homes_;              // (owned + ghosts) rank that owns the atom; empty on one rank
  std::vector<double> masses_;          // per owned atom, where masses are per type
  std::vector<double> local_values_;
  std::vector<double *> local_rows_;
  nscd::Box box_;
  int held_ = 0;                        // bits of the groups of fix freeze
  SceneChecks::OtherGroups others_;     // bits of the groups of other fixes nscd
  bool rows_every_step_ = false;
  bool doubted_ = false, materials_doubted_ = false;
  nscd::Totals totals_;
  nscd::RestartRecords records_;
  int largest_record_ = 0;              // of all ranks
  std::string materials_;               // of the pair style, as it describes them; empty: it has none
  std::vector<class FixWallNscd *> walls_;   // of the run, behind its own
  bool knows_walls_ = false;
  std::vector<nscd::WallTouch> wall_touches_;
  std::vector<double> restart_words_;   // records that wait for the first run
  bool excludes_ = false;               // neigh_modify exclude leaves out pairs that could be contacts
  bigint atoms_told_of_ = 0;
  bigint steps_ = 0;                    // of the run
};

}    // namespace LAMMPS_NS
