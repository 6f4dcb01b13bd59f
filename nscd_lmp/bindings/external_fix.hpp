// The Python door: a whole step inside `fix external` or `fix python/invoke`, on LAMMPS' own arrays.
#pragma once

#include "../core/report.hpp"
#include "../core/step.hpp"
#include "library.hpp"
#include "python_ranks.hpp"

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
  // `cutoff`: pair cutoff plus skin, m, up to which centres are listed at a build. `ranks`: as PythonRanks takes it,
  // and `find_homes` a function of images' places and tags and of owned tags (nscd_lmp/ghost_homes.py); None on one
  // rank.
  ExternalFix(const Library &library, const std::string &id, const std::string &pair_style, double cutoff,
              int group_bit, const Settings &settings, Step::CustomSolver custom, nanobind::object ranks,
              nanobind::object find_homes);

  // Called by LAMMPS with the step's arrays: the signature of FixExternalFnPtr.
  static void callback(void *self, std::int64_t timestep, int owned, int *tags, double **x, double **f_external);
  // Called by fix python/invoke, as a Python function, with the LAMMPS object and its virial flag; raises nothing.
  void invoke(nanobind::handle lammps, int vflag);

  const Step &step() const { return step_; }
  // Hands over the rows since the last call.
  std::vector<StatsRow> take_stats() { return std::exchange(stats_, {}); }
  std::vector<std::string> take_remarks() { return step_.take_remarks(); }
  std::vector<std::string> doubts() const;  // about a scene before its first step
  void set_cutoff(double cutoff) { cutoff_ = cutoff; }

  // What stopped the run; empty if nothing did. Reading it forgets it.
  std::exception_ptr take_failure() { return std::exchange(failure_, nullptr); }
  bool failed() const { return bool(failure_); }

 private:
  void guarded(int first_call);
  void begin_run(int first_call);
  void advance();
  int setting(const char *name) const;
  void require_atoms() const;
  void require_last() const;
  void find_list();
  Grains arrays();
  Grains grains();
  void look_at_box();
  void require_all_grains(int owned);
  void find_homes(const Grains &grains);
  PairList pairs(const Grains &grains);
  void record(std::int64_t timestep);
  std::int64_t timestep() const;

  Library library_;
  std::string id_, pair_style_;
  double cutoff_;
  int group_bit_;
  std::unique_ptr<PythonRanks> ranks_;   // none on one rank
  nanobind::object find_homes_;
  Step step_;
  int list_ = -1;
  std::vector<int> atoms_, counts_, homes_;
  std::vector<int *> first_;
  std::vector<double> masses_;
  Box box_;
  std::vector<StatsRow> stats_;
  double largest_radius_ = 0;
  std::exception_ptr failure_;
};

}    // namespace nscd
