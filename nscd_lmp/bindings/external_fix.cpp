// SPDX-License-Identifier: GPL-2.0-or-later
#include "external_fix.hpp"

#include "arrays.hpp"

#include "base/error.hpp"
#include "scene/doubts.hpp"
#include "scene/list/bonded.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace nscd {

// Steps since the run began, at the first call: fix external calls in the setup too, fix python/invoke does not.
constexpr int in_setup = 0, in_first_step = 1;

ExternalFix::ExternalFix(const Library &library, const std::string &id, int group_bit, const Settings &settings,
                         Step::CustomSolver custom, nanobind::object ranks, nanobind::object find_homes) :
    library_(library),
    id_(id), group_bit_(group_bit), pair_(library_, settings), materials_(pair_.materials()),
    ranks_(ranks.is_none() ? nullptr : std::make_unique<PythonRanks>(ranks)), find_homes_(std::move(find_homes)),
    step_(pair_.with(materials_), std::move(custom), setting("dimension"), ranks_.get(), setting("ntypes")),
    wall_loads_(step_.settings().walls.size())
{
}

void ExternalFix::callback(void *self, std::int64_t, int owned, int *, double **, double **f_external)
{
  static_cast<ExternalFix *>(self)->guarded(in_setup);
  // The contact forces are in LAMMPS' own force array, to which fix external adds this one.
  if (owned > 0) std::fill_n(f_external[0], 3 * std::size_t(owned), 0.0);
}

void ExternalFix::invoke(nanobind::handle, int) { guarded(in_first_step); }

// Nothing may be thrown through LAMMPS: what goes wrong is kept, the run is made to end after this step, and the
// caller of `run` raises it. Until then the arrays stay as they are.
void ExternalFix::guarded(int first_call)
{
  if (failure_) return;
  try {
    const double elapsed = library_.get_thermo(library_.handle, "elapsed");
    if (elapsed == first_call) begin_run(first_call);
    if (elapsed > 0) advance(elapsed);
  } catch (...) {
    failure_ = std::current_exception();
    library_.force_timeout(library_.handle);
  }
}

void ExternalFix::begin_run(int first_call)
{
  require_atoms();
  require_last();
  BoxEdges edges = box();
  const double *radius = library_.per_atom<double>("radius");
  for (int i = 0; i < setting("nlocal"); ++i) edges.radius = std::max(edges.radius, radius[i]);
  if (ranks_) ranks_->max({&edges.radius, 1});
  require_walls_repeat(step_.settings().walls, edges);
  take_materials();
  find_list();
  homes_.clear();
  reach_.begin_run();
  // A list that the setup built is as old as the run; grains stay where they are until the first step.
  new_list_ = setting("neigh_ago") <= first_call;
  step_.begin_run(new_list_);
  if (first_call == in_setup) step_.see(arrays());
}

void ExternalFix::advance(double elapsed)
{
  require_next_step(elapsed);
  try {
    const Grains g = grains();
    forget_places(elapsed);
    step_.advance(g, pairs(g), *library_.global<double>("dt"));
  } catch (const Error &refused) {
    fail(refused.what(), " (step ", timestep(), ")");
  }
  last_step_ = timestep();
  record(last_step_);
}

// `rerun` sets up frame after frame and takes no steps.
void ExternalFix::require_next_step(double elapsed)
{
  if (elapsed > 1 && timestep() != last_step_ + 1)
    fail("timestep ", timestep(), " follows ", last_step_, ": `rerun` reads frames, and each would be taken for a ",
         "step: detach before it");
}

// Scripts may move grains between runs and between the pieces of `run every`, and what moves the box moves grains.
void ExternalFix::forget_places(double elapsed)
{
  const BoxEdges now = box();
  if (elapsed <= 1 || std::memcmp(now.edge, last_box_.edge, sizeof now.edge) != 0) step_.forget_places();
  last_box_ = now;
}

// On all ranks; LAMMPS of before 2022 does not tell its special_bonds.
void ExternalFix::require_bonds_listed(const Grains &g)
{
  const auto *bonds = library_.global<std::int64_t>("nbonds");
  const double *lj = library_.global<double>("special_lj"), *coulomb = library_.global<double>("special_coul");
  if (!bonds || *bonds == 0 || !lj || !coulomb) return;
  Bonded bonded{library_.per_atom<const int *>("nspecial"), {}};
  for (int k = 0; k < 3; ++k) bonded.listed[k] = lj[k + 1] != 0 || coulomb[k + 1] != 0;
  if (bonded.all_listed()) return;
  // Templates keep the partners of their atoms to themselves.
  double tag = bonded.partners || g.owned == 0 ? find_unlisted(bonded, g) : g.tag[0];
  if (ranks_) ranks_->max({&tag, 1});
  require_listed(std::int32_t(tag));
}

int ExternalFix::setting(const char *name) const { return library_.extract_setting(library_.handle, name); }

void ExternalFix::require_atoms() const
{
  if (setting("radius_flag") != 1) fail("atoms have no radius: use atom_style sphere");
  if (step_.settings().frictional() && setting("omega_flag") != 1)
    fail("friction turns grains, but atoms have no angular velocity: use atom_style sphere, or leave friction out");
  if (setting("tagint") != 4) fail("this LAMMPS was built with 64-bit atom IDs; nscd needs 32-bit ones");
}

// Fixes act in the order of their definition: forces of one behind ours would be missed.
void ExternalFix::require_last() const
{
  char last[256] = "";
  library_.id_name(library_.handle, "fix", library_.id_count(library_.handle, "fix") - 1, last, sizeof last);
  if (id_ != last)
    fail("fix ", last, " was defined after attach by the script that runs the steps, and what it does would be missed: "
         "define it before, or give LAMMPS the commands one by one (lmp.command, commands_list or commands_string)");
}

// What pair_coeff has changed since the last run.
void ExternalFix::take_materials()
{
  const std::string now = pair_.materials();
  if (now == materials_) return;
  const Settings wanted = pair_.with(now);
  step_.change_materials(wanted.pairs, wanted.mixing);
  materials_ = now;
}

void ExternalFix::set_listed_pairs(ListedPairs listed)
{
  if (listed.pair_style == ToldPair::style && pair_.materials().empty())
    fail("pair_style nscd does not tell its materials: is the plugin that LAMMPS has loaded of another version? Use ",
         "`pair_style zero CUTOFF`");
  reach_.set(std::move(listed));
}

void ExternalFix::find_list()
{
  if (reach_.pair_style() == ToldPair::style) {
    list_ = reach_.take(pair_.list());
    if (list_ < 0)
      fail("pair_style nscd is gone, or has no neighbor list: give LAMMPS the commands one by one (lmp.command, ",
           "commands_list or commands_string), or detach first");
    image_cutoff_ = reach_.told_images();
    return;
  }
  list_ = library_.find_pair_neighlist(library_.handle, reach_.pair_style().c_str(), 1, 0, 0);
  if (list_ < 0)
    fail("pair_style ", reach_.pair_style(), " has no neighbor list: use pair_style zero CUTOFF, beside other styles ",
         "`pair_style hybrid/overlay zero CUTOFF ...` with `pair_coeff * * zero`");
}

std::int64_t ExternalFix::timestep() const { return *library_.global<std::int64_t>("ntimestep"); }

void ExternalFix::require_all_grains(int owned)
{
  double here = owned;
  if (ranks_) ranks_->sum({&here, 1});
  const double natoms = library_.get_natoms(library_.handle);
  if (here != natoms)
    fail(natoms - here, " of ", natoms, " grains left the box: close it with wall planes or boundary s or m, or take "
         "a smaller timestep");
}

void ExternalFix::find_homes(const Grains &g)
{
  namespace nb = nanobind;
  nb::gil_scoped_acquire gil;
  const auto tags = [&](int first, int count) {
    return make_array<int>(count, 0, [&](auto k, auto) { return g.tag[first + k]; });
  };
  const auto x = make_array<double>(g.ghosts, 3, [&](auto k, auto d) { return g.x[3 * (g.owned + k) + d]; });
  const auto homes = nb::cast<nb::ndarray<const int, nb::ndim<1>, nb::c_contig>>(
      find_homes_(x, tags(g.owned, g.ghosts), tags(0, g.owned)));
  homes_.assign(homes.data(), homes.data() + homes.shape(0));
  homes_.push_back(0);  // so that it is not empty where there are no images
}

std::vector<std::string> ExternalFix::doubts() const
{
  Grains g;
  g.owned = setting("nlocal");
  g.radius = library_.per_atom<double>("radius");
  g.mass = library_.per_atom<double>("rmass");
  g.tag = library_.per_atom<std::int32_t>("id");
  g.mask = library_.per_atom<int>("mask");
  g.type = library_.per_atom<int>("type");
  g.group = group_bit_;
  const bool spheres = setting("radius_flag") == 1 && setting("rmass_flag") == 1 && setting("tagint") == 4;
  std::vector<std::string> said = nscd::doubts(step_.settings());
  if (timestep() != 0 || !spheres) return said;
  for (const std::string &doubt : nscd::doubts(g, library_.get_natoms(library_.handle), ranks_.get()))
    said.push_back(doubt);
  return said;
}

Grains ExternalFix::grains()
{
  Grains g = arrays();
  // LAMMPS drops grains when it builds lists. Whether the list is new is the same on all ranks.
  const bool new_list = !ranks_ || setting("neigh_ago") <= 0 || homes_.empty();
  if (new_list) {
    require_all_grains(g.owned);
    require_bonds_listed(g);
  }
  if (ranks_) {
    if (new_list) find_homes(g);
    g.home = homes_.data();
  }
  return g;
}

std::vector<std::string> ExternalFix::take_remarks()
{
  std::vector<std::string> remarks = step_.take_remarks();
  if (std::exchange(leaves_out_pairs_, false))
    remarks.push_back("pairs of grains are near each other and not on the neighbor list, as `neigh_modify exclude` has "
                      "it: they are never contacts");
  return remarks;
}

void ExternalFix::record_walls(const State &state)
{
  if (wall_loads_.empty()) return;
  collect_wall_touches(state, wall_touches_);
  std::fill(wall_loads_.begin(), wall_loads_.end(), WallLoad{});
  for (const WallTouch &touch : wall_touches_) {
    const std::size_t wall = std::size_t(touch.wall);
    add_touch(wall_loads_[wall], touch, torque_point(*pair_.keywords().walls[wall].shape));
  }
}

std::vector<WallLoad> ExternalFix::wall_loads() const
{
  std::vector<WallLoad> loads = wall_loads_;
  if (ranks_ && !loads.empty()) ranks_->sum({loads[0].data(), loads.size() * loads[0].size()});
  return loads;
}

// LAMMPS' arrays, tags among them, are others by the time that somebody asks.
void ExternalFix::record(std::int64_t timestep)
{
  const State &state = step_.state();
  contact_rows_.resize(state.table.contacts.size() * contact_columns(state.in.settings));
  fill_contact_rows(state, contact_rows_.data());
  record_walls(state);
  const StepReport &report = step_.report();
  StatsRow row{timestep, {}, report.seconds_contacts, report.seconds_solver};
  for (int c = 0; c < report_columns; ++c) row.columns[c] = report_column(report, c);
  stats_.push_back(row);
}

}    // namespace nscd
