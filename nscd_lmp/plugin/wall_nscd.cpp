// SPDX-License-Identifier: GPL-2.0-or-later
#include "wall_nscd.hpp"

#include "base/error.hpp"
#include "fix_nscd.hpp"
#include "obstacle/kinds.hpp"
#include "obstacle/moved.hpp"
#include "region_checks.hpp"
#include "region_wall.hpp"

#include <atom.h>
#include <comm.h>
#include <domain.h>
#include <error.h>
#include <memory.h>
#include <modify.h>
#include <update.h>

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;

namespace {

constexpr int row_columns = 8;   // as fix wall/gran has them

std::string name_of(const char *id) { return std::string("fix ") + id; }

std::size_t count_words(std::string_view text) { return std::size_t(std::count(text.begin(), text.end(), ' ')) + 1; }

// Adds the kinds that LAMMPS has to the list of ours that an error shows.
std::shared_ptr<const nscd::Obstacle> read_shape(nscd::Arguments &words, const std::string &name)
{
  std::string choices = "region";
  for (const nscd::ObstacleEntry &entry : nscd::obstacle_kinds()) {
    choices.append(", ").append(entry.name);
    if (!words.skip(entry.name)) continue;
    words.require(count_words(entry.words), std::string(entry.name) + " " + std::string(entry.words));
    return entry.read(words, name);
  }
  nscd::fail("unknown wall '", words.word(), "': choose one of ", choices);
}

// The words that say where a wall is and how it moves: all but those of its contacts.
std::string place_of(const std::vector<std::string> &words)
{
  std::string place;
  for (std::size_t k = 1; k < words.size(); ++k) {
    const std::string &word = words[k];
    if (word == "friction" || word == "restitution" || word == "e_t") ++k;
    else if (word != "stick" && word != "contacts") place += word + " ";
  }
  return place;
}

// Without the name in front, which the message has already.
std::string without_name(const std::string &message, const std::string &name)
{
  const std::string front = name + ": ";
  return message.rfind(front, 0) == 0 ? message.substr(front.size()) : message;
}

}    // namespace

std::vector<FixWallNscd *> LAMMPS_NS::walls_of(LAMMPS *lmp)
{
  std::vector<FixWallNscd *> walls;
  for (Fix *fix : lmp->modify->get_fix_list())
    if (auto *wall = dynamic_cast<FixWallNscd *>(fix)) walls.push_back(wall);
  return walls;
}

FixWallNscd::FixWallNscd(LAMMPS *lmp, int narg, char **arg) :
    Fix(lmp, narg, arg), options_(name_of(arg[0])),
    variables_(std::make_shared<VariableCourse>(lmp, name_of(arg[0])))
{
  vector_flag = 1;
  size_vector = columns;
  global_freq = 1;
  extvector = 0;
  restart_global = 1;
  dynamic_group_allow = 1;
  try {
    read({arg + 2, arg + narg});
  } catch (const nscd::Error &refused) {
    error->all(FLERR, "Fix wall/nscd {}: {}", id, without_name(refused.what(), name_of(id)));
  }
  if (comm->me == 0 && shape_ && !shape_->told().empty())
    utils::logmesg(lmp, "fix wall/nscd {}: {}\n", id, shape_->told());
  tell_fixes_nscd();
  if (!wants_rows_) return;
  peratom_flag = 1;
  size_peratom_cols = row_columns;
  peratom_freq = 1;
  clear_rows();
}

FixWallNscd::~FixWallNscd()
{
  memory->destroy(array_atom);
  tell_fixes_nscd();
}

void FixWallNscd::tell_fixes_nscd() const
{
  for (Fix *fix : modify->get_fix_list())
    if (auto *solves = dynamic_cast<FixNscd *>(fix)) solves->forget_walls();
}

// `words` begin with the style, as errors name it.
void FixWallNscd::read(std::vector<std::string> words)
{
  place_ = place_of(words);
  variables_->read(words);
  nscd::Arguments rest(words);
  rest.keyword();
  if (rest.done()) nscd::fail("give a wall: region ID, or a kind such as zplane lo hi");
  if (rest.skip("region")) {
    rest.require(1, "region ID");
    region_id_ = rest.word();
  } else shape_ = read_shape(rest, name_of(id));
  while (!rest.done()) {
    if (!wants_rows_ && rest.skip("contacts")) wants_rows_ = true;
    else if (wants_rows_ && rest.next_is("contacts")) nscd::fail("contacts is given twice: give it once");
    else if (!options_.read(rest)) nscd::refuse_own_word(rest.word(), "friction, restitution, e_t, contacts, wiggle, "
                                                        "shear, rotate, move");
  }
  if (variables_->is_given() && options_.moves())
    nscd::fail("it moves by variables and by wiggle, shear or a period at once: use one of them");
  if (region_id_.empty()) return;
  Region *region = domain->get_region_by_id(region_id_);
  if (!region) nscd::fail("there is no region ", region_id_, ": define it before the fix");
  if (region->dynamic && (variables_->is_given() || options_.moves()))
    nscd::fail("region ", region_id_, " moves, and so would its wall: give the motion to one of them");
  const RegionTree fits(region);   // what does not is said now
}

void FixWallNscd::init()
{
  const auto others = modify->get_fix_by_style("^nscd");
  if (others.empty())
    error->all(FLERR, "Fix wall/nscd {} needs a fix nscd, which solves its contacts: add `fix ID group nscd`", id);
  for (const FixWallNscd *other : walls_of(lmp)) {
    if (other == this) return;
    const bool meets = other->groupbit == groupbit || other->groupbit == 1 || groupbit == 1;
    if (other->place_ == place_ && meets)
      error->all(FLERR, "Fix wall/nscd {} is the same wall as fix {}, and grains would touch both: remove one", id,
                 other->id);
  }
}

std::shared_ptr<const nscd::Obstacle> FixWallNscd::shape_in_run()
{
  if (region_id_.empty()) return shape_;
  Region *region = domain->get_region_by_id(region_id_);
  if (!region)
    nscd::fail(name_of(id), ": region ", region_id_, " is not there any more: unfix ", id,
               ", or define the region again");
  region->init();
  tree_ = std::make_shared<RegionTree>(region);
  tree_->begin_run();
  std::erase_if(trees_, [](const std::weak_ptr<RegionTree> &tree) { return tree.expired(); });
  trees_.push_back(tree_);
  return std::make_shared<RegionWall>(tree_, domain->dimension == 2);
}

nscd::Wall FixWallNscd::begin_run()
{
  auto shape = shape_in_run();
  step_ = update->ntimestep;
  if (tree_) RegionChecks(lmp, *tree_).require_true_normals(*shape);
  clear();
  if (variables_->is_given()) {
    variables_->begin_run(time_);
    shape = std::make_shared<nscd::Moved>(shape, variables_, time_);
  }
  nscd::Wall wall = options_.wall(shape, time_);
  wall.groups = groupbit == 1 ? 0 : groupbit;
  about_ = nscd::torque_point(*wall.shape);
  if (tree_ && tree_->rotation_point()) std::copy_n(tree_->rotation_point(), 3, about_.begin());
  return wall;
}

void FixWallNscd::begin_step()
{
  if (step_ == update->ntimestep) return;
  step_ = update->ntimestep;
  const bool asks = variables_->is_given() || (tree_ && tree_->moves());
  if (asks) modify->clearstep_compute();
  if (variables_->is_given()) variables_->begin_step(time_, update->dt);
  for (const std::weak_ptr<RegionTree> &tree : trees_)
    if (const auto alive = tree.lock(); alive && alive->moves()) alive->begin_step(update->dt);
  if (asks) modify->addstep_compute(step_ + 1);
  dt_ = update->dt;
  time_ += dt_;
  clear();
}

void FixWallNscd::clear()
{
  sums_.fill(0);
  summed_ = -1;
  if (wants_rows_) clear_rows();
}

void FixWallNscd::clear_rows()
{
  if (rows_ < atom->nmax || !array_atom) {
    rows_ = std::max(atom->nmax, 1);
    memory->destroy(array_atom);
    memory->create(array_atom, rows_, row_columns, "wall/nscd:array_atom");
  }
  std::fill_n(array_atom[0], std::size_t(rows_) * row_columns, 0.0);
  strongest_.assign(std::size_t(rows_), -1.0);
}

void FixWallNscd::add(const nscd::WallTouch &touch)
{
  nscd::add_touch(sums_, touch, about_);
  const double size = std::hypot(touch.force[0], touch.force[1], touch.force[2]);
  if (!wants_rows_ || size == 0) return;
  double *row = array_atom[touch.grain];
  row[0] = 1;
  for (int d = 0; d < 3; ++d) row[1 + d] += touch.force[d];
  if (size > strongest_[std::size_t(touch.grain)]) {
    strongest_[std::size_t(touch.grain)] = size;
    for (int d = 0; d < 3; ++d) row[4 + d] = touch.place[d];
  }
  row[7] = atom->radius[touch.grain];
}

double FixWallNscd::compute_vector(int n)
{
  if (n < shift) {
    if (summed_ != step_) MPI_Allreduce(sums_.data(), all_.data(), int(sums_.size()), MPI_DOUBLE, MPI_SUM, world);
    summed_ = step_;
    return all_[std::size_t(n)];
  }
  if (tree_ && tree_->moves()) {
    const RegionPose pose = tree_->poses_at(dt_)[0], rates = tree_->rates();
    if (n >= angle) return n == angle ? pose.angle : rates.angle;
    return n < velocity ? pose.shift[n - shift] : rates.shift[n - velocity];
  }
  const nscd::Course *course = variables_->is_given() ? variables_.get() : options_.course();
  if (!course) return 0;
  const nscd::Place now = course->at(time_), before = course->at(time_ - dt_);
  const double per_step = dt_ > 0 ? 1 / dt_ : 0;
  if (n >= angle) return n == angle ? now.angle : (now.angle - before.angle) * per_step;
  if (n < velocity) return now.shift[n - shift];
  return (now.shift[n - velocity] - before.shift[n - velocity]) * per_step + course->belt[n - velocity];
}

void FixWallNscd::require_inside(int group) const
{
  if (!tree_) return;
  const auto region = std::make_shared<RegionWall>(tree_, domain->dimension == 2);
  std::shared_ptr<const nscd::Moved> moved;
  if (variables_->is_given()) moved = std::make_shared<nscd::Moved>(region, variables_, time_);
  else moved = std::dynamic_pointer_cast<const nscd::Moved>(options_.wall(region, time_).shape);
  RegionChecks(lmp, *tree_).require_inside(group, groupbit, dt_, id, moved.get());
}

void FixWallNscd::write_restart(FILE *file)
{
  if (comm->me != 0) return;
  const int bytes = sizeof time_;
  fwrite(&bytes, sizeof bytes, 1, file);
  fwrite(&time_, bytes, 1, file);
}

void FixWallNscd::restart(char *buffer) { memcpy(&time_, buffer, sizeof time_); }

double FixWallNscd::memory_usage() { return double(rows_) * row_columns * sizeof(double); }
