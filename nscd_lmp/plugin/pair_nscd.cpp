// SPDX-License-Identifier: GPL-2.0-or-later
#include "pair_nscd.hpp"

#include "base/error.hpp"
#include "contact_list.hpp"
#include "settings/told_pairs.hpp"

#include <atom.h>
#include <comm.h>
#include <domain.h>
#include <error.h>
#include <fix.h>
#include <memory.h>
#include <modify.h>
#include <neighbor.h>
#include <update.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

using namespace LAMMPS_NS;

namespace {

// Of the mean radius. More makes longer lists, less more of them; and what is added for speeds is no more than `most`.
constexpr double share_of_radius = 0.5, most_for_speeds = 3;

// LAMMPS' default of `neighbor`, by `units`.
double default_skin(const char *units)
{
  if (strcmp(units, "lj") == 0) return 0.3;
  if (strcmp(units, "si") == 0) return 0.001;
  if (strcmp(units, "cgs") == 0 || strcmp(units, "micro") == 0 || strcmp(units, "nano") == 0) return 0.1;
  return 2.0;
}

// One number of a restart file, on all ranks.
template <class T>
T read_one(FILE *file, int me, MPI_Comm world, Error *error)
{
  T value{};
  if (me == 0) utils::sfread(FLERR, &value, sizeof value, 1, file, nullptr, error);
  MPI_Bcast(&value, sizeof value, MPI_BYTE, 0, world);
  return value;
}

template <class T>
void write_one(FILE *file, const T &value)
{
  fwrite(&value, sizeof value, 1, file);
}

}    // namespace

PairNscd::PairNscd(LAMMPS *lmp) : Pair(lmp)
{
  single_enable = 0;
  restartinfo = 1;
  writedata = 1;
  respa_enable = 0;
  finitecutflag = 1;
  no_virial_fdotr_compute = 1;
}

PairNscd::~PairNscd()
{
  if (!allocated) return;
  memory->destroy(setflag);
  memory->destroy(cutsq);
}

void PairNscd::allocate()
{
  allocated = 1;
  types_ = std::size_t(atom->ntypes);
  const int n = int(types_) + 1;
  memory->create(setflag, n, n, "pair:setflag");
  memory->create(cutsq, n, n, "pair:cutsq");
  for (int i = 1; i < n; ++i)
    for (int j = 1; j < n; ++j) setflag[i][j] = 0, cutsq[i][j] = 0;
  own_.assign(std::size_t(n) * n, {});
}

void PairNscd::compute(int eflag, int vflag) { ev_init(eflag, vflag); }

void PairNscd::settings(int narg, char **arg)
{
  if (narg > 0)
    error->all(FLERR,
               "Pair style nscd takes no arguments, but '{}' stands behind it: materials are given by pair_coeff, and "
               "cutoffs come from the radii of the grains",
               arg[0]);
}

void PairNscd::set(int i, int j, const nscd::OwnMaterial &given)
{
  own(i, j) = given;
  setflag[i][j] = 1;
}

void PairNscd::coeff(int narg, char **arg)
{
  if (!allocated) allocate();
  int ilo, ihi, jlo, jhi;
  utils::bounds_typelabel(FLERR, arg[0], 1, int(types_), ilo, ihi, lmp, Atom::ATOM);
  utils::bounds_typelabel(FLERR, arg[1], 1, int(types_), jlo, jhi, lmp, Atom::ATOM);
  try {
    const nscd::OwnMaterial given = nscd::read_own_material({arg + 2, arg + narg});
    for (int i = ilo; i <= ihi; ++i)
      for (int j = jlo; j <= jhi; ++j) set(std::min(i, j), std::max(i, j), given);
  } catch (const nscd::Error &refused) {
    error->all(FLERR, "Pair nscd: pair_coeff {} {}: {}", arg[0], arg[1], refused.what());
  }
}

std::vector<nscd::PairMaterial> PairNscd::materials() const
{
  std::vector<nscd::PairMaterial> given;
  for (int i = 1; i <= int(types_); ++i)
    for (int j = i; j <= int(types_); ++j)
      if (setflag[i][j]) given.push_back({std::to_string(i) + " " + std::to_string(j), {i, i}, {j, j}, own(i, j)});
  return given;
}

nscd::Mixing PairNscd::mixing() const
{
  if (mix_flag == SIXTHPOWER) error->all(FLERR, "Pair nscd mixes materials by pair_modify mix geometric or arithmetic");
  return mix_flag == ARITHMETIC ? nscd::Mixing::arithmetic : nscd::Mixing::geometric;
}

std::string PairNscd::described() const
{
  return nscd::told(materials(), mixing());
}

// What nscd_lmp.attach asks by LAMMPS' C interface, which has no names for its types: `dim` stays unknown.
void *PairNscd::extract(const char *what, int & /*dim*/)
{
  if (strcmp(what, "nscd/materials") == 0) return (told_materials_ = described()).data();
  if (strcmp(what, "nscd/list") == 0) return (told_list_ = told_list(lmp)).data();
  return nullptr;
}

void PairNscd::init_style()
{
  if (!atom->radius_flag) error->all(FLERR, "Pair nscd needs the radii of grains: use atom_style sphere");
  measure_radii();
  choose_list();
  neighbor->add_request(this, NeighConst::REQ_SIZE);
}

// Those that fixes pour and deposit will insert included, as pair_style granular asks them.
void PairNscd::measure_radii()
{
  std::vector<double> sums{0, 0}, largest(types_ + 1, 0.0);
  for (int i = 0; i < atom->nlocal; ++i) {
    sums[0] += atom->radius[i], sums[1] += 1;
    largest[atom->type[i]] = std::max(largest[atom->type[i]], atom->radius[i]);
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, world);
  MPI_Allreduce(MPI_IN_PLACE, largest.data(), int(largest.size()), MPI_DOUBLE, MPI_MAX, world);
  double inserted = 0;
  for (const char *style : {"^pour", "^deposit"})
    for (Fix *fix : modify->get_fix_by_style(style))
      for (int type = 1; type <= int(types_); ++type) {
        int asked = type;
        const auto *radius = static_cast<double *>(fix->extract("radius", asked));
        if (!radius) continue;
        largest[type] = std::max(largest[type], *radius);
        inserted = std::max(inserted, *radius);
      }
  largest_radius_ = largest;
  mean_radius_ = sums[1] > 0 ? sums[0] / sums[1] : inserted;
}

// In place of LAMMPS' defaults, which know no radii. What a script gives by `neighbor` stays.
void PairNscd::choose_list()
{
  const bool given = neighbor->skin != default_skin(update->unit_style) && neighbor->skin != chosen_skin_;
  if (given || !(mean_radius_ > 0)) return;
  // Once for the step to come, and once for the moves since the list was built.
  const double for_speeds = std::min(2 * approach_in_step(), most_for_speeds * mean_radius_);
  neighbor->skin = chosen_skin_ = share_of_radius * mean_radius_ + for_speeds;
  const bool ours = chosen_multi_ || neighbor->style == Neighbor::BIN;
  const std::vector<double> upper = intervals();
  if (!ours || (upper.size() < 2 && !chosen_multi_)) return;
  neighbor->style = Neighbor::MULTI;
  std::string words = "collection/interval " + std::to_string(upper.size());
  for (const double bound : upper) words += " " + fmt::format("{}", bound);
  neighbor->modify_params(words);
  chosen_multi_ = true;
}

// What two grains approach each other by in a step, as fast as they are or get if they fall through the box, m.
double PairNscd::approach_in_step() const
{
  double speed2 = 0;
  for (int i = 0; i < atom->nlocal; ++i) {
    const double *v = atom->v[i];
    speed2 = std::max(speed2, v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  }
  MPI_Allreduce(MPI_IN_PLACE, &speed2, 1, MPI_DOUBLE, MPI_MAX, world);
  for (Fix *fix : modify->get_fix_by_style("^gravity")) {
    int vector = 0;
    const auto *pull = static_cast<double *>(fix->extract("gvec", vector));
    for (int d = 0; pull && d < domain->dimension; ++d) speed2 += 2 * std::abs(pull[d]) * domain->prd[d];
  }
  return 2 * update->dt * std::sqrt(speed2);
}

// Diameters up to which grains share bins, m: with bins for the largest, each of many small ones would look at
// thousands. One for grains of about the mean size, and one for each power of four beyond that has grains.
std::vector<double> PairNscd::intervals() const
{
  constexpr double about_the_mean = 1.25, apart = 4;
  const double largest = 2 * *std::max_element(largest_radius_.begin(), largest_radius_.end());
  const double first = about_the_mean * 2 * mean_radius_;
  if (!(largest > apart * first)) return {largest * (1 + 1e-9)};
  const auto interval = [&](double radius) {
    return std::size_t(std::max(0.0, std::ceil(std::log(2 * radius / first) / std::log(apart))));
  };
  std::vector<int> held(interval(0.5 * largest) + 1, 0);
  for (int i = 0; i < atom->nlocal; ++i) held[std::min(interval(atom->radius[i]), held.size() - 1)] = 1;
  MPI_Allreduce(MPI_IN_PLACE, held.data(), int(held.size()), MPI_INT, MPI_MAX, world);
  std::vector<double> upper;
  for (std::size_t k = 0; k + 1 < held.size(); ++k)
    if (held[k]) upper.push_back(first * std::pow(apart, double(k)));
  upper.push_back(largest * (1 + 1e-9));
  return upper;
}

double PairNscd::init_one(int i, int j)
{
  if (!setflag[i][j]) did_mix = true;
  const double cutoff = largest_radius_[i] + largest_radius_[j];
  // Types without grains have no pairs yet, and LAMMPS wants a cutoff of all.
  return cutoff > 0 ? cutoff : 2 * *std::max_element(largest_radius_.begin(), largest_radius_.end());
}

// Of each pair of types: whether it was given, then of each number of a material whether it was, and the number.
void PairNscd::write_restart(FILE *file)
{
  write_one(file, mix_flag);
  for (int i = 1; i <= int(types_); ++i)
    for (int j = i; j <= int(types_); ++j) {
      write_one(file, setflag[i][j]);
      for (std::size_t part = 0; part < nscd::material_parts.size(); ++part) {
        write_one(file, int(own(i, j).has(part)));
        write_one(file, own(i, j).value(part));
      }
    }
}

void PairNscd::read_restart(FILE *file)
{
  allocate();
  mix_flag = read_one<int>(file, comm->me, world, error);
  for (int i = 1; i <= int(types_); ++i)
    for (int j = i; j <= int(types_); ++j) {
      setflag[i][j] = read_one<int>(file, comm->me, world, error);
      for (std::size_t part = 0; part < nscd::material_parts.size(); ++part) {
        const bool has = read_one<int>(file, comm->me, world, error) != 0;
        const auto value = read_one<double>(file, comm->me, world, error);
        if (has) own(i, j).set(part, value);
      }
    }
}

void PairNscd::write_data(FILE *file)
{
  for (int i = 1; i <= int(types_); ++i) fprintf(file, "%d %s\n", i, written(own(i, i)).c_str());
}

void PairNscd::write_data_all(FILE *file)
{
  for (int i = 1; i <= int(types_); ++i)
    for (int j = i; j <= int(types_); ++j)
      if (setflag[i][j]) fprintf(file, "%d %d %s\n", i, j, written(own(i, j)).c_str());
}

double PairNscd::memory_usage() { return double(own_.size()) * sizeof(nscd::OwnMaterial) + Pair::memory_usage(); }
