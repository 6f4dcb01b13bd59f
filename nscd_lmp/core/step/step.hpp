// SPDX-License-Identifier: GPL-2.0-or-later
// One step of the scheme: arrays in, contacts, solver, arrays out. Both doors call this and nothing beneath it.
#pragma once

#include "parallel/halo.hpp"
#include "scene/detection.hpp"
#include "scene/drift/belts.hpp"
#include "scene/drift/drift.hpp"
#include "scene/left_places.hpp"
#include "scene/list/list_guard.hpp"
#include "scene/state.hpp"
#include "scheme/scheme.hpp"
#include "step/list_watch.hpp"
#include "step/remarks.hpp"
#include "step/rounds.hpp"
#include "step/solves.hpp"
#include "warm_start/warm_start.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

namespace nscd {

// What a step reports, written once, at its end; the columns of the stats table and of fix nscd's vector.
struct StepReport {
  std::int64_t contacts = 0;
  int iterations = 0;
  Criterion criterion;
  double largest_overlap = 0;        // m, at q_{k+1}
  double largest_overlap_ratio = 0;  // over the smaller radius of the pair
  double largest_move_ratio = 0;     // dt times the fastest grain's speed at the start, over the smallest radius
  double cutoff_to_list = 0;         // m, of a list that has all pairs that meet; 0: it had them
  double pushed = 0;                 // N s, sum of the normal impulses between grains, in boxes that stand still
  double passed2 = 0;                // N s, weighed by them: by how much of a diameter pairs pass each other, squared
  double dissipated_in_step = 0;     // J, by contacts
  double dissipated = 0;             // J, by contacts since begin_run
  long unconverged = 0;              // steps since begin_run
  long accepted_steps = 0;           // steps since begin_run
  long energy_limited = 0;           // steps since begin_run in which impulses were scaled back, since they made energy
  bool unread_torque = false;        // a frictionless step met torques
  bool converged = true;             // or accepted
  bool accepted = false;             // above tol, but good enough for the sweeps that it has cost
  bool jammed = false;               // unconverged, since obstacles approach and nothing can give way
  bool impacts_left = false;         // impacts under restitution that did not end were taken as inelastic
  double seconds_contacts = 0;       // detection, biases, update
  double seconds_solver = 0;
};

class Step {
 public:
  using CustomSolver = nscd::CustomSolver;

  // `dimension`: 3, or 2 for grains in a plane z = const; with the settings it decides how many unknowns a contact has.
  // Raises Error for bad settings, or for settings that do not fit the dimension.
  // `ranks`: those that share the scene; null for one. They must outlive the step.
  explicit Step(const Settings &settings, CustomSolver custom = {}, int dimension = 3, Ranks *ranks = nullptr,
                int types = 1);
  Step(const Step &) = delete;
  Step &operator=(const Step &) = delete;

  // Energy and unconverged steps count from here. `list_just_built`: the first step starts from its positions.
  void begin_run(bool list_just_built);

  // What radii and box are as the run starts, and where obstacles: without it the first step does not know what has
  // changed since. Local.
  void see(const Grains &grains)
  {
    drifts_.see(grains);
    belts_.see(grains);
  }

  // One step of length dt (s). Raises Error and leaves the arrays as they were if the input is bad, a contact
  // can be missed, or the step does not converge under `unconverged error`.
  const StepReport &advance(const Grains &grains, const PairList &pairs, double dt);

  // Something that is no integrator may have moved grains since the last step.
  void forget_places() { left_.forget(); }

  // Materials by pair of types, from the next step on. Raises Error if contacts have friction or restitution now and
  // had none before, or the other way round.
  void change_materials(const std::vector<PairMaterial> &pairs, Mixing mixing);
  // Walls behind the first `kept`, from the next step on, as they are then. Raises Error likewise.
  void change_walls(std::size_t kept, std::span<const Wall> others);

  const StepReport &report() const { return report_; }
  const Settings &settings() const { return settings_; }
  bool has_custom_solver() const { return solves_.is_custom(); }
  const State &state() const { return state_; }
  const Halo *halo() const { return halo_.get(); }
  // What users are to be told of the steps since they were last told.
  std::vector<std::string> take_remarks() { return remarks_.take(settings_, looks_ahead()); }
  // What users are to be told of threads without cores of their own; empty if there are none.
  const std::string &crowding() const { return crowding_; }

  // The impulses that the next step starts from, to be kept between runs.
  WarmStart &memory() { return memory_; }

  // After a step: true if the next one needs a fresh neighbor list to be sure of every contact. Collective.
  bool wants_rebuild() { return watch_.wants_rebuild(); }

 private:
  bool looks_ahead() const { return look_ahead_ > 0; }
  // What is known of a step before its contacts are.
  struct Seen {
    bool unread_torque;
    double move_ratio;
    double cutoff_to_list;     // m
  };
  // What contacts have done in a step, over all ranks.
  struct Tally {
    Overlap largest;
    double dissipated;         // J
    double pushed, passed2;    // as reported
  };
  // Since begin_run.
  struct Totals {
    double dissipated = 0;
    long unconverged = 0, accepted = 0, energy_limited = 0;
  };
  void change(const Settings &wanted);
  Seen prepare(const PairList &pairs);
  void count(const Solves::Outcome &solved);
  void refuse_unsolved(const Rounds::Result &rounds) const;
  Tally finish(double calmed);
  Tally tally_contacts(double calmed);
  void write_back();
  void write_report(const Seen &seen, const Rounds::Result &rounds, const Tally &tally, double seconds);

  Settings settings_;
  int types_;
  Materials materials_;
  const std::unique_ptr<Scheme> scheme_;
  State state_;
  const std::unique_ptr<Halo> halo_;   // none on one rank
  ListGuard list_;
  Belts belts_;
  Drifts drifts_;
  LeftPlaces left_;
  WarmStart memory_;
  StepReport report_;
  Totals totals_;
  Remarks remarks_;
  const double prediction_;        // contacts are sought at q_k + prediction dt v_k
  const double look_ahead_;        // and this times dt |v| around (0 or 1)
  ListWatch watch_{state_, list_, drifts_, prediction_, look_ahead_};
  Solves solves_;
  const Sought sought_;            // all pairs within reach where another round costs as much as the first
  Rounds rounds_;
  const std::string crowding_;
};

}    // namespace nscd
