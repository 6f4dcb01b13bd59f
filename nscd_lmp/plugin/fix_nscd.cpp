// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_nscd.hpp"

#include "base/error.hpp"
#include "pair_nscd.hpp"
#include "progress.hpp"
#include "scene/doubts.hpp"
#include "settings/told_pairs.hpp"
#include "wall_nscd.hpp"

#include <atom.h>
#include <comm.h>
#include <domain.h>
#include <error.h>
#include <force.h>
#include <modify.h>
#include <neighbor.h>
#include <output.h>
#include <update.h>

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace FixConst;

namespace {

// Runs `body`; what the core refuses ends the LAMMPS run with the core's own words.
template <class Body>
auto or_stop(Error *error, const char *id, Body body)
{
  try {
    return body();
  } catch (const nscd::Error &refused) {
    error->all(FLERR, std::string("Fix nscd ") + id + ": " + refused.what());
  }
}

// What the core refuses of a step, by its number.
template <class Body>
auto in_step(bigint step, Body body)
{
  try {
    return body();
  } catch (const nscd::Error &refused) {
    nscd::fail(refused.what(), " (step ", step, ")");
  }
}

// The core's alone: it knows no regions.
void require_own_kinds_of_walls(const std::vector<std::string> &words)
{
  for (std::size_t k = 0; k + 1 < words.size(); ++k)
    if (words[k] == "wall" && words[k + 1] == "region")
      nscd::fail("a region has a fix of its own as a wall: `fix ID group wall/nscd region ...`");
}

}    // namespace

FixNscd::FixNscd(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg), ranks_(world), checks_(lmp, this, ranks_),
    lost_(lmp, ranks_), listed_(lmp, ranks_)
{
  time_integrate = 1;
  dynamic_group_allow = 1;
  force_reneighbor = 1;
  next_reneighbor = -1;
  scalar_flag = vector_flag = array_flag = local_flag = 1;
  size_vector = nscd::report_columns;
  size_array_rows = 1;
  size_local_rows = size_local_cols = 0;
  global_freq = local_freq = 1;
  extscalar = extvector = extarray = 0;
  comm_forward = 1;
  restart_global = restart_peratom = 1;

  or_stop(error, id, [&] {
    require_own_kinds_of_walls({arg + 3, arg + narg});
    nscd::parse_keywords(keywords_, {arg + 3, arg + narg});
    require_own_walls_stand();
    nscd::Settings settings = with_pair(keywords_);
    // Friction and restitution may come by a fix wall/nscd.
    if (!settings.frictional()) settings.inertia.reset();
    if (!settings.restitutive()) settings.min_bounce = 0;
    step_ = make_step(settings);
    if (const PairNscd *style = pair()) materials_ = style->described();
  });
  // Last, since a fix that is refused above has no destructor to take it back.
  atom->add_callback(Atom::RESTART);
}

FixNscd::~FixNscd()
{
  if (modify->get_fix_by_id(id)) atom->delete_callback(id, Atom::RESTART);
}

int FixNscd::setmask() { return FINAL_INTEGRATE | POST_RUN; }

// The contact pairs come from the pair style's list: with pair_style zero it costs nothing more.
void FixNscd::find_list()
{
  if (!listed_.begin_run())
    error->all(FLERR,
               "Fix nscd {} needs the neighbor list of a pair style, and pair style {} has none: use pair_style nscd, "
               "alone with pair_coeff * *, or in hybrid/overlay with pair_coeff * * nscd",
               id, force->pair ? force->pair_style : "none");
}

PairNscd *FixNscd::pair() const
{
  Pair *found = force->pair_match("nscd", 1);   // null where there are several
  if (!found && force->pair_match("nscd", 1, 1))
    error->all(FLERR,
               "Fix nscd {}: a hybrid pair style has nscd more than once, and contacts have one material: use it once, "
               "for all types",
               id);
  return dynamic_cast<PairNscd *>(found);
}

nscd::Settings FixNscd::with_pair(nscd::Settings settings) const
{
  const PairNscd *style = pair();
  if (!style) return settings;
  nscd::require_no_pairs(settings, "keyword material");
  settings.pairs = style->materials();
  settings.mixing = style->mixing();
  return settings;
}

std::unique_ptr<nscd::Step> FixNscd::make_step(const nscd::Settings &settings)
{
  auto step = std::make_unique<nscd::Step>(settings, nscd::Step::CustomSolver{}, domain->dimension, &ranks_,
                                           atom->ntypes);
  // No less than ever: what reads the rows has asked how many columns there are. The array has as many, beyond the
  // totals zeros: `dump local f_ID[*]` takes as many columns as the global array has.
  size_local_cols = std::max(size_local_cols, nscd::contact_columns(settings));
  size_array_cols = std::max(nscd::totals_columns, size_local_cols);
  return step;
}

// A restart file knows how far fixes wall/nscd have moved.
void FixNscd::require_own_walls_stand() const
{
  for (const nscd::Wall &wall : keywords_.walls)
    if (wall.shape->after(0, 1)) nscd::fail(wall.name, " moves: use a fix wall/nscd for it, with the same words");
}

// What the pair style and fixes wall/nscd have made of the scene since the last run. Steps go on with other materials
// and walls; but whether contacts have friction, or restitution, is what a Step is made for.
void FixNscd::take_scene()
{
  walls_ = walls_of(lmp);
  knows_walls_ = true;
  nscd::Settings wanted = with_pair(keywords_);
  for (FixWallNscd *wall : walls_) wanted.walls.push_back(wall->begin_run());
  wanted = nscd::checked(wanted, domain->dimension);
  const nscd::Settings &now = step_->settings();
  if (wanted.frictional() != now.frictional() || wanted.restitutive() != now.restitutive()) {
    step_ = make_step(wanted);
  } else {
    const std::size_t own = keywords_.walls.size();
    if (!walls_.empty() || now.walls.size() > own) step_->change_walls(own, std::span(wanted.walls).subspan(own));
    const std::string materials = pair() ? pair()->described() : "";
    if (materials != materials_) step_->change_materials(wanted.pairs, wanted.mixing);
  }
  materials_ = pair() ? pair()->described() : "";
  records_.give(*step_, restart_words_);
}

void FixNscd::begin_walls()
{
  if (!knows_walls_)
    nscd::fail("a fix wall/nscd has come or gone, and `run ... pre no` does not look at fixes: leave `pre no` out");
  for (FixWallNscd *wall : walls_) {
    if (neighbor->ago == 0 || steps_ == 0) wall->require_inside(groupbit);
    wall->begin_step();
  }
}

void FixNscd::give_to_walls()
{
  if (walls_.empty()) return;
  nscd::collect_wall_touches(step_->state(), wall_touches_);
  const int own = int(keywords_.walls.size());
  for (const nscd::WallTouch &touch : wall_touches_)
    if (touch.wall >= own) walls_[std::size_t(touch.wall - own)]->add(touch);
}

void FixNscd::init()
{
  or_stop(error, id, [&] {
    take_scene();
    checks_.require_spheres(step_->settings().frictional());
    checks_.require_sole_integrator();
  });
  checks_.tell_of_other_fixes_nscd();
  checks_.tell_of_soft_contacts();
  checks_.tell_of_soft_walls();
  checks_.tell_of_forgotten_walls(step_->settings());
  if (materials_doubted_) return;
  materials_doubted_ = true;
  for (const std::string &doubt : nscd::doubts(step_->settings()))
    if (comm->me == 0) error->warning(FLERR, "Fix nscd {}: {}", id, doubt);
}

void FixNscd::check_run()
{
  or_stop(error, id, [&] {
    checks_.require_steps();
    checks_.require_walls_repeat(step_->settings());
    checks_.require_future_bonds_listed();
  });
  held_ = checks_.held_groups();
  others_ = checks_.groups_of_other_fixes_nscd();
  rows_every_step_ = checks_.rows_may_be_read();
  checks_.tell_of_force_holders();
  excludes_ = false;
  tell_of_exclusions();
}

// Again when atoms have come in.
void FixNscd::tell_of_exclusions()
{
  if (excludes_) return;
  atoms_told_of_ = atom->natoms;
  const std::string excluded = checks_.exclusions(grains());
  excludes_ = !excluded.empty();
  if (comm->me == 0 && excludes_) error->warning(FLERR, "Fix nscd {}: {}", id, excluded);
}

// Before the first step of a scene, once.
void FixNscd::tell_doubts()
{
  if (doubted_ || update->ntimestep != 0 || !atom->rmass_flag) return;
  doubted_ = true;
  for (const std::string &doubt : nscd::doubts(grains(), double(atom->natoms), &ranks_))
    if (comm->me == 0) error->warning(FLERR, "Fix nscd {}: {}", id, doubt);
}

void FixNscd::setup(int /*vflag*/)
{
  check_run();
  find_list();
  step_->begin_run(neighbor->ago == 0);
  step_->see(grains());
  steps_ = 0;
  tell_doubts();
  nscd_progress.begin_run(update->beginstep, update->endstep, update->ntimestep);
  if (comm->me != 0) return;
  if (!step_->crowding().empty()) error->warning(FLERR, "Fix nscd {}: {}", id, step_->crowding());
  utils::logmesg(lmp, "fix nscd {}: {}\n", id, nscd::describe(*step_));
}

// The rank of every atom, from its owner by LAMMPS' communication of ghosts.
void FixNscd::find_homes()
{
  if (comm->nprocs == 1) return;
  homes_.assign(atom->nlocal + atom->nghost, comm->me);
  comm->forward_comm(this);
}

int FixNscd::pack_forward_comm(int count, int *list, double *to, int /*pbc_flag*/, int * /*pbc*/)
{
  for (int k = 0; k < count; ++k) to[k] = homes_[list[k]];
  return count;
}

void FixNscd::unpack_forward_comm(int count, int first, double *from)
{
  for (int k = 0; k < count; ++k) homes_[first + k] = int(from[k]);
}

// A box that fix deform moves without moving the grains has a rate that LAMMPS knows ahead of the first change.
void FixNscd::look_at_box()
{
  std::copy_n(domain->h, 6, box_.edges);
  std::copy_n(domain->boxlo, 3, box_.low);
  std::copy_n(domain->periodicity, 3, box_.periodic);
  box_.rate_known = domain->deform_flag && domain->deform_vremap;
  if (!box_.rate_known) return;
  std::copy_n(domain->h_rate, 6, box_.rate);
  box_.changes_now = false;
  for (const Fix *fix : modify->get_fix_by_style("^deform"))
    if (fix->nevery > 0 && update->ntimestep % fix->nevery == 0) box_.changes_now = true;
}

nscd::Grains FixNscd::grains()
{
  nscd::Grains g;
  g.owned = atom->nlocal;
  g.ghosts = atom->nghost;
  g.x = atom->nlocal + atom->nghost ? atom->x[0] : nullptr;
  g.v = atom->nlocal ? atom->v[0] : nullptr;
  g.f = atom->nlocal ? atom->f[0] : nullptr;
  if (step_->settings().frictional() && atom->nlocal) {
    g.omega = atom->omega[0];
    g.torque = atom->torque ? atom->torque[0] : nullptr;
  } else if (atom->nlocal && atom->torque) {
    g.unread_torque = atom->torque[0];
  }
  g.radius = atom->radius;
  g.mass = atom->rmass;
  if (!atom->rmass) {
    masses_.resize(atom->nlocal);
    for (int i = 0; i < atom->nlocal; ++i) masses_[i] = atom->mass[atom->type[i]];
    g.mass = masses_.data();
  }
  g.tag = atom->tag;
  g.home = homes_.empty() ? nullptr : homes_.data() + atom->nlocal;
  g.mask = atom->mask;
  g.type = atom->type;
  g.group = groupbit;
  g.held = held_;
  g.earlier = others_.earlier;
  g.later = others_.later;
  g.force_to_acceleration = force->ftm2v;
  g.square_to_energy = force->mvv2e;
  look_at_box();
  g.box = &box_;
  return g;
}

nscd::PairList FixNscd::pairs()
{
  nscd::PairList pairs = listed_.pairs(groupbit);
  pairs.excludes = excludes_;
  return pairs;
}

void FixNscd::final_integrate()
{
  if (neighbor->ago == 0 || steps_ == 0) {
    const std::string left = or_stop(error, id, [&] { return lost_.check(); });
    if (!left.empty() && comm->me == 0) error->warning(FLERR, "Fix nscd {}: {}", id, left);
    find_homes();
    or_stop(error, id, [&] {
      checks_.require_sole_integrator();
      checks_.require_bonds_listed(grains());
    });
    if (atom->natoms != atoms_told_of_) {
      tell_of_exclusions();
      checks_.tell_of_force_holders();
    }
  }
  or_stop(error, id, [&] {
    in_step(update->ntimestep, [&] {
      begin_walls();
      step_->advance(grains(), pairs(), update->dt);
    });
    give_to_walls();
  });
  totals_.add(step_->report());
  const double time = update->atime + double(update->ntimestep - update->atimestep) * update->dt;
  nscd_progress.add(step_->report(), update->ntimestep, time);
  ++steps_;
  const bool wants_rebuild =
      or_stop(error, id, [&] { return in_step(update->ntimestep, [&] { return step_->wants_rebuild(); }); });
  next_reneighbor = wants_rebuild ? update->ntimestep + 1 : -1;
  if (local_rows_wanted()) fill_local();
}

void FixNscd::post_run()
{
  for (const std::string &remark : step_->take_remarks())
    if (comm->me == 0) error->warning(FLERR, "Fix nscd {}: {}", id, remark);
}

// They cannot be made when they are read: LAMMPS reads them as they lie.
bool FixNscd::local_rows_wanted() const { return rows_every_step_ || output->next == update->ntimestep; }

void FixNscd::fill_local()
{
  const int rows = int(step_->state().table.contacts.size());
  const int columns = size_local_cols;
  local_values_.resize(std::size_t(rows) * columns);
  nscd::fill_contact_rows(step_->state(), local_values_.data(), columns);
  local_rows_.resize(std::max(rows, 1));
  for (int r = 0; r < rows; ++r) local_rows_[r] = local_values_.data() + std::size_t(r) * columns;
  array_local = local_rows_.data();
  size_local_rows = rows;
}

double FixNscd::compute_scalar() { return step_->report().iterations; }

double FixNscd::compute_vector(int n) { return nscd::report_column(step_->report(), n); }

double FixNscd::compute_array(int /*row*/, int column)
{
  return column < nscd::totals_columns ? totals_.column(column) : 0;
}

// Called on all ranks ahead of the records; rank 0 writes their number of words, which nothing reads.
void FixNscd::write_restart(FILE *file)
{
  records_.give(*step_, restart_words_);   // of a file that was read, and no run since
  records_.collect(*step_, atom->nlocal, atom->tag);
  double largest = records_.largest();
  ranks_.max({&largest, 1});
  largest_record_ = int(largest);
  if (comm->me != 0) return;
  const int bytes = sizeof largest;
  fwrite(&bytes, sizeof bytes, 1, file);
  fwrite(&largest, bytes, 1, file);
}

// Rank 0 alone is asked.
int FixNscd::maxsize_restart() { return largest_record_; }

int FixNscd::size_restart(int atom_index) { return records_.size(atom->tag[atom_index]); }

int FixNscd::pack_restart(int atom_index, double *to) { return records_.pack(atom->tag[atom_index], to); }

// `nth` records of other fixes lie before this one's.
void FixNscd::unpack_restart(int atom_index, int nth)
{
  const double *record = atom->extra[atom_index];
  for (int k = 0; k < nth; ++k) record += int(record[0]);
  restart_words_.insert(restart_words_.end(), record, record + int(record[0]));
}

double FixNscd::memory_usage() { return double(step_->state().table.bytes()); }
